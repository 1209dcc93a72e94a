//! What may be written at a cursor. In: the text of a document and an offset. Out: the [`Place`], from the tokens before the cursor: the
//! text need not be valid, because it is being written.

use std::ops::Range;

use psd_language::syntax::tokens::{Kind, Token, Tokens};
use psd_plan::schema::{self, BlockKind, Field, FieldType, ITEM_WORDS, Variant};
use psd_text::markdown::{Document, is_document};
use psd_text::source::FileId;

/// A cursor.
#[derive(Debug)]
pub struct Cursor<'a> {
    /// The bytes of the word that is being written, up to the cursor.
    pub prefix: Range<usize>,
    pub place: Place<'a>,
}

#[derive(Debug)]
pub enum Place<'a> {
    /// A comment, a name that is being declared, or text that is no plan.
    Nothing,
    /// The start of an item, after these words of it.
    Item(Vec<&'a str>),
    /// The start of an entry.
    Key(Inside<'a>),
    /// A value.
    Value(Value<'a>),
    /// After a number, where its unit stands.
    Unit(Value<'a>),
    /// After `NAME.` or `NAME.NAME.`
    Member {
        owner: Vec<&'a str>,
        value: Value<'a>,
    },
    /// Inside of a string.
    Text(Value<'a>),
}

/// The block around a cursor.
#[derive(Clone, Debug)]
pub struct Inside<'a> {
    pub kind: Option<&'static BlockKind>,
    /// Where it begins.
    pub start: usize,
    /// The fields that it states.
    pub keys: Vec<&'a str>,
}

/// The value around a cursor.
#[derive(Clone, Debug)]
pub struct Value<'a> {
    pub block: Option<Inside<'a>>,
    /// The first word of the line: the key of a field, or `let`, `require`, …
    pub word: &'a str,
    /// The field of the entry, or the argument of the call.
    pub field: Option<&'static Field>,
    /// The variants of the innermost choice.
    pub variants: &'static [Variant],
    pub call: Option<Call<'a>>,
    /// Whether a value ends before the cursor, so that an operator follows.
    pub is_complete: bool,
    /// Path and members of the value before the last comparison: `hit.max_displacement` of `hit.max_displacement < 5 `.
    pub compared: Vec<&'a str>,
}

/// A call that is being written.
#[derive(Clone, Debug)]
pub struct Call<'a> {
    pub name: &'a str,
    pub variant: Option<&'static Variant>,
    /// The arguments before the cursor that have names.
    pub named: Vec<&'a str>,
    /// Number of arguments before this one.
    pub index: usize,
    /// The name of this argument.
    pub argument: Option<&'a str>,
}

/// The plan of a document, with everything else blank.
pub fn plan_text(name: &str, text: &str) -> String {
    if is_document(name) {
        Document::read(text).blanked(text)
    } else {
        text.to_owned()
    }
}

/// Whether an offset is in the plan of a document.
pub fn is_in_plan(name: &str, text: &str, offset: usize) -> bool {
    let inside = |body: &Range<usize>| body.start <= offset && offset <= body.end;
    !is_document(name)
        || Document::read(text)
            .blocks
            .iter()
            .any(|block| inside(&block.body))
}

impl<'a> Cursor<'a> {
    /// Reads the tokens of a plan up to an offset.
    pub fn of(text: &'a str, offset: usize) -> Self {
        let tokens = Tokens::read(text, FileId(0));
        let list: Vec<Token> = tokens
            .list
            .iter()
            .copied()
            .filter(|token| token.start < offset)
            .collect();
        let last = list.last().copied();
        let nothing = Self {
            prefix: offset..offset,
            place: Place::Nothing,
        };
        if let Some(last) = last {
            let ends = text[last.start..last.end].trim_end();
            if last.kind == Kind::Comment && last.end >= offset {
                return nothing;
            }
            if last.kind == Kind::Text {
                let closed = last.end - last.start > 1 && ends.ends_with('"');
                if offset < last.end || !closed {
                    let value = Lines::read(&tokens, text, &list[..list.len() - 1]).value();
                    let from = last.start + 1;
                    return Self {
                        prefix: from..offset.max(from),
                        place: Place::Text(value),
                    };
                }
            }
        }
        if let Some(prefix) = unit_prefix(text, &list, offset) {
            let before = list.partition_point(|token| token.end <= prefix.start);
            let value = Lines::read(&tokens, text, &list[..before]).value();
            return Self {
                prefix,
                place: Place::Unit(value),
            };
        }
        let partial =
            last.filter(|last| matches!(last.kind, Kind::Word | Kind::Unit) && last.end >= offset);
        if partial.is_none()
            && last.is_some_and(|last| last.kind == Kind::Number && last.end >= offset)
        {
            return nothing;
        }
        let prefix = partial.map_or(offset..offset, |last| last.start..offset);
        let before = if partial.is_some() {
            &list[..list.len() - 1]
        } else {
            &list[..]
        };
        let lines = Lines::read(&tokens, text, before);
        Self {
            prefix,
            place: lines.place(),
        }
    }
}

/// The unit that is being written after a number or a list.
fn unit_prefix(text: &str, list: &[Token], offset: usize) -> Option<Range<usize>> {
    let number = list.iter().rev().find(|token| {
        token.end <= offset && (token.kind == Kind::Number || &text[token.start..token.end] == "]")
    })?;
    let between = &text[number.end..offset];
    let unit = between.trim_start_matches([' ', '\t']);
    let is_unit = |c: char| c.is_alphanumeric() || "%/*^.µμ".contains(c);
    let starts_well = unit.starts_with(|c: char| c.is_alphabetic() || c == '%' || c == '1');
    let is_range = unit.contains("..");
    if unit.is_empty() && between.is_empty() || is_range {
        return None;
    }
    (unit.is_empty() || starts_well && unit.chars().all(is_unit))
        .then(|| offset - unit.len()..offset)
}

/// An open bracket.
struct Frame<'a> {
    /// The name before a parenthesis.
    name: Option<&'a str>,
    /// The token after it.
    start: usize,
    named: Vec<&'a str>,
    index: usize,
    argument: Option<&'a str>,
}

/// The item, the entry and the brackets that are open after some tokens.
struct Lines<'a> {
    text: &'a str,
    list: Vec<Token>,
    /// Where the words and the name of the block stand, and where it begins.
    block: Option<(Vec<&'a str>, usize)>,
    keys: Vec<&'a str>,
    /// The first token of the line.
    line: usize,
    frames: Vec<Frame<'a>>,
}

impl<'a> Lines<'a> {
    fn read(tokens: &Tokens<'a>, text: &'a str, list: &[Token]) -> Self {
        let mut lines = Self {
            text,
            list: list.to_vec(),
            block: None,
            keys: Vec::new(),
            line: 0,
            frames: Vec::new(),
        };
        let is = |at: usize, sign: &str| {
            list.get(at)
                .is_some_and(|token| &text[token.start..token.end] == sign)
        };
        for (at, token) in list.iter().enumerate() {
            let word = &text[token.start..token.end];
            match (token.kind, word) {
                (Kind::Newline, _) => {
                    let next = list.get(at + 1);
                    let begins = next.is_some_and(|next| {
                        let word = &text[next.start..next.end];
                        next.kind == Kind::Word && (is(at + 2, "=") || ITEM_WORDS.contains(&word))
                    });
                    if lines.frames.is_empty() || begins {
                        lines.frames.clear();
                        lines.line = at + 1;
                    }
                }
                (Kind::Sign, "{") => {
                    let head = &list[lines.line.min(at)..at];
                    let words = head.iter().filter(|token| token.kind == Kind::Word);
                    let start = head.first().map_or(token.start, |token| token.start);
                    let words = words.map(|token| &text[token.start..token.end]).collect();
                    lines.block = Some((words, start));
                    lines.keys.clear();
                    lines.frames.clear();
                    lines.line = at + 1;
                }
                (Kind::Sign, "}") => {
                    lines.block = None;
                    lines.frames.clear();
                    lines.line = at + 1;
                }
                (Kind::Sign, "(" | "[") => {
                    let before = at.checked_sub(1).map(|before| list[before]);
                    let name = before
                        .filter(|before| before.kind == Kind::Word && before.end == token.start);
                    let name = name.filter(|_| word == "(");
                    lines.frames.push(Frame {
                        name: name.map(|name| &text[name.start..name.end]),
                        start: at + 1,
                        named: Vec::new(),
                        index: 0,
                        argument: None,
                    });
                }
                (Kind::Sign, ")" | "]") => {
                    lines.frames.pop();
                }
                (Kind::Sign, ",") => {
                    if let Some(frame) = lines.frames.last_mut() {
                        frame.index += 1;
                        frame.argument = None;
                        frame.start = at + 1;
                    }
                }
                (Kind::Sign, ":") => {
                    if let (Some(frame), Some(name)) = (lines.frames.last_mut(), at.checked_sub(1))
                    {
                        let name = &text[list[name].start..list[name].end];
                        frame.argument = Some(name);
                        frame.named.push(name);
                        frame.start = at + 1;
                    }
                }
                (Kind::Sign, "=") if at == lines.line + 1 && lines.block.is_some() => {
                    lines
                        .keys
                        .push(&text[list[lines.line].start..list[lines.line].end]);
                }
                _ => {}
            }
        }
        // The entries after the cursor count too: what is stated there is not missing.
        if lines.block.is_some() {
            let rest = &tokens.list[list.len().min(tokens.list.len())..];
            for pair in rest.windows(2) {
                let word = |token: Token| &text[token.start..token.end];
                if word(pair[0]) == "}" || word(pair[0]) == "{" {
                    break;
                }
                if pair[0].kind == Kind::Word && word(pair[1]) == "=" {
                    lines.keys.push(word(pair[0]));
                }
            }
        }
        lines
    }

    fn word(&self, token: Token) -> &'a str {
        &self.text[token.start..token.end]
    }

    /// The tokens of the line, without comments.
    fn tokens(&self) -> Vec<Token> {
        let line = &self.list[self.line.min(self.list.len())..];
        let is_read = |token: &&Token| !matches!(token.kind, Kind::Comment | Kind::Newline);
        line.iter().filter(is_read).copied().collect()
    }

    fn inside(&self) -> Option<Inside<'a>> {
        let (words, start) = self.block.as_ref()?;
        Some(Inside {
            kind: schema::block_of_words(words),
            start: *start,
            keys: self.keys.clone(),
        })
    }

    fn place(&self) -> Place<'a> {
        let line = self.tokens();
        let words: Vec<&str> = line.iter().map(|token| self.word(*token)).collect();
        let Some(first) = words.first() else {
            return match self.inside() {
                Some(inside) => Place::Key(inside),
                None => Place::Item(Vec::new()),
            };
        };
        let has_value = words.contains(&"=");
        if self.block.is_some() && !has_value {
            return Place::Nothing;
        }
        let is_declared = self.block.is_none() && matches!(*first, "let" | "param") && !has_value;
        let is_label = *first == "require" && !line.iter().any(|token| token.kind == Kind::Text);
        if is_declared || is_label {
            return Place::Nothing;
        }
        if self.block.is_none() && !ITEM_WORDS.contains(first) {
            return Place::Item(words);
        }
        let mut owner: Vec<&str> = Vec::new();
        let mut rest = &line[..];
        while let [before @ .., name, dot] = rest
            && self.word(*dot) == "."
            && name.kind == Kind::Word
        {
            owner.insert(0, self.word(*name));
            rest = before;
        }
        let value = self.value();
        if owner.is_empty() {
            Place::Value(value)
        } else {
            Place::Member { owner, value }
        }
    }

    /// The value in which the tokens end.
    fn value(&self) -> Value<'a> {
        let line = self.tokens();
        let block = self.inside();
        let word = line.first().map_or("", |first| self.word(*first));
        let kind = block.as_ref().and_then(|block| block.kind);
        let mut field = kind.and_then(|kind| kind.field(word));
        let mut variants: &'static [Variant] = &[];
        let mut call = None;
        let mut take = |field: Option<&'static Field>| {
            let own = field.map_or(&[][..], |field| field.ty.variants());
            if !own.is_empty() {
                variants = own;
            }
            variants
        };
        take(field);
        for frame in &self.frames {
            let Some(name) = frame.name else { continue };
            let variant = take(field).iter().find(|variant| variant.name == name);
            if let Some(variant) = variant {
                field = match frame.argument {
                    Some(name) => variant.argument(name),
                    None => variant.arguments.get(frame.index).or(variant
                        .arguments
                        .last()
                        .filter(|last| matches!(last.ty, FieldType::Inners))),
                };
                take(field);
            }
            call = Some(Call {
                name,
                variant,
                named: frame.named.clone(),
                index: frame.index,
                argument: frame.argument,
            });
        }
        let from = self.frames.last().map_or(self.line, |frame| frame.start);
        let last = self.list[from.min(self.list.len())..]
            .iter()
            .rfind(|token| !matches!(token.kind, Kind::Comment | Kind::Newline));
        let is_complete = last.is_some_and(|last| match last.kind {
            Kind::Number | Kind::Unit => true,
            Kind::Text => {
                word != "require" || self.word(line[1.min(line.len() - 1)]) != self.word(*last)
            }
            Kind::Word => {
                let joins = psd_language::syntax::tokens::JOINING_WORDS;
                !joins.contains(&self.word(*last)) && last.start != line[0].start
            }
            Kind::Sign => matches!(self.word(*last), ")" | "]"),
            Kind::Newline | Kind::Comment => false,
        });
        Value {
            compared: self.compared(&line),
            block,
            word,
            field,
            variants,
            call,
            is_complete,
        }
    }

    /// The names before the last comparison of a line.
    fn compared(&self, line: &[Token]) -> Vec<&'a str> {
        let comparison = line.iter().rposition(|token| {
            matches!(
                self.word(*token),
                "<" | "<=" | ">" | ">=" | "==" | "!=" | "within" | "in" | "~"
            )
        });
        let Some(at) = comparison else {
            return Vec::new();
        };
        let mut names: Vec<&str> = Vec::new();
        for token in line[..at].iter().rev() {
            match self.word(*token) {
                "." => {}
                word if token.kind == Kind::Word => names.insert(0, word),
                _ => break,
            }
            if names.len() > 1
                && line[..at].len() > 3
                && !line[..at].iter().any(|one| self.word(*one) == ".")
            {
                break;
            }
        }
        names
    }
}
