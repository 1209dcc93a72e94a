//! `psd explain`: the page of a diagnostic code or of a word of the language, or the list of all codes. The page of a code shows the lines in which its wrong and its right plan differ;
//! `--full` shows both plans.

mod words;

use std::fmt::Write as _;

use crate::exit::{Exit, Failure};
use crate::output::print_result;
use crate::settings::Settings;
use clap::Args;
use psd::codes;
use psd_text::diagnostic::Code;
use psd_text::diagnostic::page::{Page, PagePlan};
use psd_text::suggest::nearest;
use similar::{Algorithm, DiffOp, capture_diff_slices};

/// Each code with its page, without the cases of the page.
static PAGES: &[(&str, &str)] = &include!(concat!(env!("OUT_DIR"), "/pages.rs"));

/// Changed lines of a page without `--full`.
const MOST_LINES: usize = 12;

#[derive(Debug, Args)]
pub struct ExplainArguments {
    /// A code, or a word: `E202`, `hit.max_displacement`, `kN/m`
    #[arg(value_name = "WORD")]
    pub word: Option<String>,
    /// Show the wrong and the right plan of a code in full
    #[arg(long, requires = "word")]
    pub full: bool,
}

/// Prints the page of a code or of a word.
pub fn explain(word: Option<&str>, full: bool, settings: Settings) -> Result<Exit, Failure> {
    let text = match word {
        None => list(settings),
        Some(written) => {
            let wanted = written.trim().to_ascii_uppercase();
            // A code can be given by its number alone: errors and warnings have no number in common.
            let known = codes::all()
                .into_iter()
                .find(|code| code.id() == wanted || code.id()[1..] == wanted);
            match known {
                Some(known) if full => full_page(known, settings),
                Some(known) => page(known, settings),
                None => words::page(written.trim(), settings)
                    .ok_or_else(|| unknown(written.trim(), &wanted))?,
            }
        }
    };
    print_result(&text)?;
    Ok(Exit::Met)
}

fn unknown(written: &str, wanted: &str) -> Failure {
    let codes = codes::all();
    let near_code = nearest(wanted, codes.iter().map(|code| code.id()));
    let last = written.rsplit('.').next().unwrap_or(written);
    let help = match near_code.or_else(|| nearest(last, words::all())) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "`psd explain` lists every code, and `psd units` every unit".to_owned(),
    };
    Failure::command_line(format!("no code, word or unit is `{written}`")).help(help)
}

/// The page of a code.
fn page_of(code: Code) -> Page<'static> {
    let found = PAGES.iter().find(|(id, _)| *id == code.id());
    Page::read(found.map_or("", |(_, page)| page))
}

/// The text of a page, and the lines in which its plans differ.
fn page(code: Code, settings: Settings) -> String {
    let page = page_of(code);
    let prose = page.shown.split("```psd ").next().unwrap_or_default();
    let mut text = String::new();
    for line in prose.trim_end().lines() {
        let heading = line.strip_prefix("# ");
        let shown = heading.map_or_else(|| line.to_owned(), |title| settings.paint_heading(title));
        let _ = writeln!(text, "{shown}");
    }
    if let (Some(wrong), Some(right)) = (page.plan("wrong"), page.plan("right")) {
        let changed = changed_lines(wrong, right);
        text.push('\n');
        for line in changed.iter().take(MOST_LINES) {
            let _ = writeln!(text, "  {line}");
        }
        let more = if changed.len() > MOST_LINES {
            "  …\n"
        } else {
            ""
        };
        let _ = writeln!(text, "{more}\n`psd explain {code} --full` shows both plans");
    }
    text
}

/// The command that gives the diagnostic, if it needs an option: `psd check plan.psd --set speed="9 m/s"`.
fn command(plan: &PagePlan<'_>) -> Option<String> {
    let set = plan.option("set").and_then(|set| set.split_once('='));
    let set = set.map(|(name, value)| format!("psd check plan.psd --set {name}=\"{value}\""));
    set.or_else(|| {
        plan.option("rig")
            .map(|rig| format!("psd check plan.psd --rig {rig}"))
    })
}

/// The changed lines, `-` wrong and `+` right. Blanks inside a line are not compared, because fields are aligned.
fn changed_lines(wrong: &PagePlan<'_>, right: &PagePlan<'_>) -> Vec<String> {
    let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    let lines = |plan: &str| plan.lines().map(words).collect::<Vec<_>>();
    let (old, new) = (lines(wrong.text), lines(right.text));
    let mut changed = Vec::new();
    for operation in capture_diff_slices(Algorithm::Myers, &old, &new) {
        if matches!(operation, DiffOp::Equal { .. }) {
            continue;
        }
        let removed = old[operation.old_range()].iter();
        let added = new[operation.new_range()].iter();
        let removed = removed.map(|line| format!("- {line}"));
        let lines = removed.chain(added.map(|line| format!("+ {line}")));
        changed.extend(lines.filter(|line| line.len() > 2));
    }
    if changed.is_empty() {
        changed.extend(command(wrong).map(|command| format!("- {command}")));
        changed.extend(command(right).map(|command| format!("+ {command}")));
    }
    changed
}

/// A page with its plans, as code blocks under headings.
fn full_page(code: Code, settings: Settings) -> String {
    let (mut text, mut in_plan) = (String::new(), false);
    for line in page_of(code).shown.trim_end().lines() {
        in_plan = (in_plan || line.starts_with("```")) && line != "```";
        // In a plan, `# ` begins a comment.
        let heading = line.strip_prefix("# ").filter(|_| !in_plan);
        let shown = match (heading, line.strip_prefix("```psd ")) {
            (Some(heading), _) => settings.paint_heading(heading),
            (None, Some(word)) => settings.paint_heading(&format!("{word}:")),
            (None, None) if line == "```" => continue,
            (None, None) => line.to_owned(),
        };
        let _ = writeln!(text, "{shown}");
    }
    text
}

fn list(settings: Settings) -> String {
    codes::all()
        .into_iter()
        .fold(String::new(), |mut text, code| {
            let _ = writeln!(
                text,
                "{}  {}",
                settings.paint_heading(code.id()),
                page_of(code).title()
            );
            text
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_has_its_page_without_cases() {
        for code in codes::all() {
            let page = page_of(code);
            assert!(page.shown.starts_with(&format!("# {code}: ")), "{code}");
            assert!(!page.shown.contains("## Cases"), "{code}");
        }
    }

    #[test]
    fn every_page_with_plans_shows_how_they_differ() {
        for code in codes::all() {
            let page = page_of(code);
            let Some((wrong, right)) = page.plan("wrong").zip(page.plan("right")) else {
                continue;
            };
            let changed = changed_lines(wrong, right);
            assert!(!changed.is_empty(), "{code}: the two plans are the same");
        }
    }

    #[test]
    fn a_diff_has_the_wrong_and_the_right_line() {
        let lines = |code: Code| {
            let page = page_of(code);
            let examples = page.plan("wrong").zip(page.plan("right"));
            examples.map_or_else(Vec::new, |(wrong, right)| changed_lines(wrong, right))
        };
        assert_eq!(
            lines(Code::new("E301")),
            ["- mass = 10 mm", "+ mass = 10 kg"]
        );
        assert_eq!(lines(Code::new("W719")), ["+ i_modification = true"]);
        assert_eq!(
            lines(Code::new("E603")),
            [
                "- psd check plan.psd --rig simulted",
                "+ psd check plan.psd --rig simulated"
            ]
        );
        assert!(lines(Code::new("E406"))[0].contains("--set speed=\"9 m/s\""));
    }
}
