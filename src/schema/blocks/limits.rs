//! `limits { … }`: the limits that no command may exceed.

use crate::schema::types::{BlockKind, Field, Kind, Naming};
use crate::units::Dimension;

pub(crate) const LIMITS: BlockKind = BlockKind {
    kind: Kind::Limits,
    keyword: &["limits"],
    naming: Naming::MaybeNamed,
    procedure: false,
    fields: &[
        Field::bounds("displacement", Dimension::LENGTH, true, "of every target and reading"),
        Field::bounds("force", Dimension::FORCE, true, "of every reading"),
        Field::bounds("speed", Dimension::VELOCITY, false, "of the actuator"),
        Field::bounds("increment", Dimension::LENGTH, false, "largest change of target in one step"),
        Field::bounds("tracking_error", Dimension::LENGTH, false, "measured less target, by size, after settling"),
        Field::bounds("energy_error", Dimension::NUMBER, false, "energy error over the input energy, by size"),
        Field::bounds(
            "tracking_energy_error",
            Dimension::NUMBER,
            false,
            "energy that following wrongly puts into the test or takes out, over the input energy, by size",
        )
        .or_said("5 %"),
        Field::bounds("nrms_error", Dimension::NUMBER, false, "tracking error over command, root mean squares of the run"),
    ],
    exports: &[],
    results: &[],
    example: "limits { displacement = -2 mm .. 25 mm }",
    doc: "What nothing may drive the rig past: of the plan, or, with a name, of the rigs that name it",
};
