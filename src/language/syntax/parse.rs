//! Parses one file: [`parse`] returns the tree of everything that could be parsed, and every syntax error. A valid file
//! is parsed as a whole; one with errors is cut into pieces (`layout`), which are parsed separately.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::codes::{E101, E103, E104};
use pest::{
    Parser as _,
    error::{ErrorVariant, InputLocation},
    iterators::Pair,
};
use psd_text::diagnostic::Diagnostic;
use psd_text::markdown::{self, Document};
use psd_text::source::{FileId, Sources, Span, Spanned};

use super::{
    ast::{Ast, Block, Entry, Ident, Item, ItemKind},
    control, foreign,
    grammar::{Grammar, Rule},
    layout::{self, Piece, Statement},
    lexical::symbols::Symbols,
    lexical::tokens::{Kind, Tokens},
    lexical::{confusables, long_lines},
    limits,
    lower::{Lowering, unescape},
    messages, rule_names,
};

/// Parses one file: a text of the language, or the `psd` blocks of a Markdown document. Never panics; the valid parts of a file with
/// errors are in the tree, with [`ExprKind::Faulty`](super::ast::ExprKind::Faulty) in place of an invalid value.
#[must_use]
pub fn parse(sources: &Sources, file: FileId) -> (Ast, Vec<Diagnostic>) {
    let (mut ast, errors) = parse_file(sources, file);
    ast.sound = !errors.iter().any(Diagnostic::is_error);
    (ast, errors)
}

fn parse_file(sources: &Sources, file: FileId) -> (Ast, Vec<Diagnostic>) {
    let source = sources.file(file);
    if !markdown::is_document(&source.name) {
        return parse_text(&source.text, file);
    }
    let document = Document::read(&source.text);
    let (ast, mut errors) = parse_text(&document.blanked(&source.text), file);
    let of_fences = document.errors.iter();
    let of_fences: Vec<Diagnostic> = of_fences
        .map(|error| messages::fence(file, error))
        .collect();
    if document.blocks.is_empty() && of_fences.is_empty() && errors.is_empty() {
        errors.push(messages::no_plan_block(Span::new(file, 0, 0)));
    }
    if errors.is_empty() && of_fences.is_empty() {
        errors.extend(crossing(&document, &ast));
    }
    errors.extend(of_fences);
    errors.sort_by_key(|error| error.span().map(|span| (span.start, span.end)));
    (ast, errors)
}

/// The items that continue after the end of their code block.
fn crossing(document: &Document, ast: &Ast) -> Vec<Diagnostic> {
    let end_of_block = |span: Span| {
        let start = span.range().start;
        let bodies = document.blocks.iter().map(|block| &block.body);
        let body = bodies.rev().find(|body| body.start <= start)?;
        (span.range().end > body.end).then_some(body.end)
    };
    let mut found = Vec::new();
    for item in &ast.items {
        if let Some(end) = end_of_block(item.span) {
            let head = match &item.kind {
                ItemKind::Block(block) => block.head,
                _ => Span::new(ast.file, item.span.range().start, end),
            };
            found.push(messages::item_over_fences(head));
        }
    }
    found
}

fn parse_text(text: &str, file: FileId) -> (Ast, Vec<Diagnostic>) {
    let mut ast = Ast {
        file,
        sound: false,
        items: Vec::new(),
        comments: Vec::new(),
        misspelt: Vec::new(),
    };
    if text.len() > limits::FILE_BYTES {
        let start = Span::new(file, 0, 0);
        return (
            ast,
            vec![messages::too_large(
                start,
                "this file",
                limits::FILE_BYTES,
                "bytes",
            )],
        );
    }
    let too_long = long_lines::errors(text, file);
    if !too_long.is_empty() {
        return (ast, too_long);
    }
    if let Some(at) = text.find('\r').filter(|_| !text.contains('\n')) {
        return (
            ast,
            vec![messages::carriage_returns(Span::new(file, at, at + 1))],
        );
    }
    let normalized = confusables::normalize(text, file);
    let text = normalized.text.as_ref();
    let mut tokens = Tokens::read(text, file);
    ast.comments = tokens.comments();
    if tokens.errors.is_empty()
        && let Some(items) = whole(&tokens)
    {
        ast.items = items;
        ast.misspelt = normalized.spans;
        return (ast, normalized.errors);
    }
    if tokens.cut_short {
        return (ast, [normalized.errors, tokens.errors].concat());
    }
    let (items, mut errors) = piecewise(&mut tokens);
    ast.items = items;
    let ends: Vec<usize> = text
        .bytes()
        .enumerate()
        .filter(|(_, byte)| *byte == b'\n')
        .map(|(at, _)| at)
        .collect();
    let line = |at: Span| ends.partition_point(|end| *end < at.start as usize);
    let lines: BTreeSet<usize> = normalized.spans.iter().copied().map(line).collect();
    errors.retain(|error| {
        !follows(error) || error.span().is_none_or(|at| !lines.contains(&line(at)))
    });
    errors.extend(normalized.errors);
    ast.misspelt = normalized.spans;
    if errors.is_empty() {
        // The grammar rejected the whole file but accepts the pieces: report the position at which it stopped.
        let symbols = Symbols::new(&tokens, 0, tokens.list.len());
        let error = Grammar::parse(Rule::file, &symbols.text).err();
        let bytes = 0..text.len();
        errors.extend(error.map(|error| refused(&tokens, &symbols, &bytes, Rule::file, &error)));
    }
    errors.sort_by_key(|error| error.span().map(|span| (span.start, span.end)));
    (ast, errors)
}

/// Whether an error states only that a line cannot be parsed, which may follow from a confusable on the same line.
fn follows(error: &Diagnostic) -> bool {
    matches!(error.code, E101 | E103 | E104)
}

/// A valid file; `None` where there is any error.
fn whole(tokens: &Tokens) -> Option<Vec<Item>> {
    let symbols = Symbols::new(tokens, 0, tokens.list.len());
    let lowering = Lowering::new(&symbols);
    let file = Grammar::parse(Rule::file, &symbols.text).ok()?.next()?;
    let pairs = file.into_inner();
    let items = pairs.filter(|pair| !matches!(pair.as_rule(), Rule::end_of_line | Rule::EOI));
    let items: Option<Vec<Item>> = items.map(|pair| lowering.item(pair)).collect();
    lowering.errors.into_inner().is_empty().then_some(items)?
}

/// Every piece of a file, parsed separately. A valid file has the same items as from [`whole`].
fn piecewise(tokens: &mut Tokens) -> (Vec<Item>, Vec<Diagnostic>) {
    let found = std::mem::take(&mut tokens.errors);
    let mut reader = Pieces {
        tokens,
        lexical: found.len(),
        errors: found,
        by_indentation: None,
    };
    let mut items = Vec::new();
    reader.read(&mut items);
    if let Some(ByIndentation { colon, whole, head }) = reader.by_indentation {
        reader
            .errors
            .push(messages::blocks_by_indentation(colon, whole, &head));
    }
    (items, reader.errors)
}

/// The error of the piece `bytes` of a file, whose tokens are `symbols` and do not match `rule`.
fn refused(
    tokens: &Tokens,
    symbols: &Symbols,
    bytes: &Range<usize>,
    rule: Rule,
    error: &pest::error::Error<Rule>,
) -> Diagnostic {
    let index = match error.location {
        InputLocation::Pos(index) | InputLocation::Span((index, _)) => index,
    };
    let at = symbols.start(index).unwrap_or(bytes.end);
    let expected = match &error.variant {
        // A head ends where its brace opens.
        ErrorVariant::ParsingError { positives, .. }
            if rule == Rule::head_alone && positives.contains(&Rule::EOI) =>
        {
            "`{`".to_owned()
        }
        ErrorVariant::ParsingError { positives, .. } => rule_names::expected(positives),
        ErrorVariant::CustomError { .. } => "something else".to_owned(),
    };
    if let Some(form) = foreign::form(tokens, bytes, at, rule) {
        return form;
    }
    let later = &tokens.list[tokens.list.partition_point(|token| token.end <= at)..];
    let next = later.iter().find(|token| token.kind != Kind::Comment);
    let inside = next.filter(|token| token.start < bytes.end || token.kind == Kind::Newline);
    if let Some(token) = inside.filter(|token| token.kind != Kind::Newline) {
        let mut found: String = tokens.text_of(*token).chars().take(30).collect();
        if found.len() < token.end - token.start {
            found.push('…');
        }
        return messages::unexpected(
            tokens.span(token.start, token.end),
            &format!("`{found}`"),
            &expected,
        );
    }
    let end = bytes.start + tokens.text[bytes.start..at].trim_end().len();
    let context = if inside.is_some() {
        "the end of the line"
    } else {
        "the end of the file"
    };
    messages::unexpected(tokens.span(end, end), context, &expected)
}

/// Parses the pieces of a file with errors.
struct Pieces<'a> {
    tokens: &'a Tokens<'a>,
    /// How many of the errors were found by `tokens`.
    lexical: usize,
    errors: Vec<Diagnostic>,
    /// The statements without braces, as in YAML, once there is one.
    by_indentation: Option<ByIndentation>,
}

/// Statements of a language that marks blocks by colons and indentation: reported once.
struct ByIndentation {
    colon: Span,
    whole: Span,
    head: String,
}

impl Pieces<'_> {
    fn read(&mut self, items: &mut Vec<Item>) {
        let (pieces, brackets) = layout::cut(self.tokens);
        self.errors.extend(brackets);
        for piece in pieces {
            if self.errors.len() > limits::ERRORS + self.lexical {
                break;
            }
            match piece {
                Piece::Item(statement) => items.extend(self.item(statement)),
                Piece::Block {
                    head,
                    open,
                    fields,
                    close,
                } => items.extend(self.block(head, open, &fields, close)),
            }
        }
    }

    fn bounds(&self, statement: Statement) -> (usize, usize) {
        let start = self.tokens.list[statement.start].start;
        (
            start,
            statement
                .end
                .checked_sub(1)
                .map_or(start, |last| self.tokens.list[last].end.max(start)),
        )
    }

    /// Parses one statement by `rule`. `None`: it has an error, which has been reported.
    fn alone<T>(
        &mut self,
        statement: Statement,
        rule: Rule,
        lower: impl Fn(&Lowering, Pair<'_, Rule>) -> Option<T>,
    ) -> Option<T> {
        let (start, end) = self.bounds(statement);
        let within = |error: &Diagnostic| {
            error
                .span()
                .is_some_and(|at| at.start as usize <= end && at.end as usize > start)
        };
        if statement.broken || self.errors[..self.lexical].iter().any(within) {
            return None;
        }
        let symbols = Symbols::new(self.tokens, statement.start, statement.end);
        let mut pairs = match Grammar::parse(rule, &symbols.text) {
            Ok(pairs) => pairs,
            Err(error) => {
                self.errors
                    .push(refused(self.tokens, &symbols, &(start..end), rule, &error));
                return None;
            }
        };
        let lowering = Lowering::new(&symbols);
        let pair = pairs.next()?.into_inner().next()?;
        let lowered = lower(&lowering, pair);
        let errors = lowering.errors.into_inner();
        let sound = errors.is_empty();
        self.errors.extend(errors);
        lowered.filter(|_| sound)
    }

    fn word(&self, index: usize) -> Option<Ident> {
        let token = *self
            .tokens
            .list
            .get(index)
            .filter(|token| token.kind == Kind::Word)?;
        Some(Spanned::new(
            self.tokens.text_of(token).to_owned(),
            self.tokens.span(token.start, token.end),
        ))
    }

    /// An item other than a block; with an error, its name and a faulty value.
    fn item(&mut self, statement: Statement) -> Option<Item> {
        if !super::ast::ITEM_WORDS
            .iter()
            .any(|word| self.tokens.is(statement.start, word))
        {
            self.no_item(statement);
            return None;
        }
        let (start, end) = self.bounds(statement);
        let nameless = self.tokens.is(statement.start, "require")
            && statement.end > statement.start + 1
            && self.tokens.kind(statement.start + 1) != Some(Kind::Text);
        if nameless {
            let second = self.tokens.list[statement.start + 1];
            let span = self.tokens.span(second.start, second.end);
            self.errors.push(messages::requirement_without_name(
                span,
                &self.tokens.text[second.start..end],
            ));
            return None;
        }
        if let Some(item) = self.alone(statement, Rule::item_alone, |lowering, pair| {
            lowering.item(pair)
        }) {
            return Some(item);
        }
        let span = self.tokens.span(start, end);
        let value = Lowering::faulty(span);
        let second = (statement.start + 1 < statement.end).then_some(statement.start + 1)?;
        let keyword = self.word(statement.start)?;
        let kind = match keyword.node.as_str() {
            "let" => ItemKind::Let {
                name: self.word(second)?,
                value,
            },
            "param" => ItemKind::Param {
                name: self.word(second)?,
                value,
                bounds: None,
            },
            "require" => {
                let token = *self
                    .tokens
                    .list
                    .get(second)
                    .filter(|token| token.kind == Kind::Text)?;
                let label = Spanned::new(
                    unescape(self.tokens.text_of(token)),
                    self.tokens.span(token.start, token.end),
                );
                ItemKind::Require {
                    label,
                    condition: value,
                }
            }
            _ => return None,
        };
        Some(Item { span, kind })
    }

    /// A statement among the items that is not an item: a field, or a block without its `{`.
    fn no_item(&mut self, statement: Statement) {
        if self.is_by_indentation(statement) {
            return;
        }
        let key = self
            .word(statement.start)
            .filter(|_| self.tokens.is(statement.start + 1, "="));
        if let Some(key) = key {
            self.errors
                .push(messages::field_outside(key.span, &key.node));
        } else if let Some((word, help)) = self.other_language(statement) {
            self.errors.push(messages::word_of_another_language(
                word.span, &word.node, &help,
            ));
        } else if let Some((word, message, help)) = self.control(statement) {
            let (start, end) = self.bounds(statement);
            let whole = self.tokens.span(start, end);
            self.errors
                .push(messages::no_control(message, help, word.span, whole));
        } else if self
            .alone(statement, Rule::head_alone, |lowering, pair| {
                lowering.head(pair)
            })
            .is_some()
        {
            let (start, end) = self.bounds(statement);
            self.errors.push(messages::stray_words(
                self.tokens.span(start, end),
                &self.tokens.text[start..end],
            ));
        }
    }

    /// Whether it is `specimen bar:`, or follows such a line.
    fn is_by_indentation(&mut self, statement: Statement) -> bool {
        let (start, end) = self.bounds(statement);
        if let Some(found) = &mut self.by_indentation {
            found.whole = found.whole.to(self.tokens.span(start, end));
            return true;
        }
        let colon = (statement.start..statement.end)
            .find(|index| self.tokens.kind(*index) != Some(Kind::Word))
            .filter(|index| *index > statement.start && self.tokens.is(*index, ":"));
        let Some(token) = colon.map(|index| self.tokens.list[index]) else {
            return false;
        };
        self.by_indentation = Some(ByIndentation {
            colon: self.tokens.span(token.start, token.end),
            whole: self.tokens.span(start, end),
            head: self.tokens.text[start..token.start].trim_end().to_owned(),
        });
        true
    }

    /// A line that begins as in another language, and its form in this one.
    fn other_language(&self, statement: Statement) -> Option<(Ident, String)> {
        let word = self.word(statement.start)?;
        let help = match word.node.as_str() {
            "import" | "include" | "from" | "source" => {
                "write `use` to include a file, as in `use \"lib/frame.psd\"`".to_owned()
            }
            "if" | "assert" | "expect" | "ensure" | "check" | "verify" => {
                "write `require`, as in `require \"stays in travel\" hit.max_displacement < 9 mm`"
                    .to_owned()
            }
            "run" | "start" | "do" | "call" => {
                "remove this line: every procedure of a plan runs, in the order written".to_owned()
            }
            _ => {
                let name = self
                    .word(statement.start + 1)
                    .filter(|_| self.tokens.is(statement.start + 2, "="))?;
                format!("write `let` to name a value, as in `let {} = …`", name.node)
            }
        };
        Some((word, help))
    }

    /// A condition, a loop or a function of another language, with its message and its suggestion.
    fn control(&self, statement: Statement) -> Option<(Ident, &'static str, &'static str)> {
        let word = self.word(statement.start)?;
        let (message, help) = control::of_another_language(&word.node)?;
        Some((word, message, help))
    }

    fn block(
        &mut self,
        head: Statement,
        open: usize,
        fields: &[Statement],
        close: Option<usize>,
    ) -> Option<Item> {
        #[expect(
            clippy::redundant_closure_for_method_calls,
            reason = "the method has one lifetime, the closure any"
        )]
        let sound = (head.end > head.start)
            .then(|| self.alone(head, Rule::head_alone, |lowering, pair| lowering.head(pair)));
        if sound.is_none() {
            let brace = self.tokens.list[open];
            let span = self.tokens.span(brace.start, brace.end);
            self.errors
                .push(messages::unexpected(span, "`{`", "the name of a block"));
        }
        let block = sound.flatten().or_else(|| self.faulty_head(head));
        let entries: Vec<Entry> = fields
            .iter()
            .filter_map(|field| self.entry(*field))
            .collect();
        let mut block = block?;
        block.fields = entries;
        let last = close
            .or_else(|| fields.last().map(|field| field.end - 1))
            .unwrap_or(open);
        let span = self
            .tokens
            .span(block.head.start as usize, self.tokens.list[last].end);
        Some(Item {
            span,
            kind: ItemKind::Block(block),
        })
    }

    /// The words of a head that could not be parsed.
    fn faulty_head(&self, head: Statement) -> Option<Block> {
        let words: Vec<Ident> = (head.start..head.end)
            .map_while(|index| self.word(index))
            .collect();
        let span = words.first()?.span.to(words.last()?.span);
        Some(Block {
            words,
            title: None,
            fields: Vec::new(),
            head: span,
        })
    }

    /// A field; with an error, its key and a faulty value, so that it does not count as missing.
    fn entry(&mut self, statement: Statement) -> Option<Entry> {
        if let Some(entry) = self.alone(statement, Rule::entry_alone, |lowering, pair| {
            lowering.entry(pair)
        }) {
            return Some(entry);
        }
        // A single word is not a field, and `drop` of `drop-height` is no name.
        let touched = |key: &Ident| {
            let next = self.tokens.list[statement.start + 1];
            self.tokens.is(statement.start + 1, "-") && next.start == key.span.end as usize
        };
        let key = self
            .word(statement.start)
            .filter(|key| statement.end > statement.start + 1 && !touched(key))?;
        let (start, end) = self.bounds(statement);
        let value = self.tokens.span(end.min(key.span.end as usize), end);
        Some(Entry {
            span: self.tokens.span(start, end),
            key,
            value: Lowering::faulty(value),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::tests::{IMPACT, QUAKE};

    #[test]
    fn a_sound_file_reads_the_same_whole_and_in_pieces() {
        for text in [
            IMPACT,
            QUAKE,
            "a { }\r\nb \"t\" { x = 1 } # c\nlet x = (1 +\n # c\n 2)\n",
            "c {\n x = [\n1 ,\n2] m\n\n y = 1 }",
        ] {
            let file = FileId(0);
            let mut tokens = Tokens::read(text, file);
            let (items, errors) = piecewise(&mut tokens);
            assert_eq!(errors, []);
            assert_eq!(Some(items), whole(&tokens));
        }
    }
}
