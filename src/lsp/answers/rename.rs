//! Rename. In: a position and a new name. Out: the changes of every plan that names the symbol, or the reason why the name cannot be.

use std::collections::HashMap;

use gen_lsp_types as lsp;
use psd_language::syntax::limits::NAME_CHARS;
use psd_language::syntax::tokens::JOINING_WORDS;
use psd_plan::schema::{BLOCKS, FUNCTIONS, ITEM_WORDS};

use super::View;
use super::navigation::{everywhere, symbol_at};
use crate::occurrences::SymbolKind;

pub fn prepare(
    view: &View<'_>,
    params: &lsp::PrepareRenameParams,
) -> Option<lsp::PrepareRenamePlaceholder> {
    let position = params.text_document_position_params.position;
    let (symbol, span) = symbol_at(view, view.text().offset(position))?;
    let symbol = view.analysis.symbol(symbol);
    let quotes = usize::from(symbol.kind == SymbolKind::Requirement);
    let range = span.range();
    Some(lsp::PrepareRenamePlaceholder {
        range: view.range(range.start + quotes..range.end - quotes),
        placeholder: symbol.name.clone(),
    })
}

pub fn rename(view: &View<'_>, params: &lsp::RenameParams) -> Result<lsp::WorkspaceEdit, String> {
    let offset = view
        .text()
        .offset(params.text_document_position_params.position);
    let Some((symbol, _)) = symbol_at(view, offset) else {
        return Err("this word cannot be renamed: it is not declared in the plan".to_owned());
    };
    let symbol = view.analysis.symbol(symbol);
    let name = params.new_name.trim();
    let is_label = symbol.kind == SymbolKind::Requirement;
    if !is_label {
        refused(view, name, &symbol.name)?;
    } else if name.is_empty() || name.contains(['"', '\\', '\n', '\r']) {
        return Err("the name of a requirement is one line without quotes".to_owned());
    }
    let mut changes: HashMap<lsp::Uri, Vec<lsp::TextEdit>> = HashMap::new();
    for place in everywhere(view, offset) {
        let new_text = if is_label {
            format!("\"{name}\"")
        } else {
            name.to_owned()
        };
        let edit = lsp::TextEdit {
            range: place.location.range,
            new_text,
        };
        changes.entry(place.location.uri).or_default().push(edit);
    }
    Ok(lsp::WorkspaceEdit {
        changes: Some(changes),
        ..lsp::WorkspaceEdit::default()
    })
}

/// Why a name cannot be, if so.
fn refused(view: &View<'_>, name: &str, old: &str) -> Result<(), String> {
    let is_start = |c: char| c.is_ascii_alphabetic() || c == '_';
    let is_name = name.starts_with(is_start)
        && name.len() <= NAME_CHARS
        && name.chars().all(|c| is_start(c) || c.is_ascii_digit());
    if !is_name {
        return Err(format!(
            "`{name}` is not a name: write a-z, 0-9 and `_`, first a letter"
        ));
    }
    let is_word = ITEM_WORDS.contains(&name)
        || JOINING_WORDS.contains(&name)
        || FUNCTIONS.iter().any(|function| function.name == name)
        || BLOCKS
            .iter()
            .any(|block| block.keyword.first() == Some(&name));
    if is_word {
        return Err(format!("`{name}` is a word of the language"));
    }
    let symbols = &view.analysis.occurrences.symbols;
    let is_taken = |one: &crate::occurrences::Symbol| {
        one.kind != SymbolKind::Requirement && one.name == name && name != old
    };
    if symbols.iter().any(is_taken) {
        return Err(format!("`{name}` is declared already"));
    }
    Ok(())
}
