//! `move NAME { … }`

use crate::language::check::checker::Checker;
use crate::plan::procedures::move_to::block as schema;
use crate::plan::{Move, ProcedureKind};
use crate::schema::procedures::SPEED;

pub fn move_block(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    checker.specimen_needed(block);
    // All fields are read before one fails, so that all errors are reported at once.
    let to = checker.quantity(block, schema::TO.name);
    let speed = checker.optional(block, SPEED.name);
    Some(ProcedureKind::Move(Move {
        to: to?,
        speed: speed?,
    }))
}
