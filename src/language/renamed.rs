//! Names of version 0.1 in a plan. In: the syntax trees, and whether they come from a run log. Out: the same trees with the
//! present names; for a new plan, an error (E215) for each old name.

use std::collections::BTreeMap;

use crate::check::messages::names as message;
use crate::syntax::ast::{Argument, Ast, Block, Expr, ExprKind, Ident, ItemKind};
use psd_plan::schema::{self, Kind, NameRole, Renamed};
use psd_text::diagnostic::Diagnostic;
use psd_text::source::Span;

/// Replaces every old name. If the plan is not `recorded`, reports each of them, except aliases.
pub fn restate(trees: &mut [Ast], recorded: bool, diagnostics: &mut Vec<Diagnostic>) {
    let mut walk = Walk {
        procedures: procedures(trees),
        recorded,
        diagnostics,
    };
    for item in trees.iter_mut().flat_map(|tree| &mut tree.items) {
        match &mut item.kind {
            ItemKind::Use { .. } => {}
            ItemKind::Param { value, bounds, .. } => {
                walk.expression(value);
                if let Some(bounds) = bounds {
                    walk.expression(bounds);
                }
            }
            ItemKind::Let { value, .. } => walk.expression(value),
            ItemKind::Require { condition, .. } => walk.expression(condition),
            ItemKind::Block(block) => walk.block(block),
        }
    }
}

/// The kind of a block.
fn kind(block: &Block) -> Option<&'static schema::BlockKind> {
    let words: Vec<&str> = block.words.iter().map(|word| word.node.as_str()).collect();
    schema::block_of_words(&words)
}

/// The procedures of all files, by name.
fn procedures(trees: &[Ast]) -> BTreeMap<String, Kind> {
    let items = trees.iter().flat_map(|tree| &tree.items);
    let named = items.filter_map(|item| {
        let ItemKind::Block(block) = &item.kind else {
            return None;
        };
        let (kind, name) = (kind(block)?, block.words.last()?);
        kind.is_procedure().then(|| (name.node.clone(), kind.kind))
    });
    named.collect()
}

struct Walk<'d> {
    procedures: BTreeMap<String, Kind>,
    recorded: bool,
    diagnostics: &'d mut Vec<Diagnostic>,
}

impl Walk<'_> {
    /// Reports an old name, unless it is still allowed.
    fn report(&mut self, row: &Renamed, span: Span) {
        if !self.recorded && !row.alias {
            self.diagnostics.push(message::renamed(row, span));
        }
    }

    fn replace(&mut self, name: &mut Ident, at: impl Fn(NameRole) -> bool) {
        if let Some(row) = schema::renamed_at(&name.node, at) {
            self.report(row, name.span);
            row.new.clone_into(&mut name.node);
        }
    }

    fn block(&mut self, block: &mut Block) {
        let kind = kind(block).map(|kind| kind.kind);
        for entry in &mut block.fields {
            self.replace(
                &mut entry.key,
                |role| matches!(role, NameRole::Field(of) if Some(of) == kind),
            );
            self.word(&entry.key.node, &mut entry.value);
            self.expression(&mut entry.value);
        }
    }

    /// The words or variants that are the value of a field.
    fn word(&mut self, field: &str, value: &mut Expr) {
        let at = |role| matches!(role, NameRole::Word(fields) if fields.contains(&field));
        match &mut value.kind {
            ExprKind::Call { name, .. } => self.replace(name, at),
            ExprKind::Name(name) => {
                if let Some(row) = schema::renamed_at(name, at) {
                    self.report(row, value.span);
                    row.new.clone_into(name);
                }
            }
            ExprKind::List { items, .. } => {
                for item in items {
                    self.word(field, item);
                }
            }
            ExprKind::Parenthesised(inner) => self.word(field, inner),
            _ => {}
        }
    }

    fn expression(&mut self, expr: &mut Expr) {
        match &mut expr.kind {
            ExprKind::Number { .. } | ExprKind::Text(_) | ExprKind::Name(_) | ExprKind::Faulty => {}
            ExprKind::List { items, .. } => items.iter_mut().for_each(|item| self.expression(item)),
            ExprKind::Range { start, end, step } => {
                self.expression(start);
                self.expression(end);
                if let Some(step) = step {
                    self.expression(step);
                }
            }
            ExprKind::Call { name, arguments } => self.arguments(&name.node, arguments),
            ExprKind::Field { base, name } => {
                self.result(base, name);
                self.expression(base);
            }
            ExprKind::Member {
                base,
                name,
                arguments,
            } => {
                self.expression(base);
                self.arguments(&name.node, arguments);
            }
            ExprKind::Index { base, index } => {
                self.expression(base);
                self.expression(index);
            }
            ExprKind::Stepped { input, values } => {
                self.expression(input);
                self.expression(values);
            }
            ExprKind::Negate(inner) | ExprKind::Parenthesised(inner) => self.expression(inner),
            ExprKind::Binary { left, right, .. } => {
                self.expression(left);
                self.expression(right);
            }
            ExprKind::Within {
                value,
                tolerance,
                target,
            } => {
                self.expression(value);
                self.expression(tolerance);
                self.expression(target);
            }
        }
    }

    fn arguments(&mut self, variant: &str, arguments: &mut [Argument]) {
        for argument in arguments {
            if let Some(name) = &mut argument.name {
                self.replace(
                    name,
                    |role| matches!(role, NameRole::Argument(of) if of.contains(&variant)),
                );
            }
            self.expression(&mut argument.value);
        }
    }

    /// `base.name`, if `base` names a procedure. `curve.break_uncertainties` becomes `curve.breaks.u`.
    fn result(&mut self, base: &mut Expr, name: &mut Ident) {
        let ExprKind::Name(owner) = &base.kind else {
            return;
        };
        let row = self
            .procedures
            .get(owner)
            .and_then(|kind| schema::renamed_result(*kind, &name.node));
        let Some(row) = row else {
            return;
        };
        self.report(row, name.span);
        let (result, part) = match row.new.split_once('.') {
            Some((result, part)) => (result, Some(part)),
            None => (row.new, None),
        };
        result.clone_into(&mut name.node);
        if let Some(part) = part {
            let of = Ident {
                node: part.to_owned(),
                span: name.span,
            };
            let result = ExprKind::Field {
                base: Box::new(base.clone()),
                name: std::mem::replace(name, of),
            };
            base.kind = result;
        }
    }
}
