//! Files of the repository that a text names exist.

use std::path::Path;

use super::literals::literals;
use super::pages::commands;
use crate::explain_pages::shown_text;
use crate::source_text::{none, rust_files};

#[test]
fn files_that_a_message_names_exist() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let is_path = |word: &str| {
        let folder = ["docs/", "grammar/", "plans/", "src/", "tests/"]
            .iter()
            .any(|folder| word.starts_with(folder));
        let ending = [".md", ".json", ".psd", ".rs"]
            .iter()
            .any(|ending| word.ends_with(ending));
        folder && ending && !word.contains(['{', '*']) && !word.contains("NAME")
    };
    let mut texts: Vec<(String, String)> = Vec::new();
    for file in rust_files("src").iter().filter(|file| !file.is_test()) {
        let named = literals(file).into_iter();
        texts.extend(named.map(|(line, text)| (format!("src/{}:{line}", file.path), text)));
    }
    commands(&[], &mut texts);
    texts.extend(
        psd::codes::all()
            .iter()
            .map(|code| (format!("psd explain {code}"), shown_text(*code))),
    );
    let mut missing = Vec::new();
    let mut seen = 0;
    for (position, text) in &texts {
        let words = text.split(|c: char| c.is_whitespace() || "`'\"(),;".contains(c));
        for word in words
            .map(|word| word.trim_end_matches(['.', ':']))
            .filter(|word| is_path(word))
        {
            seen += 1;
            if !root.join(word).exists() {
                missing.push(format!("{position} names {word}"));
            }
        }
    }
    none(&missing, "a message names a file that does not exist");
    assert!(seen > 5, "{seen} files named");
}
