//! Error recovery: cuts a file with errors into items and fields by its lines and brackets, so that each can be parsed separately and
//! none includes the next. In: tokens. Out: [`Piece`]s and the errors of brackets. Knows lines, not grammar.

use super::{
    ast::ITEM_WORDS,
    control,
    lexical::tokens::{JOINING_WORDS, Kind, Tokens},
    limits, messages,
};
use psd_text::diagnostic::Diagnostic;

/// One statement: tokens `start..end`, the last of which is not a line end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Statement {
    pub start: usize,
    pub end: usize,
    /// Its brackets do not match, and that has been reported.
    pub broken: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Piece {
    /// `let`, `param`, `use`, `require`, or a statement that is not an item.
    Item(Statement),
    /// `open` is the token of `{`, `close` that of `}`.
    Block {
        head: Statement,
        open: usize,
        fields: Vec<Statement>,
        close: Option<usize>,
    },
}

#[must_use]
pub fn cut(tokens: &Tokens) -> (Vec<Piece>, Vec<Diagnostic>) {
    let mut cutter = Cutter {
        tokens,
        at: 0,
        errors: Vec::new(),
    };
    let mut pieces = Vec::new();
    while cutter.goes_on() {
        if cutter.is("}") {
            cutter.unexpected("an item");
            cutter.at += 1;
            continue;
        }
        if cutter.skips_control() {
            continue;
        }
        let statement = cutter.statement();
        cutter.brace_below(statement);
        if cutter.is("{") || cutter.lacks_its_brace(statement) {
            let block = cutter.block(statement);
            let closed = matches!(block, Piece::Block { close: Some(_), .. });
            pieces.push(block);
            if closed && !cutter.ends_line() && !cutter.is("}") {
                cutter.unexpected("the end of the line");
            }
        } else {
            pieces.push(Piece::Item(statement));
        }
    }
    (pieces, cutter.errors)
}

/// Largest number of words and characters in the fields of a block without `{`.
const FIELDS_WITHOUT_BRACE: usize = 500;

/// Characters between two values.
const OPERATORS: [&str; 13] = [
    "+", "-", "*", "/", "^", "..", "<", "<=", ">", ">=", "==", "!=", "~",
];

struct Cutter<'a> {
    tokens: &'a Tokens<'a>,
    at: usize,
    errors: Vec<Diagnostic>,
}

impl Cutter<'_> {
    fn is(&self, text: &str) -> bool {
        self.tokens.is(self.at, text)
    }

    fn ends_line(&self) -> bool {
        matches!(
            self.tokens.kind(self.at),
            None | Some(Kind::Newline | Kind::Comment)
        )
    }

    /// The index of the first token from `at` on that is neither a line end nor a comment.
    fn after_lines(&self, mut at: usize) -> usize {
        while matches!(self.tokens.kind(at), Some(Kind::Newline | Kind::Comment)) {
            at += 1;
        }
        at
    }

    /// Skips line ends and comments; returns whether anything is left that is worth reading: more errors than are reported are not
    /// looked for.
    fn goes_on(&mut self) -> bool {
        self.at = self.after_lines(self.at);
        self.at < self.tokens.list.len() && !self.has_enough()
    }

    fn has_enough(&self) -> bool {
        self.errors.len() > limits::ERRORS
    }

    fn unexpected(&mut self, expected: &str) {
        let token = self.tokens.list[self.at];
        let found = format!("`{}`", self.tokens.text_of(token));
        self.errors.push(messages::unexpected(
            self.tokens.span(token.start, token.end),
            &found,
            expected,
        ));
    }

    fn unclosed(&mut self, open: usize) {
        let token = self.tokens.list[open];
        let text = self.tokens.text_of(token);
        let close = closing(text);
        self.errors.push(messages::unclosed(
            self.tokens.span(token.start, token.end),
            text,
            close,
        ));
    }

    /// One statement from here: to the end of its line, further where a bracket is open or an operator is last,
    /// but never beyond a line that starts a new statement, nor beyond a brace.
    fn statement(&mut self) -> Statement {
        let start = self.at;
        let mut end = start;
        let mut open = OpenBrackets::default();
        let mut broken = false;
        while let Some(kind) = self.tokens.kind(self.at) {
            match kind {
                Kind::Newline => {
                    if open.list.is_empty() && !self.continues(end) {
                        if !self.goes_on_below() {
                            break;
                        }
                        broken = true;
                    } else if self.starts_something() {
                        break;
                    }
                    // The lines between are looked at once.
                    self.at = self.after_lines(self.at);
                    continue;
                }
                Kind::Comment => {}
                _ if self.is("{") || self.is("}") => break,
                _ => {
                    let text = self.tokens.text_of(self.tokens.list[self.at]);
                    match text {
                        "(" | "[" => open.push(self.at, text),
                        ")" | "]" => {
                            if let Some(skipped) = open.close(text) {
                                self.unclosed(skipped);
                                broken = true;
                            }
                        }
                        _ => {}
                    }
                    end = self.at + 1;
                }
            }
            self.at += 1;
        }
        if let Some((innermost, _)) = open.list.last() {
            self.unclosed(*innermost);
            broken = true;
        }
        Statement { start, end, broken }
    }

    /// Whether the next line begins with an operator, which is reported: it continues the expression of this line.
    fn goes_on_below(&mut self) -> bool {
        let next = self.at + 1;
        let joins = |word: &&str| self.tokens.is(next, word) && !self.tokens.is(next + 1, "=");
        if !OPERATORS.iter().chain(&JOINING_WORDS).any(joins) {
            return false;
        }
        let token = self.tokens.list[next];
        let operator = self.tokens.text_of(token);
        self.errors.push(messages::operator_begins_line(
            self.tokens.span(token.start, token.end),
            operator,
        ));
        true
    }

    /// A brace on a separate line below the head of its block: it is reported, and read as that block's.
    fn brace_below(&mut self, head: Statement) {
        let next = self.after_lines(self.at);
        let words = (head.start..head.end)
            .all(|at| matches!(self.tokens.kind(at), Some(Kind::Word | Kind::Text)));
        let item = ITEM_WORDS
            .iter()
            .any(|word| self.tokens.is(head.start, word));
        if next > self.at && head.end > head.start && words && !item && self.tokens.is(next, "{") {
            let brace = self.tokens.list[next];
            self.errors.push(messages::brace_on_next_line(
                self.tokens.span(brace.start, brace.end),
            ));
            self.at = next;
        }
    }

    /// Whether these are the words of a block that is closed and never opened, which is reported: fields follow, and a `}`.
    fn lacks_its_brace(&mut self, head: Statement) -> bool {
        let words = (head.start..head.end)
            .all(|at| matches!(self.tokens.kind(at), Some(Kind::Word | Kind::Text)));
        let item = ITEM_WORDS
            .iter()
            .any(|word| self.tokens.is(head.start, word));
        let next = self.after_lines(self.at);
        let field = self.tokens.kind(next) == Some(Kind::Word) && self.tokens.is(next + 1, "=");
        // The search is bounded, so that the time for a file is proportional to its length.
        let closed = || {
            let brace = (next..next + FIELDS_WITHOUT_BRACE)
                .find(|at| self.tokens.is(*at, "{") || self.tokens.is(*at, "}"));
            brace.is_some_and(|at| self.tokens.is(at, "}"))
        };
        let lacks = head.end > head.start && words && !item && field && closed();
        if lacks {
            let (first, last) = (self.tokens.list[head.start], self.tokens.list[head.end - 1]);
            self.errors.push(messages::brace_missing(
                self.tokens.span(first.start, last.end),
            ));
        }
        lacks
    }

    /// Whether the token before `end` must be followed by a value.
    fn continues(&self, end: usize) -> bool {
        let Some(last) = end.checked_sub(1) else {
            return false;
        };
        // `intensity = speed in` goes on below; after a number `in` is the unit.
        let is_word = |at: usize| self.tokens.kind(at) == Some(Kind::Word);
        let is_stepped = self.tokens.is(last, "in") && is_word(last);
        if is_stepped && last.checked_sub(1).is_some_and(is_word) {
            return true;
        }
        OPERATORS
            .iter()
            .chain(&JOINING_WORDS)
            .any(|operator| self.tokens.is(last, operator))
    }

    /// Whether the line after this line end starts a field, an item, a block or ends a block.
    fn starts_something(&self) -> bool {
        let next = self.after_lines(self.at);
        self.tokens.is(next, "}")
            || (self.tokens.kind(next) == Some(Kind::Word) && self.tokens.is(next + 1, "="))
            || self.starts_item(next)
    }

    /// Whether an item other than a field starts at `index`.
    fn starts_item(&self, index: usize) -> bool {
        if self.tokens.kind(index) != Some(Kind::Word) || self.tokens.is(index + 1, "=") {
            return false;
        }
        let keyword = ITEM_WORDS.iter().any(|word| self.tokens.is(index, word));
        let mut after = index + 1;
        while self.tokens.kind(after) == Some(Kind::Word) {
            after += 1;
        }
        let named = after > index + 1 || self.tokens.kind(after) == Some(Kind::Text);
        if self.tokens.kind(after) == Some(Kind::Text) {
            after += 1;
        }
        (keyword && named) || self.tokens.is(after, "{")
    }

    /// Skips a condition or a loop of another language, with everything in its braces; it is reported once.
    fn skips_control(&mut self) -> bool {
        let first = self.tokens.list[self.at];
        let Some((message, help)) = control::of_another_language(self.tokens.text_of(first)) else {
            return false;
        };
        let line = (self.at..).take_while(|at| {
            !matches!(
                self.tokens.kind(*at),
                None | Some(Kind::Newline | Kind::Comment)
            )
        });
        let brace = line.into_iter().find(|at| self.tokens.is(*at, "{"));
        let Some(brace) = brace.filter(|_| !self.tokens.is(self.at + 1, "=")) else {
            return false;
        };
        self.at = brace;
        self.skip_braces();
        while self
            .tokens
            .list
            .get(self.at)
            .is_some_and(|token| control::is_condition(self.tokens.text_of(*token)))
        {
            self.at = (self.at..self.tokens.list.len())
                .find(|at| self.tokens.is(*at, "{"))
                .unwrap_or(self.tokens.list.len());
            self.skip_braces();
        }
        let last = self.tokens.list[self.at.max(1) - 1];
        let (begins, whole) = (
            self.tokens.span(first.start, first.end),
            self.tokens.span(first.start, last.end),
        );
        self.errors
            .push(messages::no_control(message, help, begins, whole));
        true
    }

    fn column(&self, index: usize) -> usize {
        let start = self.tokens.list[index].start;
        start
            - self.tokens.text[..start]
                .rfind('\n')
                .map_or(0, |newline| newline + 1)
    }

    /// The block whose `{` is here.
    fn block(&mut self, head: Statement) -> Piece {
        // A block without its brace opens after its last word.
        let open = if self.is("{") { self.at } else { head.end - 1 };
        let mut fields = Vec::new();
        self.at += usize::from(self.is("{"));
        loop {
            if !self.goes_on() {
                if !self.has_enough() {
                    self.unclosed(open);
                }
                return Piece::Block {
                    head,
                    open,
                    fields,
                    close: None,
                };
            }
            if self.is("}") {
                self.at += 1;
                return Piece::Block {
                    head,
                    open,
                    fields,
                    close: Some(self.at - 1),
                };
            }
            if self.skips_control() {
                continue;
            }
            if self.starts_item(self.at) {
                // A line with no more indentation than the head of the block is the next item: the block was never closed.
                if self.column(self.at) <= self.column(head.start.min(open)) {
                    self.unclosed(open);
                    return Piece::Block {
                        head,
                        open,
                        fields,
                        close: None,
                    };
                }
                self.skip_misplaced();
                continue;
            }
            let before = self.at;
            let field = self.statement();
            if field.end > field.start {
                fields.push(field);
            }
            if self.is("{") && self.arguments_in_braces(field) {
                if let Some(field) = fields.last_mut() {
                    field.broken = true;
                }
                continue;
            }
            if self.is("{") || self.at == before {
                self.unexpected("the end of the line");
                self.skip_braces();
            }
        }
    }

    /// Skips `{0.5}` of `contact = restitution{0.5}`, on one line, and reports it.
    fn arguments_in_braces(&mut self, field: Statement) -> bool {
        let close = (self.at..)
            .take_while(|at| !matches!(self.tokens.kind(*at), None | Some(Kind::Newline)));
        let close = close.into_iter().find(|at| self.tokens.is(*at, "}"));
        let named = field.end == self.at
            && self.tokens.kind(self.at - 1) == Some(Kind::Word)
            && self.tokens.is(field.start + 1, "=");
        let Some(close) = close.filter(|_| named) else {
            return false;
        };
        let (name, open, last) = (
            self.tokens.list[self.at - 1],
            self.tokens.list[self.at],
            self.tokens.list[close],
        );
        let inside = self.tokens.text[open.end..last.start].trim();
        let call = format!("{}({inside})", self.tokens.text_of(name));
        self.errors.push(messages::arguments_in_braces(
            self.tokens.span(open.start, last.end),
            &call,
        ));
        self.at = close + 1;
        true
    }

    fn skip_misplaced(&mut self) {
        let token = self.tokens.list[self.at];
        self.errors.push(messages::misplaced_block(
            self.tokens.span(token.start, token.end),
        ));
        self.statement();
        if self.is("{") {
            self.skip_braces();
        }
    }

    /// Skips the `{` here with everything up to its `}`, or this one token.
    fn skip_braces(&mut self) {
        let mut depth = 0_usize;
        while self.at < self.tokens.list.len() {
            depth += usize::from(self.is("{"));
            depth = depth.saturating_sub(usize::from(self.is("}")));
            self.at += 1;
            if depth == 0 {
                return;
            }
        }
    }
}

/// The brackets that are open in a statement. One that closes nothing is found without a search, so that the time for a statement is
/// proportional to its length.
#[derive(Default)]
struct OpenBrackets {
    /// The token of each, with the bracket that closes it.
    list: Vec<(usize, &'static str)>,
    /// How many `(` and `[` are among them.
    round: usize,
    square: usize,
}

impl OpenBrackets {
    fn count(&mut self, close: &str) -> &mut usize {
        if close == ")" {
            &mut self.round
        } else {
            &mut self.square
        }
    }

    fn push(&mut self, token: usize, text: &str) {
        let close = closing(text);
        self.list.push((token, close));
        *self.count(close) += 1;
    }

    /// Closes the innermost bracket that `close` fits, with those inside it. Returns the innermost of these, which is never closed.
    fn close(&mut self, close: &str) -> Option<usize> {
        if *self.count(close) == 0 {
            return None;
        }
        let mut unclosed = None;
        while let Some((token, fits)) = self.list.pop() {
            *self.count(fits) -= 1;
            if fits == close {
                break;
            }
            unclosed = unclosed.or(Some(token));
        }
        unclosed
    }
}

fn closing(open: &str) -> &'static str {
    match open {
        "(" => ")",
        "[" => "]",
        _ => "}",
    }
}
