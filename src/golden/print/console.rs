//! A test's outcome for a terminal. In: the outcome of one plan. Out: aligned lines, plain or coloured.

use std::fmt::Write as _;

use super::words::Words;
use crate::golden::finding::Finding;
use crate::golden::tested::{Accepted, Outcome, Report, Tested};
use psd_text::count::counted;

/// Differences shown for one part of a plan's results; the JSON report has all.
const SHOWN: usize = 7;

const GREEN: &str = "32";
const RED: &str = "31";
const YELLOW: &str = "33";

/// One plan: a line, and its differences below.
#[must_use]
pub fn summary_text(tested: &Tested, coloured: bool) -> String {
    let (word, colour, detail) = match &tested.outcome {
        Outcome::Same {
            verdict: Some(verdict),
        } => ("ok", GREEN, (*verdict).to_owned()),
        Outcome::Same { verdict: None } => ("ok", GREEN, "fails to check, as accepted".to_owned()),
        Outcome::Accepted(Accepted::New) => {
            ("accepted", YELLOW, format!("new, in {}", tested.folder))
        }
        Outcome::Accepted(Accepted::Changed(found)) if found.is_empty() => (
            "accepted",
            YELLOW,
            format!("written again, no result changed, in {}", tested.folder),
        ),
        Outcome::Accepted(Accepted::Changed(found)) => (
            "accepted",
            YELLOW,
            format!("{} changed, in {}", found.len(), tested.folder),
        ),
        Outcome::Accepted(Accepted::Unchanged) => (
            "same",
            GREEN,
            "within tolerance: nothing written".to_owned(),
        ),
        Outcome::NotRun => ("skipped", YELLOW, "not run".to_owned()),
        _ => ("FAILED", RED, tested.complaint().unwrap_or_default()),
    };
    let word = format!("{word:<8}");
    let word = if coloured {
        format!("\u{1b}[1;{colour}m{word}\u{1b}[0m")
    } else {
        word
    };
    let mut text = format!("{word}  {}  {detail}\n", tested.name);
    text.push_str(&differences(tested.outcome.findings(), coloured));
    text
}

/// Findings in columns: name, old and new value, difference; below each its position and the tolerance.
fn differences(found: &[Finding], coloured: bool) -> String {
    let shown = found
        .chunk_by(|a, b| a.part == b.part)
        .flat_map(|part| part.iter().take(SHOWN));
    let words: Vec<Words> = shown.map(Words::of).collect();
    let width = |of: fn(&Words) -> &str| {
        words
            .iter()
            .map(|words| of(words).chars().count())
            .max()
            .unwrap_or(0)
    };
    let (part, name) = (
        width(|words| words.part),
        width(|words| &words.name).min(44),
    );
    let padded = |text: &str, width: usize| {
        format!(
            "{text}{}",
            " ".repeat(width.saturating_sub(text.chars().count()))
        )
    };
    let mut text = String::new();
    for words in &words {
        let line = format!(
            "  {}  {}  {}  {}",
            padded(words.part, part),
            padded(&words.name, name),
            words.change,
            words.by
        );
        let _ = writeln!(text, "{}", line.trim_end());
        if words.detail.is_empty() {
            continue;
        }
        let detail = format!("  {}  {}", " ".repeat(part), words.detail);
        let _ = if coloured {
            writeln!(text, "\u{1b}[2m{detail}\u{1b}[0m")
        } else {
            writeln!(text, "{detail}")
        };
    }
    if found.len() > words.len() {
        let _ = writeln!(
            text,
            "  and {} more: `--format json` lists all",
            found.len() - words.len()
        );
    }
    text
}

/// The last lines: unused folders, and the count.
#[must_use]
pub fn closing(report: &Report) -> String {
    let mut text = String::new();
    for folder in &report.unused {
        let _ = writeln!(text, "unused    {folder}  no plan has this name");
    }
    let (good, all) = (report.good(), report.tested.len());
    let accepted = report
        .tested
        .iter()
        .filter(|tested| {
            matches!(
                tested.outcome,
                Outcome::Accepted(Accepted::New | Accepted::Changed(_))
            )
        })
        .count();
    let plans = counted(all, "plan", "plans");
    let _ = match (all - good, accepted) {
        (0, 0) => writeln!(text, "{plans} as accepted"),
        (0, _) => writeln!(
            text,
            "{plans}, {accepted} accepted; review the changes before you commit them"
        ),
        (bad, _) => writeln!(text, "{bad} of {all} failed"),
    };
    text
}
