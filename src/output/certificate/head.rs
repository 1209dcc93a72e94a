//! The top of the certificate: what was tested, the verdict, and what must be known before it is believed.

use maud::{Markup, html};

use super::super::{Run, amendment, deviations, number, summary};
use super::{marks, title};
use crate::record::{EventKind, Outcome};
use crate::run::rehearsal;
use crate::verdict::{RequirementOutcome, Verdict};

/// Title, run id, verdict and marks.
pub(super) fn title_and_verdict(run: &Run<'_>) -> Markup {
    let verdict = run.assessment.verdict;
    html! {
        header.title {
            div {
                p.kind { "Report of a pseudo-dynamic test" }
                @if let Some(replaced) = replaced(run) { p.kind { strong { "Amendment to report " (replaced) } } }
                h1 { (title(run)) }
            }
            div.run {
                @if run.provenance.amends.is_some() { "report " span.id { (run.provenance.report_id()) } br; }
                "run " span.id { (run.provenance.run_id) } br;
                @if let Some(date) = &run.provenance.date { (date) } @else { "date not given" }
            }
        }
        section class={ "verdict " (verdict.name()) } {
            strong { (verdict.name().to_uppercase()) }
            (sentence(run))
            @if let Outcome::Aborted { reason } | Outcome::Faulted { reason } = &run.record.outcome { " Reason: " (reason) "." }
        }
        (marks::boxed(run))
        (amendments(run))
    }
}

/// The report that this one takes the place of.
fn replaced<'a>(run: &Run<'a>) -> Option<&'a str> {
    let amends = run.provenance.amends.as_ref()?;
    amends.amendments.last().map(|amendment| amendment.replaces.as_str())
}

/// Why there is another report of the same run, and what it says otherwise.
fn amendments(run: &Run<'_>) -> Markup {
    let told = amendment::told(run);
    html! {
        @if !told.is_empty() {
            section {
                h2 { "Amendment" }
                ul { @for told in &told { li { (told) } } }
                p.note {
                    "The record of the run is the same, and so is every measured and computed number. The report named above is "
                    "kept and no longer valid."
                }
            }
        }
    }
}

fn sentence(run: &Run<'_>) -> String {
    let all = &run.assessment.requirements;
    let with = |verdict: Verdict| all.iter().filter(|requirement| requirement.verdict == verdict).count();
    match run.assessment.verdict {
        Verdict::Pass if rehearsal::told(run.plan).is_some() => {
            "A rehearsal decides no requirement: it came to its end.".to_owned()
        }
        Verdict::Pass if all.is_empty() => "The plan states no requirement.".to_owned(),
        Verdict::Pass if all.len() == 1 => "The requirement is met.".to_owned(),
        Verdict::Pass => format!("All {} requirements are met.", all.len()),
        Verdict::Inconclusive => {
            format!("{} of {} requirements cannot be decided from this run.", with(Verdict::Inconclusive), all.len())
        }
        Verdict::Fail => format!("{} of {} requirements are not met.", with(Verdict::Fail), all.len()),
        Verdict::Aborted => "The run was stopped before its end; what follows is what was recorded until then.".to_owned(),
        Verdict::Error => "The rig failed; what follows is what was recorded until then.".to_owned(),
    }
}

/// Every requirement with value, uncertainty, limit and margin, and the rule by which it was decided.
pub(super) fn requirements(run: &Run<'_>) -> Markup {
    let rule = run.plan.particulars.iter().find(|(name, _)| *name == "decision_rule").map_or("simple", |(_, text)| text);
    html! {
        section {
            h2 { "Requirements" }
            @if run.assessment.requirements.is_empty() {
                p { "No requirement: the verdict says only that the run came to its end." }
            } @else {
                table {
                    thead {
                        tr {
                            th { "Requirement" }
                            th.number { "Value ± u" }
                            th.number { "Limit" }
                            th.number { "Margin" }
                            th { "Verdict" }
                        }
                    }
                    tbody { @for requirement in &run.assessment.requirements { (conditions(requirement)) } }
                }
                p.note {
                    "Decision rule: " (rule) ". With the rule “simple” the value alone is held against the limit, whatever its "
                    "uncertainty. u is the standard uncertainty (k = 1) where a measured result carries one. Margin is the distance "
                    "inside the limit; a negative margin is the distance by which it is missed."
                }
            }
        }
    }
}

fn conditions(requirement: &RequirementOutcome) -> Markup {
    let deciding = summary::governing(requirement).map(|condition| condition.text.as_str());
    html! {
        @for (index, condition) in requirement.conditions.iter().enumerate() {
            tr {
                td {
                    @if index == 0 { (requirement.label) br; }
                    code.soft { (condition.text) }
                    @if let Some(reason) = &condition.reason { br; span.note { (reason) } }
                }
                td.number {
                    @match number::value(condition) {
                        Some(value) => { (value) }
                        None => { span.missing { "no value" } }
                    }
                }
                td.number { (number::bound(condition)) }
                td.number { @if let Some(margin) = number::margin(condition) { (margin) } @else { "—" } }
                td class=(condition.verdict.name()) { (condition.verdict.name()) }
            }
        }
        @if deciding.is_none() {
            tr { td colspan="4" { (requirement.label) } td class=(requirement.verdict.name()) { (requirement.verdict.name()) } }
        }
    }
}

/// Deviations from the plan, and remarks on the numbers.
pub(super) fn deviations(run: &Run<'_>) -> Markup {
    let found = deviations::of(run);
    let remarks: Vec<_> = run
        .record
        .events
        .iter()
        .filter(|event| match event.kind {
            EventKind::Remark | EventKind::Inspection => true,
            EventKind::Note => !deviations::is_of_the_line(&event.text),
            _ => false,
        })
        .collect();
    html! {
        section {
            h2 { "Deviations and remarks" }
            @if found.is_empty() { p { "No deviation from the plan was recorded." } }
            @else { ul { @for deviation in &found { li { (deviation) } } } }
            @if !remarks.is_empty() {
                ul {
                    @for event in remarks {
                        li {
                            (capital(summary::event_kind(event.kind)))
                            (deviations::place(event.procedure.as_deref(), event.step)) ": " (event.text)
                        }
                    }
                }
            }
        }
    }
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + letters.as_str())
}
