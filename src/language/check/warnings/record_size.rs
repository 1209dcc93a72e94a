//! Whether the log of a run can be read back when it is over, as far as the plan determines its steps. In: a checked plan and the
//! blocks of its procedures. Out: the first procedure by whose end the log is too long. It reads no disk space.

use crate::language::check::checker::Checker;
use crate::language::check::messages::whole;
use crate::plan::{Counts, FRAME, MOST_RECORD_BYTES, Plan};
use crate::procedures;

/// Compares the steps of all procedures that integrate, one after another, with the longest log.
pub fn fits(checker: &mut Checker, plan: &Plan, blocks: &[usize]) {
    #[expect(clippy::cast_precision_loss, reason = "far less than 2^53")]
    let most = MOST_RECORD_BYTES as f64;
    let mut before = FRAME;
    for (procedure, block) in plan.procedures.iter().zip(blocks.iter().copied()) {
        let Some((stepping, steps)) = procedures::facts_of(&procedure.kind)
            .stepping
            .zip(procedures::known_steps(&procedure.kind, plan))
        else {
            continue;
        };
        let bytes = |steps: f64| Counts::stepped(stepping.mode, steps).bytes(plan);
        #[expect(clippy::cast_precision_loss, reason = "an estimate")]
        let after = before + bytes(steps as f64);
        if after > most {
            let each = bytes(1.0) - bytes(0.0);
            let fit = ((most - before - bytes(0.0)) / each).max(0.0).floor();
            let head = checker.scope.blocks[block].block.head;
            let at = checker
                .field(block, "duration")
                .map_or(head, |(_, entry)| entry.value.span);
            checker
                .diagnostics
                .push(whole::record_too_long(at, after, most, steps, fit));
            return;
        }
        before = after;
    }
}
