//! The verdict in one sentence. In: a run. Out: the verdict of the document.

use crate::record::Outcome;
use crate::report::document::Verdict as Stated;
use crate::report::run::Run;
use crate::report::wording::verdict as wording;
use crate::run::rehearsal;
use crate::verdict::Verdict;

/// The verdict, and the reason if the run was not completed.
pub(in super::super) fn verdict(run: &Run<'_>) -> Stated {
    let reason = match &run.record.outcome {
        Outcome::Completed => String::new(),
        Outcome::Aborted { reason }
        | Outcome::NotReleased { reason }
        | Outcome::Blocked { reason }
        | Outcome::Faulted { reason } => wording::reason(reason.trim_end_matches('.')),
    };
    Stated {
        name: run.assessment.verdict.name(),
        text: (sentence(run) + &reason).into(),
    }
}

fn sentence(run: &Run<'_>) -> String {
    let requirements = &run.assessment.requirements;
    let total = requirements.len();
    let count = |verdict: Verdict| {
        requirements
            .iter()
            .filter(|requirement| requirement.verdict == verdict)
            .count()
    };
    let blocked = matches!(run.record.outcome, Outcome::Blocked { .. });
    match run.assessment.verdict {
        Verdict::Completed if rehearsal::rehearsed_plan(run.plan).is_some() => {
            wording::REHEARSAL.to_owned()
        }
        Verdict::Completed => wording::NO_REQUIREMENT.to_owned(),
        Verdict::Pass if total == 1 => wording::THE_REQUIREMENT_IS_MET.to_owned(),
        Verdict::Pass => wording::all_met(total),
        Verdict::Inconclusive if blocked => wording::BLOCKED.to_owned(),
        Verdict::Inconclusive if count(Verdict::Inconclusive) == 0 => {
            wording::ZERO_DRIFT.to_owned()
        }
        Verdict::Inconclusive => wording::undecided(count(Verdict::Inconclusive), total),
        Verdict::Fail => wording::not_met(count(Verdict::Fail), total),
        Verdict::Aborted => wording::ABORTED.to_owned(),
        Verdict::Error => wording::RIG_FAILED.to_owned(),
    }
}
