//! Definition, references and highlights. In: a position. Out: places of the same symbol, in every plan that uses its file.

use gen_lsp_types as lsp;
use psd_text::source::Span;

use super::{View, links, location};
use crate::occurrences::Meaning;

pub fn definition(view: &View<'_>, params: &lsp::DefinitionParams) -> Option<lsp::Location> {
    let position = params.text_document_position_params.position;
    let found = view.analysis.at(view.file, view.text().offset(position))?;
    match found.meaning {
        Meaning::Symbol(symbol) => Some(view.location(view.analysis.symbol(symbol).span)),
        Meaning::Entry { key, .. } => Some(view.location(key)),
        // A result is what its procedure leaves.
        Meaning::Result { owner, .. } => Some(view.location(view.analysis.symbol(owner?).span)),
        Meaning::File => {
            let target = links::target(view, found.span)?;
            let start = lsp::Range::default();
            Some(lsp::Location {
                uri: target,
                range: start,
            })
        }
        _ => None,
    }
}

pub fn references(view: &View<'_>, params: &lsp::ReferenceParams) -> Vec<lsp::Location> {
    let position = params.text_document_position_params.position;
    let with_declaration = params.context.include_declaration;
    everywhere(view, view.text().offset(position))
        .into_iter()
        .filter(|place| with_declaration || !place.declares)
        .map(|place| place.location)
        .collect()
}

pub fn highlight(
    view: &View<'_>,
    params: &lsp::DocumentHighlightParams,
) -> Vec<lsp::DocumentHighlight> {
    let position = params.text_document_position_params.position;
    let Some((own, _)) = symbol_at(view, view.text().offset(position)) else {
        return Vec::new();
    };
    let places = view.analysis.occurrences.of_symbol(own);
    places
        .filter(|place| place.span.file == view.file)
        .map(|place| lsp::DocumentHighlight {
            range: view.range(place.span.range()),
            kind: Some(if place.declares {
                lsp::DocumentHighlightKind::Write
            } else {
                lsp::DocumentHighlightKind::Read
            }),
        })
        .collect()
}

/// A place of a symbol.
pub struct Found {
    pub location: lsp::Location,
    pub declares: bool,
}

/// The symbol at an offset, with the span of the word.
pub fn symbol_at(view: &View<'_>, offset: usize) -> Option<(usize, Span)> {
    let found = view.analysis.at(view.file, offset)?;
    match found.meaning {
        Meaning::Symbol(symbol) => Some((symbol, found.span)),
        _ => None,
    }
}

/// Every place of the symbol at an offset, in all plans that use the file that declares it. Each place is there once.
pub fn everywhere(view: &View<'_>, offset: usize) -> Vec<Found> {
    let Some((own, _)) = symbol_at(view, offset) else {
        return Vec::new();
    };
    let declared = view.analysis.symbol(own);
    let file = &view.analysis.documents[declared.span.file.0 as usize];
    let mut found: Vec<Found> = Vec::new();
    let mut plans = view.documents.plans_of(file);
    if !plans.contains(&view.plan) {
        plans.push(view.plan.clone());
    }
    for plan in plans {
        let Some(analysis) = view.documents.analysis(&plan) else {
            continue;
        };
        let Some(own_file) = analysis.file(file) else {
            continue;
        };
        let span = Span {
            file: own_file,
            ..declared.span
        };
        let Some(symbol) = analysis
            .occurrences
            .symbols
            .iter()
            .position(|one| one.span == span)
        else {
            continue;
        };
        for place in analysis.occurrences.of_symbol(symbol) {
            let location = location(view.documents, &analysis, place.span);
            if !found.iter().any(|one| one.location == location) {
                found.push(Found {
                    location,
                    declares: place.declares,
                });
            }
        }
    }
    found
}
