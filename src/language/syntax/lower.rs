//! Pairs of the grammar → items, blocks and fields of the tree. Expressions are lowered in `expr`.

use std::cell::RefCell;

use pest::iterators::Pair;

use super::{
    ast::{Block, Entry, Expr, ExprKind, Ident, Item, ItemKind},
    grammar::Rule,
};
use psd_text::diagnostic::Diagnostic;
use psd_text::source::{FileId, Span, Spanned};

/// Lowers the pairs of one piece of text that starts at byte `base` of `file`.
pub struct Lowering {
    pub file: FileId,
    pub base: usize,
    pub errors: RefCell<Vec<Diagnostic>>,
}

impl Lowering {
    #[must_use]
    pub fn new(file: FileId, base: usize) -> Self {
        Self {
            file,
            base,
            errors: RefCell::new(Vec::new()),
        }
    }

    /// The span of a pair. It is exact for tokens and for rules that end with one; a rule that ends with an optional part may
    /// include spaces after it, so those spans are built from their parts.
    #[must_use]
    pub fn span(&self, pair: &Pair<'_, Rule>) -> Span {
        let span = pair.as_span();
        Span::new(self.file, self.base + span.start(), self.base + span.end())
    }

    #[must_use]
    pub fn ident(&self, pair: &Pair<'_, Rule>) -> Ident {
        Spanned::new(pair.as_str().to_owned(), self.span(pair))
    }

    #[must_use]
    pub fn text(&self, pair: &Pair<'_, Rule>) -> Spanned<String> {
        Spanned::new(unescape(pair.as_str()), self.span(pair))
    }

    /// Any item, blocks included.
    #[must_use]
    pub fn item(&self, pair: Pair<'_, Rule>) -> Option<Item> {
        let rule = pair.as_rule();
        let mut span = self.span(&pair);
        let mut name = None;
        let mut text = None;
        let mut values = Vec::new();
        if rule == Rule::block {
            return self.block(pair).map(|block| Item {
                span,
                kind: ItemKind::Block(block),
            });
        }
        for part in pair.into_inner() {
            let end = match part.as_rule() {
                Rule::new_name => self.span(&name.insert(part).clone()),
                Rule::text => self.span(&text.insert(part).clone()),
                Rule::expression => {
                    values.push(self.expression(part, 0));
                    values[values.len() - 1].span
                }
                Rule::range => {
                    values.push(self.range(part, 0));
                    values[values.len() - 1].span
                }
                _ => self.span(&part),
            };
            span.end = end.end;
        }
        let mut values = values.into_iter();
        let kind = match rule {
            Rule::use_item => ItemKind::Use {
                path: self.text(&text?),
            },
            Rule::let_item => ItemKind::Let {
                name: self.ident(&name?),
                value: values.next()?,
            },
            Rule::param_item => ItemKind::Param {
                name: self.ident(&name?),
                value: values.next()?,
                bounds: values.next(),
            },
            Rule::require_item => ItemKind::Require {
                label: self.text(&text?),
                condition: values.next()?,
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
        let value = self.expression(parts.find(|part| part.as_rule() == Rule::expression)?, 0);
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
