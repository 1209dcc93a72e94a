//! Code actions: the fixes of diagnostics, missing fields, other units. In: a range of a document. Out: changes of its text.

use std::collections::HashMap;
use std::ops::Range;

use gen_lsp_types as lsp;
use psd_language::check::imports;
use psd_language::syntax::ast::{Block, Expr, ExprKind, ItemKind};
use psd_plan::schema::{self, Presence};
use psd_text::units::unit;

use super::View;
use crate::occurrences::parts;
use crate::units;

/// Most units that a number is offered in.
const MOST_UNITS: usize = 6;

pub fn actions(view: &View<'_>, params: &lsp::CodeActionParams) -> Vec<lsp::CodeAction> {
    let wanted = view.text().bytes(params.range);
    let only = params.context.only.as_ref();
    let asked = |kind: lsp::CodeActionKind| {
        let begins = |one: &lsp::CodeActionKind| kind.to_string().starts_with(&one.to_string());
        only.is_none_or(|only| only.iter().any(begins))
    };
    let mut found = Vec::new();
    if asked(lsp::CodeActionKind::QuickFix) {
        found.extend(fixes(view, &wanted, &params.context.diagnostics));
    }
    if asked(lsp::CodeActionKind::RefactorRewrite) {
        found.extend(missing_fields(view, &wanted));
        found.extend(other_units(view, &wanted));
    }
    found
}

fn touches(one: &Range<usize>, other: &Range<usize>) -> bool {
    one.start <= other.end && other.start <= one.end
}

fn action(
    view: &View<'_>,
    title: String,
    kind: lsp::CodeActionKind,
    edits: Vec<lsp::TextEdit>,
) -> lsp::CodeAction {
    let uri = view.documents.now.uri(view.key());
    lsp::CodeAction {
        title,
        kind: Some(kind),
        edit: Some(lsp::WorkspaceEdit {
            changes: Some(HashMap::from([(uri, edits)])),
            ..lsp::WorkspaceEdit::default()
        }),
        ..lsp::CodeAction::default()
    }
}

/// The fixes of the diagnostics in a range.
fn fixes(
    view: &View<'_>,
    wanted: &Range<usize>,
    diagnostics: &[lsp::Diagnostic],
) -> Vec<lsp::CodeAction> {
    let own = imports::own_path(&view.analysis.sources, view.file);
    let here = view
        .fixes
        .iter()
        .filter(|fix| fix.file == own && touches(&fix.at, wanted));
    here.map(|fix| {
        let range = view.range(fix.at.clone());
        let code = lsp::Code::String(fix.code.id().to_owned());
        let is_own =
            |one: &&lsp::Diagnostic| one.range == range && one.code.as_ref() == Some(&code);
        let edit = lsp::TextEdit {
            range: view.range(fix.replaced.clone()),
            new_text: fix.text.clone(),
        };
        let of: Vec<lsp::Diagnostic> = diagnostics.iter().filter(is_own).cloned().collect();
        lsp::CodeAction {
            diagnostics: (!of.is_empty()).then_some(of),
            is_preferred: fix.is_meant.then_some(true),
            ..action(
                view,
                fix.title.clone(),
                lsp::CodeActionKind::QuickFix,
                vec![edit],
            )
        }
    })
    .collect()
}

/// The block and its values in a range.
fn block_at<'v>(view: &'v View<'_>, wanted: &Range<usize>) -> Option<(&'v Block, Range<usize>)> {
    let items = &view.analysis.tree(view.file)?.items;
    items.iter().find_map(|item| match &item.kind {
        ItemKind::Block(block) if touches(&item.span.range(), wanted) => {
            Some((block, item.span.range()))
        }
        _ => None,
    })
}

/// All fields that a block requires and does not state, at once.
fn missing_fields(view: &View<'_>, wanted: &Range<usize>) -> Option<lsp::CodeAction> {
    let (block, item) = block_at(view, wanted)?;
    let words: Vec<&str> = block.words.iter().map(|word| word.node.as_str()).collect();
    let kind = schema::block_of_words(&words)?;
    let missing: Vec<&schema::Field> = kind
        .fields
        .iter()
        .filter(|field| field.presence == Presence::Required)
        .filter(|field| {
            !block
                .fields
                .iter()
                .any(|entry| entry.key.node == field.name)
        })
        .collect();
    if missing.is_empty() {
        return None;
    }
    let text = view.text().as_str();
    let brace = block.head.range().end + text.get(block.head.range().end..item.end)?.find('{')? + 1;
    let lines: Vec<String> = missing
        .iter()
        .map(|field| format!("\n  {}", field.example))
        .collect();
    let lines = lines.concat();
    // What follows the brace on its line begins a line of its own.
    let rest = text[brace..item.end]
        .lines()
        .next()
        .unwrap_or_default()
        .trim();
    let end = if rest.is_empty() { "" } else { "\n" };
    let names: Vec<String> = missing
        .iter()
        .map(|field| format!("`{}`", field.name))
        .collect();
    let edit = lsp::TextEdit {
        range: view.range(brace..brace),
        new_text: format!("{lines}{end}"),
    };
    let title = format!("add {}", names.join(", "));
    Some(action(
        view,
        title,
        lsp::CodeActionKind::RefactorRewrite,
        vec![edit],
    ))
}

/// The number in a range in other units of its dimension.
fn other_units(view: &View<'_>, wanted: &Range<usize>) -> Vec<lsp::CodeAction> {
    let Some((value, number, token)) = number_at(view, wanted) else {
        return Vec::new();
    };
    let Ok(from) = unit::parse(token) else {
        return Vec::new();
    };
    let others = units::units_of(from.dimension)
        .into_iter()
        .filter(|unit| unit != token);
    let mut converted: Vec<units::Converted> = others
        .filter_map(|unit| units::converted(number, from, &unit))
        .collect();
    converted.sort_by_key(|one| one.is_rounded);
    converted
        .into_iter()
        .take(MOST_UNITS)
        .map(|one| {
            let note = if one.is_rounded { ", rounded" } else { "" };
            let title = format!("write `{}`{note}", one.text);
            let edit = lsp::TextEdit {
                range: view.range(value.clone()),
                new_text: one.text,
            };
            let kind = lsp::CodeActionKind::RefactorRewrite;
            action(view, title, kind, vec![edit])
        })
        .collect()
}

/// The number with a unit in a range: its bytes, its value and its unit.
fn number_at<'v>(
    view: &'v View<'_>,
    wanted: &Range<usize>,
) -> Option<(Range<usize>, f64, &'v str)> {
    let items = &view.analysis.tree(view.file)?.items;
    let item = items
        .iter()
        .find(|item| touches(&item.span.range(), wanted))?;
    let mut open: Vec<&Expr> = match &item.kind {
        ItemKind::Use { .. } => Vec::new(),
        ItemKind::Let { value, .. } => vec![value],
        ItemKind::Param { value, bounds, .. } => std::iter::once(value).chain(bounds).collect(),
        ItemKind::Require { condition, .. } => vec![condition],
        ItemKind::Block(block) => block.fields.iter().map(|entry| &entry.value).collect(),
    };
    while let Some(expr) = open.pop() {
        if !touches(&expr.span.range(), wanted) {
            continue;
        }
        if let ExprKind::Number {
            value,
            unit: Some(unit),
            ..
        } = &expr.kind
        {
            return Some((expr.span.range(), *value, &unit.node));
        }
        open.extend(parts(expr));
    }
    None
}
