//! What is run, in the order written, and on which specimen.

use super::checker::Checker;
use super::faults::{axes as axis_faults, frames, names, whole as fault};
use super::rig::CheckedRig;
use super::scope::{DeclaredBlock, Meaning};
use super::{axes, cycle, damping_sweep, escalate, impact, inspect, move_block, shake, stiffness_ramp, unload};
use crate::diagnostic::Code;
use crate::plan::{BlowOn, Escalate, Procedure, ProcedureKind, Specimen};
use crate::schema::{self, Kind};
use crate::source::Span;
use crate::syntax::ast::ExprKind;

/// Every procedure; None for those with a fault.
pub fn procedures(checker: &mut Checker) -> Vec<(usize, Option<Procedure>)> {
    let blocks: Vec<usize> = checker.scope.procedures().map(|(index, _)| index).collect();
    blocks.into_iter().map(|block| (block, procedure(checker, block))).collect()
}

fn procedure(checker: &mut Checker, block: usize) -> Option<Procedure> {
    let declared = &checker.scope.blocks[block];
    let kind = match declared.kind.kind {
        Kind::StiffnessRamp => stiffness_ramp::stiffness_ramp(checker, block),
        Kind::DampingSweep => damping_sweep::damping_sweep(checker, block),
        Kind::Impact => impact::impact(checker, block),
        Kind::Shake => shake::shake(checker, block),
        Kind::Cycle => cycle::cycle(checker, block),
        Kind::Escalate => escalate::escalate(checker, block),
        Kind::Unload => unload::unload(checker, block),
        Kind::Move => move_block::move_block(checker, block),
        _ => inspect::inspect(checker, block),
    };
    Some(Procedure { name: declared.name?.node.clone(), kind: kind? })
}

/// One rig holds one specimen: every procedure must test the one that the first of them tests.
pub fn hold_specimen(checker: &mut Checker, procedures: &[(usize, Option<Procedure>)]) {
    let mut on_rig: Option<(usize, Span)> = None;
    for (block, procedure) in procedures {
        // Without the first one's specimen nothing can be said of those after it.
        let Some(procedure) = procedure else { return };
        let Some(specimen) = procedure.kind.specimen() else { continue };
        let head = checker.scope.blocks[*block].block.head;
        let span = checker.given(*block, "specimen").map_or(head, |(_, entry)| entry.value.span);
        let (first, first_span) = *on_rig.get_or_insert((specimen, span));
        if specimen != first {
            let name = |place| {
                let named = checker.scope.of_kind(Kind::Specimen).nth(place).and_then(|(_, block)| block.name);
                named.map_or("", |name| name.node.as_str())
            };
            let fault = fault::another_specimen(name(specimen), span, name(first), first_span);
            checker.faults.push(fault);
        }
    }
}

/// What drives one actuator cannot drive the several of a frame, and a real rig has as many as it says.
pub fn hold_axes(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    specimens: &[Option<Specimen>],
    rig: Option<&CheckedRig>,
) {
    let on_rig = procedures.iter().find_map(|(_, procedure)| procedure.as_ref()?.kind.specimen()).unwrap_or(0);
    let Some(Some(specimen)) = specimens.get(on_rig) else { return };
    axes::hold_specimen(checker, rig, specimen);
    let storeys = specimen.degrees_of_freedom();
    if storeys == 1 {
        return;
    }
    // A rig that lists its axes is held to them as a whole.
    let one_axis = rig.filter(|rig| rig.block.is_some_and(|block| checker.given(block, "axes").is_none()));
    let one_axis = one_axis.filter(|rig| rig.plan.link.as_real().is_some()).map(|rig| rig.plan.name.clone());
    let declared = checker.scope.of_kind(Kind::Specimen).nth(on_rig).map(|(_, block)| block.block.head);
    for (block, procedure) in procedures {
        let Some(procedure) = procedure else { continue };
        let head = checker.scope.blocks[*block].block.head;
        match procedure.kind {
            ProcedureKind::Shake(_)
            | ProcedureKind::StoreyImpact(_)
            | ProcedureKind::FrameUnload(_)
            | ProcedureKind::Escalate(Escalate { blow: BlowOn::Storey(_), .. }) => {
                checker
                    .faults
                    .extend(one_axis.iter().map(|rig| axis_faults::frame_on_one_axis(&specimen.name, storeys, rig, head)));
            }
            ProcedureKind::Inspect { .. } => {}
            _ => {
                let keyword = procedure.kind.keyword();
                checker.faults.push(frames::one_degree_of_freedom(keyword, &specimen.name, storeys, head, declared));
            }
        }
    }
}

impl Checker<'_> {
    /// The specimen of a procedure as its place in the plan.
    pub fn specimen_of(&mut self, block: usize) -> Option<usize> {
        self.specimen_block(block).map(|specimen| self.scope.place_in_kind(specimen))
    }

    /// The specimen a procedure names, else the only one declared.
    pub fn specimen_block(&mut self, block: usize) -> Option<usize> {
        if self.given(block, "specimen").is_some() {
            return self.reference(block, "specimen", Kind::Specimen);
        }
        let mut declared = self.scope.of_kind(Kind::Specimen);
        match (declared.len(), declared.next()) {
            (1, Some((only, _))) => Some(only),
            (_, None) => {
                self.specimen_needed(block);
                None
            }
            (several, _) => {
                let head = self.scope.blocks[block].block.head;
                let named = |(_, specimen): (usize, &DeclaredBlock<'_>)| {
                    (specimen.name.map(|name| name.node.clone()), specimen.block.head)
                };
                let declared = self.scope.of_kind(Kind::Specimen).map(named).filter_map(|(name, head)| Some((name?, head)));
                let shown: Vec<_> = declared.take(fault::SHOWN).collect();
                self.fail(fault::several_specimens(head, &shown, several))
            }
        }
    }

    /// The same, where what is wrong with it is said by whoever reads the block.
    pub fn tested(&self, block: usize) -> Option<usize> {
        let mut declared = self.scope.of_kind(Kind::Specimen);
        let Some((_, written)) = self.given(block, "specimen") else {
            return declared.next().filter(|_| declared.len() == 0).map(|(only, _)| only);
        };
        let ExprKind::Name(name) = &written.value.kind else { return None };
        match self.scope.meaning(name) {
            Some(Meaning::Block(index)) if self.scope.blocks[index].kind.kind == Kind::Specimen => Some(index),
            _ => None,
        }
    }

    /// Says once that nothing is there to be tested.
    pub fn specimen_needed(&mut self, block: usize) {
        let none = self.scope.of_kind(Kind::Specimen).next().is_none();
        // A block whose keyword is no word of the language may be the one that is missing.
        let said = self.faults.iter().any(|fault| matches!(fault.code, Code::MissingBlock | Code::UnknownBlock));
        if none && !said && !self.names_lost && self.unread.is_empty() {
            let head = self.scope.blocks[block].block.head;
            self.faults.push(names::missing_block(schema::block(Kind::Specimen), head));
        }
    }
}
