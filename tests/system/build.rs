//! The program's own name: what `docs/record.md` has anybody reckon from the sources, and what those sources are.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::stage::PSD;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// What a shell says, run at the root of the sources.
fn told(script: &str) -> String {
    let output = Command::new("sh").args(["-c", script]).current_dir(ROOT).output().unwrap();
    assert!(output.status.success(), "{script}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The lines of the page that reckon it.
fn documented() -> String {
    let page = fs::read_to_string(Path::new(ROOT).join("docs/record.md")).unwrap();
    let script = page.split("```").find(|block| block.contains("find Cargo.toml")).expect("the page says how");
    script.trim_start_matches("sh").to_owned()
}

#[test]
fn anybody_reckons_the_name_of_the_program_from_its_sources() {
    let reckoned = told(&documented());
    let digest = reckoned.split_whitespace().next().unwrap();
    let version = Command::new(PSD).arg("--version").output().unwrap();
    let version = String::from_utf8(version.stdout).unwrap();
    assert!(version.contains(digest), "{digest} is not in: {version}");
}

/// What cargo read to make the program is told beside it: each of those files counts.
#[test]
fn every_source_of_the_program_counts() {
    let counted = told(documented().split("| sort").next().unwrap());
    let counted: Vec<&str> = counted.lines().collect();
    let read = fs::read_to_string(Path::new(PSD).with_extension("d")).unwrap();
    let sources: Vec<&str> = read.split_whitespace().filter_map(|path| path.strip_prefix(ROOT)?.strip_prefix('/')).collect();
    assert!(sources.contains(&"src/lib.rs"), "{read}");
    for source in sources.into_iter().filter(|source| !source.starts_with("target/")) {
        assert!(counted.contains(&source), "{source} does not count");
    }
}
