//! The statement of conformity: every requirement with value, limit and verdict, and the decision rule. In: a run. Out: blocks.

mod explanation;

use super::results::budget_table::{self, Scope};
use super::{Source, entry_name, with_spaces};
use crate::report::budget::coverage_factor;
use crate::report::document::{Block, Column, Style, Table, Text};
use crate::report::number;
use crate::report::run::Run;
use crate::report::status::ReportStatus;
use crate::report::wording::{common, headline, requirements as wording};
use crate::verdict::{ConditionOutcome, RequirementOutcome, Verdict};
use psd_plan::formula::{Formula, ResultPart, ResultValue};
use psd_plan::{Condition, DecisionRule, Requirement};

/// Every requirement with value, expanded uncertainty, limit, probability of conformity and verdict; below them the decision rule.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let run = source.run;
    if run.assessment.requirements.is_empty() {
        return;
    }
    body.push(Block::section(wording::TITLE));
    let uncertain = conditions(run).any(|(condition, _)| condition.conforms.is_some());
    let [name, value, accepted, conforms, verdict] = wording::COLUMNS;
    let columns = vec![
        Column::words(name, 1),
        Column::numbers(if is_partial(run) {
            headline::VALUE_WITH_U
        } else {
            value
        }),
        Column::numbers(accepted),
        Column::numbers(conforms),
        Column::short(verdict),
    ];
    let requirements = run
        .assessment
        .requirements
        .iter()
        .zip(&run.plan.requirements);
    let rows = requirements
        .flat_map(|(requirement, planned)| rows(run, requirement, planned))
        .collect();
    body.push(Block::Table(Table { columns, rows }));
    body.push(Block::note(decision_rule(run, uncertain)));
    if let Some(names) = run.plan.studies.requirement_names() {
        body.push(Block::note(wording::of_studies(names)));
    }
    if prints_mark(run) {
        body.push(Block::note(common::MARKED));
    }
}

/// Whether the budgets of a real rig give no expanded uncertainty.
fn is_partial(run: &Run<'_>) -> bool {
    Scope::of(run) == Scope::PartialReal
}

/// Every condition with the one of the plan.
fn conditions<'a>(run: &Run<'a>) -> impl Iterator<Item = (&'a ConditionOutcome, &'a Condition)> {
    let requirements = run
        .assessment
        .requirements
        .iter()
        .zip(&run.plan.requirements);
    requirements.flat_map(|(outcome, planned)| outcome.conditions.iter().zip(&planned.conditions))
}

/// Whether a value of this section is marked as an estimate, so that its note is printed here.
pub(crate) fn prints_mark(run: &Run<'_>) -> bool {
    conditions(run).any(|(condition, planned)| is_marked(run, condition, planned))
}

fn is_marked(run: &Run<'_>, condition: &ConditionOutcome, planned: &Condition) -> bool {
    condition.uncertainty.is_some() && !is_reliable(run, planned)
}

/// The mark of an estimate behind a value that has it.
pub(crate) fn mark(
    run: &Run<'_>,
    condition: &ConditionOutcome,
    planned: &Condition,
) -> &'static str {
    if is_marked(run, condition, planned) {
        budget_table::MARK
    } else {
        ""
    }
}

/// Whether a condition reads no result whose uncertainty is marked as an estimate.
fn is_reliable(run: &Run<'_>, condition: &Condition) -> bool {
    let mut references = Vec::new();
    condition.collect_references(&mut references);
    references
        .into_iter()
        .filter(|reference| reference.part == ResultPart::Value)
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
fn decision_rule(run: &Run<'_>, uncertain: bool) -> String {
    let mut sentences = vec![match run.assessment.rule {
        DecisionRule::Simple | DecisionRule::ValueAlone => wording::SIMPLE_RULE.to_owned(),
        DecisionRule::Guarded => wording::guarded_rule(coverage_factor::equation(run.assessment)),
    }];
    if uncertain {
        sentences.push(
            coverage_factor::largest(run.assessment)
                .map_or_else(|| wording::EXPANDED.to_owned(), wording::expanded_up_to),
        );
        sentences.push(wording::PROBABILITY.to_owned());
    }
    if is_partial(run) {
        sentences.push(headline::STANDARD.to_owned());
    }
    sentences.join(" ")
}

fn rows(run: &Run<'_>, requirement: &RequirementOutcome, planned: &Requirement) -> Vec<Vec<Text>> {
    if requirement.conditions.is_empty() {
        let none = || Text::from("—");
        return vec![vec![
            requirement.label.as_str().into(),
            none(),
            none(),
            none(),
            verdict(run, requirement.verdict),
        ]];
    }
    let single = requirement.conditions.len() == 1;
    let conditions = requirement.conditions.iter().zip(&planned.conditions);
    let mut rows = Vec::new();
    for (index, (condition, planned)) in conditions.enumerate() {
        let label = if index == 0 {
            Text::from(requirement.label.as_str()).line()
        } else {
            Text::new()
        };
        rows.push(row(run, label, condition, planned, single));
    }
    rows
}

/// A reason with the names of results, which are in backquotes, as words.
fn in_words(reason: &str) -> String {
    let parts = reason.split('`').enumerate();
    parts
        .map(|(index, part)| match index % 2 {
            0 => part.to_owned(),
            _ => part.replace('_', " "),
        })
        .collect()
}

/// The row of one condition; the quantity that it reads follows `label`.
fn row(
    run: &Run<'_>,
    label: Text,
    condition: &ConditionOutcome,
    planned: &Condition,
    single: bool,
) -> Vec<Text> {
    let rule = run.assessment.rule;
    let mut name = match quantity(run, planned).filter(|_| single) {
        Some(quantity) => label.soft(quantity),
        None => label.code(&condition.text),
    };
    if let Some(line) = explanation::criterion(run, planned) {
        name = name.line().soft(line);
    }
    if let Some(line) = explanation::distance(run, condition) {
        name = name.line().soft(line);
    }
    if let Some(reason) = &condition.reason {
        name = name.line().soft(in_words(reason));
    }
    if let Some(line) = explanation::largest_part(run, condition, planned) {
        name = name.line().soft(line);
    }
    let decided = condition.verdict != Verdict::Inconclusive;
    if condition.wider_than_tolerance && rule == DecisionRule::Simple && decided {
        name = name.line().soft(wording::WIDER_THAN_TOLERANCE);
    }
    let mark = mark(run, condition, planned);
    let bound = Text::from(number::bound(condition));
    let bound = match (rule, number::guard_band(condition)) {
        (DecisionRule::Guarded, Some(band)) => bound.line().soft(format!("w = {band}")),
        _ => bound,
    };
    vec![
        name,
        number::value(condition).map_or_else(
            || Text::missing(common::NO_VALUE),
            |value| Text::from(value + mark),
        ),
        bound,
        match condition.conforms {
            Some(probability) => number::probability(probability).into(),
            None if condition.decides_without_uncertainty() => wording::NO_U.into(),
            None => "—".into(),
        },
        verdict(run, condition.verdict),
    ]
}

/// The result that a condition compares, in words; None if it compares a calculated value.
fn quantity(run: &Run<'_>, condition: &Condition) -> Option<String> {
    let (reference, entry) = match &condition.value {
        Formula::Index(inner, index) => (inner.as_result()?, Some(*index)),
        formula => (formula.as_result()?, None),
    };
    let procedure = run.plan.procedures.get(reference.procedure.0)?;
    if reference.part != ResultPart::Value {
        return None;
    }
    let name = match entry {
        Some(_) => entry_name(reference.name),
        None => with_spaces(reference.name),
    };
    let entry = match (entry, run.record.procedures.get(reference.procedure.0)) {
        (None, _) => String::new(),
        (Some(entry), Some(record)) => {
            headline::entry(budget_table::entry_kind(reference.name, record), entry + 1)
        }
        (Some(_), None) => return None,
    };
    Some(wording::quantity(name, entry, &procedure.name))
}

/// In a simulation, or a report that is not issuable, a met requirement has no colour: nothing passed a test.
fn verdict(run: &Run<'_>, verdict: Verdict) -> Text {
    let is_test = !run.record.rig.simulated
        && !matches!(ReportStatus::of(run), ReportStatus::NotIssuable { .. });
    let style = match verdict {
        Verdict::Completed => Style::Plain,
        Verdict::Pass if !is_test => Style::Strong,
        Verdict::Pass => Style::Pass,
        Verdict::Inconclusive => Style::Inconclusive,
        Verdict::Fail | Verdict::Aborted | Verdict::Error => Style::Fail,
    };
    Text::new().with(style, verdict.name())
}
