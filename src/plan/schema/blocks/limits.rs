//! `limits { … }`: the limits that no command may exceed.

use crate::schema::types::{BlockKind, Field, Kind, Naming};
use psd_text::units::Dimension;

pub const DISPLACEMENT: Field = Field::bounds(
    "displacement",
    Dimension::LENGTH,
    true,
    "displacement of all targets and readings",
);

pub const FORCE: Field = Field::bounds("force", Dimension::FORCE, true, "force of all readings");

pub const SPEED: Field =
    Field::bounds("speed", Dimension::VELOCITY, false, "speed of the actuator");

pub const INCREMENT: Field = Field::bounds(
    "increment",
    Dimension::LENGTH,
    false,
    "largest change of the target in one step",
);

pub const TRACKING_ERROR: Field = Field::bounds(
    "tracking_error",
    Dimension::LENGTH,
    false,
    "absolute tracking error after settling",
);

pub const ENERGY_ERROR: Field = Field::bounds(
    "energy_error",
    Dimension::NUMBER,
    false,
    "absolute energy error relative to the input energy",
);

pub const TRACKING_ENERGY_ERROR: Field = Field::bounds(
    "tracking_energy_error",
    Dimension::NUMBER,
    false,
    "absolute tracking-error energy relative to the input energy",
)
.default_in_words("5 %");

pub const NRMS_ERROR: Field = Field::bounds(
    "nrms_error",
    Dimension::NUMBER,
    false,
    "rms tracking error relative to rms command, of the run",
);

pub const LIMITS: BlockKind = BlockKind {
    kind: Kind::Limits,
    keyword: &["limits"],
    naming: Naming::MaybeNamed,
    fields: &[
        DISPLACEMENT,
        FORCE,
        SPEED,
        INCREMENT,
        TRACKING_ERROR,
        ENERGY_ERROR,
        TRACKING_ENERGY_ERROR,
        NRMS_ERROR,
    ],
    exports: &[],
    results: &[],
    example: "limits { displacement = -2 mm .. 25 mm }",
    doc: "Safety limits: of the plan, or, if named, of the rigs that refer to it",
};
