//! The identifier of the program, calculated from the sources as `docs/record.md` describes.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::stage::PSD;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

#[test]
fn the_identifier_of_the_program_follows_from_its_sources() {
    let page = fs::read_to_string(Path::new(ROOT).join("docs/record.md")).unwrap();
    let script = page
        .split("```")
        .find(|block| block.contains("find Cargo.toml"))
        .expect("the page says how");
    let mut shell = Command::new("sh");
    shell
        .args(["-c", script.trim_start_matches("sh")])
        .current_dir(ROOT);
    let calculated = String::from_utf8(shell.output().unwrap().stdout).unwrap();
    let digest = calculated
        .split_whitespace()
        .next()
        .expect("it says a digest");
    let version = Command::new(PSD).arg("--version").output().unwrap();
    let version = String::from_utf8(version.stdout).unwrap();
    assert!(version.contains(digest), "{digest} is not in: {version}");
}
