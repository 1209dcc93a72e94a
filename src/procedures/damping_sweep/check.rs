//! `damping sweep NAME { … }`

use crate::language::check::checker::Checker;
use crate::language::check::messages::methods as fault;
use crate::plan::{DampingSweep, ProcedureKind};
use crate::procedures::stepping::mode_check::stops_at_targets;

pub fn damping_sweep(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    read_together(checker, block);
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

/// A sweep reads on the way. Where displacement and force are not of one instant, the way between the two is a force in proportion to
/// the velocity, which no sweep can tell from damping.
fn read_together(checker: &mut Checker, block: usize) {
    let Some(rig) = checker.real_rig else { return };
    let at = checker.scope.blocks[block].block.head;
    let entry = |field| {
        checker
            .field(rig, field)
            .map(|(_, entry)| entry.key.span.to(entry.value.span))
    };
    let apart = match (entry("load_cell"), stops_at_targets(checker, rig)) {
        (Some(cell), _) => Some((
            cell,
            "the force is read here, and the displacement elsewhere".to_owned(),
        )),
        (None, Some(dialect)) => entry("link").or_else(|| entry("actuator")).map(|link| {
            let told = format!(
                "`{dialect}` gives no displacement and force of one instant while it moves"
            );
            (link, told)
        }),
        (None, None) => None,
    };
    if let Some((link, told)) = apart {
        checker.diagnostics.push(fault::read_apart(at, link, told));
    }
}
