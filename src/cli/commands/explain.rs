//! `psd explain`: the page of a diagnostic code, or the list of all. A page shows the lines in which its wrong and its right plan differ;
//! `--full` shows both plans.

use clap::Args;
use std::fmt::Write as _;

use similar::{Algorithm, DiffOp, capture_diff_slices};

use crate::cli::exit::{Exit, Failure};
use crate::cli::output::print_result;
use crate::cli::settings::Settings;
use crate::text::diagnostic::Code;
use crate::text::suggest::nearest;

/// Changed lines of a page without `--full`.
const MOST_LINES: usize = 12;

#[derive(Debug, Args)]
pub struct ExplainArguments {
    /// Diagnostic code
    pub code: Option<String>,
    /// Show the wrong and the right plan in full
    #[arg(long, requires = "code")]
    pub full: bool,
}

/// Prints the page of `code`.
pub fn explain(code: Option<&str>, full: bool, settings: Settings) -> Result<Exit, Failure> {
    let text = match code {
        None => list(settings),
        Some(written) => {
            let wanted = written.trim().to_ascii_uppercase();
            // A code can be given by its number alone: errors and warnings have no number in common.
            let known = Code::ALL
                .iter()
                .find(|code| code.id() == wanted || code.id()[1..] == wanted)
                .ok_or_else(|| unknown(written, &wanted))?;
            if full {
                full_page(*known, settings)
            } else {
                page(*known, settings)
            }
        }
    };
    print_result(&text)?;
    Ok(Exit::Met)
}

fn unknown(written: &str, wanted: &str) -> Failure {
    let help = match nearest(wanted, Code::ALL.iter().map(|code| code.id())) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "`psd explain` lists every code".to_owned(),
    };
    Failure::command_line(format!("no diagnostic has the code `{written}`")).help(help)
}

/// The text of a page, and the lines in which its plans differ.
fn page(code: Code, settings: Settings) -> String {
    let (prose, plans) = code
        .page()
        .split_once("```psd ")
        .unwrap_or((code.page(), ""));
    let mut text = String::new();
    for line in prose.trim_end().lines() {
        let heading = line.strip_prefix("# ");
        let shown = heading.map_or_else(|| line.to_owned(), |title| settings.paint_heading(title));
        let _ = writeln!(text, "{shown}");
    }
    if let (Some(wrong), Some(right)) = (Example::of(plans, "wrong"), Example::of(plans, "right")) {
        let changed = changed_lines(&wrong, &right);
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

/// One example of a page: its options and its plan.
struct Example<'a> {
    options: Vec<&'a str>,
    plan: &'a str,
}

impl<'a> Example<'a> {
    /// The example `kind`, from the part of the page after the first fence.
    fn of(plans: &'a str, kind: &str) -> Option<Self> {
        let fence = plans
            .split("```psd ")
            .find_map(|fence| fence.strip_prefix(kind))?;
        let (options, rest) = fence.split_once('\n')?;
        let (plan, _) = rest.split_once("```")?;
        let options = options.split('"').collect();
        Some(Self { options, plan })
    }

    /// The command that gives the diagnostic, if it needs an option: `psd check plan.psd --set speed="9 m/s"`.
    fn command(&self) -> Option<String> {
        let value = |name: &str| {
            let at = self
                .options
                .iter()
                .position(|option| option.trim() == format!("{name}="))?;
            self.options.get(at + 1)
        };
        let set = value("set").and_then(|set| set.split_once('='));
        let set = set.map(|(name, value)| format!("psd check plan.psd --set {name}=\"{value}\""));
        set.or_else(|| value("rig").map(|rig| format!("psd check plan.psd --rig {rig}")))
    }
}

/// The changed lines, `-` wrong and `+` right. Blanks inside a line are not compared, because fields are aligned.
fn changed_lines(wrong: &Example<'_>, right: &Example<'_>) -> Vec<String> {
    let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    let lines = |plan: &str| plan.lines().map(words).collect::<Vec<_>>();
    let (old, new) = (lines(wrong.plan), lines(right.plan));
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
        let command = |sign: &str, example: &Example<'_>| {
            example.command().map(|command| format!("{sign} {command}"))
        };
        changed.extend(command("-", wrong));
        changed.extend(command("+", right));
    }
    changed
}

/// A page with its plans, as code blocks under headings.
fn full_page(code: Code, settings: Settings) -> String {
    let (mut text, mut in_plan) = (String::new(), false);
    for line in code.page().trim_end().lines() {
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
    Code::ALL.iter().fold(String::new(), |mut text, code| {
        let _ = writeln!(
            text,
            "{}  {}",
            settings.paint_heading(code.id()),
            title(*code)
        );
        text
    })
}

/// The page's heading without the code.
fn title(code: Code) -> &'static str {
    let heading = code
        .page()
        .lines()
        .next()
        .unwrap_or_default()
        .trim_start_matches("# ");
    heading
        .trim_start_matches(code.id())
        .trim_start_matches([':', ' '])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_page_with_plans_shows_how_they_differ() {
        for &code in Code::ALL {
            let (_, plans) = code.page().split_once("```psd ").unwrap_or_default();
            let examples = Example::of(plans, "wrong").zip(Example::of(plans, "right"));
            let Some((wrong, right)) = examples else {
                continue;
            };
            let changed = changed_lines(&wrong, &right);
            assert!(!changed.is_empty(), "{code}: the two plans are the same");
        }
    }

    #[test]
    fn a_diff_has_the_wrong_and_the_right_line() {
        let lines = |code: &str| {
            let code = Code::ALL.iter().find(|known| known.id() == code);
            let page = code.map(|code| code.page()).unwrap_or_default();
            let (_, plans) = page.split_once("```psd ").unwrap_or_default();
            let examples = Example::of(plans, "wrong").zip(Example::of(plans, "right"));
            examples.map_or_else(Vec::new, |(wrong, right)| changed_lines(&wrong, &right))
        };
        assert_eq!(lines("E301"), ["- mass = 10 mm", "+ mass = 10 kg"]);
        assert_eq!(lines("W719"), ["+ i_modification = true"]);
        assert_eq!(
            lines("E603"),
            [
                "- psd check plan.psd --rig simulted",
                "+ psd check plan.psd --rig simulated"
            ]
        );
        assert!(lines("E406")[0].contains("--set speed=\"9 m/s\""));
    }
}
