//! `move NAME { … }`

use crate::language::check::checker::Checker;
use crate::plan::{Move, ProcedureKind};

pub fn move_block(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    checker.specimen_needed(block);
    let (to, speed) = (
        checker.quantity(block, "to"),
        checker.optional(block, "speed"),
    );
    Some(ProcedureKind::Move(Move {
        to: to?,
        speed: speed?,
    }))
}
