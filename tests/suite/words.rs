//! The style of everything that psd says: short sentences, and no idiom that the glossary replaces. In: the string literals of `src`, the
//! help of the command line, the pages of `psd explain`, the descriptions of `summary.json`. The book uses the same list of words.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use psd::text::diagnostic::Code;

use super::source_text::{SourceText, none, rust_files};

/// Words that have a plain term in the glossary.
pub const IDIOMS: &str = "anew, anybody, at once, bless, blessed, blesses, blow, blows, by size, certifiable, certificate, comes to, doubt, \
    doubts, felt, foretell, foretells, foretold, gets told, gone on, hangs on, heeded, held against, hears, in its stead, is told, let go, lets go, mended, \
    nobody, place, places, reckon, reckoned, reckons, room, somebody, stand, stands, stands in, stood, taken again, tell, \
    tells, told, vouches, way, ways, weighed, weighs";

/// Words that a message of the program does not need either.
const IN_MESSAGES: &str = "remark, remarks, said, says, what";

/// Texts in which an idiom is the right word, and the reason.
const EXCEPTIONS: &[(&str, &str)] = &[
    (
        "calibration certificate",
        "ISO/IEC 17025: a calibration has a certificate, a test has a report",
    ),
    (
        "the stand",
        "the maker's name of the machine: a Mark-10 test stand",
    ),
    (
        "mark 10 stand",
        "the maker's name of the machine: a Mark-10 test stand",
    ),
    ("not certifiable", "a name in summaries of older versions"),
    ("says more", "the pointer to a page of `psd explain`"),
    ("in place", "a seal in the file itself"),
    ("same place", "a reference to a position in a list"),
];

/// Folders whose strings reach no reader: numerics, and bytes of a protocol.
const SILENT: &[&str] = &["physics", "emulator/firmware", "tests"];

/// Longest mean of the words in a sentence.
const MEAN: usize = 17;

/// A sentence with more words is long; fewer than one in 20 may be.
const LONG: usize = 30;

/// Whether no string of this file reaches a reader.
fn is_silent(file: &SourceText) -> bool {
    let is_test = file.path.ends_with("_tests.rs") || file.path.ends_with("testing.rs");
    // The report prints the cases of the self-test.
    let is_shown = file.is_in(&["physics/self_test"]);
    is_test || file.is_test() || file.is_in(SILENT) && !is_shown
}

/// The counts of one source of text.
#[derive(Default)]
struct Counts {
    sentences: usize,
    words: usize,
    long: Vec<String>,
    idioms: Vec<String>,
}

impl Counts {
    fn add(&mut self, position: &str, text: &str) {
        for sentence in sentences(text) {
            let words = words(&sentence);
            self.sentences += 1;
            self.words += words;
            if words > LONG {
                self.long
                    .push(format!("{position}: {words} words: {sentence}"));
            }
        }
        let lists = [IDIOMS, IN_MESSAGES];
        let idioms = lists.iter().flat_map(|list| idioms(text, list));
        for idiom in idioms.chain(constructions(text)) {
            self.idioms
                .push(format!("{position}: `{idiom}` in: {text}"));
        }
    }
}

/// Number of words of a sentence.
pub fn words(sentence: &str) -> usize {
    let is_word = |word: &&str| word.chars().any(char::is_alphanumeric);
    sentence.split_whitespace().filter(is_word).count()
}

/// The idioms of a list that a text has, outside the exceptions.
pub fn idioms(text: &str, list: &'static str) -> Vec<&'static str> {
    let plain: String = text
        .to_lowercase()
        .chars()
        .map(|c| if c.is_alphanumeric() { c } else { ' ' })
        .collect();
    let words: Vec<&str> = plain.split_whitespace().collect();
    let mut padded = format!(" {} ", words.join(" "));
    for (exception, _) in EXCEPTIONS {
        padded = padded.replace(&format!(" {exception} "), " ");
    }
    list.split(", ")
        .filter(|idiom| padded.contains(&format!(" {idiom} ")))
        .collect()
}

/// Constructions of other languages: `Of a …` at the start, `is no …`, `, for …` as a reason.
fn constructions(text: &str) -> Vec<&'static str> {
    let opens = text.starts_with("Of ")
        || [". Of ", ": Of ", "; Of "]
            .iter()
            .any(|start| text.contains(start));
    let is_no = [" is no ", " are no "].iter().any(|no| {
        text.split_once(no)
            .is_some_and(|(before, _)| !before.to_lowercase().ends_with("there"))
    });
    let because = text.contains(", for ") && !text.contains(", for example");
    let found = [(opens, "Of …"), (is_no, "is no …"), (because, ", for …")];
    found
        .into_iter()
        .filter(|(has, _)| *has)
        .map(|(_, name)| name)
        .collect()
}

/// A text without its code, which is replaced by one word.
pub fn without_code(text: &str) -> String {
    text.split('`').step_by(2).collect::<Vec<_>>().join("x")
}

/// The sentences of a paragraph: three words or more, up to `.`, `:`, `;`, `!` or `?`.
pub fn sentences(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for line in text.split('\n') {
        let mut sentence = String::new();
        for word in line.split_whitespace() {
            sentence.extend([word, " "]);
            if word.ends_with(['.', ':', ';', '!', '?']) {
                found.push(std::mem::take(&mut sentence));
            }
        }
        found.push(sentence);
    }
    found.retain(|sentence| words(sentence) > 2);
    found
}

/// The string literals of a source text, each with its line, without comments, tests, assertions and the reasons of lints.
fn literals(source: &SourceText) -> Vec<(usize, String)> {
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
fn message(literal: &str) -> Option<String> {
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

/// The text of a help screen: one line per option or paragraph.
fn help_lines(help: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for line in help.lines() {
        let text = line.trim_start();
        let indent = line.len() - text.len();
        let is_item = indent <= 6 && (text.starts_with(['-', '<', '[']) || text.contains("  "));
        let starts = text.is_empty() || indent == 0 || is_item;
        let text = if is_item {
            text.rsplit("  ").next().unwrap_or_default()
        } else {
            text
        };
        if starts || lines.is_empty() {
            lines.push(text.to_owned());
        } else if let Some(last) = lines.last_mut() {
            last.extend([" ", text]);
        }
    }
    lines.retain(|line| !line.starts_with("Usage:"));
    lines
}

/// The command, and every subcommand of it.
fn commands(words: &[String], found: &mut Vec<(String, String)>) {
    let output = Command::new(env!("CARGO_BIN_EXE_psd"))
        .args(words)
        .arg("--help")
        .output()
        .expect("psd runs");
    let help = String::from_utf8(output.stdout).expect("help is text");
    let listed = help
        .split_once("\nCommands:\n")
        .map_or("", |(_, listed)| listed);
    let listed = listed.lines().take_while(|line| line.starts_with("  "));
    for name in listed
        .filter(|line| !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
    {
        if name != "help" {
            commands(&[words, &[name.to_owned()]].concat(), found);
        }
    }
    found.push((format!("psd {} --help", words.join(" ")), help));
}

/// The descriptions of a JSON schema.
fn descriptions(schema: &serde_json::Value, found: &mut Vec<String>) {
    match schema {
        serde_json::Value::Object(keys) => {
            for (key, value) in keys {
                match value.as_str().filter(|_| key == "description") {
                    Some(text) => found.push(text.replace('\n', " ")),
                    None => descriptions(value, found),
                }
            }
        }
        serde_json::Value::Array(values) => {
            for value in values {
                descriptions(value, found);
            }
        }
        _ => {}
    }
}

/// All text for a reader: its source (a folder of `src`, or a kind of page), its position, the text.
fn all() -> Vec<(String, String, String)> {
    let mut all = Vec::new();
    for file in rust_files("src").iter().filter(|file| !is_silent(file)) {
        let folder = file.path.split('/').next().unwrap_or_default();
        for (line, literal) in literals(file) {
            if let Some(text) = message(&literal) {
                all.push((folder.to_owned(), format!("src/{}:{line}", file.path), text));
            }
        }
    }
    let mut screens = Vec::new();
    commands(&[], &mut screens);
    for (command, help) in screens {
        let lines = help_lines(&help)
            .into_iter()
            .filter_map(|line| message(&line));
        all.extend(lines.map(|line| ("help".to_owned(), command.clone(), line)));
    }
    for &code in Code::ALL {
        let prose = code
            .page()
            .split("```")
            .step_by(2)
            .collect::<Vec<_>>()
            .join("\n\n");
        for paragraph in prose.split("\n\n") {
            let text = without_code(&paragraph.replace('\n', " "));
            all.push((
                "explain pages".to_owned(),
                format!("psd explain {code}"),
                text,
            ));
        }
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("grammar/summary.schema.json");
    let schema = fs::read_to_string(path).expect("the schema");
    let mut found = Vec::new();
    descriptions(&serde_json::from_str(&schema).expect("JSON"), &mut found);
    let found = found.iter().map(|text| without_code(text));
    all.extend(found.map(|text| {
        (
            "summary schema".to_owned(),
            "grammar/summary.schema.json".to_owned(),
            text,
        )
    }));
    all
}

#[test]
fn messages_are_short_and_their_words_are_the_glossarys() {
    let mut sources: BTreeMap<String, Counts> = BTreeMap::new();
    for (source, position, text) in all() {
        sources.entry(source).or_default().add(&position, &text);
    }
    let (mut sentences, mut words, mut long) = (0, 0, 0);
    let mut wrong = Vec::new();
    for (name, counts) in &sources {
        println!(
            "{name}: {} sentences, {} words, {} long, {} idioms",
            counts.sentences,
            counts.words,
            counts.long.len(),
            counts.idioms.len()
        );
        wrong.extend(counts.idioms.clone());
        if 20 * counts.long.len() >= counts.sentences.max(1) {
            wrong.push(format!(
                "{name}: {} long sentences of {}",
                counts.long.len(),
                counts.sentences
            ));
            wrong.extend(counts.long.clone());
        }
        sentences += counts.sentences;
        words += counts.words;
        long += counts.long.len();
    }
    none(
        &wrong,
        "words of the glossary (docs/glossary.md), and short sentences",
    );
    assert!(sentences > 1000, "{sentences} sentences");
    assert!(
        words <= MEAN * sentences,
        "{words} words in {sentences} sentences"
    );
    assert!(
        20 * long < sentences,
        "{long} of {sentences} sentences have more than {LONG} words"
    );
    for source in [
        "explain pages",
        "help",
        "language",
        "report",
        "summary schema",
    ] {
        assert!(sources.contains_key(source), "no text comes from {source}");
    }
}

/// Files of the repository that a text names exist.
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
        Code::ALL
            .iter()
            .map(|code| (format!("psd explain {code}"), code.page().to_owned())),
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
