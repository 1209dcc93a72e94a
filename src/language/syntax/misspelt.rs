//! Characters that look like those of the language and are others: a no-break space, `≤`,
//! `“x”`, `=<`, a Cyrillic і. In: the text of a file. Out: the normalized text, with the same length in bytes, so that
//! every span in it stays valid, and one error for each sort of confusable. It knows no grammar.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use super::{faults, letters, limits};
use crate::text::diagnostic::Diagnostic;
use crate::text::source::{FileId, Span};

/// A text with its confusables replaced.
pub struct Mended<'a> {
    pub text: Cow<'a, str>,
    /// One for each sort of confusable, at its first position.
    pub faults: Vec<Diagnostic>,
    /// Every span that is read otherwise than it is written, in order.
    pub places: Vec<Span>,
}

/// A character or word that was written for another. Each is reported once, however often it appears.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Slip<'a> {
    /// A byte order mark at the start.
    ByteOrderMark,
    /// A space other than the one of the keyboard.
    Blank(char),
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

/// Signs that look like one of the language, or have its meaning elsewhere. The longer ones come first.
const SIGNS: &[(&str, &str)] = &[
    ("===", "=="),
    ("!==", "!="),
    ("...", ".."),
    ("->", "."),
    ("=<", "<="),
    ("=>", ">="),
    ("<>", "!="),
    ("**", "^"),
    (":=", "="),
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

/// Spaces that the language does not know.
const fn is_odd_blank(c: char) -> bool {
    matches!(
        c,
        '\u{a0}' | '\u{1680}' | '\u{2000}'..='\u{200a}' | '\u{202f}' | '\u{205f}' | '\u{3000}'
    )
}

/// Replaces every confusable.
#[must_use]
pub fn mend(text: &str, file: FileId) -> Mended<'_> {
    let mut mender = Mender {
        text,
        at: 0,
        mended: Vec::new(),
        slips: Vec::new(),
        known: BTreeMap::new(),
    };
    while mender.at < text.len() {
        mender.at += mender.turn();
    }
    let span = |place: &Range<usize>| Span::new(file, place.start, place.end);
    let told = |(slip, places): &(Slip, Vec<Range<usize>>)| {
        faults::misspelt(*slip, span(&places[0]), places.len(), text)
    };
    let faults = mender.slips.iter().take(limits::FAULTS).map(told).collect();
    let mut places: Vec<Span> = mender
        .slips
        .iter()
        .flat_map(|(_, places)| places)
        .map(span)
        .collect();
    places.sort_by_key(|place| place.start);
    let mended = String::from_utf8(mender.mended)
        .ok()
        .filter(|mended| !mended.is_empty());
    Mended {
        text: mended.map_or(Cow::Borrowed(text), Cow::Owned),
        faults,
        places,
    }
}

struct Mender<'a> {
    text: &'a str,
    at: usize,
    /// Empty while nothing is replaced.
    mended: Vec<u8>,
    slips: Vec<(Slip<'a>, Vec<Range<usize>>)>,
    /// The index of each among them.
    known: BTreeMap<Slip<'a>, usize>,
}

impl<'a> Mender<'a> {
    /// Reads one character or confusable; returns its length in bytes.
    fn turn(&mut self) -> usize {
        let rest = &self.text[self.at..];
        let Some(first) = rest.chars().next() else {
            return 1;
        };
        match first {
            'a'..='z' | 'A'..='Z' | '0'..='9' | '_' | ' ' | '\n' | ',' => 1,
            '#' => line(rest).len(),
            // A string that is never closed has a separate error: nothing after it is a sign.
            '"' => text_extent(rest).unwrap_or_else(|| match self.quoted(rest, first) {
                1 => line(rest).len(),
                length => length,
            }),
            ';' if ends_statement(&rest[1..]) => self.slip(Slip::Semicolon, 1, " "),
            '/' if rest.starts_with("//") => {
                self.slip(Slip::Comment("//"), 2, "#");
                line(rest).len()
            }
            '/' if rest.starts_with("/*") => self.long_comment(rest),
            '\u{feff}' if self.at == 0 => self.slip(Slip::ByteOrderMark, first.len_utf8(), ""),
            // Between digits it groups them, which is an error of the number.
            blank if is_odd_blank(blank) && self.groups_digits(rest) => {
                self.write(self.at, blank.len_utf8(), "");
                blank.len_utf8()
            }
            blank if is_odd_blank(blank) => self.slip(Slip::Blank(blank), blank.len_utf8(), ""),
            '\'' | '’' if self.groups_digits(rest) => first.len_utf8(),
            _ if QUOTES.iter().any(|(open, _)| *open == first) => self.quoted(rest, first),
            _ if SUPERSCRIPTS.iter().any(|(raised, _)| *raised == first) => self.superscript(rest),
            _ if letters::is_foreign(first) => self.word(),
            _ => match SIGNS.iter().find(|(written, _)| rest.starts_with(written)) {
                Some((written, meant)) => {
                    self.slip(Slip::Sign(written, meant), written.len(), meant)
                }
                None => first.len_utf8(),
            },
        }
    }

    /// Records a confusable of `length` bytes here, and replaces it.
    fn slip(&mut self, slip: Slip<'a>, length: usize, meant: &str) -> usize {
        self.note(slip, self.at..self.at + length);
        self.write(self.at, length, meant);
        length
    }

    fn note(&mut self, slip: Slip<'a>, place: Range<usize>) {
        let at = *self.known.entry(slip).or_insert(self.slips.len());
        match self.slips.get_mut(at) {
            Some((_, places)) => places.push(place),
            None => self.slips.push((slip, vec![place])),
        }
    }

    /// Replaces `length` bytes by `meant` and spaces.
    fn write(&mut self, at: usize, length: usize, meant: &str) {
        if self.mended.is_empty() {
            self.mended = self.text.as_bytes().to_vec();
        }
        let place = &mut self.mended[at..at + length];
        place.fill(b' ');
        place[..meant.len()].copy_from_slice(meant.as_bytes());
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
        let length = rest[2..]
            .find("*/")
            .map_or_else(|| line(rest).len(), |end| 2 + end + 2);
        self.note(Slip::Comment("/*"), self.at..self.at + 2);
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
            Slip::Quotes(if open == '"' { close } else { open }),
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
        self.slip(Slip::Superscript(&rest[..length]), length, &meant)
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
        self.note(Slip::Word(word), start..end);
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
