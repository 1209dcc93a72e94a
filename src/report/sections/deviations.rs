//! Deviations from the plan on the first page, observations on the numbers on the second, the notes of the run in an annex. In: a
//! run. Out: blocks.

use super::results::budget_table::Scope;
use super::{Source, capitalised, with_spaces};
use crate::procedures;
use crate::report::document::{Block, Text};
use crate::report::number;
use crate::report::run::Run;
use crate::report::status::deviations;
use crate::report::wording::deviations as wording;
use psd_plan::formula::{ProcedureId, ResultPart, ResultReference};
use psd_plan::record::{EventKind, NO_OPERATOR_ASKED, ProcedureRecord};
use psd_plan::uncertainty::measurement_uncertainty;

/// Every deviation. A simulation without any has no such section.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let mut found = deviations::of_run(source.run, false);
    // A stated “none” must not precede a deviation, and without any it states what is printed anyway.
    found.retain(|text| {
        !text
            .trim_end_matches('.')
            .eq_ignore_ascii_case(wording::STATED_NONE)
    });
    if found.is_empty() && source.run.record.rig.simulated {
        return;
    }
    body.push(Block::section(wording::TITLE));
    if found.is_empty() {
        body.push(Block::paragraph(wording::NO_DEVIATION));
    } else {
        list(found, body);
    }
}

/// The observations of the program on the results.
pub(super) fn observations(source: &Source<'_>, body: &mut Vec<Block>) {
    let implied: Vec<&str> = source
        .run
        .plan
        .procedures
        .iter()
        .flat_map(|procedure| procedures::facts_of(&procedure.kind).implied)
        .copied()
        .collect();
    let mut observations = of_kind(source.run, |kind, text| {
        kind == EventKind::Remark && !implied.iter().any(|end| text.ends_with(end))
    });
    observations.extend(not_distinct(source.run));
    if !observations.is_empty() {
        body.push(Block::section(wording::OBSERVATIONS));
        list(observations, body);
    }
}

/// Results that say nothing because their expanded uncertainty includes zero.
fn not_distinct(run: &Run<'_>) -> Vec<String> {
    let sentence = |(index, procedure): (usize, &ProcedureRecord)| {
        let name = procedures::recorded(&procedure.history).distinct_from_zero?;
        let result = procedure.result(name)?;
        let reference = ResultReference {
            procedure: ProcedureId(index),
            name: result.name,
            part: ResultPart::Value,
        };
        let value = procedure.number(name)?;
        let u = measurement_uncertainty(&result.contributions_of(reference), run.record)?;
        (value.abs() < u.expanded()).then(|| {
            let value = if Scope::of(run) == Scope::PartialReal {
                number::with_uncertainty(value, Some(u.standard), result.dimension)
            } else {
                number::with_expanded(value, u, result.dimension)
            };
            wording::not_distinct(&procedure.name, with_spaces(name), value)
        })
    };
    let procedures = run.record.procedures.iter().enumerate();
    procedures.filter_map(sentence).collect()
}

/// Notes and inspections in the order of the run.
pub(super) fn notes(source: &Source<'_>, body: &mut Vec<Block>) {
    let notes = of_kind(source.run, |kind, text| match kind {
        EventKind::Inspection => !text.ends_with(NO_OPERATOR_ASKED),
        EventKind::Note => !deviations::is_of_the_line(text),
        _ => false,
    });
    if !notes.is_empty() {
        body.push(Block::part(wording::NOTES));
        list(notes, body);
    }
}

fn of_kind(run: &Run<'_>, is_printed: impl Fn(EventKind, &str) -> bool) -> Vec<String> {
    let events = run
        .record
        .events
        .iter()
        .filter(|event| is_printed(event.kind, &event.text));
    let text = |event: &psd_plan::record::Event| {
        let position = deviations::position(event.procedure.as_deref(), event.step);
        let position = position.strip_prefix(' ').unwrap_or(&position);
        let text = event.text.trim_end_matches('.');
        if position.is_empty() {
            format!("{}.", capitalised(text))
        } else {
            format!("{}: {text}.", capitalised(position))
        }
    };
    events.map(text).collect()
}

fn list(texts: Vec<String>, body: &mut Vec<Block>) {
    body.push(Block::List {
        items: texts.into_iter().map(Text::from).collect(),
    });
}
