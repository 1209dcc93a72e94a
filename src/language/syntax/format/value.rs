//! One value in canonical spacing: on one line if it fits and was on one line, else lists and calls with one element per line. In: the
//! value's tokens and the text before it. Out: lines.

use super::{INDENT, WIDTH};
use crate::syntax::lexical::tokens::{JOINING_WORDS, Kind, Tokens};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// An opening bracket; the atom that closes it, and whether commas separate its elements.
    Open {
        close: usize,
        elements: bool,
    },
    Close,
    Comma,
    Infix,
    Operand,
    Newline,
    Comment,
}

/// A token and its spacing.
#[derive(Clone, Copy, Debug)]
struct Atom<'a> {
    text: &'a str,
    role: Role,
    /// A space before it, unless it starts a line.
    blank: bool,
}

/// The value on one line, whatever its length. Only for values without comments and line ends.
pub fn flat(tokens: &Tokens, start: usize, end: usize) -> String {
    let mut text = String::new();
    push_flat(&atoms(tokens, start, end), &mut text);
    text
}

/// `head` and the value; lines after the first are indented from `indent`.
pub fn lines(tokens: &Tokens, start: usize, end: usize, head: &str, indent: usize) -> Vec<String> {
    let atoms = atoms(tokens, start, end);
    if !is_loose(&atoms) {
        let mut line = head.to_owned();
        push_flat(&atoms, &mut line);
        if width(&line) <= WIDTH {
            return vec![line];
        }
    }
    let mut writer = Writer {
        lines: vec![head.to_owned()],
        fresh: true,
        commented: false,
    };
    writer.value(&atoms, 0, atoms.len(), indent);
    writer.lines
}

fn width(line: &str) -> usize {
    line.chars().count()
}

fn is_loose(atoms: &[Atom]) -> bool {
    atoms
        .iter()
        .any(|atom| matches!(atom.role, Role::Newline | Role::Comment))
}

fn atoms<'a>(tokens: &Tokens<'a>, start: usize, end: usize) -> Vec<Atom<'a>> {
    let mut atoms: Vec<Atom> = Vec::with_capacity(end.saturating_sub(start));
    let mut open: Vec<usize> = Vec::new();
    // Whether a value has just ended, so that an operator comes next, and neither a unary minus nor a name.
    let mut after_value = false;
    let mut glued = true;
    for token in tokens.list.get(start..end).unwrap_or_default() {
        let text = tokens.text_of(*token).trim_end();
        let (role, blank, glue_next, value) = match (token.kind, text) {
            (Kind::Newline, _) => (Role::Newline, false, glued, after_value),
            (Kind::Comment, _) => (Role::Comment, false, glued, after_value),
            (Kind::Sign, "(" | "[") => {
                let elements = (text == "(") == after_value;
                open.push(atoms.len());
                (
                    Role::Open { close: 0, elements },
                    !after_value && !glued,
                    true,
                    false,
                )
            }
            (Kind::Sign, ")" | "]") => {
                let close = atoms.len();
                if let Some(Role::Open { close: closing, .. }) =
                    open.pop().map(|open| &mut atoms[open].role)
                {
                    *closing = close;
                }
                (Role::Close, false, false, true)
            }
            (Kind::Sign, ",") => (Role::Comma, false, false, false),
            (Kind::Sign, ":") => (Role::Operand, false, false, false),
            (Kind::Sign, ".") => (Role::Operand, false, true, false),
            (Kind::Sign, "-") if !after_value => (Role::Operand, !glued, true, false),
            (Kind::Sign, _) => (Role::Infix, true, false, false),
            // `in` is no joining word to the lexer, because `3 in` is three inches.
            (Kind::Word, _) if after_value && (JOINING_WORDS.contains(&text) || text == "in") => {
                (Role::Infix, true, false, false)
            }
            _ => (Role::Operand, !glued, false, true),
        };
        atoms.push(Atom { text, role, blank });
        glued = glue_next;
        after_value = value;
    }
    atoms
}

fn push(line: &mut String, atom: Atom, fresh: bool) {
    if atom.blank && !fresh {
        line.push(' ');
    }
    line.push_str(atom.text);
}

fn push_flat(atoms: &[Atom], line: &mut String) {
    let mut fresh = true;
    for (index, atom) in atoms.iter().enumerate() {
        let last_comma = atom.role == Role::Comma
            && atoms
                .get(index + 1)
                .is_some_and(|next| next.role == Role::Close);
        if !last_comma {
            push(line, *atom, fresh);
            fresh = false;
        }
    }
}

struct Writer {
    lines: Vec<String>,
    /// The last line has only the text before a value so far.
    fresh: bool,
    /// The last line ends with a comment: no further text can follow on it.
    commented: bool,
}

impl Writer {
    fn line(&mut self) -> &mut String {
        if self.lines.is_empty() {
            self.lines.push(String::new());
        }
        let last = self.lines.len() - 1;
        &mut self.lines[last]
    }

    fn new_line(&mut self, indent: usize) {
        self.lines.push(" ".repeat(indent));
        self.fresh = true;
        self.commented = false;
    }

    fn push(&mut self, atom: Atom) {
        let fresh = self.fresh;
        push(self.line(), atom, fresh);
        self.fresh = false;
    }

    /// A comment on the line of the token before it, or on a separate one. The next token starts a line.
    fn comment(&mut self, text: &str, own_line: bool, indent: usize) {
        if own_line {
            self.new_line(indent);
        } else {
            self.line().push_str("  ");
        }
        self.line().push_str(text);
        self.fresh = false;
        self.commented = true;
    }

    fn value(&mut self, atoms: &[Atom], start: usize, end: usize, indent: usize) {
        let mut at = start;
        // A line end or comment was read: the next token starts a line.
        let mut broken = false;
        let mut own_line = false;
        while at < end {
            let atom = atoms[at];
            match atom.role {
                Role::Newline => {
                    broken = true;
                    own_line = true;
                }
                Role::Comment => {
                    self.comment(atom.text, own_line, indent + INDENT);
                    broken = true;
                }
                _ => {
                    if std::mem::take(&mut broken) {
                        self.new_line(indent + INDENT);
                    }
                    own_line = false;
                    if let Role::Open { close, elements } = atom.role {
                        self.group(atoms, at, close, elements, indent);
                        at = close;
                    } else {
                        self.push(atom);
                        broken = atom.role == Role::Infix && self.overflows(&atoms[at + 1..end]);
                    }
                }
            }
            at += 1;
        }
    }

    /// Whether the next operand would exceed the width where one line is to contain it.
    fn overflows(&mut self, rest: &[Atom]) -> bool {
        let mut depth = 0_usize;
        let mut length = 0;
        for atom in rest {
            match atom.role {
                Role::Newline | Role::Comment => return false,
                Role::Infix if depth == 0 => break,
                Role::Open { .. } => depth += 1,
                Role::Close => depth = depth.saturating_sub(1),
                _ => {}
            }
            length += usize::from(atom.blank) + width(atom.text);
        }
        width(self.line()) + length > WIDTH
    }

    /// A bracket and its content, `atoms[open..=close]`.
    fn group(&mut self, atoms: &[Atom], open: usize, close: usize, elements: bool, indent: usize) {
        let whole = &atoms[open..=close];
        let mut flat = String::new();
        push_flat(whole, &mut flat);
        let fits = width(self.line()) + width(&flat) < WIDTH;
        if !is_loose(whole) && (fits || close == open + 1) {
            let blank = atoms[open].blank && !self.fresh;
            self.line().push_str(if blank { " " } else { "" });
            self.line().push_str(&flat);
            self.fresh = false;
            return;
        }
        self.push(atoms[open]);
        let inner = indent + INDENT;
        let mut at = open + 1;
        while at < close {
            at = self.comments(atoms, at, close, inner);
            if at == close {
                break;
            }
            let end = element_end(atoms, at, close);
            let solid = (at..end)
                .rev()
                .find(|index| !matches!(atoms[*index].role, Role::Newline | Role::Comment));
            let solid = solid.map_or(at, |last| last + 1);
            self.new_line(inner);
            self.value(atoms, at, solid, inner);
            if elements {
                self.line().push(',');
            }
            self.comments(atoms, solid, end, inner);
            at = if end < close { end + 1 } else { close };
        }
        self.new_line(indent);
        self.push(atoms[close]);
    }

    /// Writes the comments from `at` on; returns the first atom that is not a comment.
    fn comments(&mut self, atoms: &[Atom], mut at: usize, end: usize, indent: usize) -> usize {
        let mut own_line = self.commented;
        while at < end {
            match atoms[at].role {
                Role::Newline => own_line = true,
                Role::Comment => {
                    self.comment(atoms[at].text, own_line, indent);
                    own_line = true;
                }
                _ => break,
            }
            at += 1;
        }
        at
    }
}

/// The end of the element that starts at `at`: its comma, or the closing bracket.
fn element_end(atoms: &[Atom], mut at: usize, close: usize) -> usize {
    while at < close && atoms[at].role != Role::Comma {
        at = match atoms[at].role {
            Role::Open { close, .. } => close + 1,
            _ => at + 1,
        };
    }
    at
}
