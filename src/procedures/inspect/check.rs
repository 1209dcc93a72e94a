//! `inspect NAME { … }`

use psd_language::check::checker::Checker;
use psd_plan::ProcedureKind;
use psd_plan::procedures::inspect::block::NOTE;

pub fn inspect(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    checker
        .text_field(block, NOTE.name)
        .map(|note| ProcedureKind::Inspect { note })
}
