//! The messages in the page on troubleshooting are messages of the program: the parts between `…` occur in its sources.

use std::fs;
use std::path::Path;

/// The sources, with multi-line strings joined.
fn sources() -> String {
    let (mut folders, mut text) = (
        vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src")],
        String::new(),
    );
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder of sources") {
            let path = entry.expect("a readable entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                text += &fs::read_to_string(path).expect("a readable source");
            }
        }
    }
    let mut parts = text.split("\\\n");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |joined, part| joined + part.trim_start())
}

#[test]
fn every_message_on_the_page_is_one_of_the_program() {
    let sources = sources();
    let page = super::text(Path::new("how-to/troubleshooting.md"));
    let (messages, _) = page
        .split_once("## The result is not")
        .expect("the page has messages, then observations");
    let mut seen = 0;
    for row in messages.lines().filter_map(|line| line.strip_prefix("| ")) {
        let cell = row.split(" | ").next().unwrap_or_default();
        if cell == "message" {
            continue;
        }
        for part in cell.split(['…', '(', ')', '`']) {
            let part = part.trim_matches([' ', ',', '.', ';']);
            assert!(
                part.len() < 6 || sources.contains(part),
                "how-to/troubleshooting.md: no message has `{part}`"
            );
        }
        seen += 1;
    }
    assert!(seen > 15, "{seen} messages");
}
