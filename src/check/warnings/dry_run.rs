//! What a run of the plan on an ideal copy of its rig finds before anything moves: a stop (W740), and requirements that no run decides
//! (W741). In: the checked plan. Out: warnings. Only a plan that is simulated in milliseconds is run.

use crate::codes::{W740, W741};
use crate::procedures::most_steps;
use crate::run::{Keep, Unwatched, run_with};
use crate::verdict::{self, Verdict};
use psd_language::check::checker::Checker;
use psd_language::codes::{W729, W736};
use psd_plan::Plan;
use psd_plan::record::{Outcome, Record};
use psd_rig::virtual_rig;
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;

/// Most steps of a plan that is run by its check: milliseconds.
const MOST_STEPS: u64 = 20_000;
/// Most steps of a plan whose uncertainties are evaluated too: each is a run of its own.
const MOST_STEPS_WITH_UNCERTAINTY: u64 = 500;

/// `ends`: how the run ends.
struct RunStops<'a> {
    ends: &'a str,
    reason: &'a str,
    head: Span,
}

impl Violation for RunStops<'_> {
    const CODE: Code = W740;

    fn diagnostic(self) -> Diagnostic {
        let Self { ends, reason, head } = self;
        Diagnostic::new(Self::CODE, format!("the run {ends}: {reason}"))
            .at(head, "the dry run ends here")
            .help("change this procedure or the limit; `psd check --explain` shows the margin to each limit")
    }
}

#[derive(Violation)]
#[violation(W741, "the test will not decide `{requirement}`: {reason}")]
#[help(
    "change the plan so that the requirement can be decided; `psd check --explain` shows the prediction"
)]
struct NotDecided<'a> {
    requirement: &'a str,
    reason: &'a str,
    #[label("predicted to be inconclusive")]
    span: Span,
}

/// Whether a plan can be run without its rig, and in a short time. A plan of many steps is too long.
#[must_use]
pub fn is_short(plan: &Plan) -> bool {
    steps(plan) <= MOST_STEPS
}

fn steps(plan: &Plan) -> u64 {
    let procedures = plan.procedures.iter();
    procedures
        .filter_map(|procedure| most_steps(&procedure.kind, plan))
        .fold(0, u64::saturating_add)
}

/// Runs the plan on an ideal copy of its rig, and warns of what would go wrong. `blocks`: of its procedures.
pub fn warn(checker: &mut Checker, plan: &Plan, blocks: &[usize]) {
    if plan.unknown_specimen().is_some() || plan.procedures.is_empty() || !is_short(plan) {
        return;
    }
    let ideal = plan.on_an_ideal_rig();
    let keep = if steps(plan) <= MOST_STEPS_WITH_UNCERTAINTY {
        Keep::Everything
    } else {
        Keep::Steps
    };
    let mut rig = virtual_rig(&ideal);
    let record = run_with(&ideal, rig.as_mut(), &mut Unwatched, keep);
    if record.outcome != Outcome::Completed {
        warn_of_stop(checker, &record, blocks);
    } else if keep == Keep::Everything {
        warn_of_undecided(checker, plan, &record);
    }
}

fn warn_of_stop(checker: &mut Checker, record: &Record, blocks: &[usize]) {
    let at = record.stop_position();
    let position = at.map_or_else(String::new, |(name, step)| {
        format!(" in `{name}`, step {step}")
    });
    let (ends, reason) = match &record.outcome {
        Outcome::Completed => return,
        Outcome::Aborted { reason } | Outcome::NotReleased { reason } => {
            (format!("would be stopped{position}"), reason)
        }
        Outcome::Blocked { reason } => ("could not continue".to_owned(), reason),
        Outcome::Faulted { reason } => (format!("would fail{position}"), reason),
    };
    let block = blocks[record.procedures.len().saturating_sub(1)];
    checker.report(RunStops {
        ends: &ends,
        reason,
        head: checker.scope.blocks[block].block.head,
    });
}

fn warn_of_undecided(checker: &mut Checker, plan: &Plan, record: &Record) {
    // These two give the reason from the plan alone.
    let explained = [W729, W736];
    if checker
        .diagnostics
        .iter()
        .any(|found| explained.contains(&found.code))
    {
        return;
    }
    let assessment = verdict::assess(plan, record);
    for (index, outcome) in assessment.requirements.iter().enumerate() {
        let undecided = outcome
            .conditions
            .iter()
            .find(|condition| condition.verdict == Verdict::Inconclusive);
        if let Some(reason) = undecided.and_then(|condition| condition.reason.as_deref()) {
            checker.report(NotDecided {
                requirement: &outcome.label,
                reason,
                span: checker.scope.requirements[index].condition.span,
            });
        }
    }
}
