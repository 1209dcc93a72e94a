//! `damping sweep NAME { … }`

use super::checker::Checker;
use crate::plan::{DampingSweep, ProcedureKind};

pub fn damping_sweep(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    let specimen = checker.specimen_of(block);
    let velocities = checker.quantities(block, "velocities");
    let stroke = checker.quantity(block, "stroke");
    let about = checker.optional(block, "about");
    let stiffness = checker.quantity(block, "stiffness");
    let rate = checker.optional(block, "rate");
    Some(ProcedureKind::DampingSweep(DampingSweep {
        specimen: specimen?,
        velocities: velocities?,
        stroke: stroke?,
        about: about?,
        stiffness: stiffness?,
        rate: rate?,
    }))
}
