//! The build's own name: a digest of everything the program is made from, so that a record can say which program wrote
//! it, and a run is not gone on with by another. In: sources, grammar, locked dependencies. Out: `PSD_BUILD`.

use std::path::{Path, PathBuf};
use std::{env, fs};

/// FNV-1a, 64 bits: it tells builds apart, it proves nothing. (Fowler, Noll, Vo; offset basis and prime as published.)
struct Digest(u64);

impl Digest {
    fn take(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo gives the folder"));
    let mut files = Vec::new();
    for folder in ["src", "grammar"] {
        println!("cargo::rerun-if-changed={folder}");
        walk(&root.join(folder), &mut files);
    }
    for file in ["Cargo.toml", "Cargo.lock"] {
        println!("cargo::rerun-if-changed={file}");
        files.push(root.join(file));
    }
    files.sort();
    let mut digest = Digest(0xcbf2_9ce4_8422_2325);
    for file in files {
        // A package may come without its lock file.
        let Ok(bytes) = fs::read(&file) else { continue };
        let name = file.strip_prefix(&root).unwrap_or(&file).to_string_lossy().replace('\\', "/");
        for part in [name.as_bytes(), bytes.as_slice()] {
            digest.take(&(part.len() as u64).to_le_bytes());
            digest.take(part);
        }
    }
    println!("cargo::rustc-env=PSD_BUILD={:016x}", digest.0);
}

fn walk(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            walk(&path, files);
        } else {
            files.push(path);
        }
    }
}
