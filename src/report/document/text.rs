//! A line of print: pieces of text, each with what it is. In: strings from anywhere, also from a plan. Out: pieces without
//! control characters. Knows no fonts and no markup.

use serde::Serialize;

use crate::text::sanitize;

/// What a piece of text is; how that looks is the renderer's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Style {
    Plain,
    /// Beside the point.
    Soft,
    /// As the plan's language has it.
    Code,
    /// An identifier of many digits, which may be broken anywhere.
    Id,
    /// What should be there and is not.
    Missing,
    /// A word of a verdict, in its colour.
    Pass,
    Doubt,
    Fail,
    /// The end of a line.
    Break,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Piece {
    pub text: String,
    pub style: Style,
}

/// Pieces in order.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub(crate) struct Text(pub Vec<Piece>);

impl Text {
    /// Empty.
    pub fn new() -> Self {
        Self::default()
    }

    /// What was not given.
    pub fn missing(words: &str) -> Self {
        Self::new().with(Style::Missing, words)
    }

    /// A text that may be missing; one of blanks is.
    pub fn given(text: Option<&str>) -> Self {
        match text {
            Some(text) if !text.trim().is_empty() => text.into(),
            _ => Self::missing("not given"),
        }
    }

    /// The same with one more piece.
    #[must_use]
    pub fn with(mut self, style: Style, text: impl AsRef<str>) -> Self {
        self.0.push(Piece {
            text: printable(text.as_ref()),
            style,
        });
        self
    }

    #[must_use]
    pub fn and(self, text: impl AsRef<str>) -> Self {
        self.with(Style::Plain, text)
    }

    #[must_use]
    pub fn code(self, text: impl AsRef<str>) -> Self {
        self.with(Style::Code, text)
    }

    #[must_use]
    pub fn soft(self, text: impl AsRef<str>) -> Self {
        self.with(Style::Soft, text)
    }

    #[must_use]
    pub fn id(self, text: impl AsRef<str>) -> Self {
        self.with(Style::Id, text)
    }

    /// The same, and what follows begins a new line.
    #[must_use]
    pub fn line(self) -> Self {
        self.with(Style::Break, "")
    }
}

impl From<&str> for Text {
    fn from(text: &str) -> Self {
        Self::new().and(text)
    }
}

impl From<String> for Text {
    fn from(text: String) -> Self {
        text.as_str().into()
    }
}

/// Without what steers a printer or turns the direction of reading: a label must not read otherwise than it is written.
pub(crate) fn printable(text: &str) -> String {
    sanitize::printed(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_steers_is_printed() {
        assert_eq!(
            printable("a\u{1b}[31m\u{202e}b\u{ffff}\nc"),
            "a\u{fffd}[31m\u{fffd}b\u{fffd}\u{fffd}c"
        );
        assert_eq!(printable("Ẋ ≤ 8.5\u{a0}mm"), "Ẋ ≤ 8.5\u{a0}mm");
        assert_eq!(Text::given(Some(" ")), Text::missing("not given"));
    }
}
