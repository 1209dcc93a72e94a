//! The string literals of `src` that reach a reader. In: a source text. Out: each literal with its line, as a reader sees it.

use super::without_code;
use crate::source_text::SourceText;

/// Folders whose strings reach no reader: the bytes of a protocol, and tests.
const SILENT: &[&str] = &["emulator/firmware", "tests"];

/// Whether no string of this file reaches a reader.
pub(super) fn is_silent(file: &SourceText) -> bool {
    let is_test = file.path.ends_with("_tests.rs") || file.path.ends_with("testing.rs");
    is_test || file.is_test() || file.is_in(SILENT)
}

/// The string literals of a source text, each with its line, without comments, tests, assertions and the reasons of lints.
pub(super) fn literals(source: &SourceText) -> Vec<(usize, String)> {
    let product = source
        .text
        .split_once("#[cfg(test)]\nmod tests {")
        .map_or(source.text.as_str(), |(product, _)| product);
    let text: Vec<char> = product.chars().collect();
    let (mut found, mut at, mut line) = (Vec::new(), 0, 1);
    while at < text.len() {
        match text[at] {
            '/' if text.get(at + 1) == Some(&'/') => {
                at += text[at..].iter().take_while(|c| **c != '\n').count();
                continue;
            }
            // A character, not a lifetime.
            '\'' if text.get(at + 1) == Some(&'\\') => {
                at += 2
                    + text[at + 2..]
                        .iter()
                        .skip(1)
                        .take_while(|c| **c != '\'')
                        .count()
                    + 1;
            }
            '\'' if text.get(at + 2) == Some(&'\'') => at += 2,
            '"' => {
                let (value, length) = literal(&text[at + 1..]);
                let before: String = text[at.saturating_sub(48)..at].iter().collect();
                if !is_for_developers(before.trim_end()) {
                    found.push((line, value));
                }
                line += text[at..at + length].iter().filter(|c| **c == '\n').count();
                at += length;
            }
            '\n' => line += 1,
            _ => {}
        }
        at += 1;
    }
    found
}

/// The value of the literal that begins here, after its quote, and its length with the closing quote.
fn literal(text: &[char]) -> (String, usize) {
    let (mut value, mut at) = (String::new(), 0);
    while at < text.len() && text[at] != '"' {
        if text[at] == '\\' {
            at += 1;
            match text.get(at) {
                Some('\n') => {
                    at += text[at + 1..]
                        .iter()
                        .take_while(|c| c.is_whitespace())
                        .count();
                }
                Some('n') => value.push('\n'),
                Some('t') => value.push(' '),
                Some(other) => value.push(*other),
                None => {}
            }
        } else {
            value.push(text[at]);
        }
        at += 1;
    }
    (value, at + 1)
}

fn is_for_developers(before: &str) -> bool {
    [
        "reason =",
        ".expect(",
        "unreachable!(",
        "panic!(",
        "assert!(",
        "include_str!(",
        "env!(",
    ]
    .iter()
    .any(|call| before.ends_with(call))
}

/// A literal as a reader sees it: code and placeholders are one word each. None: it is no text.
pub(super) fn message(literal: &str) -> Option<String> {
    let mut text = String::new();
    let mut depth = 0;
    for c in without_code(literal).chars() {
        match c {
            '{' => depth += 1,
            '}' if depth > 0 => {
                depth -= 1;
                text.push('x');
            }
            c if depth == 0 => text.push(c),
            _ => {}
        }
    }
    let is_word = |word: &&str| word.chars().filter(|c| c.is_alphabetic()).count() > 1;
    (text.split_whitespace().filter(is_word).count() > 1).then_some(text)
}
