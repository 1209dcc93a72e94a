//! Lexical analysis: words, numbers, strings, symbols and line ends of a file, and every error that needs no grammar (invalid characters,
//! invalid numbers, units attached to expressions, all size limits). In: text. Out: [`Tokens`]. The grammar parses the text itself;
//! tokens serve recovery (`layout`), messages and the formatter.

use super::unit_tokens::{unit_extent, unit_in_brackets, unit_in_parentheses};
use super::{characters, numbers};
use crate::syntax::{ast::ITEM_WORDS, limits, messages};
use psd_text::diagnostic::Diagnostic;
use psd_text::source::{FileId, Span, Spanned};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Word,
    Number,
    /// A unit directly after a number or a list.
    Unit,
    Text,
    /// Brackets, operators, `=`, `,`, `:`, `..`.
    Sign,
    Newline,
    /// From `#` to the end of the line.
    Comment,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token {
    pub kind: Kind,
    pub start: usize,
    pub end: usize,
}

/// The tokens of a file. Comments are in `list` too, so that the formatter finds their positions.
#[derive(Debug)]
pub struct Tokens<'a> {
    pub text: &'a str,
    pub file: FileId,
    pub list: Vec<Token>,
    pub errors: Vec<Diagnostic>,
    /// The file was too large to be read to its end.
    pub cut_short: bool,
}

impl<'a> Tokens<'a> {
    #[must_use]
    pub fn read(text: &'a str, file: FileId) -> Self {
        let mut reader = Reader {
            tokens: Tokens {
                text,
                file,
                list: Vec::new(),
                errors: Vec::new(),
                cut_short: false,
            },
            at: 0,
            open: Vec::new(),
        };
        reader.read();
        reader.tokens
    }

    #[must_use]
    pub fn text_of(&self, token: Token) -> &'a str {
        &self.text[token.start..token.end]
    }

    #[must_use]
    pub fn span(&self, start: usize, end: usize) -> Span {
        Span::new(self.file, start, end)
    }

    /// Whether the token is the symbol or word `text`.
    #[must_use]
    pub fn is(&self, index: usize, text: &str) -> bool {
        self.list.get(index).is_some_and(|token| {
            matches!(token.kind, Kind::Sign | Kind::Word) && self.text_of(*token) == text
        })
    }

    #[must_use]
    pub fn kind(&self, index: usize) -> Option<Kind> {
        self.list.get(index).map(|token| token.kind)
    }

    #[must_use]
    pub fn comments(&self) -> Vec<Spanned<String>> {
        let comments = self.list.iter().filter(|token| token.kind == Kind::Comment);
        comments
            .map(|token| {
                Spanned::new(
                    self.text_of(*token).to_owned(),
                    self.span(token.start, token.end),
                )
            })
            .collect()
    }
}

/// Symbols of two characters; they have priority over those of one.
const LONG_SIGNS: [&str; 5] = ["..", "<=", ">=", "==", "!="];
/// Words that join two values or follow a value, so that none of them is a unit.
pub const JOINING_WORDS: [&str; 5] = ["and", "within", "of", "step", "between"];

/// Most lines of a string that is not closed on its first line.
const LINES_OF_A_TEXT: usize = 20;

struct Reader<'a> {
    tokens: Tokens<'a>,
    at: usize,
    /// The brackets that are open here.
    open: Vec<char>,
}

impl<'a> Reader<'a> {
    fn rest(&self) -> &'a str {
        &self.tokens.text[self.at..]
    }

    fn error(&mut self, error: Diagnostic) {
        self.tokens.errors.push(error);
    }

    fn push(&mut self, kind: Kind, length: usize) {
        self.tokens.list.push(Token {
            kind,
            start: self.at,
            end: self.at + length,
        });
        self.at += length;
    }

    fn span(&self, length: usize) -> Span {
        self.tokens.span(self.at, self.at + length)
    }

    fn read(&mut self) {
        while let Some(first) = self.rest().chars().next() {
            if self.tokens.list.len() >= limits::TOKENS {
                self.tokens.cut_short = true;
                self.error(messages::too_large(
                    self.span(first.len_utf8()),
                    "this file",
                    limits::TOKENS,
                    "words and characters",
                ));
                return;
            }
            if self.tokens.errors.len() >= limits::ERRORS {
                self.tokens.cut_short = true;
                self.error(messages::too_large(
                    self.span(first.len_utf8()),
                    "the list of errors",
                    limits::ERRORS,
                    "errors",
                ));
                return;
            }
            match first {
                ' ' | '\t' => self.at += 1,
                '\n' => self.newline(1),
                '\r' if self.rest().starts_with("\r\n") => self.newline(2),
                '#' => self.comment(),
                '"' => self.text(),
                '0'..='9' => self.number(),
                // `hit.1` is a name with a point, and not the number .1.
                '.' if self.rest()[1..].starts_with(|next: char| next.is_ascii_digit())
                    && !self.touches_a_word() =>
                {
                    self.number();
                }
                'a'..='z' | 'A'..='Z' | '_' => self.word(),
                _ => self.sign(first),
            }
        }
    }

    fn touches_a_word(&self) -> bool {
        let last = self.tokens.list.last();
        last.is_some_and(|last| last.kind == Kind::Word && last.end == self.at)
    }

    /// A line end. No bracket extends beyond a line that starts a field or an item, so an open one is dropped there.
    fn newline(&mut self, length: usize) {
        self.push(Kind::Newline, length);
        let line = self.rest().trim_start_matches([' ', '\t']);
        let after =
            line.trim_start_matches(|next: char| next.is_ascii_alphanumeric() || next == '_');
        let word = &line[..line.len() - after.len()];
        let sign = after.trim_start_matches([' ', '\t']);
        let field = sign.starts_with('=') && !sign.starts_with("==");
        if !word.is_empty() && (field || ITEM_WORDS.contains(&word)) {
            self.open.clear();
        }
    }

    fn comment(&mut self) {
        let line = self.rest().split('\n').next().unwrap_or_default();
        let line = line.strip_suffix('\r').unwrap_or(line);
        for (range, shown) in characters::bad_runs(line, true) {
            let span = self.tokens.span(self.at + range.start, self.at + range.end);
            self.error(messages::bad_character(span, &shown));
        }
        self.push(Kind::Comment, line.len());
    }

    fn text(&mut self) {
        let line = self.rest().split('\n').next().unwrap_or_default();
        let line = line.strip_suffix('\r').unwrap_or(line);
        let mut end = None;
        let mut escaped = false;
        for (offset, character) in line.char_indices().skip(1) {
            if escaped {
                escaped = false;
                if !matches!(character, '"' | '\\' | 'n' | 't') {
                    let span = self.tokens.span(
                        self.at + offset - 1,
                        self.at + offset + character.len_utf8(),
                    );
                    self.error(messages::bad_escape(span, character));
                }
            } else if character == '\\' {
                escaped = true;
            } else if character == '"' {
                end = Some(offset + 1);
                break;
            }
        }
        let length = end.unwrap_or(line.len());
        for (range, shown) in characters::bad_runs(&line[..length], false) {
            let span = self.tokens.span(self.at + range.start, self.at + range.end);
            self.error(messages::bad_character(span, &shown));
        }
        if end.is_none() {
            self.error(messages::unclosed_text(self.span(1)));
            // A string over several lines is one token, so that its other lines are not read as fields.
            return self.push(Kind::Text, closed_below(self.rest()).unwrap_or(length));
        } else if length - 2 > limits::TEXT_BYTES {
            self.error(messages::too_large(
                self.span(1),
                "this string",
                limits::TEXT_BYTES,
                "bytes",
            ));
        }
        self.push(Kind::Text, length);
    }

    fn number(&mut self) {
        let length = numbers::extent(
            self.rest(),
            self.open.is_empty(),
            self.open.last() != Some(&'['),
        );
        let written = &self.rest()[..length];
        if let Some(error) = numbers::error_of(written) {
            self.error(messages::bad_number(self.span(length), written, &error));
        }
        self.push(Kind::Number, length);
        self.unit();
    }

    /// The unit that may follow a number or a `]`, after spaces.
    fn unit(&mut self) {
        let blanks = self.rest().len() - self.rest().trim_start_matches([' ', '\t']).len();
        let length = unit_extent(&self.rest()[blanks..]);
        let unit = &self.rest()[blanks..blanks + length];
        if JOINING_WORDS.contains(&unit) {
            return;
        }
        let of_number = length == 0
            && self
                .tokens
                .list
                .last()
                .is_some_and(|last| last.kind == Kind::Number);
        let bracketed = unit_in_brackets(&self.rest()[blanks..]).filter(|_| of_number);
        let brackets = bracketed.is_some();
        if let Some((more, flat)) =
            bracketed.or_else(|| unit_in_parentheses(&self.rest()[blanks + length..], length == 0))
        {
            self.at += blanks;
            let number = self.tokens.list.last().map_or(self.at, |token| token.start);
            let corrected = format!(
                "{} {unit}{flat}",
                self.tokens.text[number..self.at].trim_end()
            );
            self.error(messages::unit_in_parentheses(
                self.span(length + more),
                &corrected,
                brackets,
            ));
            self.push(Kind::Unit, length + more);
            return;
        }
        if length == 0 {
            return;
        }
        self.at += blanks;
        let after = &self.rest()[length..];
        let member = after.starts_with('.') && !after.starts_with("..");
        if after.starts_with(['*', '/', '^'])
            || (unit.contains(['*', '/']) && (member || after.starts_with('(')))
        {
            // The operator that separates is the one after the unit, else the last one in it.
            let operator = if member || after.starts_with('(') {
                unit.rfind(['*', '/']).unwrap_or(length)
            } else {
                length
            };
            let glued = after
                .find([' ', '\t', '\n', '\r', ',', ')', ']', '#'])
                .unwrap_or(after.len());
            // A parenthesis that opens in the unit is also closed in it.
            let closes = after[..glued].contains('(') && after[glued..].starts_with(')');
            let glued = glued + usize::from(closes);
            let span = self.span(length + glued);
            let whole = &self.rest()[..length + glued];
            let number = self
                .tokens
                .list
                .last()
                .filter(|token| token.kind == Kind::Number)
                .map_or(self.at, |token| token.start);
            let number = &self.tokens.text[number..self.at];
            let corrected = format!(
                "{number}{} {} {}",
                &whole[..operator],
                &whole[operator..=operator],
                whole[operator + 1..].trim()
            );
            self.error(messages::unit_without_blank(span, corrected.trim_end()));
        }
        self.push(Kind::Unit, length);
    }

    fn word(&mut self) {
        let rest = self.rest();
        let length = rest
            .find(|next: char| !(next.is_ascii_alphanumeric() || next == '_'))
            .unwrap_or(rest.len());
        if length > limits::NAME_CHARS {
            self.error(messages::too_large(
                self.span(length.min(80)),
                "this name",
                limits::NAME_CHARS,
                "characters",
            ));
        }
        self.push(Kind::Word, length);
    }

    fn sign(&mut self, first: char) {
        if self.rest().starts_with("+/-") {
            self.error(messages::stray(self.span(3), "+/-"));
            return self.push(Kind::Sign, 3);
        }
        if self.rest().starts_with("°C") {
            self.error(messages::stray(self.span(3), "°C"));
            return self.push(Kind::Sign, 3);
        }
        if let Some(sign) = LONG_SIGNS
            .iter()
            .find(|sign| self.rest().starts_with(**sign))
        {
            return self.push(Kind::Sign, sign.len());
        }
        match first {
            '(' | '[' => {
                self.open.push(first);
                if self.open.len() == limits::NESTING + 1 {
                    self.error(messages::nested_too_deep(self.span(1)));
                }
                self.push(Kind::Sign, 1);
            }
            ')' | ']' => {
                self.open.pop();
                self.push(Kind::Sign, 1);
                if first == ']' {
                    self.unit();
                }
            }
            '{' | '}' => {
                self.open.clear();
                self.push(Kind::Sign, 1);
            }
            '=' | '<' | '>' | '+' | '-' | '*' | '/' | '^' | ',' | ':' | '.' | '~' => {
                self.push(Kind::Sign, 1);
            }
            _ => {
                let rest = self.rest();
                let length = characters::stray_run(rest);
                let shown = characters::shown(&rest[..length]);
                let error = if characters::is_bad(first, false) || first == '\r' {
                    messages::bad_character(self.span(length), &shown)
                } else if first.is_alphabetic() {
                    messages::foreign_letter(self.span(length), &rest[..length], &shown)
                } else {
                    messages::stray(self.span(length), &rest[..length])
                };
                self.error(error);
                self.push(Kind::Sign, length);
            }
        }
    }
}

/// Length in bytes of a string that is closed several lines below the line on which it opens; None if another statement begins before
/// that.
fn closed_below(text: &str) -> Option<usize> {
    let mut end = 0;
    for (index, line) in text.split_inclusive('\n').take(LINES_OF_A_TEXT).enumerate() {
        let words = line.trim_start();
        let after =
            words.trim_start_matches(|next: char| next.is_ascii_alphanumeric() || next == '_');
        let begins = after.trim_start().starts_with('=')
            || words.starts_with('}')
            || line.trim_end().ends_with('{');
        match (index, line.matches('"').count()) {
            (0, _) => {}
            (_, 0) if !begins => {}
            (_, 1) if !begins => return line.find('"').map(|at| end + at + 1),
            _ => return None,
        }
        end += line.len();
    }
    None
}
