//! Signs, blanks, quotes and letters that a person takes for those of the language and that are others: a no-break space, `≤`,
//! `“x”`, `=<`, a Cyrillic і. In: the text of a file. Out: the text as it was meant, byte for byte of the same length, so that
//! every place in it stays what it was, and one fault for each sort of slip. It knows no grammar.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use super::{faults, letters, limits};
use crate::text::diagnostic::Diagnostic;
use crate::text::source::{FileId, Span};

/// A text read as it was meant.
pub struct Mended<'a> {
    pub text: Cow<'a, str>,
    /// One for each sort of slip, at its first place.
    pub faults: Vec<Diagnostic>,
    /// Every place that is read otherwise than it is written, in order.
    pub places: Vec<Span>,
}

/// What was written for something else. The same slip is told once, however often it was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Slip<'a> {
    /// A byte order mark at the start.
    ByteOrderMark,
    /// A blank that is not the one of the keyboard.
    Blank(char),
    /// A sign, and the one that was meant.
    Sign(&'a str, &'static str),
    /// `²`
    Superscript(&'a str),
    /// `“x”`, by the quote that opens it.
    Quotes(char),
    /// `//` or `/*`
    Comment(&'static str),
    /// `;` at the end of a field
    Semicolon,
    /// A word that holds letters of another alphabet.
    Word(&'a str),
}

/// Signs that look like one of the language, or mean it elsewhere. The longer stand first.
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

/// Quotes that open a text, each with those that close it; `"` closes all of them.
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

/// Blanks that are no blanks of the language.
const fn is_odd_blank(c: char) -> bool {
    matches!(
        c,
        '\u{a0}' | '\u{1680}' | '\u{2000}'..='\u{200a}' | '\u{202f}' | '\u{205f}' | '\u{3000}'
    )
}

/// Reads a text as it was meant.
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
    /// Empty while nothing is to be mended.
    mended: Vec<u8>,
    slips: Vec<(Slip<'a>, Vec<Range<usize>>)>,
    /// Where each is among them.
    known: BTreeMap<Slip<'a>, usize>,
}

impl<'a> Mender<'a> {
    /// What stands here; how many bytes it is.
    fn turn(&mut self) -> usize {
        let rest = &self.text[self.at..];
        let Some(first) = rest.chars().next() else {
            return 1;
        };
        match first {
            'a'..='z' | 'A'..='Z' | '0'..='9' | '_' | ' ' | '\n' | ',' => 1,
            '#' => line(rest).len(),
            // One that is never closed is told of as such: nothing behind it is a sign.
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
            // Between digits it groups them, which is a fault of the number.
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

    /// Notes a slip of `length` bytes here, and what is read in its place.
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

    /// Puts `meant` into the place of `length` bytes, with blanks behind it.
    fn write(&mut self, at: usize, length: usize, meant: &str) {
        if self.mended.is_empty() {
            self.mended = self.text.as_bytes().to_vec();
        }
        let place = &mut self.mended[at..at + length];
        place.fill(b' ');
        place[..meant.len()].copy_from_slice(meant.as_bytes());
    }

    /// Whether a digit stands before this one character, and three behind it, as in `1 000`.
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

    /// A text in quotes that are not `"`. One that cannot be told where it ends is left as it is.
    fn quoted(&mut self, rest: &'a str, open: char) -> usize {
        let begin = open.len_utf8();
        let closing = QUOTES
            .iter()
            .find(|(known, _)| *known == open)
            .map_or("", |(_, closing)| closing);
        // A longer one is refused anyway; and each is looked through for so far only.
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

    /// The word whose first foreign letter stands here. How many bytes are left of it.
    fn word(&mut self) -> usize {
        let text = self.text;
        let before = &text[..self.at];
        let start = before.rfind(|c| !letters::in_word(c)).map_or(0, |at| {
            at + before[at..].chars().next().map_or(1, char::len_utf8)
        });
        // A unit may stand right behind its number.
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

/// Bytes of the text in `"` that begins here; `None` where its line does not close it.
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
