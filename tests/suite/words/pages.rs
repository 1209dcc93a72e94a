//! Text in files: pages of Markdown, plans, help screens, a JSON schema. In: a file, or the program. Out: paragraphs without code.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::without_code;

/// Pages of the repository outside the book.
const ROOT: &[&str] = &[
    "README.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "grammar/LANGUAGE.md",
    "plans/README.md",
];

/// A page with the glossary's own words, and a list of links.
const NO_PROSE: &[&str] = &["docs/glossary.md", "docs/SUMMARY.md"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn found(folder: &str, ending: &str) -> Vec<PathBuf> {
    let (mut folders, mut files) = (vec![PathBuf::from(folder)], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(root().join(&folder)).expect("a folder") {
            let entry = entry.expect("a readable entry");
            let path = folder.join(entry.file_name());
            if entry.path().is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|found| found == ending) {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

/// Source, position and paragraph of every page, plan and comment of a plan.
pub(super) fn all() -> Vec<(String, String, String)> {
    let mut all = Vec::new();
    let mut pages: Vec<PathBuf> = ROOT.iter().map(PathBuf::from).collect();
    pages.extend(found("docs", "md"));
    pages.extend(found("plans", "md"));
    for page in pages {
        let name = page.display().to_string();
        if NO_PROSE.contains(&name.as_str()) {
            continue;
        }
        let source = if name.starts_with("docs/") {
            "book"
        } else {
            "pages"
        };
        let text = fs::read_to_string(root().join(&page)).expect("a readable page");
        let paragraphs = paragraphs(&text).into_iter();
        all.extend(paragraphs.map(|text| (source.to_owned(), name.clone(), text)));
    }
    for plan in found("plans", "psd") {
        let name = plan.display().to_string();
        let text = fs::read_to_string(root().join(&plan)).expect("a readable plan");
        let texts = comments(&text).into_iter();
        all.extend(texts.map(|text| ("plans".to_owned(), name.clone(), text)));
    }
    all
}

/// Paragraphs, items of lists, headings and cells of tables, without fenced blocks, code and the targets of links.
pub(super) fn paragraphs(text: &str) -> Vec<String> {
    // The number of backticks of an open fence: a shorter fence is part of its block.
    let mut fence = None;
    let mut paragraphs = vec![String::new()];
    for line in text.lines() {
        let start = line.trim_start();
        let ticks = start.bytes().take_while(|byte| *byte == b'`').count();
        if ticks >= fence.unwrap_or(3) {
            fence = fence.is_none().then_some(ticks);
            paragraphs.push(String::new());
        } else if fence.is_some() || start.starts_with("<!--") {
        } else if start.starts_with('|') {
            let cells = start.split('|').map(|cell| cell.trim().to_owned());
            paragraphs.extend(cells);
            paragraphs.push(String::new());
        } else {
            let number = start.trim_start_matches(|c: char| c.is_ascii_digit());
            let list =
                start.starts_with("- ") || number.len() < start.len() && number.starts_with(". ");
            if start.is_empty() || list || start.starts_with('#') {
                paragraphs.push(String::new());
            }
            let last = paragraphs.last_mut().expect("never empty");
            *last += start.trim_start_matches(['-', '#', '>', ' ']);
            last.push(' ');
            if start.starts_with('#') {
                paragraphs.push(String::new());
            }
        }
    }
    paragraphs
        .iter()
        .map(|paragraph| without_targets(&without_tags(&without_code(paragraph))))
        .filter(|paragraph| !paragraph.trim().is_empty())
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

/// A text without anchors such as `<b id=impact.contact>`.
fn without_tags(text: &str) -> String {
    let mut parts = text.split("<b id=");
    let first = parts.next().unwrap_or_default().to_owned();
    let text = parts.fold(first, |kept, part| {
        kept + part.split_once("</b>").map_or("", |(_, rest)| rest)
    });
    text.replace("</b>", "")
}

/// Comments of a plan, lines that follow each other joined; its strings.
fn comments(plan: &str) -> Vec<String> {
    let mut texts = vec![String::new()];
    for line in plan.lines() {
        let (code, comment) = line.split_once('#').unwrap_or((line, ""));
        if code.trim().is_empty() && !comment.is_empty() {
            let last = texts.last_mut().expect("never empty");
            last.extend([comment.trim(), " "]);
        } else {
            texts.push(comment.trim().to_owned());
            texts.push(String::new());
        }
        texts.extend(code.split('"').skip(1).step_by(2).map(str::to_owned));
        if !code.trim().is_empty() {
            texts.push(String::new());
        }
    }
    let texts = texts.iter().map(|text| without_code(text));
    texts.filter(|text| !text.trim().is_empty()).collect()
}

/// The text of a help screen: one line per option or paragraph.
pub(super) fn help_lines(help: &str) -> Vec<String> {
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
pub(super) fn commands(words: &[String], found: &mut Vec<(String, String)>) {
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
pub(super) fn descriptions(schema: &serde_json::Value, found: &mut Vec<String>) {
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
