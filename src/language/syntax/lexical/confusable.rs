//! A character or a word that is easily confused with one of the language.

/// A character or word that was written instead of another. Each is reported once, however often it appears.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Confusable<'a> {
    /// A byte order mark at the start.
    ByteOrderMark,
    /// A space that differs from the normal space.
    Space(char),
    /// A character, and the one as which it is read.
    Sign(&'a str, &'static str),
    /// `²`
    Superscript(&'a str),
    /// `“x”`, by its opening quote.
    Quotes(char),
    /// `//` or `/*`
    Comment(&'static str),
    /// `;` at the end of a field
    Semicolon,
    /// A word with letters of another alphabet.
    Word(&'a str),
}
