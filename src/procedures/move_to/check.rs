//! `move NAME { … }`

use crate::language::check::checker::Checker;
use crate::language::check::expressions::read_field::ReadField;
use crate::plan::move_fields;
use crate::plan::procedures::move_to::block::NAMES;
use crate::plan::reader;
use crate::plan::{Move, ProcedureKind};

pub fn move_block(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    checker.specimen_needed(block);
    read(checker, block).map(ProcedureKind::Move)
}

move_fields!(reader);
