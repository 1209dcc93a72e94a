//! Whether the record of a run can be read back when it is over, as far as the plan tells its steps. In: a checked plan and where
//! its procedures stand in the text. Out: the first procedure by whose end the record is too long. It asks no disk.

use crate::language::check::checker::Checker;
use crate::language::check::messages::whole;
use crate::plan::{Counts, FRAME, MOST_RECORD_BYTES, Plan};
use crate::procedures;

/// Holds the steps of all procedures that integrate, block by block, against the longest record.
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
                .given(block, "duration")
                .map_or(head, |(_, entry)| entry.value.span);
            checker
                .faults
                .push(whole::record_too_long(at, (after, most), (steps, fit)));
            return;
        }
        before = after;
    }
}
