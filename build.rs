//! The identifier of the build, and the addresses that the program is linked to. The identifier is a digest of all sources of the
//! program and of the tools that built it. With it a log identifies the program that wrote it, and no other program resumes its run. In:
//! sources, grammar, manifests, the compiler. Out: `PSD_BUILD` (SHA-256) and `PSD_TOOLCHAIN`, which depend on neither a path of this
//! machine nor a date, and the pages of `psd explain`. The two lines of `docs/record.md` reproduce the digest.
//!
//! Files that are not part of a run do not count: `tests.rs`, `testing.rs`, `…_tests.rs`, and those in a folder `tests`, `testing`,
//! `examples`, `benches`, `explain` or `editors`. After a change of a test only the tests are built.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use sha2::{Digest as _, Sha256};

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo gives the folder"));
    let mut files = Vec::new();
    for folder in ["src", "grammar"] {
        walk(&root, folder, &mut files);
    }
    files.extend(["Cargo.toml", "Cargo.lock", "build.rs"].map(str::to_owned));
    files.sort();
    let mut listed = String::new();
    // Cargo watches files, not folders, so that a changed test file triggers nothing. A new source is named in a watched file.
    for name in files {
        println!("cargo::rerun-if-changed={name}");
        // A published package may have no lock file.
        let Ok(bytes) = fs::read(root.join(&name)) else {
            continue;
        };
        let _ = writeln!(listed, "{}  {name}", sha256(&bytes));
    }
    println!("cargo::rustc-env=PSD_BUILD={}", sha256(listed.as_bytes()));
    println!("cargo::rustc-env=PSD_TOOLCHAIN={}", toolchain());
    pages(&root);
    fixed_addresses();
}

/// Writes `pages.rs`: an array of every diagnostic code with its page, without the cases of the page.
fn pages(root: &Path) {
    const FOLDER: &str = "src/text/diagnostic/explain";
    println!("cargo::rerun-if-changed={FOLDER}");
    let mut names: Vec<_> = fs::read_dir(root.join(FOLDER))
        .expect("the folder of the pages can be read")
        .map(|entry| entry.expect("the entry can be read").path())
        .filter(|path| !path.ends_with("README.md"))
        .collect();
    names.sort();
    let mut array = "[\n".to_owned();
    for name in names {
        let code = name.file_stem().unwrap_or_default().to_string_lossy();
        let page = fs::read_to_string(&name).expect("a page is text");
        let shown = page.split("\n## Cases\n").next().unwrap_or_default();
        let _ = writeln!(array, "    ({code:?}, {shown:?}),");
    }
    let folder = PathBuf::from(env::var_os("OUT_DIR").expect("cargo gives the folder"));
    fs::write(folder.join("pages.rs"), array + "]\n").expect("the pages can be written");
}

/// On Linux the program is linked to fixed addresses. Its large libraries have 200,000 addresses in their tables, which the loader would
/// otherwise write at each start: 3 ms and 6 MiB of every command.
fn fixed_addresses() {
    let target = |part: &str| env::var(format!("CARGO_CFG_TARGET_{part}")).unwrap_or_default();
    if target("OS") == "linux" && target("ENV") == "gnu" {
        println!("cargo::rustc-link-arg-bins=-no-pie");
    }
}

fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes)
        .iter()
        .fold(String::new(), |mut hex, byte| {
            let _ = write!(hex, "{byte:02x}");
            hex
        })
}

/// The other inputs of the machine code: target, profile, compiler.
fn toolchain() -> String {
    println!("cargo::rerun-if-env-changed=RUSTC");
    let variable = |name| env::var(name).unwrap_or_else(|_| "unknown".to_owned());
    let version = Command::new(variable("RUSTC"))
        .arg("--version")
        .output()
        .ok();
    let version = version.and_then(|output| String::from_utf8(output.stdout).ok());
    let version = version.map_or_else(|| "rustc unknown".to_owned(), |text| text.trim().to_owned());
    format!(
        "{}, {} profile at optimisation {}, {version}",
        variable("TARGET"),
        variable("PROFILE"),
        variable("OPT_LEVEL")
    )
}

fn walk(root: &Path, folder: &str, files: &mut Vec<String>) {
    for entry in fs::read_dir(root.join(folder))
        .into_iter()
        .flatten()
        .flatten()
    {
        let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            if !matches!(
                name.rsplit('/').next(),
                Some("tests" | "testing" | "examples" | "benches" | "explain" | "editors")
            ) {
                walk(root, &name, files);
            }
        } else if !["/tests.rs", "/testing.rs", "_tests.rs"]
            .iter()
            .any(|end| name.ends_with(end))
        {
            files.push(name);
        }
    }
}
