//! Symbols of a document and of the workspace. In: a document, or a query. Out: the items of plans.

use gen_lsp_types as lsp;
use psd_language::syntax::ast::{Block, Item, ItemKind};
use psd_plan::schema::{self, Kind};

use super::{View, location};
use crate::documents::Documents;
use crate::occurrences::{Symbol, SymbolKind};

/// Most symbols of an answer.
const MOST: usize = 500;
/// Most files that are looked through for an answer.
const MOST_FILES: usize = 500;

pub fn of_document(view: &View<'_>, _: &lsp::DocumentSymbolParams) -> Vec<lsp::DocumentSymbol> {
    let tree = view.analysis.tree(view.file);
    let items = tree.map_or(&[][..], |tree| &tree.items);
    items.iter().filter_map(|item| symbol(view, item)).collect()
}

fn symbol(view: &View<'_>, item: &Item) -> Option<lsp::DocumentSymbol> {
    let text = |span| view.analysis.sources.text(span).trim().to_owned();
    let (name, detail, kind, span) = match &item.kind {
        ItemKind::Use { .. } => return None,
        ItemKind::Let { name, value } => (
            name.node.clone(),
            text(value.span),
            lsp::SymbolKind::Constant,
            name.span,
        ),
        ItemKind::Param { name, value, .. } => (
            name.node.clone(),
            text(value.span),
            lsp::SymbolKind::Variable,
            name.span,
        ),
        ItemKind::Require { label, condition } => (
            label.node.clone(),
            text(condition.span),
            lsp::SymbolKind::Boolean,
            label.span,
        ),
        ItemKind::Block(block) => of_block(block)?,
    };
    let children = match &item.kind {
        ItemKind::Block(block) => block
            .fields
            .iter()
            .map(|entry| lsp::DocumentSymbol {
                detail: Some(text(entry.value.span)),
                ..plain(
                    entry.key.node.clone(),
                    lsp::SymbolKind::Field,
                    view.range(entry.span.range()),
                    view.range(entry.key.span.range()),
                )
            })
            .collect(),
        _ => Vec::new(),
    };
    // The range of a symbol contains that of its name.
    let whole = item.span.to(span);
    Some(lsp::DocumentSymbol {
        detail: Some(detail),
        children: (!children.is_empty()).then_some(children),
        ..plain(
            name,
            kind,
            view.range(whole.range()),
            view.range(span.range()),
        )
    })
}

#[expect(
    deprecated,
    reason = "the type has a field that the protocol deprecates"
)]
fn plain(
    name: String,
    kind: lsp::SymbolKind,
    range: lsp::Range,
    selection_range: lsp::Range,
) -> lsp::DocumentSymbol {
    lsp::DocumentSymbol {
        // An empty name is an error in some editors.
        name: if name.is_empty() {
            "…".to_owned()
        } else {
            name
        },
        detail: None,
        kind,
        tags: None,
        deprecated: None,
        range,
        selection_range,
        children: None,
    }
}

fn of_block(block: &Block) -> Option<(String, String, lsp::SymbolKind, psd_text::source::Span)> {
    let words: Vec<&str> = block.words.iter().map(|word| word.node.as_str()).collect();
    let kind = schema::block_of_words(&words)?;
    let rest = &block.words[kind.keyword.len()..];
    let (name, span) = match (rest.first(), &block.title) {
        (Some(name), _) => (name.node.clone(), name.span),
        (None, Some(title)) => (title.node.clone(), title.span),
        (None, None) => (kind.words(), block.head),
    };
    Some((name, kind.words(), of_kind(kind.kind), span))
}

fn of_kind(kind: Kind) -> lsp::SymbolKind {
    match kind {
        Kind::Procedure(_) => lsp::SymbolKind::Method,
        Kind::Specimen | Kind::Striker | Kind::Ground => lsp::SymbolKind::Struct,
        Kind::Rig => lsp::SymbolKind::Interface,
        Kind::Plan => lsp::SymbolKind::Module,
        _ => lsp::SymbolKind::Object,
    }
}

/// The symbols of all known plans whose names contain the letters of a query, in order.
pub fn of_workspace(documents: &Documents, query: &str) -> Vec<lsp::WorkspaceSymbol> {
    let mut found: Vec<lsp::WorkspaceSymbol> = Vec::new();
    for key in documents.known().take(MOST_FILES) {
        let Some(analysis) = documents.analysis(key) else {
            continue;
        };
        let own = |symbol: &&Symbol| symbol.span.file.0 == 0 && contains(&symbol.name, query);
        for symbol in analysis.occurrences.symbols.iter().filter(own) {
            if found.len() == MOST {
                return found;
            }
            found.push(lsp::WorkspaceSymbol {
                location: location(documents, &analysis, symbol.span).into(),
                data: None,
                base_symbol_information: lsp::BaseSymbolInformation {
                    name: symbol.name.clone(),
                    kind: match symbol.kind {
                        SymbolKind::Let => lsp::SymbolKind::Constant,
                        SymbolKind::Param => lsp::SymbolKind::Variable,
                        SymbolKind::Requirement => lsp::SymbolKind::Boolean,
                        SymbolKind::Block(kind) => of_kind(kind),
                    },
                    tags: None,
                    container_name: Some(analysis.sources.file(symbol.span.file).name.clone()),
                },
            });
        }
    }
    found
}

/// Whether the letters of a query are in a name, in order.
fn contains(name: &str, query: &str) -> bool {
    let mut letters = name.chars().flat_map(char::to_lowercase);
    let mut wanted = query.chars().flat_map(char::to_lowercase);
    wanted.all(|wanted| letters.any(|letter| letter == wanted))
}
