//! The style of the book: short sentences, and no idiom that the glossary replaces. Code, tables, headings and generated parts are not
//! checked.

use std::path::Path;

use crate::words::{IDIOMS, idioms, sentences as sentences_of, without_code, words};

/// The sentences of a page, code replaced by a letter.
fn sentences(text: &str) -> Vec<String> {
    let (mut fenced, mut generated) = (false, false);
    let mut paragraphs = vec![String::new()];
    for line in text.lines() {
        if line.starts_with("```") {
            fenced = !fenced;
            paragraphs.push(String::new());
        } else if line.starts_with("<!--") {
            generated = line == "<!-- generated -->";
        } else if !fenced && !generated {
            let list = line.starts_with("- ")
                || line
                    .trim_start_matches(|c: char| c.is_ascii_digit())
                    .starts_with(". ");
            if line.is_empty() || list {
                paragraphs.push(String::new());
            }
            if !line.starts_with(['|', '#']) {
                let last = paragraphs.last_mut().expect("never empty");
                *last += line.trim_start_matches("- ");
                last.push(' ');
            }
        }
    }
    paragraphs
        .iter()
        .flat_map(|paragraph| sentences_of(&without_targets(&without_code(paragraph))))
        .collect()
}

/// A text without the targets of its links.
fn without_targets(text: &str) -> String {
    let mut parts = text.split("](");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |kept, part| {
        kept + part.split_once(')').map_or("", |(_, rest)| rest)
    })
}

#[test]
fn sentences_are_short_and_words_are_the_glossarys() {
    let (mut total, mut count, mut long) = (0, 0, 0);
    for page in super::pages() {
        if page == Path::new("glossary.md") || page == Path::new("SUMMARY.md") {
            continue;
        }
        for sentence in sentences(&super::text(&page)) {
            let found = idioms(&sentence, IDIOMS);
            assert!(
                found.is_empty(),
                "docs/{}: {found:?} in: {sentence}",
                page.display()
            );
            let words = words(&sentence);
            total += words;
            count += 1;
            if words > 30 {
                long += 1;
                println!("docs/{}: {words} words: {sentence}", page.display());
            }
        }
    }
    assert!(count > 500, "{count} sentences");
    assert!(total <= 17 * count, "{total} words in {count} sentences");
    assert!(
        20 * long < count,
        "{long} of {count} sentences have more than 30 words"
    );
}
