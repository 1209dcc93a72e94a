//! mdBook builds the book of `docs/` without a warning, and finds its pages by search. Skipped without mdBook.

mod emulator;

use std::fs;
use std::process::Command;

use tempfile::TempDir;

#[test]
fn mdbook_builds_the_book() {
    let folder = TempDir::new().expect("a folder can be made");
    let build = Command::new("mdbook")
        .args(["build", "--dest-dir"])
        .arg(folder.path())
        .arg(env!("CARGO_MANIFEST_DIR"))
        .output();
    let Ok(build) = build else {
        println!("SKIPPED: no mdBook here");
        return;
    };
    let output = String::from_utf8_lossy(&build.stderr).into_owned()
        + &String::from_utf8_lossy(&build.stdout);
    assert!(build.status.success(), "{output}");
    assert!(
        !output.contains("WARN") && !output.contains("ERROR"),
        "{output}"
    );
    let page = |name: &str| fs::read_to_string(folder.path().join(name)).expect("a page");
    // The reference is included from `grammar/LANGUAGE.md`.
    assert!(page("reference/vocabulary.html").contains("max_displacement"));
    let mut files = fs::read_dir(folder.path()).expect("the site");
    let is_index = |name: &str| name.starts_with("searchindex");
    assert!(
        files.any(|file| is_index(&file.expect("a file").file_name().to_string_lossy())),
        "the site has a search index"
    );
}
