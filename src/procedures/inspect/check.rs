//! `inspect NAME { … }`

use crate::language::check::checker::Checker;
use crate::plan::ProcedureKind;
use crate::plan::procedures::inspect::block::NOTE;

pub fn inspect(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    checker
        .text_field(block, NOTE.name)
        .map(|note| ProcedureKind::Inspect { note })
}
