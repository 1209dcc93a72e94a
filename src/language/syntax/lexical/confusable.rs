//! A character or a word that is easily confused with one of the language.

/// A character or word that was written for another. Each is reported once, however often it appears.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Confusable<'a> {
    /// A byte order mark at the start.
    ByteOrderMark,
    /// A space other than the one of the keyboard.
    Space(char),
    /// A sign, and the one it is read as.
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
