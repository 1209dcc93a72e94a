//! Hover: the meaning of a word, and the value of what it names. In: a position. Out: text in Markdown.

use gen_lsp_types as lsp;
use psd_language::check::checker::Typed;
use psd_plan::formula::Formula;
use psd_text::source::Span;
use psd_text::units::display::{plain, readable, si_unit, significant, trimmed};
use psd_text::units::{Dimension, unit};

use super::{View, describe, markdown};
use crate::occurrences::{Meaning, Occurrence, Symbol, SymbolKind};

pub fn hover(view: &View<'_>, params: &lsp::HoverParams) -> Option<lsp::Hover> {
    let position = params.text_document_position_params.position;
    let found = *view.analysis.at(view.file, view.text().offset(position))?;
    Some(lsp::Hover {
        contents: markdown(hover_text(view, found)?).into(),
        range: Some(view.range(found.span.range())),
    })
}

fn hover_text(view: &View<'_>, found: Occurrence) -> Option<String> {
    let value = |meaning: Meaning| {
        let typed = view
            .analysis
            .value_of(&|file: &str| view.load(file), meaning)?;
        Some(shown(&typed))
    };
    Some(match found.meaning {
        Meaning::ItemWord(word) => item_word(word).to_owned(),
        Meaning::Keyword(kind) => describe::block(kind),
        Meaning::Symbol(index) => symbol(view, index, value(found.meaning)),
        Meaning::Entry { field, .. } => {
            let value = value(found.meaning).map(|value| format!("Here: {value}"));
            joined(describe::field(field), value)
        }
        Meaning::FieldOf(field) | Meaning::Argument(field) => describe::field(field),
        Meaning::Variant(variant) => describe::variant(variant),
        Meaning::Function(function) => {
            let arguments = function.takes.arguments();
            format!("**{}({arguments})**\n\n{}", function.name, function.doc)
        }
        Meaning::Figure(figure) => format!("**{}**\n\nfigure of a report", figure.name()),
        Meaning::Result { owner, result } => {
            let owner = owner.map(|owner| view.analysis.symbol(owner).name.as_str());
            let simulated = owner.and_then(|owner| simulated(view, owner, result.name));
            joined(describe::result(result), simulated)
        }
        Meaning::Uncertainty => "**u**\n\nstandard uncertainty of the result".to_owned(),
        Meaning::CriticalTimeStep => {
            "**critical**\n\nlargest time step at which the integration is stable, known when the procedure begins".to_owned()
        }
        Meaning::Number => number(view, found.span)?,
        Meaning::File => return None,
    })
}

fn item_word(word: &str) -> &'static str {
    match word {
        "let" => "**let**\n\na named value\n\n```psd\nlet stiffness = 300 kN/m\n```",
        "param" => {
            "**param**\n\na named value that `psd run --set` and studies can change\n\n```psd\nparam speed = 1 m/s between 0.5 m/s .. 3 m/s\n```"
        }
        "require" => {
            "**require**\n\na requirement on the results of the run\n\n```psd\nrequire \"stays in travel\" hit.max_displacement <= 8.5 mm\n```"
        }
        _ => {
            "**use**\n\nthe declarations of another file in the plan's folder\n\n```psd\nuse \"lib/frame.psd\"\n```"
        }
    }
}

fn joined(mut text: String, more: Option<String>) -> String {
    if let Some(more) = more {
        text.push_str("\n\n");
        text.push_str(&more);
    }
    text
}

fn symbol(view: &View<'_>, index: usize, value: Option<String>) -> String {
    let Symbol {
        name, kind, item, ..
    } = view.analysis.symbol(index);
    match kind {
        SymbolKind::Let | SymbolKind::Param => {
            let written = view.analysis.sources.text(*item);
            let comment = comment_above(view, *item);
            let text = format!("```psd\n{}\n```", written.trim_end());
            joined(joined(text, value), comment)
        }
        SymbolKind::Requirement => {
            let simulation = view.simulation.and_then(|simulation| {
                simulation
                    .requirements
                    .iter()
                    .find(|one| one.label == *name)
            });
            let verdict = simulation.map(|one| format!("Simulated: {}", one.verdict));
            joined(format!("**require** \"{name}\""), verdict)
        }
        SymbolKind::Block(kind) => {
            let kind = psd_plan::schema::block(*kind);
            let text = format!("**{} {name}**\n\n{}", kind.words(), kind.doc);
            joined(text, comment_above(view, *item))
        }
    }
}

/// The comment on the lines just above an item.
fn comment_above(view: &View<'_>, item: Span) -> Option<String> {
    let text = &view.analysis.sources.file(item.file).text;
    let before = &text[..text.floor_char_boundary(item.range().start)];
    let mut lines: Vec<&str> = before
        .lines()
        .rev()
        .map(str::trim)
        .take_while(|line| line.starts_with('#'))
        .map(|line| line.trim_start_matches('#').trim())
        .collect();
    lines.reverse();
    (!lines.is_empty()).then(|| lines.join(" "))
}

/// A value as the plan writes such values, and in SI.
pub fn shown(typed: &Typed) -> String {
    let dimension = typed.dimension;
    match (&typed.formula, typed.constant()) {
        (_, Some(value)) => in_both(value, dimension),
        (Formula::List(parts), None) => {
            let values: Option<Vec<f64>> = parts.iter().map(Formula::constant).collect();
            let Some(values) = values else {
                return format!(
                    "{} values of {}, known in the run",
                    parts.len(),
                    dimension.describe()
                );
            };
            let ends = [values.first(), values.last()].map(|end| end.copied().unwrap_or(0.0));
            format!(
                "{} values, {} to {}",
                values.len(),
                readable(ends[0], dimension),
                readable(ends[1], dimension)
            )
        }
        (_, None) => format!("{}, known in the run", dimension.describe()),
    }
}

/// A number in the unit that fits its size, and in SI.
fn in_both(value: f64, dimension: Dimension) -> String {
    let (fitting, si) = (plain(value, dimension, 6), si(value, dimension));
    if fitting == si || dimension == Dimension::NUMBER {
        fitting
    } else {
        format!("{fitting} = {si}")
    }
}

fn si(value: f64, dimension: Dimension) -> String {
    let unit = si_unit(dimension);
    let factor = unit::parse(&unit).map_or(1.0, |unit| unit.factor);
    let number = trimmed(&significant(value / factor, 6));
    format!("{number} {unit}").trim_end().to_owned()
}

/// A result of the newest simulation.
pub fn simulated(view: &View<'_>, procedure: &str, result: &str) -> Option<String> {
    let procedures = &view.simulation?.procedures;
    let (_, results) = procedures.iter().find(|(name, _)| name == procedure)?;
    let found = results.iter().find(|one| one.name == result)?;
    let value = psd_plan::schema::readable_result(result, found.value, found.dimension);
    Some(format!("Simulated: {value}"))
}

/// A number with its unit: its value in SI, and what the unit is.
fn number(view: &View<'_>, span: Span) -> Option<String> {
    let written = view.analysis.sources.text(span);
    let token = written.trim_start_matches(|c: char| c.is_ascii_digit() || matches!(c, '.' | '_'));
    let token = token.trim_start_matches(['e', 'E']);
    let token = token
        .trim_start_matches(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-'))
        .trim();
    let unit = unit::parse(token).ok().filter(|_| !token.is_empty())?;
    let typed = view.analysis.values(&|file: &str| view.load(file), &[span]);
    let value = typed.first().and_then(Typed::constant);
    let name = unit.dimension.describe();
    Some(match value {
        Some(value) => format!("`{written}` = {}\n\n{name}", si(value, unit.dimension)),
        None => format!(
            "`{token}` = {} {}\n\n{name}",
            unit.factor,
            si_unit(unit.dimension)
        ),
    })
}
