//! `psd explain`: the page of a diagnostic code, or the list of all.

use std::fmt::Write as _;

use crate::cli::exit::{Exit, Failure};
use crate::cli::output::print_result;
use crate::cli::settings::Settings;
use crate::text::diagnostic::Code;
use crate::text::suggest::nearest;

/// Prints the page of `code`.
pub fn explain(code: Option<&str>, settings: Settings) -> Result<Exit, Failure> {
    let text = match code {
        None => list(settings),
        Some(written) => {
            let wanted = written.trim().to_ascii_uppercase();
            let known = Code::ALL
                .iter()
                .find(|code| code.id() == wanted)
                .ok_or_else(|| unknown(written, &wanted))?;
            page(*known, settings)
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

/// A page with its heading and code blocks, coloured if colour is on.
fn page(code: Code, settings: Settings) -> String {
    let mut text = String::new();
    for line in code.page().trim_end().lines() {
        let shown = match (line.strip_prefix("# "), line.strip_prefix("```psd ")) {
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
