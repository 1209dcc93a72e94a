//! The sections on single runs: how often each requirement is met, the worst runs with the settings that reproduce them, and why runs have
//! no result. In: answers. Out: blocks.

use super::numbers::{probability, range};
use super::source::Source;
use crate::report::document::{Block, Column, Table, Text};
use crate::report::wording::study as wording;
use crate::study::answers::{RequirementAnswer, WorstRun};
use psd_plan::schema::readable_result;

/// Requirements of the plan with their counts.
pub fn requirements(source: &Source<'_>, body: &mut Vec<Block>) {
    let answers = source.answers;
    let is_sample = answers
        .requirements
        .iter()
        .any(|it| it.probability.is_some());
    if !is_sample {
        return;
    }
    body.push(Block::section(wording::REQUIREMENTS));
    let [label, met, not_met, no_result, chance, interval] = wording::REQUIREMENT_COLUMNS;
    let row = |answer: &RequirementAnswer| {
        vec![
            Text::from(answer.label.as_str()).line().code(&answer.text),
            answer.met.to_string().into(),
            answer.not_met.to_string().into(),
            answer.no_result.to_string().into(),
            probability(answer.probability.as_ref()),
            range(answer.probability.as_ref()),
        ]
    };
    body.push(Block::Table(Table {
        columns: vec![
            Column::words(label, 1),
            Column::numbers(met),
            Column::numbers(not_met),
            Column::numbers(no_result),
            Column::numbers(chance),
            Column::numbers(interval),
        ],
        rows: answers.requirements.iter().map(row).collect(),
    }));
    let any = |of: fn(&RequirementAnswer) -> bool| answers.requirements.iter().any(of);
    if any(|answer| answer.not_met == 0) {
        body.push(Block::note(wording::NO_FAILURE));
    }
    if any(|answer| answer.no_result > 0) {
        body.push(Block::note(wording::NO_RESULT_BOUNDS));
    }
}

/// The worst runs of every requirement.
pub fn worst(source: &Source<'_>, body: &mut Vec<Block>) {
    let answers = source.answers;
    if answers
        .requirements
        .iter()
        .all(|answer| answer.worst.is_empty())
    {
        return;
    }
    body.push(Block::section(wording::WORST));
    let command = format!("psd run {} --set …", source.metadata.plan);
    let reproduced = if source.metadata.has_series {
        wording::REPRODUCE_SERIES
    } else {
        wording::REPRODUCE
    };
    body.push(Block::note(Text::from(reproduced).code(command)));
    for (index, answer) in answers.requirements.iter().enumerate() {
        body.push(Block::part(wording::worst_of(&answer.label)));
        if answer.worst.is_empty() {
            body.push(Block::note(wording::NO_WORST));
            continue;
        }
        let limited = source.metadata.requirements[index].limit;
        let compared = limited.map(|limit| &source.metadata.results[limit.result]);
        let row = |run: &WorstRun| {
            let outcome = if run.outcome == "met" {
                wording::MET
            } else {
                wording::NOT_MET
            };
            let value = run.value.zip(compared);
            let value =
                value.map(|(value, column)| readable_result(&column.name, value, column.dimension));
            let settings = run
                .settings
                .iter()
                .map(|setting| format!("--set {setting}"));
            vec![
                run.run.to_string().into(),
                outcome.to_lowercase().into(),
                value.unwrap_or_else(|| "–".to_owned()).into(),
                Text::new().code(settings.collect::<Vec<_>>().join(" ")),
            ]
        };
        let [run, outcome, value, settings] = wording::WORST_COLUMNS;
        body.push(Block::Table(Table {
            columns: vec![
                Column::numbers(run),
                Column::short(outcome),
                Column::numbers(value),
                Column::words(settings, 1),
            ],
            rows: answer.worst.iter().map(row).collect(),
        }));
    }
    let scatter =
        |figure: &super::source::DrawnFigure| figure.kind == super::figures::FigureKind::Scatter;
    body.extend(source.figures_of(scatter));
}

/// Why runs have no result.
pub fn reasons(source: &Source<'_>, body: &mut Vec<Block>) {
    if source.answers.reasons.is_empty() {
        return;
    }
    body.push(Block::section(wording::REASONS));
    let [reason, runs, first] = wording::REASON_COLUMNS;
    let rows = source.answers.reasons.iter().map(|counted| {
        vec![
            counted.reason.as_str().into(),
            counted.runs.to_string().into(),
            counted.first_run.to_string().into(),
        ]
    });
    body.push(Block::Table(Table {
        columns: vec![
            Column::words(reason, 1),
            Column::numbers(runs),
            Column::numbers(first),
        ],
        rows: rows.collect(),
    }));
}
