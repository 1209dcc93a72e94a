//! Pairs of the grammar → items, blocks and fields of the tree. Expressions are lowered in `expr`.

use std::cell::RefCell;

use pest::iterators::Pair;

use super::{
    ast::{Block, Entry, Expr, ExprKind, Ident, Item, ItemKind},
    grammar::Rule,
    lexical::symbols::Symbols,
};
use psd_text::diagnostic::Diagnostic;
use psd_text::source::{Span, Spanned};

/// Lowers the pairs of one piece of a file, whose tokens are `symbols`.
pub struct Lowering<'a> {
    symbols: &'a Symbols<'a>,
    pub errors: RefCell<Vec<Diagnostic>>,
}

impl<'a> Lowering<'a> {
    #[must_use]
    pub fn new(symbols: &'a Symbols<'a>) -> Self {
        Self {
            symbols,
            errors: RefCell::new(Vec::new()),
        }
    }

    /// The span of a pair, from its first token to its last one.
    #[must_use]
    pub fn span(&self, pair: &Pair<'_, Rule>) -> Span {
        let span = pair.as_span();
        self.symbols.span(span.start(), span.end())
    }

    /// The first token of a pair, as written.
    #[must_use]
    pub fn written(&self, pair: &Pair<'_, Rule>) -> &'a str {
        self.symbols.written(pair.as_span().start())
    }

    #[must_use]
    pub fn ident(&self, pair: &Pair<'_, Rule>) -> Ident {
        Spanned::new(self.written(pair).to_owned(), self.span(pair))
    }

    #[must_use]
    pub fn text(&self, pair: &Pair<'_, Rule>) -> Spanned<String> {
        Spanned::new(unescape(self.written(pair)), self.span(pair))
    }

    /// Any item, blocks included.
    #[must_use]
    pub fn item(&self, pair: Pair<'_, Rule>) -> Option<Item> {
        let span = self.span(&pair);
        let rule = pair.as_rule();
        let mut parts = pair.clone().into_inner();
        let kind = match rule {
            Rule::block => ItemKind::Block(self.block(pair)?),
            Rule::use_item => ItemKind::Use {
                path: self.text(&parts.nth(1)?),
            },
            Rule::require_item => ItemKind::Require {
                label: self.text(&parts.nth(1)?),
                condition: self.expression(parts.next()?, 0)?,
            },
            Rule::let_item => ItemKind::Let {
                name: self.ident(&parts.nth(1)?),
                value: self.expression(parts.nth(1)?, 0)?,
            },
            Rule::param_item => ItemKind::Param {
                name: self.ident(&parts.nth(1)?),
                value: self.expression(parts.nth(1)?, 0)?,
                bounds: match parts.next() {
                    Some(_) => self.range(&mut parts.peekable(), 0),
                    None => None,
                },
            },
            _ => return None,
        };
        Some(Item { span, kind })
    }

    fn block(&self, pair: Pair<'_, Rule>) -> Option<Block> {
        let mut block = None;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::head => block = self.head(part),
                Rule::entry => {
                    if let (Some(block), Some(entry)) = (block.as_mut(), self.entry(part)) {
                        block.fields.push(entry);
                    }
                }
                _ => {}
            }
        }
        block
    }

    /// The words and title of a block; its fields follow.
    #[must_use]
    pub fn head(&self, pair: Pair<'_, Rule>) -> Option<Block> {
        let mut words = Vec::new();
        let mut title = None;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::word => words.push(self.ident(&part)),
                Rule::text => title = Some(self.text(&part)),
                _ => {}
            }
        }
        let last = title
            .as_ref()
            .map(|title| title.span)
            .or_else(|| words.last().map(|word| word.span))?;
        let head = words.first()?.span.to(last);
        Some(Block {
            words,
            title,
            fields: Vec::new(),
            head,
        })
    }

    #[must_use]
    pub fn entry(&self, pair: Pair<'_, Rule>) -> Option<Entry> {
        let mut parts = pair.into_inner();
        let key = self.ident(&parts.next()?);
        let value = self.expression(parts.nth(1)?, 0)?;
        Some(Entry {
            span: key.span.to(value.span),
            key,
            value,
        })
    }

    pub fn error(&self, error: Diagnostic) {
        self.errors.borrow_mut().push(error);
    }

    #[must_use]
    pub const fn faulty(span: Span) -> Expr {
        Expr {
            span,
            kind: ExprKind::Faulty,
        }
    }
}

/// The string between the quotes, escapes resolved.
#[must_use]
pub fn unescape(quoted: &str) -> String {
    let body = quoted.strip_prefix('"').unwrap_or(quoted);
    let body = body.strip_suffix('"').unwrap_or(body);
    let mut text = String::with_capacity(body.len());
    let mut characters = body.chars();
    while let Some(character) = characters.next() {
        text.push(match character {
            '\\' => match characters.next() {
                Some('n') => '\n',
                Some('t') => '\t',
                Some(other) => other,
                None => break,
            },
            other => other,
        });
    }
    text
}
