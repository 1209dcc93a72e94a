//! The requirements, each with value, limit, margin and verdict, and the decision rule. In: a run. Out: blocks.

use super::Source;
use super::results::budget_table;
use crate::plan::formula::{Part, ResultValue};
use crate::plan::{Condition, DecisionRule, Requirement};
use crate::report::budget::coverage_factor;
use crate::report::document::{Block, Column, Style, Table, Text};
use crate::report::number;
use crate::report::run::Run;
use crate::report::wording::{common, requirements as wording};
use crate::verdict::{ConditionOutcome, RequirementOutcome, Verdict};

/// Every requirement with value, expanded uncertainty, limit, margin and verdict; below them the decision rule.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let run = source.run;
    body.push(Block::section(wording::TITLE));
    if run.assessment.requirements.is_empty() {
        body.push(Block::paragraph(wording::NONE));
        return;
    }
    let [name, value, accepted, margin, conforms, verdict] = wording::COLUMNS;
    let columns = vec![
        Column::words(name, 1),
        Column::numbers(value),
        Column::numbers(accepted),
        Column::numbers(margin),
        Column::numbers(conforms),
        Column::short(verdict),
    ];
    let requirements = run
        .assessment
        .requirements
        .iter()
        .zip(&run.plan.requirements);
    let marked = run
        .plan
        .requirements
        .iter()
        .flat_map(|requirement| &requirement.conditions)
        .any(|condition| !is_reliable(run, condition));
    body.push(Block::Table(Table {
        columns,
        rows: requirements
            .flat_map(|(requirement, planned)| rows(run, requirement, planned))
            .collect(),
    }));
    body.push(Block::note(decision_rule(run)));
    if marked {
        body.push(Block::note(wording::MARKED));
    }
}

/// Whether a condition reads no result whose uncertainty is marked as an estimate.
fn is_reliable(run: &Run<'_>, condition: &Condition) -> bool {
    let mut references = Vec::new();
    condition.collect_references(&mut references);
    references
        .into_iter()
        .filter(|reference| reference.part == Part::Value)
        .all(|reference| {
            let result = run
                .record
                .procedures
                .get(reference.procedure.0)
                .and_then(|procedure| procedure.result(reference.name));
            result.is_none_or(|result| match &result.value {
                ResultValue::Number { .. } => budget_table::is_reliable(result, 0),
                ResultValue::List(values) => {
                    (0..values.len()).all(|entry| budget_table::is_reliable(result, entry))
                }
            })
        })
}

/// The decision rule with its risk, and the meaning of the columns.
fn decision_rule(run: &Run<'_>) -> String {
    let rule = match run.assessment.rule {
        DecisionRule::Simple => wording::SIMPLE_RULE.to_owned(),
        DecisionRule::Guarded => wording::guarded_rule(coverage_factor::equation(run.assessment)),
    };
    let expanded = coverage_factor::largest(run.assessment)
        .map_or_else(|| wording::EXPANDED.to_owned(), wording::expanded_up_to);
    format!("{rule} {expanded} {}", wording::CONFORMS_AND_MARGIN)
}

fn rows(run: &Run<'_>, requirement: &RequirementOutcome, planned: &Requirement) -> Vec<Vec<Text>> {
    if requirement.conditions.is_empty() {
        let none = || Text::from("—");
        return vec![vec![
            requirement.label.as_str().into(),
            none(),
            none(),
            none(),
            none(),
            verdict(requirement.verdict),
        ]];
    }
    let conditions = requirement.conditions.iter().zip(&planned.conditions);
    let mut rows = Vec::new();
    for (index, (condition, planned)) in conditions.enumerate() {
        let label = if index == 0 {
            Text::from(requirement.label.as_str()).line()
        } else {
            Text::new()
        };
        rows.push(row(run, label, condition, planned));
    }
    rows
}

/// The row of one condition; its name follows `label`.
fn row(run: &Run<'_>, label: Text, condition: &ConditionOutcome, planned: &Condition) -> Vec<Text> {
    let rule = run.assessment.rule;
    let mut name = label.code(&condition.text);
    if let Some(reason) = &condition.reason {
        name = name.line().soft(reason);
    }
    let conforms = condition
        .conforms
        .map_or_else(|| "—".to_owned(), number::probability);
    if condition.wider_than_tolerance && rule == DecisionRule::Simple {
        name = name.line().soft(wording::wider_than_tolerance(&conforms));
    }
    let mark = if condition.uncertainty.is_some() && !is_reliable(run, planned) {
        budget_table::MARK
    } else {
        ""
    };
    let margin = number::margin(condition).map_or_else(|| "—".into(), Text::from);
    let margin = match (rule, number::guard_band(condition)) {
        (DecisionRule::Guarded, Some(band)) => margin.line().soft(format!("w = {band}")),
        (DecisionRule::Simple, _) | (DecisionRule::Guarded, None) => margin,
    };
    vec![
        name,
        number::value(condition).map_or_else(
            || Text::missing(common::NO_VALUE),
            |value| Text::from(value + mark),
        ),
        number::bound(condition).into(),
        margin,
        conforms.into(),
        verdict(condition.verdict),
    ]
}

fn verdict(verdict: Verdict) -> Text {
    let style = match verdict {
        Verdict::Completed => Style::Plain,
        Verdict::Pass => Style::Pass,
        Verdict::Inconclusive => Style::Inconclusive,
        Verdict::Fail | Verdict::Aborted | Verdict::Error => Style::Fail,
    };
    Text::new().with(style, verdict.name())
}
