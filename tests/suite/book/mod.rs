//! The book in `docs/`: every page is in the summary, every link leads to a page and a heading, every plan passes its check. Every
//! console block shows the output of psd. `cargo xtask generate book` writes console blocks, figures and generated parts.

mod console;
mod figures;
mod generated;
mod messages;
mod one_step;
mod plans;

use std::fs;
use std::path::{Component, Path, PathBuf};

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

/// Whether the tests write the expected files instead of comparing them.
fn accepts_output() -> bool {
    std::env::var_os("PSD_BLESS").is_some()
}

/// The pages of the book, relative to `docs/`, in order of name.
pub(crate) fn pages() -> Vec<PathBuf> {
    let (mut folders, mut pages) = (vec![docs()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder of the book") {
            let path = entry.expect("a readable entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "md") {
                pages.push(path.strip_prefix(docs()).expect("in the book").to_owned());
            }
        }
    }
    pages.sort();
    pages
}

fn text(page: &Path) -> String {
    fs::read_to_string(docs().join(page)).expect("a readable page")
}

/// A fenced block: the words after its fence, and its lines.
struct Block {
    info: String,
    body: String,
}

fn blocks(text: &str) -> Vec<Block> {
    let (mut blocks, mut open) = (Vec::new(), None::<Block>);
    for line in text.lines() {
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(info)) => {
                open = Some(Block {
                    info: info.trim().to_owned(),
                    body: String::new(),
                });
            }
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some(block), None) => block.body.extend([line, "\n"]),
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a fence is not closed");
    blocks
}

/// The lines outside of fenced blocks, with code in backticks removed.
fn prose(text: &str) -> String {
    let mut fenced = false;
    let mut prose = String::new();
    for line in text.lines() {
        if line.starts_with("```") {
            fenced = !fenced;
        } else if !fenced {
            let words: Vec<&str> = line.split('`').step_by(2).collect();
            prose.extend([words.join("").as_str(), "\n"]);
        }
    }
    prose
}

/// The targets of the links and pictures of a text, and of its labels: `[models]: specimens.md`.
fn links(text: &str) -> Vec<String> {
    let text = prose(text);
    let written = text.split("](").skip(1);
    let written = written.filter_map(|rest| rest.split(')').next());
    let labels = text.lines().filter(|line| line.starts_with('['));
    let labels = labels.filter_map(|line| line.split_once("]: "));
    written
        .chain(labels.map(|(_, target)| target))
        .map(str::to_owned)
        .collect()
}

/// The anchor that mdBook gives a heading.
fn anchor(heading: &str) -> String {
    heading
        .trim_start_matches('#')
        .trim()
        .to_lowercase()
        .chars()
        .filter(|letter| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_'))
        .map(|letter| if letter == ' ' { '-' } else { letter })
        .collect()
}

fn anchors(page: &Path) -> Vec<String> {
    let mut fenced = false;
    let mut anchors = Vec::new();
    for line in text(page).lines() {
        fenced ^= line.starts_with("```");
        if !fenced && line.starts_with('#') {
            anchors.push(anchor(line));
        }
    }
    anchors
}

/// A path without its `..`; `None` if it leaves the book.
fn resolved(page: &Path, target: &str) -> Option<PathBuf> {
    let mut path = page.parent().unwrap_or(Path::new("")).to_owned();
    for part in Path::new(target).components() {
        match part {
            Component::ParentDir if !path.pop() => return None,
            Component::Normal(name) => path.push(name),
            _ => {}
        }
    }
    Some(path)
}

#[test]
fn every_page_is_in_the_summary() {
    let summary = text(Path::new("SUMMARY.md"));
    let mut listed: Vec<PathBuf> = links(&summary).iter().map(PathBuf::from).collect();
    let count = listed.len();
    listed.sort();
    listed.dedup();
    assert_eq!(count, listed.len(), "a page is listed twice");
    let mut pages = pages();
    pages.retain(|page| page != Path::new("SUMMARY.md"));
    assert_eq!(pages, listed);
}

#[test]
fn every_link_leads_to_a_page_and_a_heading() {
    for page in pages() {
        for target in links(&text(&page)) {
            if target.starts_with("https://") {
                continue;
            }
            let (file, fragment) = target.split_once('#').unwrap_or((&target, ""));
            let there = if file.is_empty() {
                Some(page.clone())
            } else {
                resolved(&page, file)
            };
            let there =
                there.unwrap_or_else(|| panic!("{}: {target} leaves the book", page.display()));
            assert!(
                docs().join(&there).is_file(),
                "{}: no file {target}",
                page.display()
            );
            assert!(
                fragment.is_empty() || anchors(&there).iter().any(|anchor| anchor == fragment),
                "{}: no heading {target}",
                page.display()
            );
        }
    }
}

/// Every page has one title, which is its first line.
#[test]
fn every_page_has_one_title() {
    for page in pages() {
        let text = text(&page);
        let first = text.lines().next().unwrap_or_default();
        assert!(
            first.starts_with("# ") || first.starts_with("{{#include"),
            "{}: begins with `{first}`",
            page.display()
        );
    }
}
