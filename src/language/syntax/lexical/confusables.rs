//! Characters that look like those of the language but differ from them: a no-break space, `≤`, `“x”`, `=<`, a Cyrillic і. In: the text
//! of a file. Out: the normalized text, with the same length in bytes, so that every span in it stays valid, and one error for each sort
//! of confusable. It knows no grammar.

use super::confusable::Confusable;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use super::letters;
use crate::syntax::{limits, messages};
use psd_text::diagnostic::Diagnostic;
use psd_text::source::{FileId, Span};

/// A text with its confusables replaced.
pub struct Normalized<'a> {
    pub text: Cow<'a, str>,
    /// One for each sort of confusable, at its first position.
    pub errors: Vec<Diagnostic>,
    /// Every span that is not read as it is written, in order.
    pub spans: Vec<Span>,
}

/// Operators of other languages. The longer ones come first.
const FOREIGN_OPERATORS: &[(&str, &str)] = &[
    ("===", "=="),
    ("!==", "!="),
    ("...", ".."),
    ("->", "."),
    ("=<", "<="),
    ("=>", ">="),
    ("<>", "!="),
    ("**", "^"),
    (":=", "="),
];

/// Characters that look like one of the language, or have its meaning elsewhere.
const SIGNS: &[(&str, &str)] = &[
    ("−", "-"),
    ("–", "-"),
    ("—", "-"),
    ("‐", "-"),
    ("‑", "-"),
    ("－", "-"),
    ("×", "*"),
    ("·", "*"),
    ("∙", "*"),
    ("⋅", "*"),
    ("∗", "*"),
    ("÷", "/"),
    ("∕", "/"),
    ("⁄", "/"),
    ("≤", "<="),
    ("⩽", "<="),
    ("≥", ">="),
    ("⩾", ">="),
    ("≠", "!="),
    ("＝", "="),
    ("＜", "<"),
    ("＞", ">"),
    ("，", ","),
    ("：", ":"),
    ("（", "("),
    ("）", ")"),
    ("［", "["),
    ("］", "]"),
    ("｛", "{"),
    ("｝", "}"),
    ("…", ".."),
];

const SUPERSCRIPTS: [(char, char); 11] = [
    ('⁻', '-'),
    ('⁰', '0'),
    ('¹', '1'),
    ('²', '2'),
    ('³', '3'),
    ('⁴', '4'),
    ('⁵', '5'),
    ('⁶', '6'),
    ('⁷', '7'),
    ('⁸', '8'),
    ('⁹', '9'),
];

/// Opening quotes, each with its closing quotes; `"` closes all of them.
const QUOTES: &[(char, &str)] = &[
    ('“', "”“"),
    ('”', "”"),
    ('„', "“”"),
    ('«', "»"),
    ('»', "«"),
    ('‘', "’‘"),
    ('’', "’"),
    ('‚', "‘’"),
    ('\'', "'’"),
    ('`', "`'"),
    ('＂', "＂"),
    ('"', "”“＂"),
];

/// Spaces that are not part of the language.
const fn is_foreign_space(c: char) -> bool {
    matches!(
        c,
        '\u{a0}' | '\u{1680}' | '\u{2000}'..='\u{200a}' | '\u{202f}' | '\u{205f}' | '\u{3000}'
    )
}

/// Replaces every confusable.
#[must_use]
pub fn normalize(text: &str, file: FileId) -> Normalized<'_> {
    let mut normalizer = Normalizer {
        text,
        at: 0,
        normalized: Vec::new(),
        confusables: Vec::new(),
        known: BTreeMap::new(),
        last_comment_end: text.rfind("*/"),
    };
    while normalizer.at < text.len() {
        normalizer.at += normalizer.read_next();
    }
    let span = |bytes: &Range<usize>| Span::new(file, bytes.start, bytes.end);
    let to_diagnostic = |(confusable, spans): &(Confusable, Vec<Range<usize>>)| {
        messages::confusable(*confusable, span(&spans[0]), spans.len(), text)
    };
    let errors = normalizer
        .confusables
        .iter()
        .take(limits::ERRORS)
        .map(to_diagnostic)
        .collect();
    let mut spans: Vec<Span> = normalizer
        .confusables
        .iter()
        .flat_map(|(_, spans)| spans)
        .map(span)
        .collect();
    spans.sort_by_key(|span| span.start);
    let normalized = String::from_utf8(normalizer.normalized)
        .ok()
        .filter(|normalized| !normalized.is_empty());
    Normalized {
        text: normalized.map_or(Cow::Borrowed(text), Cow::Owned),
        errors,
        spans,
    }
}

struct Normalizer<'a> {
    text: &'a str,
    at: usize,
    /// Empty while nothing is replaced.
    normalized: Vec<u8>,
    confusables: Vec<(Confusable<'a>, Vec<Range<usize>>)>,
    /// The index of each among them.
    known: BTreeMap<Confusable<'a>, usize>,
    /// Where the last `*/` of the text is.
    last_comment_end: Option<usize>,
}

impl<'a> Normalizer<'a> {
    /// Reads one character or confusable; returns its length in bytes.
    fn read_next(&mut self) -> usize {
        let rest = &self.text[self.at..];
        let Some(first) = rest.chars().next() else {
            return 1;
        };
        match first {
            'a'..='z'
            | 'A'..='Z'
            | '0'..='9'
            | '_'
            | ' '
            | '\n'
            | ','
            | '('
            | ')'
            | '['
            | ']'
            | '{'
            | '}'
            | '%'
            | '+'
            | '^' => 1,
            '#' => line(rest).len(),
            // A string that is never closed has a separate error: the text after it contains no operators.
            '"' => text_extent(rest).unwrap_or_else(|| match self.quoted(rest, first) {
                1 => line(rest).len(),
                length => length,
            }),
            ';' if ends_statement(&rest[1..]) => self.replace(Confusable::Semicolon, 1, " "),
            '/' if rest.starts_with("//") => {
                self.replace(Confusable::Comment("//"), 2, "#");
                line(rest).len()
            }
            '/' if rest.starts_with("/*") => self.long_comment(rest),
            '\u{feff}' if self.at == 0 => {
                self.replace(Confusable::ByteOrderMark, first.len_utf8(), "")
            }
            // Between digits it groups them, which is an error of the number.
            space if is_foreign_space(space) && self.groups_digits(rest) => {
                self.write(self.at, space.len_utf8(), "");
                space.len_utf8()
            }
            space if is_foreign_space(space) => {
                self.replace(Confusable::Space(space), space.len_utf8(), "")
            }
            '\'' | '’' if self.groups_digits(rest) => first.len_utf8(),
            _ if QUOTES.iter().any(|(open, _)| *open == first) => self.quoted(rest, first),
            _ if SUPERSCRIPTS.iter().any(|(raised, _)| *raised == first) => self.superscript(rest),
            _ if letters::is_foreign(first) => self.word(),
            _ => {
                let signs = if first.is_ascii() {
                    FOREIGN_OPERATORS
                } else {
                    SIGNS
                };
                match signs.iter().find(|(written, _)| rest.starts_with(written)) {
                    Some((written, meant)) => {
                        self.replace(Confusable::Sign(written, meant), written.len(), meant)
                    }
                    None => first.len_utf8(),
                }
            }
        }
    }

    /// Records a confusable of `length` bytes here, and replaces it.
    fn replace(&mut self, confusable: Confusable<'a>, length: usize, meant: &str) -> usize {
        self.note(confusable, self.at..self.at + length);
        self.write(self.at, length, meant);
        length
    }

    fn note(&mut self, confusable: Confusable<'a>, span: Range<usize>) {
        let at = *self
            .known
            .entry(confusable)
            .or_insert(self.confusables.len());
        match self.confusables.get_mut(at) {
            Some((_, spans)) => spans.push(span),
            None => self.confusables.push((confusable, vec![span])),
        }
    }

    /// Replaces `length` bytes by `meant` and spaces.
    fn write(&mut self, at: usize, length: usize, meant: &str) {
        if self.normalized.is_empty() {
            self.normalized = self.text.as_bytes().to_vec();
        }
        let span = &mut self.normalized[at..at + length];
        span.fill(b' ');
        span[..meant.len()].copy_from_slice(meant.as_bytes());
    }

    /// Whether this one character has a digit before it, and three after it, as in `1 000`.
    fn groups_digits(&self, rest: &str) -> bool {
        let after = rest
            .chars()
            .skip(1)
            .take_while(char::is_ascii_digit)
            .take(4)
            .count();
        after == 3 && self.text[..self.at].ends_with(|before: char| before.is_ascii_digit())
    }

    /// Up to `*/`, else to the end of the line. Line ends stay.
    fn long_comment(&mut self, rest: &str) -> usize {
        // Only an end that exists is looked for, so that no text is searched twice.
        let closed = self.last_comment_end.is_some_and(|end| end >= self.at + 2);
        let end = closed.then(|| rest[2..].find("*/")).flatten();
        let length = end.map_or_else(|| line(rest).len(), |end| 2 + end + 2);
        self.note(Confusable::Comment("/*"), self.at..self.at + 2);
        let mut at = self.at;
        for piece in rest[..length].split_inclusive('\n') {
            self.write(at, piece.trim_end_matches(['\r', '\n']).len(), "");
            at += piece.len();
        }
        length
    }

    /// A string in quotes other than `"`. One whose end is unclear is unchanged.
    fn quoted(&mut self, rest: &'a str, open: char) -> usize {
        let begin = open.len_utf8();
        let closing = QUOTES
            .iter()
            .find(|(known, _)| *known == open)
            .map_or("", |(_, closing)| closing);
        // A longer one is invalid anyway; the bound limits the search.
        let inside =
            rest[begin..].split_at_checked(rest[begin..].floor_char_boundary(limits::TEXT_BYTES));
        let inside = line(inside.map_or("", |(inside, _)| inside));
        let close = inside
            .char_indices()
            .find(|(_, c)| closing.contains(*c) || *c == '"');
        let Some((length, close)) = close.filter(|(length, _)| !inside[..*length].contains('\\'))
        else {
            return begin;
        };
        let whole = begin + length + close.len_utf8();
        self.note(
            Confusable::Quotes(if open == '"' { close } else { open }),
            self.at..self.at + whole,
        );
        self.write(self.at + begin - 1, 1, "\"");
        if begin > 1 {
            self.write(self.at, begin - 1, "");
        }
        self.write(self.at + begin + length, close.len_utf8(), "\"");
        whole
    }

    fn superscript(&mut self, rest: &'a str) -> usize {
        let raised = |c: char| {
            SUPERSCRIPTS
                .iter()
                .find(|(raised, _)| *raised == c)
                .map(|(_, plain)| *plain)
        };
        let length = rest.find(|c| raised(c).is_none()).unwrap_or(rest.len());
        let meant: String = std::iter::once('^')
            .chain(rest[..length].chars().filter_map(raised))
            .collect();
        self.replace(Confusable::Superscript(&rest[..length]), length, &meant)
    }

    /// The word whose first foreign letter is here. Returns the length of its rest in bytes.
    fn word(&mut self) -> usize {
        let text = self.text;
        let before = &text[..self.at];
        let start = before.rfind(|c| !letters::in_word(c)).map_or(0, |at| {
            at + before[at..].chars().next().map_or(1, char::len_utf8)
        });
        // A unit may follow its number directly.
        let start = start
            + before[start..]
                .find(|c: char| !c.is_ascii_digit())
                .unwrap_or(before.len() - start);
        let after = &text[self.at..];
        let end = self.at + after.find(|c| !letters::in_word(c)).unwrap_or(after.len());
        let word = &text[start..end];
        self.note(Confusable::Word(word), start..end);
        let meant = letters::written_plainly(word).unwrap_or_else(|| letters::stand_in(word));
        self.write(start, word.len(), &meant);
        end - self.at
    }
}

/// The line that begins here, without its end.
fn line(rest: &str) -> &str {
    let line = rest.split('\n').next().unwrap_or_default();
    line.strip_suffix('\r').unwrap_or(line)
}

/// Length in bytes of the string in `"` that begins here; `None` where its line does not close it.
fn text_extent(rest: &str) -> Option<usize> {
    let mut escaped = false;
    for (at, c) in line(rest).char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return Some(at + 1),
            _ => {}
        }
    }
    None
}

fn ends_statement(after: &str) -> bool {
    let after = after.trim_start_matches([' ', '\t', ';']);
    after.is_empty() || after.starts_with(['\n', '\r', '#', '}'])
}
