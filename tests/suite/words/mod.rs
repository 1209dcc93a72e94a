//! The style of everything that psd says: short sentences, and no idiom that the glossary replaces. In: the strings of `src`, the
//! help of the command line, the pages of `psd explain`, the descriptions of `summary.json`, the book, the pages at the root, the
//! comments and strings of the plans.

mod files;
mod literals;
mod pages;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::explain_pages::shown_text;
use super::source_text::{none, rust_files};
use literals::{is_silent, literals, message};
use pages::{commands, descriptions, help_lines, paragraphs};

/// Words that have a plain term in the glossary.
const IDIOMS: &str = "anew, anybody, at once, bless, blessed, blesses, blow, blows, by itself, by size, certifiable, certificate, comes to, \
    done again, doubt, doubts, end switch, end switches, felt, first loading, flows, foretell, foretells, foretold, gate, gates, \
    gets told, gone along, gone on, gone twice, hangs on, heard, heeded, held against, hears, in its stead, is told, knee, \
    largest size, last bit, last word, let go, lets go, mended, nobody, of its own, parted, place, \
    places, played back, quanta, quantum, reckon, reckoned, reckons, refute, refuted, rehearsal, rehearse, remark, remarks, \
    room, somebody, stand, stand in, stands, stands in, stood, supposition, taken again, tell, tells, the same bytes, \
    told, turning point, turning points, vouches, way, way back, ways, wear, wears, weighed, weighs, word to hold";

/// Words that a message of the program does not need either. Pages may use them.
const IN_MESSAGES: &str = "said, says, what";

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
        "esm303 stand",
        "the maker's name of the machine: a Mark-10 test stand",
    ),
    (
        "mark 10 stand",
        "the maker's name of the machine: a Mark-10 test stand",
    ),
    ("says more", "the pointer to a page of `psd explain`"),
    ("place of the test", "ISO/IEC 17025, 7.8.2.1 c"),
    (
        "stand in 1",
        "the serial number of an emulated rig in plans",
    ),
    (
        "stand in 2",
        "the serial number of an emulated rig in plans",
    ),
];

/// Longest mean of the words in a sentence.
const MEAN: usize = 17;

/// A sentence with more words is long; fewer than one in 20 may be.
const LONG: usize = 30;

/// The counts of one source of text.
#[derive(Default)]
struct Counts {
    sentences: usize,
    words: usize,
    long: Vec<String>,
    idioms: Vec<String>,
}

impl Counts {
    /// `message`: the text is one of the program, not of a page.
    fn add(&mut self, position: &str, text: &str, message: bool) {
        for sentence in sentences(text) {
            let words = words(&sentence);
            self.sentences += 1;
            self.words += words;
            if words > LONG {
                self.long
                    .push(format!("{position}: {words} words: {sentence}"));
            }
        }
        let lists = [IDIOMS, if message { IN_MESSAGES } else { "" }];
        let idioms = lists.iter().flat_map(|list| idioms(text, list));
        for idiom in idioms.chain(constructions(text, message)) {
            self.idioms
                .push(format!("{position}: `{idiom}` in: {text}"));
        }
    }
}

/// Number of words of a sentence.
fn words(sentence: &str) -> usize {
    let is_word = |word: &&str| word.chars().any(char::is_alphanumeric);
    sentence.split_whitespace().filter(is_word).count()
}

/// The idioms of a list that a text has, outside the exceptions.
fn idioms(text: &str, list: &'static str) -> Vec<&'static str> {
    // A word with an underscore is the name of a file or of an identifier.
    let words = text.split_whitespace().filter(|word| !word.contains('_'));
    let plain: String = words
        .collect::<Vec<_>>()
        .join(" ")
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
        .filter(|idiom| !idiom.is_empty() && padded.contains(&format!(" {idiom} ")))
        .collect()
}

/// Constructions of other languages: `Of a …` at the start; in messages `is no …`, and `, for …` as a reason.
fn constructions(text: &str, message: bool) -> Vec<&'static str> {
    let opens = text.starts_with("Of ")
        || [". Of ", ": Of ", "; Of "]
            .iter()
            .any(|start| text.contains(start));
    let is_no = [" is no ", " are no "].iter().any(|no| {
        text.split_once(no)
            .is_some_and(|(before, _)| !before.to_lowercase().ends_with("there"))
    });
    let because = text.contains(", for ") && !text.contains(", for example");
    let found = [
        (opens, "Of …"),
        (message && is_no, "is no …"),
        (message && because, ", for …"),
    ];
    found
        .into_iter()
        .filter(|(has, _)| *has)
        .map(|(_, name)| name)
        .collect()
}

/// A text without its code, which is replaced by one word.
fn without_code(text: &str) -> String {
    text.split('`').step_by(2).collect::<Vec<_>>().join("x")
}

/// The sentences of a paragraph: three words or more, up to `.`, `!` or `?`.
fn sentences(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for line in text.split('\n') {
        let mut sentence = String::new();
        for word in line.split_whitespace() {
            sentence.extend([word, " "]);
            if word
                .trim_end_matches(['*', ')', '"'])
                .ends_with(['.', '!', '?'])
            {
                found.push(std::mem::take(&mut sentence));
            }
        }
        found.push(sentence);
    }
    found.retain(|sentence| words(sentence) > 2);
    found
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
    for code in psd::codes::all() {
        let texts = paragraphs(&shown_text(code)).into_iter();
        let position = format!("psd explain {code}");
        all.extend(texts.map(|text| ("explain pages".to_owned(), position.clone(), text)));
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
    all.extend(pages::all());
    all
}

/// Sources whose text is in pages, not in messages of the program.
const PAGES: [&str; 3] = ["book", "pages", "plans"];

#[test]
fn sentences_are_short_and_words_are_the_glossarys() {
    let mut sources: BTreeMap<String, Counts> = BTreeMap::new();
    for (source, position, text) in all() {
        let message = !PAGES.contains(&source.as_str());
        sources
            .entry(source)
            .or_default()
            .add(&position, &text, message);
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
    assert!(sentences > 8000, "{sentences} sentences");
    assert!(
        words <= MEAN * sentences,
        "{words} words in {sentences} sentences"
    );
    assert!(
        20 * long < sentences,
        "{long} of {sentences} sentences have more than {LONG} words"
    );
    println!("{sentences} sentences, {words} words, {long} long");
    for source in [
        "book",
        "explain pages",
        "help",
        "language",
        "pages",
        "plans",
        "report",
        "summary schema",
    ] {
        assert!(sources.contains_key(source), "no text comes from {source}");
    }
}
