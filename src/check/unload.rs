//! `unload NAME { … }`

use super::checker::Checker;
use crate::formula::Formula;
use crate::plan::{ProcedureKind, Unload};

pub fn unload(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    let tested = checker.specimen_block(block);
    let specimen = tested.map(|tested| checker.scope.place_in_kind(tested));
    let stiffness = checker.stiffness_or_specimens(block, tested);
    let (within, speed) = (checker.optional(block, "within"), checker.optional(block, "speed"));
    Some(ProcedureKind::Unload(Unload { specimen: specimen?, stiffness: stiffness?, within: within?, speed: speed? }))
}

impl Checker<'_> {
    /// `stiffness`, else on a virtual rig the initial one of the `specimen` block; on a real rig it is required, and said so
    /// already.
    pub fn stiffness_or_specimens(&mut self, block: usize, specimen: Option<usize>) -> Option<Formula> {
        if self.given(block, "stiffness").is_some() {
            return self.quantity(block, "stiffness");
        }
        if self.real_rig.is_some() {
            return None;
        }
        let head = self.scope.blocks[block].block.head;
        super::specimen::export(self, specimen?, "stiffness", head).map(Formula::Constant)
    }
}
