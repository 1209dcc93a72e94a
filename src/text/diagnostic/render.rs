//! Diagnostics for the reader: the only code that turns them into text. In: diagnostics and their sources.
//! Out: the drawing, with source line, labels and help. Knows the drawing library; reads no environment.

use std::fmt;

use crate::count::counted;
use crate::source::Sources;
use miette::{
    GraphicalTheme, LabeledSpan, MietteHandlerOpts, ReportHandler as _, ThemeCharacters,
    ThemeStyles,
};

use super::excerpt::{Excerpt, escape};
use super::{Diagnostic, Severity};

/// Number of diagnostics that are drawn; of the others only the count is given.
pub const DRAWN: usize = 20;

/// Properties of the terminal that the drawing may use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Appearance {
    pub color: bool,
    pub unicode: bool,
    /// Columns; None: the width of the terminal, which the drawing library reads itself.
    pub width: Option<usize>,
    /// Prefix for the names of files, so that they can be opened from the working directory: `plans/`.
    pub folder: String,
}

impl Appearance {
    /// For a pipe: no colour, 100 columns.
    #[must_use]
    pub const fn plain() -> Self {
        Self {
            color: false,
            unicode: true,
            width: Some(100),
            folder: String::new(),
        }
    }
}

/// Draws the first [`DRAWN`] diagnostics, errors before warnings, then states their number.
#[must_use]
pub fn render_all(
    diagnostics: &[Diagnostic],
    sources: &Sources,
    appearance: &Appearance,
) -> String {
    if diagnostics.is_empty() {
        return String::new();
    }
    let mut ordered: Vec<&Diagnostic> = diagnostics.iter().collect();
    ordered.sort_by_key(|diagnostic| diagnostic.severity);
    let mut text = String::new();
    for diagnostic in ordered.iter().take(DRAWN) {
        text.push_str(&render(diagnostic, sources, appearance));
        text.push('\n');
    }
    text.push_str(&closing_line(&ordered));
    text.push('\n');
    text
}

/// Draws one diagnostic, ending with a newline.
#[must_use]
pub fn render(diagnostic: &Diagnostic, sources: &Sources, appearance: &Appearance) -> String {
    let (excerpt, labels) = Excerpt::new(diagnostic, sources, &appearance.folder);
    let drawn = Drawn {
        head: format!(
            "{}[{}]",
            severity_name(diagnostic.severity),
            diagnostic.code
        ),
        severity: match diagnostic.severity {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
        },
        message: escape(&diagnostic.message),
        help: diagnostic.help.as_deref().map(escape),
        excerpt,
        labels,
    };
    let mut options = MietteHandlerOpts::new()
        .graphical_theme(theme(&drawn, appearance))
        .force_graphical(true)
        .color(appearance.color)
        .terminal_links(false)
        .context_lines(1)
        .tab_width(4);
    if let Some(width) = appearance.width {
        options = options.width(width.max(30));
    }
    let text = Drawing {
        handler: options.build(),
        diagnostic: &drawn,
    }
    .to_string();
    let trimmed: Vec<&str> = text
        .lines()
        .map(str::trim_end)
        .filter(|line| !line.is_empty())
        .collect();
    format!("{}\n", trimmed.join("\n"))
}

/// `2 errors and 1 warning, the first 20 shown; psd explain E202 shows more`
fn closing_line(ordered: &[&Diagnostic]) -> String {
    let count = |severity, one: &str, several: &str| {
        let number = ordered
            .iter()
            .filter(|diagnostic| diagnostic.severity == severity)
            .count();
        (number > 0).then(|| counted(number, one, several))
    };
    let counted: Vec<String> = [
        count(Severity::Error, "error", "errors"),
        count(Severity::Warning, "warning", "warnings"),
    ]
    .into_iter()
    .flatten()
    .collect();
    let shown = if ordered.len() > DRAWN {
        format!(", the first {DRAWN} are shown")
    } else {
        String::new()
    };
    format!(
        "{}{shown}; `psd explain {}` says more",
        counted.join(" and "),
        ordered[0].code
    )
}

/// The name of a severity, as printed and as in JSON.
#[must_use]
pub const fn severity_name(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    }
}

/// The first label in the colour of the severity, every other one in the colour of advice.
fn theme(drawn: &Drawn, appearance: &Appearance) -> GraphicalTheme {
    let mut styles = if appearance.color {
        ThemeStyles::ansi()
    } else {
        ThemeStyles::none()
    };
    let first = match drawn.severity {
        miette::Severity::Error => styles.error,
        _ => styles.warning,
    };
    // The drawing library assigns colours in the order of the text.
    let mut in_order: Vec<(usize, bool)> = drawn
        .labels
        .iter()
        .map(|label| (label.offset(), label.primary()))
        .collect();
    in_order.sort_unstable_by_key(|(offset, _)| *offset);
    if !in_order.is_empty() {
        styles.highlights = in_order
            .iter()
            .map(|(_, primary)| if *primary { first } else { styles.advice })
            .collect();
    }
    let characters = if appearance.unicode {
        ThemeCharacters::unicode()
    } else {
        ThemeCharacters::ascii()
    };
    GraphicalTheme { characters, styles }
}

/// The drawing library draws into a formatter only.
struct Drawing<'a> {
    handler: miette::MietteHandler,
    diagnostic: &'a Drawn,
}

impl fmt::Display for Drawing<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // If the drawing fails, the message must still be shown.
        self.handler
            .debug(self.diagnostic, f)
            .or_else(|_| write!(f, "{}: {}", self.diagnostic.head, self.diagnostic.message))
    }
}

/// A diagnostic in the terms of the drawing library.
#[derive(Debug)]
struct Drawn {
    head: String,
    severity: miette::Severity,
    message: String,
    help: Option<String>,
    excerpt: Excerpt,
    labels: Vec<LabeledSpan>,
}

impl fmt::Display for Drawn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Drawn {}

impl miette::Diagnostic for Drawn {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(&self.head))
    }

    fn severity(&self) -> Option<miette::Severity> {
        Some(self.severity)
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.help
            .as_ref()
            .map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        Some(&self.excerpt)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        if self.labels.is_empty() {
            None
        } else {
            Some(Box::new(self.labels.iter().cloned()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Code;
    use crate::source::Span;

    fn at(sources: &Sources, name: &str, found: &str) -> Span {
        let (id, file) = sources.iter().find(|(_, file)| file.name == name).unwrap();
        let start = file.text.find(found).unwrap();
        Span::new(id, start, start + found.len())
    }

    #[test]
    fn an_error_shows_code_message_span_and_help() {
        let mut sources = Sources::default();
        sources.add(
            "beam.psd",
            "striker hammer {\r\n  mass = 20 kg\r\n  velocty = 1 m/s\r\n}\r\n",
        );
        let diagnostic = Diagnostic::new(Code::new("E202"), "`striker` has no field `velocty`")
            .at(at(&sources, "beam.psd", "velocty"), "no such field")
            .help("did you mean `velocity`?");
        let appearance = Appearance {
            folder: "plans/".into(),
            ..Appearance::plain()
        };
        insta::assert_snapshot!(render(&diagnostic, &sources, &appearance), @r"
        error[E202]
          × `striker` has no field `velocty`
           ╭─[plans/beam.psd:3:3]
         2 │   mass = 20 kg
         3 │   velocty = 1 m/s
           ·   ───┬───
           ·      ╰── no such field
         4 │ }
           ╰────
          help: did you mean `velocity`?
        ");
    }

    #[test]
    fn spans_in_two_files_are_both_drawn_with_their_own_lines() {
        let mut sources = Sources::default();
        sources.add("beam.psd", "use \"lib/frame.psd\"\nlet k = 2\n");
        sources.add("lib/frame.psd", "# the frame\nlet k = 1\n");
        let diagnostic = Diagnostic::new(Code::new("E208"), "`k` is declared twice")
            .at(at(&sources, "lib/frame.psd", "k = 1"), "again here")
            .at(at(&sources, "beam.psd", "k = 2"), "first here");
        insta::assert_snapshot!(render(&diagnostic, &sources, &Appearance::plain()), @r#"
        error[E208]
          × `k` is declared twice
           ╭─[lib/frame.psd:2:5]
         1 │ # the frame
         2 │ let k = 1
           ·     ──┬──
           ·       ╰── again here
           ╰────
           ╭─[beam.psd:2:5]
         1 │ use "lib/frame.psd"
         2 │ let k = 2
           ·     ──┬──
           ·       ╰── first here
           ╰────
        "#);
    }

    #[test]
    fn nothing_in_a_plan_reaches_the_terminal_as_a_command() {
        let mut sources = Sources::default();
        sources.add("a.psd", "let \u{1b}[31mx\u{202e} = \u{9b}2\n");
        let diagnostic = Diagnostic::new(Code::new("E101"), "what is `\u{1b}[31mx`")
            .at(at(&sources, "a.psd", "x\u{202e}"), "\u{7}here\u{2066}")
            .help("write \u{9b} otherwise");
        let text = render(&diagnostic, &sources, &Appearance::plain());
        assert!(
            !text
                .chars()
                .any(|c| (c.is_control() && c != '\n') || matches!(c, '\u{202a}'..='\u{2069}')),
            "{text:?}"
        );
        assert!(text.contains(r"\u{1b}[31mx\u{202e} = \u{9b}2"), "{text}");
    }

    #[test]
    fn a_very_long_line_is_truncated_around_its_span() {
        let mut sources = Sources::default();
        sources.add(
            "a.psd",
            format!(
                "let a = [{}oops{}]\n",
                "1, ".repeat(5_000),
                ", 1".repeat(5_000)
            ),
        );
        let diagnostic = Diagnostic::new(Code::new("E203"), "no name `oops`")
            .at(at(&sources, "a.psd", "oops"), "here");
        let text = render(&diagnostic, &sources, &Appearance::plain());
        assert!(text.contains("a.psd:1:15010"), "{text}");
        assert!(
            text.contains("oops") && text.lines().all(|line| line.chars().count() < 220),
            "{text}"
        );
    }

    #[test]
    fn a_span_past_the_last_line_is_drawn_at_its_end() {
        let mut sources = Sources::default();
        let file = sources.add("a.psd", "let a = 1\n");
        let diagnostic = Diagnostic::new(Code::new("E101"), "the plan ends here")
            .at(Span::new(file, 10, 10), "here");
        assert!(render(&diagnostic, &sources, &Appearance::plain()).contains("let a = 1"));
        let empty = sources.add("empty.psd", "");
        let diagnostic =
            Diagnostic::new(Code::new("W705"), "nothing runs").at(Span::new(empty, 0, 0), "here");
        assert!(render(&diagnostic, &sources, &Appearance::plain()).contains("nothing runs"));
    }

    #[test]
    fn twenty_are_drawn_and_all_are_counted() {
        let sources = Sources::default();
        let many: Vec<Diagnostic> = (0..23)
            .map(|i| Diagnostic::new(Code::new("E101"), format!("fault {i}")))
            .collect();
        let text = render_all(&many, &sources, &Appearance::plain());
        assert!(text.contains("fault 19") && !text.contains("fault 20"));
        assert!(
            text.ends_with("23 errors, the first 20 are shown; `psd explain E101` says more\n"),
            "{text}"
        );
    }
}
