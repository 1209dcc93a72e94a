//! Counts the steps of a whole run, if the plan determines them. In: a checked plan and the positions of its procedures in the text. Out:
//! an error at the first procedure whose steps exceed the limit of one run.

use crate::codes::E653;
use crate::procedures;
use psd_language::check::checker::Checker;
use psd_plan::schema::methods::DURATION;
use psd_plan::{MOST_RECORDED_STEPS, Plan};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

/// `all` steps up to the end of this procedure, which has `steps` of them; the procedures before it leave `remaining`.
#[derive(Violation)]
#[violation(
    E653,
    "too many steps in the run: {all} (at most {MOST_RECORDED_STEPS})"
)]
#[help("reduce `duration` or increase `time_step`: {remaining} steps remain here")]
struct TooManyRecordedSteps {
    #[label("{steps} steps")]
    span: Span,
    all: u64,
    steps: u64,
    remaining: u64,
}

/// Compares the steps of all procedures that integrate, summed in their order, with [`MOST_RECORDED_STEPS`].
pub fn check(checker: &mut Checker, plan: &Plan, blocks: &[usize]) {
    let mut before = 0_u64;
    for (procedure, block) in plan.procedures.iter().zip(blocks.iter().copied()) {
        let Some(steps) = procedures::known_steps(&procedure.kind, plan) else {
            continue;
        };
        let after = before.saturating_add(steps);
        if after > MOST_RECORDED_STEPS {
            let at = checker.value_or_head(block, DURATION.name);
            let remaining = MOST_RECORDED_STEPS - before;
            checker.report(TooManyRecordedSteps {
                span: at,
                all: after,
                steps,
                remaining,
            });
            return;
        }
        before = after;
    }
}
