//! `inspect NAME { … }`

use crate::language::check::checker::Checker;
use crate::plan::ProcedureKind;

pub fn inspect(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    checker
        .text_field(block, "note")
        .map(|note| ProcedureKind::Inspect { note })
}
