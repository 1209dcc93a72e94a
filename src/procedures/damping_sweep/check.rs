//! `damping sweep NAME { … }`

use crate::codes::E654;
use crate::procedures::stepping::check::mode_check::{beside_no_axial_axis, stops_at_targets};
use psd_language::check::checker::Checker;
use psd_plan::procedures::damping_sweep::block as schema;
use psd_plan::schema::rig;
use psd_plan::{DampingSweep, ProcedureKind};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

pub fn damping_sweep(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    read_together(checker, block);
    // All fields are read before one fails, so that all errors are reported at once.
    let specimen = checker.specimen_of(block);
    let velocities = checker.quantities(block, schema::VELOCITIES.name);
    let stroke = checker.quantity(block, schema::STROKE.name);
    let about = checker.optional(block, schema::ABOUT.name);
    let stiffness = checker.quantity(block, schema::STIFFNESS.name);
    let rate = checker.optional(block, schema::RATE.name);
    Some(ProcedureKind::DampingSweep(DampingSweep {
        specimen: specimen?,
        velocities: velocities?,
        stroke: stroke?,
        about: about?,
        stiffness: stiffness?,
        rate: rate?,
    }))
}

#[derive(Violation)]
#[violation(
    E654,
    "a damping sweep requires simultaneous readings of displacement and force"
)]
#[help(
    "write a damping value, as in `damping = 6 N*s/m`, or use one `native` device for both readings"
)]
struct ReadApart {
    #[label("read one after the other")]
    sweep: Span,
    #[label("{}", label)]
    link: Span,
    label: String,
}

/// Refuses a rig that does not read displacement and force at one instant. A sweep reads in motion: the travel between the two instants
/// gives a force proportional to the velocity, which cannot be distinguished from damping.
fn read_together(checker: &mut Checker, block: usize) {
    let Some(rig) = checker.real_rig else { return };
    let at = checker.scope.blocks[block].block.head;
    beside_no_axial_axis(checker, at);
    let entry = |field| {
        checker
            .field(rig, field)
            .map(|(_, entry)| entry.key.span.to(entry.value.span))
    };
    let apart = match (entry(rig::LOAD_CELL.name), stops_at_targets(checker, rig)) {
        (Some(cell), _) => Some((cell, "force read here, displacement elsewhere".to_owned())),
        (None, Some(dialect)) => entry(rig::LINK.name)
            .or_else(|| entry(rig::ACTUATOR.name))
            .map(|link| {
                let reason = format!("`{dialect}` has no simultaneous readings during motion");
                (link, reason)
            }),
        (None, None) => None,
    };
    if let Some((link, reason)) = apart {
        checker.report(ReadApart {
            sweep: at,
            link,
            label: reason,
        });
    }
}
