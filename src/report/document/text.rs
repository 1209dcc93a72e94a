//! A line of text in pieces, each with its style. In: strings from any source, such as a plan. Out: pieces without control characters. It
//! knows no fonts and no markup.

use serde::Serialize;

use crate::report::wording::common::NOT_GIVEN;
use psd_text::sanitize;

/// The role of a piece of text; the renderer chooses its style.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Style {
    Plain,
    /// Secondary information.
    Soft,
    /// Text in the language of the plan.
    Code,
    /// An identifier of many digits, which may be broken anywhere.
    Id,
    /// A missing value.
    Missing,
    /// A word of a verdict without a colour.
    Strong,
    /// A word of a verdict, in its colour.
    Pass,
    Inconclusive,
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

    /// A missing value.
    pub fn missing(words: &str) -> Self {
        Self::new().with(Style::Missing, words)
    }

    /// A text that may be missing; a text of spaces counts as missing.
    pub fn given(text: Option<&str>) -> Self {
        match text {
            Some(text) if !text.trim().is_empty() => text.into(),
            _ => Self::missing(NOT_GIVEN),
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

    /// The same with a line break.
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

/// The text without control characters and marks of reading direction: a label is displayed as it is written.
pub(crate) fn printable(text: &str) -> String {
    sanitize::printed(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_control_character_is_printed() {
        assert_eq!(
            printable("a\u{1b}[31m\u{202e}b\u{ffff}\nc"),
            "a\u{fffd}[31m\u{fffd}b\u{fffd}\u{fffd}c"
        );
        assert_eq!(printable("Ẋ ≤ 8.5\u{a0}mm"), "Ẋ ≤ 8.5\u{a0}mm");
        assert_eq!(Text::given(Some(" ")), Text::missing("not given"));
    }
}
