//! `move NAME { … }`

use psd_language::check::checker::Checker;
use psd_plan::procedures::move_to::block as schema;
use psd_plan::schema::procedures::SPEED;
use psd_plan::{Move, ProcedureKind};

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
