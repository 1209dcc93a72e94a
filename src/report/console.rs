//! The verdict on a terminal. In: a run. Out: aligned text for stderr, plain or coloured as the caller chooses.

use std::fmt::Write as _;

use super::budget::coverage_factor;
use super::run::Run;
use super::sections::requirements::{mark, prints_mark};
use super::status::{ReportStatus, deviations};
use super::wording::{reproductions as wording, terminal};
use super::{number, summary};
use crate::verdict::{ConditionOutcome, ReproductionOutcome, Verdict};
use psd_plan::DecisionRule;
use psd_plan::record::Outcome;
use psd_text::columns::columns;
use psd_text::sanitize::one_line;

/// The verdict, each requirement with value, limit and margin, the decision rule and the deviations.
#[must_use]
pub fn verdict_text(run: &Run<'_>, coloured: bool) -> String {
    if let Outcome::NotReleased { reason } = &run.record.outcome {
        return format!(
            "NOT RELEASED  {}: {}\n",
            one_line(&run.plan.title),
            one_line(reason)
        );
    }
    let mut text = String::new();
    let paint = |verdict: Verdict, words: &str| paint(verdict, words, coloured);
    let status = ReportStatus::of(run);
    let verdict = run.assessment.verdict.name().to_uppercase();
    // A pass is green only if its report can be issued.
    let issuable = !matches!(status, ReportStatus::NotIssuable { .. });
    let verdict = match run.assessment.verdict {
        Verdict::Pass if !issuable => verdict,
        other => paint(other, &verdict),
    };
    let _ = writeln!(
        text,
        "{verdict}  {}{}",
        one_line(&run.plan.title),
        status_text(&status, &one_line(&run.plan.rig.name))
    );
    if run.assessment.requirements.is_empty() && run.assessment.reproductions.is_empty() {
        text.push_str("  no requirement\n");
    }
    let rows: Vec<[String; 5]> = run
        .assessment
        .requirements
        .iter()
        .zip(&run.plan.requirements)
        .map(|(requirement, planned)| {
            let name = one_line(&requirement.label);
            let Some(governing) = summary::governing(requirement) else {
                return [
                    requirement.verdict.name().to_owned(),
                    name,
                    String::new(),
                    String::new(),
                    String::new(),
                ];
            };
            let mut conditions = requirement.conditions.iter().zip(&planned.conditions);
            let planned = conditions.find(|(condition, _)| std::ptr::eq(*condition, governing));
            let mark = planned.map_or("", |(_, planned)| mark(run, governing, planned));
            let value = number::value(governing).map(|value| value + mark);
            let value = value.unwrap_or_else(|| "no value".to_owned());
            let margin = number::margin(governing).map_or_else(String::new, |margin| {
                format!("margin {margin}{}", band(governing, run.assessment.rule))
            });
            [
                requirement.verdict.name().to_owned(),
                name,
                value,
                number::bound(governing),
                margin,
            ]
        })
        .collect();
    let width = |column: usize| {
        rows.iter()
            .map(|row| row[column].chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths = [width(0), width(1), width(2), width(3)];
    for (row, requirement) in rows.iter().zip(&run.assessment.requirements) {
        let verdict = paint(requirement.verdict, &padded(&row[0], widths[0]));
        let cells: Vec<String> = (1..4)
            .map(|column| padded(&row[column], widths[column]))
            .collect();
        let line = format!("  {verdict}  {}  {}", cells.join("  "), row[4]);
        let _ = writeln!(text, "{}", line.trim_end());
        let reason = summary::governing(requirement).and_then(|it| it.reason.as_deref());
        if let Some(reason) = reason {
            let below = " ".repeat(widths[0] + 4);
            let _ = writeln!(text, "{below}{}", one_line(reason));
        }
    }
    text.push_str(&compared(run));
    if let Some(names) = run.plan.studies.requirement_names() {
        let _ = writeln!(text, "  decided by `psd study run`: {}", one_line(&names));
    }
    text.push_str(&decision_rule(run));
    if prints_mark(run) {
        let _ = writeln!(text, "  {}", terminal::MARKED);
    }
    for deviation in deviations::of_run(run, true) {
        let _ = writeln!(text, "  note: {}", one_line(&deviation));
    }
    let report = run.provenance.report_id();
    let report = if report == run.provenance.run_id {
        String::new()
    } else {
        format!(", report {report}")
    };
    let _ = writeln!(text, "  run {}{report}", run.provenance.run_id);
    text
}

/// The guard band; under simple acceptance the probability of conformity, if U exceeds the tolerance. A value that decides without U
/// says so.
fn band(condition: &ConditionOutcome, rule: DecisionRule) -> String {
    if condition.decides_without_uncertainty() {
        return ", no U".to_owned();
    }
    match (rule, number::guard_band(condition)) {
        (DecisionRule::Simple | DecisionRule::ValueAlone, _) => match condition
            .conforms
            .filter(|_| condition.wider_than_tolerance)
        {
            Some(probability) => {
                let probability = number::probability(probability);
                // The reason follows.
                let wide = match condition.verdict {
                    Verdict::Inconclusive => "",
                    _ => "U exceeds the tolerance: ",
                };
                format!(", {wide}probability of conformity {probability}")
            }
            None => String::new(),
        },
        (DecisionRule::Guarded, Some(band)) => format!(", guard band {band}"),
        (DecisionRule::Guarded, None) => String::new(),
    }
}

/// The decision rule, if a U is printed.
fn decision_rule(run: &Run<'_>) -> String {
    let expanded = match coverage_factor::largest(run.assessment) {
        Some(factor) => {
            format!("± is U = k·u (about 95 %, k up to {factor})")
        }
        None => "± is U = 2u".to_owned(),
    };
    let uncertain = run
        .assessment
        .requirements
        .iter()
        .flat_map(|requirement| &requirement.conditions);
    match run.assessment.rule {
        DecisionRule::Guarded => {
            format!("  decision rule: guarded acceptance, guard band w = U; {expanded}\n")
        }
        DecisionRule::Simple
            if uncertain
                .into_iter()
                .any(|condition| condition.conforms.is_some()) =>
        {
            format!("  decision rule: simple acceptance; {expanded}\n")
        }
        DecisionRule::Simple | DecisionRule::ValueAlone => String::new(),
    }
}

/// The comparisons with published numbers: statement, name, value, published number, difference, tolerance.
fn compared(run: &Run<'_>) -> String {
    let row = |outcome: &ReproductionOutcome| {
        let value = number::value(&outcome.compared).unwrap_or_else(|| "no value".to_owned());
        let tolerance = number::tolerance(&outcome.compared);
        vec![
            outcome.statement().to_owned(),
            one_line(&outcome.name),
            value,
            wording::published(number::target(&outcome.compared)),
            wording::differs(number::difference(outcome), tolerance),
        ]
    };
    let rows: Vec<Vec<String>> = run.assessment.reproductions.iter().map(row).collect();
    let lines = columns(&rows);
    let mut text = String::new();
    for (line, outcome) in lines.lines().zip(&run.assessment.reproductions) {
        let _ = writeln!(text, "{line}");
        if let Some(reason) = &outcome.compared.reason {
            let _ = writeln!(text, "    {}", one_line(reason));
        }
    }
    text
}

/// The status of the report, if it is not issued as a test report.
fn status_text(status: &ReportStatus, rig: &str) -> String {
    match status {
        ReportStatus::Issued => String::new(),
        ReportStatus::CheckRun => "  (CHECK RUN: not the test of the plan)".to_owned(),
        ReportStatus::Simulation => format!("  (rig `{rig}`: a simulation)"),
        ReportStatus::NotIssuable { missing } => {
            format!("  (NOT ISSUABLE: lacks {})", one_line(&missing.join(", ")))
        }
        ReportStatus::Draft { missing } => {
            format!(
                "  (DRAFT: `psd issue` adds {})",
                one_line(&missing.join(", "))
            )
        }
    }
}

fn padded(text: &str, width: usize) -> String {
    format!(
        "{text}{}",
        " ".repeat(width.saturating_sub(text.chars().count()))
    )
}

fn paint(verdict: Verdict, words: &str, coloured: bool) -> String {
    let code = match verdict {
        Verdict::Completed => return words.to_owned(),
        Verdict::Pass => "32",
        Verdict::Inconclusive => "33",
        Verdict::Fail | Verdict::Aborted | Verdict::Error => "31",
    };
    if coloured {
        format!("\u{1b}[1;{code}m{words}\u{1b}[0m")
    } else {
        words.to_owned()
    }
}
