//! The statement on the whole run. In: a run. Out: heading and sentence of the document.

use std::borrow::Cow;

use crate::report::document::{Text, Tone, Verdict as Stated};
use crate::report::run::Run;
use crate::report::sections::reproductions::not_reproduced;
use crate::report::status::ReportStatus;
use crate::report::wording::{reproductions, verdict as wording};
use crate::verdict::Verdict;
use psd_plan::record::IS_OUTSIDE;
use psd_plan::record::Outcome;

/// The statement, and the reason if the run was not completed. A simulation is headed as such, and so is a check run: neither is
/// the test of the plan. The report of a test that is not issuable says so before the outcome.
pub(in super::super) fn verdict(run: &Run<'_>) -> Stated {
    let reason = match &run.record.outcome {
        Outcome::Completed => String::new(),
        Outcome::Aborted { reason }
        | Outcome::NotReleased { reason }
        | Outcome::Blocked { reason }
        | Outcome::Faulted { reason } => wording::reason(in_words(reason.trim_end_matches('.'))),
    };
    let (simulated, checked) = (
        run.record.rig.simulated,
        run.plan.performed_part().is_some(),
    );
    let not_issuable = matches!(ReportStatus::of(run), ReportStatus::NotIssuable { .. });
    let name = run.assessment.verdict.name().to_uppercase();
    let (heading, sentence) = match (simulated, checked) {
        (true, _) => (
            wording::simulation(outcome(run)),
            if run.plan.rig.link.as_real().is_some() {
                wording::EMULATED_RIG
            } else {
                wording::SIMULATED_RIG
            }
            .to_owned(),
        ),
        (false, true) => (
            wording::check_run(outcome(run)),
            wording::CHECK_RUN.to_owned(),
        ),
        (false, false) if not_issuable => (wording::not_issuable(outcome(run)), sentence(run)),
        (false, false) => (name, sentence(run)),
    };
    Stated {
        tone: tone(run, simulated || checked || not_issuable),
        heading,
        text: match unmet(run) {
            names if names.is_empty() => (sentence + &reason).into(),
            names => Text::from(sentence + &reason).line().and(names),
        },
    }
}

/// A limit that was broken as value and limit: `force 1.80835 kN, limit −2 kN … 1.8 kN`. Every other reason is in words already.
fn in_words(reason: &str) -> Cow<'_, str> {
    let Some((value, limit)) = reason.split_once(IS_OUTSIDE) else {
        return reason.into();
    };
    let printed = |text: &str| text.replace(" -", " −").replace(" .. ", " … ");
    let limit = printed(&format!(" {limit}"));
    wording::outside_limit(printed(value), limit.trim_start()).into()
}

/// The names of the requirements that are not met or inconclusive, and of the published numbers that are not reproduced. A run that was
/// stopped has its reason instead.
fn unmet(run: &Run<'_>) -> String {
    /// Names of each kind.
    const MOST: usize = 3;
    if run.record.outcome != Outcome::Completed {
        return String::new();
    }
    let named = |verdict: Verdict, sentence: fn(String) -> String| {
        let requirements = run.assessment.requirements.iter();
        let names: Vec<&str> = requirements
            .filter(|requirement| requirement.verdict == verdict)
            .map(|requirement| requirement.label.as_str())
            .collect();
        let more = match names.len().saturating_sub(MOST) {
            0 => String::new(),
            more => wording::more(more),
        };
        if names.is_empty() {
            return String::new();
        }
        sentence(names[..names.len().min(MOST)].join("; ") + &more)
    };
    let failed = named(Verdict::Fail, wording::failed);
    let inconclusive = named(Verdict::Inconclusive, wording::inconclusive);
    let different = match not_reproduced(run) {
        names if names.is_empty() => String::new(),
        names => reproductions::not_reproduced(names.join("; ")),
    };
    let all = [failed, inconclusive, different];
    let found: Vec<String> = all.into_iter().filter(|text| !text.is_empty()).collect();
    found.join(" ")
}

/// Only a test of a specimen whose report can be issued is green.
fn tone(run: &Run<'_>, not_the_test: bool) -> Tone {
    match run.assessment.verdict {
        Verdict::Completed => Tone::Neutral,
        Verdict::Pass if not_the_test => Tone::Neutral,
        Verdict::Pass => Tone::Pass,
        Verdict::Inconclusive => Tone::Inconclusive,
        Verdict::Fail | Verdict::Aborted | Verdict::Error => Tone::Fail,
    }
}

/// The number of requirements with this verdict, and of all.
fn count(run: &Run<'_>, verdict: Verdict) -> (usize, usize) {
    let requirements = &run.assessment.requirements;
    let found = requirements
        .iter()
        .filter(|requirement| requirement.verdict == verdict)
        .count();
    (found, requirements.len())
}

/// The outcome in a few words, for a heading.
fn outcome(run: &Run<'_>) -> String {
    match run.assessment.verdict {
        Verdict::Completed => match run.assessment.reproductions.len() {
            0 => wording::COMPLETED.to_owned(),
            1 if not_reproduced(run).is_empty() => reproductions::ONE.to_owned(),
            total => reproductions::of(total - not_reproduced(run).len(), total),
        },
        Verdict::Pass => match count(run, Verdict::Pass) {
            (_, 1) => wording::REQUIREMENT_MET.to_owned(),
            (_, total) => wording::requirements_met(total),
        },
        Verdict::Fail => match count(run, Verdict::Fail) {
            (_, 1) => wording::REQUIREMENT_NOT_MET.to_owned(),
            (found, total) => wording::requirements_not_met(found, total),
        },
        Verdict::Inconclusive => match count(run, Verdict::Inconclusive) {
            (0, _) => wording::INCONCLUSIVE.to_owned(),
            (found, total) => wording::requirements_inconclusive(found, total),
        },
        Verdict::Aborted => wording::STOPPED.to_owned(),
        Verdict::Error => wording::FAULT.to_owned(),
    }
}

fn sentence(run: &Run<'_>) -> String {
    let blocked = matches!(run.record.outcome, Outcome::Blocked { .. });
    match run.assessment.verdict {
        Verdict::Completed if run.assessment.reproductions.is_empty() => {
            wording::NO_REQUIREMENT.to_owned()
        }
        Verdict::Completed => reproductions::NO_CONFORMITY.to_owned(),
        Verdict::Pass => match count(run, Verdict::Pass) {
            (_, 1) => wording::THE_REQUIREMENT_IS_MET.to_owned(),
            (_, total) => wording::all_met(total),
        },
        Verdict::Inconclusive if blocked => wording::BLOCKED.to_owned(),
        Verdict::Inconclusive => match count(run, Verdict::Inconclusive) {
            (0, _) => wording::ZERO_DRIFT.to_owned(),
            (found, total) => wording::undecided(found, total),
        },
        Verdict::Fail => match count(run, Verdict::Fail) {
            (_, 1) => wording::THE_REQUIREMENT_IS_NOT_MET.to_owned(),
            (found, total) => wording::not_met(found, total),
        },
        Verdict::Aborted => wording::ABORTED.to_owned(),
        Verdict::Error => wording::RIG_FAILED.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_broken_limit_is_value_and_limit() {
        assert_eq!(
            in_words("force -2.1 kN is outside its limit -2 kN .. 1.8 kN"),
            "force −2.1 kN, limit −2 kN … 1.8 kN"
        );
        assert_eq!(in_words("stopped on request"), "stopped on request");
    }
}
