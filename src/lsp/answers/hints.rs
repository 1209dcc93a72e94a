//! Hints between the words: values of calculations, other units, and what the newest simulation found. In: a range of a document. Out: the
//! hints in it.

use gen_lsp_types as lsp;
use psd_language::check::checker::literal;
use psd_language::syntax::ast::{Expr, ExprKind, ItemKind};
use psd_plan::procedures::impact::block::{CRITICAL_TIME_STEP, MAX_DISPLACEMENT};
use psd_plan::schema::readable_result;
use psd_text::source::Span;
use psd_text::units::display::readable;
use psd_text::units::unit;

use super::View;
use crate::SimulatedResult;
use crate::occurrences::{SymbolKind, parts};

/// Units of which most readers want to see the metric value.
const CUSTOMARY: &[&str] = &["in", "ft", "lb", "lbf", "kip", "psi", "ksi"];

/// Most hints of one answer whose values are evaluated.
const MOST: usize = 200;

pub fn hints(view: &View<'_>, params: &lsp::InlayHintParams) -> Vec<lsp::InlayHint> {
    let wanted = view.text().bytes(params.range);
    let mut found = Vec::new();
    let items = view
        .analysis
        .tree(view.file)
        .map_or(&[][..], |tree| &tree.items);
    let touches = |span: Span| span.range().start <= wanted.end && wanted.start <= span.range().end;
    let mut values: Vec<&Expr> = Vec::new();
    for item in items.iter().filter(|item| touches(item.span)) {
        match &item.kind {
            ItemKind::Use { .. } | ItemKind::Require { .. } => {}
            ItemKind::Let { value, .. } | ItemKind::Param { value, .. } => values.push(value),
            ItemKind::Block(block) => values.extend(block.fields.iter().map(|entry| &entry.value)),
        }
    }
    values.retain(|value| touches(value.span));
    found.extend(calculated(view, &values));
    for value in &values {
        customary(view, value, &mut found);
    }
    found.extend(
        simulated(view)
            .into_iter()
            .filter(|(span, _)| touches(*span))
            .map(|(span, label)| hint(view, span.range().end, label)),
    );
    found
}

fn hint(view: &View<'_>, offset: usize, label: String) -> lsp::InlayHint {
    lsp::InlayHint {
        position: view.text().position(offset),
        label: label.into(),
        kind: None,
        text_edits: None,
        tooltip: None,
        padding_left: Some(true),
        padding_right: None,
        data: None,
    }
}

/// The values of calculations that are known before the run.
fn calculated(view: &View<'_>, values: &[&Expr]) -> Vec<lsp::InlayHint> {
    let is_calculation = |value: &&&Expr| {
        literal(value).is_none()
            && matches!(
                value.kind,
                ExprKind::Binary { .. } | ExprKind::Parenthesised(_) | ExprKind::Negate(_)
            )
    };
    let wanted: Vec<Span> = values
        .iter()
        .filter(is_calculation)
        .map(|value| value.span)
        .take(MOST)
        .collect();
    if wanted.is_empty() {
        return Vec::new();
    }
    let found = view.analysis.values(&|file: &str| view.load(file), &wanted);
    let shown = found.into_iter().filter_map(|typed| {
        let value = typed.constant()?;
        let label = format!("= {}", readable(value, typed.dimension));
        Some(hint(view, typed.span.range().end, label))
    });
    shown.collect()
}

/// Numbers in customary units, in metric ones.
fn customary(view: &View<'_>, value: &Expr, found: &mut Vec<lsp::InlayHint>) {
    if let ExprKind::Number {
        value: number,
        unit: Some(token),
        ..
    } = &value.kind
    {
        let is_customary = token
            .node
            .split(['*', '/', '^'])
            .any(|part| CUSTOMARY.contains(&part));
        if let Ok(unit) = unit::parse(&token.node)
            && is_customary
        {
            let label = format!("= {}", readable(unit.to_si(*number), unit.dimension));
            found.push(hint(view, value.span.range().end, label));
        }
    }
    for part in parts(value) {
        customary(view, part, found);
    }
}

/// What the newest simulation found, at the name of each procedure and at each requirement.
fn simulated(view: &View<'_>) -> Vec<(Span, String)> {
    let Some(simulation) = view.simulation else {
        return Vec::new();
    };
    let mut found = Vec::new();
    for symbol in view
        .analysis
        .occurrences
        .symbols
        .iter()
        .filter(|one| one.span.file == view.file)
    {
        match symbol.kind {
            SymbolKind::Block(_) => {
                let results = simulation
                    .procedures
                    .iter()
                    .find(|(name, _)| *name == symbol.name);
                let label = results.map(|(_, results)| headline(results));
                found.extend(
                    label
                        .filter(|label| !label.is_empty())
                        .map(|label| (symbol.span, label)),
                );
            }
            SymbolKind::Requirement => {
                let of_label = simulation
                    .requirements
                    .iter()
                    .find(|one| one.label == symbol.name);
                let Some(one) = of_label else { continue };
                let values: Vec<String> = one
                    .values
                    .iter()
                    .filter_map(|(value, dimension)| Some(readable((*value)?, *dimension)))
                    .collect();
                let label = format!("simulated: {}, {}", one.verdict, values.join(", "));
                found.push((symbol.item, label.trim_end_matches([',', ' ']).to_owned()));
            }
            SymbolKind::Let | SymbolKind::Param => {}
        }
    }
    found
}

/// The peak displacement and the critical time step.
fn headline(results: &[SimulatedResult]) -> String {
    let of = |name: &str, words: &str| {
        let found = results.iter().find(|one| one.name == name)?;
        Some(format!(
            "{words} {}",
            readable_result(name, found.value, found.dimension)
        ))
    };
    let parts = [
        of(MAX_DISPLACEMENT.name, "peak"),
        of(CRITICAL_TIME_STEP.name, "critical Δt"),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    parts.join(", ")
}
