//! Settings of the output. In: arguments, environment and terminal. Out: settings. No other file reads the environment. Also the present day.

use std::io::IsTerminal as _;
use std::path::Path;

use super::args::Color;
use psd_text::diagnostic::render::Appearance;

/// The day by the clock of the computer, UTC, `YYYY-MM-DD`.
pub fn today() -> String {
    jiff::Timestamp::now().strftime("%Y-%m-%d").to_string()
}

/// Colours, characters and terminals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each answers a question of its own about the surroundings"
)]
pub struct Settings {
    /// Colour on standard error.
    pub color: bool,
    /// Colour on standard output.
    pub stdout_color: bool,
    /// Whether the terminal can draw boxes.
    pub unicode: bool,
    /// Standard error is a terminal: a progress bar makes sense.
    pub stderr_terminal: bool,
    /// Standard output is a terminal.
    pub stdout_terminal: bool,
    /// The operator can be asked: standard input and standard error are a terminal.
    pub can_ask: bool,
}

impl Settings {
    /// No terminal, no colour, no operator.
    #[cfg(test)]
    pub const PLAIN: Self = Self {
        color: false,
        stdout_color: false,
        unicode: true,
        stderr_terminal: false,
        stdout_terminal: false,
        can_ask: false,
    };

    pub fn from_environment(color: Color) -> Self {
        let variable = |name: &str| std::env::var(name).unwrap_or_default();
        let stderr_terminal = std::io::stderr().is_terminal();
        let quiet = !variable("NO_COLOR").is_empty() || variable("TERM") == "dumb";
        let colored = |terminal: bool| match color {
            Color::Always => true,
            Color::Never => false,
            Color::Auto => terminal && !quiet,
        };
        let locale = ["LC_ALL", "LC_CTYPE", "LANG"]
            .into_iter()
            .map(variable)
            .find(|value| !value.is_empty());
        Self {
            color: colored(stderr_terminal),
            stdout_color: colored(std::io::stdout().is_terminal()),
            unicode: !stderr_terminal || draws_boxes(&variable("TERM"), locale.as_deref()),
            stderr_terminal,
            stdout_terminal: std::io::stdout().is_terminal(),
            can_ask: stderr_terminal && std::io::stdin().is_terminal(),
        }
    }

    /// The style of diagnostics; file names are relative to the working folder.
    pub fn appearance(self, plan: &Path) -> Appearance {
        let width = (!self.stderr_terminal).then_some(100);
        Appearance {
            color: self.color,
            unicode: self.unicode,
            width,
            folder: folder_of(plan),
        }
    }

    pub fn paint_error(self, text: &str) -> String {
        if self.color {
            format!("\u{1b}[1;31m{text}\u{1b}[0m")
        } else {
            text.to_owned()
        }
    }

    /// The colour of a bad finding on standard output.
    pub fn paint_bad(self, text: &str) -> String {
        if self.stdout_color {
            format!("\u{1b}[1;31m{text}\u{1b}[0m")
        } else {
            text.to_owned()
        }
    }

    pub fn paint_note(self, text: &str) -> String {
        if self.color {
            format!("\u{1b}[36m{text}\u{1b}[0m")
        } else {
            text.to_owned()
        }
    }

    /// A heading on standard output.
    pub fn paint_heading(self, text: &str) -> String {
        if self.stdout_color {
            format!("\u{1b}[1m{text}\u{1b}[0m")
        } else {
            text.to_owned()
        }
    }
}

/// A variable of the environment, as a batch system sets it for a task.
pub fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok()
}

/// The folder of a plan as it was typed, with its slash: `plans/`; empty for a plan of this folder.
pub fn folder_of(plan: &Path) -> String {
    let folder = plan
        .parent()
        .map(|folder| folder.to_string_lossy().into_owned())
        .unwrap_or_default();
    if folder.is_empty() || folder.ends_with('/') {
        folder
    } else {
        format!("{folder}/")
    }
}

/// A terminal draws boxes unless it is the bare console or its locale names a different encoding.
fn draws_boxes(term: &str, locale: Option<&str>) -> bool {
    let utf8 = locale.is_none_or(|locale| {
        let locale = locale.to_ascii_lowercase();
        locale.contains("utf-8") || locale.contains("utf8")
    });
    utf8 && !matches!(term, "linux" | "dumb")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_need_a_terminal_that_knows_them() {
        assert!(draws_boxes("xterm-256color", Some("en_GB.UTF-8")) && draws_boxes("screen", None));
        assert!(!draws_boxes("linux", Some("en_GB.UTF-8")) && !draws_boxes("xterm", Some("POSIX")));
    }

    #[test]
    fn a_folder_ends_with_its_slash() {
        assert_eq!(folder_of(Path::new("plans/beam.psd")), "plans/");
        assert_eq!(folder_of(Path::new("beam.psd")), "");
        assert_eq!(folder_of(Path::new("/beam.psd")), "/");
    }
}
