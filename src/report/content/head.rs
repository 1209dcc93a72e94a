//! The first page after the title: the verdict, each requirement with the rule it was decided by, and what must be known
//! before any of it is believed. In: a run. Out: blocks.

use super::super::document::{Block, Column, Style, Table, Text, Verdict as Stated};
use super::super::{IssueKind, Run, deviations, issue, number};
use super::budget;
use crate::plan::formula::{Part, ResultValue};
use crate::plan::{Condition, DecisionRule, Requirement};
use crate::record::{EventKind, Outcome};
use crate::report::coverage_factor;
use crate::run::rehearsal;
use crate::verdict::{ConditionOutcome, RequirementOutcome, Verdict};

/// The verdict in a sentence.
pub(super) fn verdict(run: &Run<'_>) -> Stated {
    let reason = match &run.record.outcome {
        Outcome::Completed => String::new(),
        Outcome::Aborted { reason }
        | Outcome::NotReleased { reason }
        | Outcome::Blocked { reason }
        | Outcome::Faulted { reason } => {
            format!(" Reason: {}.", reason.trim_end_matches('.'))
        }
    };
    Stated {
        name: run.assessment.verdict.name(),
        text: (sentence(run) + &reason).into(),
    }
}

fn sentence(run: &Run<'_>) -> String {
    let all = &run.assessment.requirements;
    let with = |verdict: Verdict| {
        all.iter()
            .filter(|requirement| requirement.verdict == verdict)
            .count()
    };
    match run.assessment.verdict {
        Verdict::Completed if rehearsal::told(run.plan).is_some() => {
            "A rehearsal decides no requirement: it came to its end.".to_owned()
        }
        Verdict::Completed => "The plan states no requirement: nothing was decided.".to_owned(),
        Verdict::Pass if all.len() == 1 => "The requirement is met.".to_owned(),
        Verdict::Pass => format!("All {} requirements are met.", all.len()),
        Verdict::Inconclusive if matches!(run.record.outcome, Outcome::Blocked { .. }) => {
            "The run could not go on with a value that it found; what follows is what was recorded until then.".to_owned()
        }
        Verdict::Inconclusive if with(Verdict::Inconclusive) == 0 => {
            "The zeros of the rig drifted farther than it allows: nothing that its readings enter is decided.".to_owned()
        }
        Verdict::Inconclusive => {
            format!("{} of {} requirements cannot be decided from this run.", with(Verdict::Inconclusive), all.len())
        }
        Verdict::Fail => format!("{} of {} requirements are not met.", with(Verdict::Fail), all.len()),
        Verdict::Aborted => "The run was stopped before its end; what follows is what was recorded until then.".to_owned(),
        Verdict::Error => "The rig failed; what follows is what was recorded until then.".to_owned(),
    }
}

/// Why there is another report of the same run, and what it says otherwise.
pub(super) fn amendments(run: &Run<'_>, body: &mut Vec<Block>) {
    let told = issue::amendments(run);
    if told.is_empty() {
        return;
    }
    body.push(Block::section("Amendment"));
    body.push(Block::List {
        items: told.into_iter().map(Text::from).collect(),
    });
    body.push(Block::note(
        "The record of the run is the same, and so is every measured and computed number. The report named above is kept and no \
         longer valid.",
    ));
}

/// The report that this one amends.
pub(super) fn replaced(run: &Run<'_>) -> Option<String> {
    let last = run.provenance.issues.as_ref()?.all.last()?;
    (last.kind == IssueKind::Amendment).then(|| last.replaces.clone())
}

/// Whether deviations stand before the requirements: of a real rig, and where long requirements would push them off the
/// first page.
pub(super) fn deviations_come_first(run: &Run<'_>) -> bool {
    const ON_ONE_PAGE: usize = 8;
    let conditions: usize = run
        .assessment
        .requirements
        .iter()
        .map(|requirement| requirement.conditions.len())
        .sum();
    run.plan.rig.link.as_real().is_some() || conditions > ON_ONE_PAGE
}

/// Every requirement with value, expanded uncertainty, limit and margin, and the rule by which it was decided.
pub(super) fn requirements(run: &Run<'_>, body: &mut Vec<Block>) {
    body.push(Block::section("Requirements"));
    if run.assessment.requirements.is_empty() {
        body.push(Block::paragraph(
            "No requirement: the verdict says only that the run came to its end.",
        ));
        return;
    }
    let columns = vec![
        Column::words("Requirement", 1),
        Column::numbers("Value ± U"),
        Column::numbers("Accepted"),
        Column::numbers("Margin"),
        Column::numbers("Conforms"),
        Column::short("Verdict"),
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
        .any(|it| !is_sure(run, it));
    body.push(Block::Table(Table {
        columns,
        rows: requirements
            .flat_map(|(requirement, planned)| rows(run, requirement, planned))
            .collect(),
    }));
    body.push(Block::note(rule(run)));
    if marked {
        body.push(Block::note(
            "† U of this value is an estimate: it reads a result that does not follow an input smoothly, or of which the record leaves \
             something open. It need not hold about 95\u{a0}% of the cases.",
        ));
    }
}

/// Whether no result that a condition reads is marked as an estimate.
fn is_sure(run: &Run<'_>, condition: &Condition) -> bool {
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
                ResultValue::Number { .. } => budget::is_sure(result, 0),
                ResultValue::List(values) => {
                    (0..values.len()).all(|entry| budget::is_sure(result, entry))
                }
            })
        })
}

/// The decision rule in words with the risk it takes, and what the columns are.
fn rule(run: &Run<'_>) -> String {
    let rule = match run.assessment.rule {
        DecisionRule::Simple => {
            "Decision rule: simple acceptance (ILAC-G8:09/2019). The value alone is held against the limit, whatever its \
             uncertainty: for a value at its limit a wrong decision is as likely as a right one, and where U exceeds the tolerance a value \
             may be accepted that probably does not conform."
                .to_owned()
        }
        DecisionRule::Guarded => format!(
            "Decision rule: guarded (after ILAC-G8:09/2019), guard band w = {} of the distance between value and limit. A value \
             passes if it keeps the limit by at least w, fails if it misses it by more than w, and is inconclusive between. As far as \
             the budgets go, a wrong pass or fail has a probability below 2.5\u{a0}% at a limit on one side, and below 5\u{a0}% at limits on \
             both. A measured value of which no uncertainty is known is inconclusive; what is exact (counts, the energy balance) is held \
             against the limit as it is.",
            coverage_factor::equation(run.assessment)
        ),
    };
    let expanded = match coverage_factor::largest(run.assessment) {
        Some(factor) => format!(
            "U = k·u is the expanded uncertainty where a measured result carries one: it holds about 95\u{a0}% of the cases, with k from \
             Student's t of the effective degrees of freedom (JCGM 100:2008, G.4), here up to {factor}."
        ),
        None => "U = 2u is the expanded uncertainty (k = 2, about 95\u{a0}%) where a measured result carries one.".to_owned(),
    };
    format!(
        "{rule} {expanded} Conforms is the probability that what was measured lies inside the limit, by that uncertainty (JCGM 106). Margin is the distance inside the limit; a negative margin is the distance by which it is missed."
    )
}

fn rows(run: &Run<'_>, requirement: &RequirementOutcome, planned: &Requirement) -> Vec<Vec<Text>> {
    let rule = run.assessment.rule;
    if requirement.conditions.is_empty() {
        let none = || Text::from("—");
        return vec![vec![
            requirement.label.as_str().into(),
            none(),
            none(),
            none(),
            none(),
            word(requirement.verdict),
        ]];
    }
    let of = |(index, (condition, planned)): (usize, (&ConditionOutcome, &Condition))| {
        let label = if index == 0 {
            Text::from(requirement.label.as_str()).line()
        } else {
            Text::new()
        };
        let mut name = label.code(&condition.text);
        if let Some(reason) = &condition.reason {
            name = name.line().soft(reason);
        }
        let conforms = condition
            .conforms
            .map_or_else(|| "—".to_owned(), number::probability);
        if condition.wider_than_tolerance && rule == DecisionRule::Simple {
            name = name.line().soft(format!(
                "U exceeds the tolerance: the probability of conformity is {conforms}"
            ));
        }
        let mark = if condition.uncertainty.is_some() && !is_sure(run, planned) {
            budget::MARK
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
                || Text::missing("no value"),
                |value| Text::from(value + mark),
            ),
            number::bound(condition).into(),
            margin,
            conforms.into(),
            word(condition.verdict),
        ]
    };
    requirement
        .conditions
        .iter()
        .zip(&planned.conditions)
        .enumerate()
        .map(of)
        .collect()
}

fn word(verdict: Verdict) -> Text {
    let style = match verdict {
        Verdict::Completed => Style::Plain,
        Verdict::Pass => Style::Pass,
        Verdict::Inconclusive => Style::Doubt,
        Verdict::Fail | Verdict::Aborted | Verdict::Error => Style::Fail,
    };
    Text::new().with(style, verdict.name())
}

/// Deviations from the plan, and remarks on the numbers.
pub(super) fn deviations(run: &Run<'_>, body: &mut Vec<Block>) {
    body.push(Block::section("Deviations and remarks"));
    let found = deviations::of(run);
    if found.is_empty() {
        body.push(Block::paragraph("No deviation from the plan was recorded."));
    }
    let remarks = run.record.events.iter().filter(|event| match event.kind {
        EventKind::Remark | EventKind::Inspection => true,
        EventKind::Note => !deviations::is_of_the_line(&event.text),
        _ => false,
    });
    let remarks = remarks.map(|event| {
        let place = deviations::place(event.procedure.as_deref(), event.step);
        format!("{}{place}: {}", capital(event.kind.word()), event.text)
    });
    let items: Vec<Text> = found.into_iter().chain(remarks).map(Text::from).collect();
    if !items.is_empty() {
        body.push(Block::List { items });
    }
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().collect::<String>() + letters.as_str()
    })
}
