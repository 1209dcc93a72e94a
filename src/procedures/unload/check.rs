//! `unload NAME { … }`: of one degree of freedom, or of all floors or elements of a frame together.

use crate::procedures::common::violations::NoUseOnAFrame;
use psd_language::check::checker::Checker;
use psd_language::check::declarations::specimen::frame;
use psd_plan::procedures::unload::block as schema;
use psd_plan::schema::procedures::{SPEED, STIFFNESS};
use psd_plan::{ProcedureKind, Unload};

pub fn unload(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    let tested = checker.specimen_block(block);
    let specimen = tested.map(|tested| checker.scope.index_in_kind(tested));
    let of_frame = tested.is_some_and(|tested| frame::is_frame(checker, tested));
    let stiffness = if of_frame {
        Some(None)
    } else {
        checker.stiffness_or_specimens(block, tested).map(Some)
    };
    let (within, speed) = (
        checker.optional(block, schema::WITHIN.name),
        checker.optional(block, SPEED.name),
    );
    if let (true, Some((_, entry))) = (of_frame, checker.field(block, STIFFNESS.name)) {
        let frame = tested.and_then(|tested| frame::frame(checker, tested));
        let help = if frame.is_some_and(|frame| frame.has_elements()) {
            "remove it: the elements of the frame have stiffnesses"
        } else {
            "remove it: the storeys of the frame have stiffnesses"
        };
        return checker.fail(NoUseOnAFrame {
            field: STIFFNESS.name,
            of: "the unloading of a frame",
            at: entry.key.span,
            help,
        });
    }
    let keep_axial_load = checker
        .word(block, schema::KEEP_AXIAL_LOAD.name, "false")
        .map(|word| word == "true");
    Some(ProcedureKind::Unload(Unload {
        specimen: specimen?,
        stiffness: stiffness?,
        within: within?,
        speed: speed?,
        keep_axial_load: keep_axial_load?,
    }))
}
