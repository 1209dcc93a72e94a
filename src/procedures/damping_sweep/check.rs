//! `damping sweep NAME { … }`

use crate::language::check::checker::Checker;
use crate::language::check::messages::methods as fault;
use crate::plan::procedure::damping_sweep::damping_sweep_fields;
use crate::plan::procedure::declaration::reader;
use crate::plan::{DampingSweep, ProcedureKind};
use crate::procedures::read_field::ReadField;
use crate::procedures::stepping::mode_check::stops_at_targets;

pub fn damping_sweep(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    read_together(checker, block);
    read(checker, block).map(ProcedureKind::DampingSweep)
}

damping_sweep_fields!(reader);

/// Refuses a rig that does not read displacement and force at one instant. A sweep reads in motion: the travel between the two instants
/// gives a force proportional to the velocity, which cannot be distinguished from damping.
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
            let reason = format!(
                "`{dialect}` gives no displacement and force of one instant while it moves"
            );
            (link, reason)
        }),
        (None, None) => None,
    };
    if let Some((link, reason)) = apart {
        checker
            .diagnostics
            .push(fault::read_apart(at, link, reason));
    }
}
