//! The block `striker`. Its reader, `language::check::declarations::striker`, names the fields by these constants.

use crate::schema::types::{BlockKind, Field, Kind, Naming, ResultKind};
use psd_text::units::Dimension;

pub const MASS: Field = Field::quantity("mass", Dimension::MASS, "mass of the striker")
    .required("mass = 20 kg")
    .above_zero();

pub const MASS_UNCERTAINTY: Field = Field::quantity(
    "mass_uncertainty",
    Dimension::MASS,
    "standard uncertainty of the mass",
)
.or(0.0, "kg")
.at_least_zero();

pub const VELOCITY: Field = Field::quantity(
    "velocity",
    Dimension::VELOCITY,
    "initial velocity, towards the structure; or `drop_height`, or `arm` and `angle`",
)
.above_zero()
.default_in_words("sqrt(2 gn * drop_height), or sqrt(2 gn * arm * (1 - cos(angle)))");

pub const VELOCITY_UNCERTAINTY: Field = Field::quantity(
    "velocity_uncertainty",
    Dimension::VELOCITY,
    "standard uncertainty of the velocity, however it is given",
)
.or(0.0, "m/s")
.at_least_zero();

pub const DROP_HEIGHT: Field = Field::quantity(
    "drop_height",
    Dimension::LENGTH,
    "drop height that gives the velocity",
)
.above_zero();

pub const ARM: Field = Field::quantity(
    "arm",
    Dimension::LENGTH,
    "length of a pendulum, to its centre of mass",
)
.above_zero();

pub const ANGLE: Field = Field::quantity(
    "angle",
    Dimension::ANGLE,
    "release angle of a pendulum, from its position at rest",
)
.above_zero_up_to(std::f64::consts::PI);

pub const GRAVITY: Field = Field::quantity(
    "gravity",
    Dimension::ACCELERATION,
    "acceleration in the direction of impact: `1 gn` for a falling weight",
)
.or(0.0, "m/s^2")
.at_least_zero();

pub const GAP: Field = Field::quantity(
    "gap",
    Dimension::LENGTH,
    "initial distance to the structure",
)
.or(0.0, "mm")
.at_least_zero();

pub const STRIKER: BlockKind = BlockKind {
    kind: Kind::Striker,
    keyword: &["striker"],
    naming: Naming::Named,
    fields: &[
        MASS,
        MASS_UNCERTAINTY,
        VELOCITY,
        VELOCITY_UNCERTAINTY,
        DROP_HEIGHT,
        ARM,
        ANGLE,
        GRAVITY,
        GAP,
    ],
    exports: &[
        ResultKind::new(MASS.name, Dimension::MASS, "mass of the striker"),
        ResultKind::new(VELOCITY.name, Dimension::VELOCITY, "initial velocity"),
        ResultKind::new(
            "energy",
            Dimension::ENERGY,
            "initial kinetic energy, ½ m v²",
        ),
        ResultKind::new(
            DROP_HEIGHT.name,
            Dimension::LENGTH,
            "drop height, v² / (2 gn)",
        ),
        ResultKind::new(
            GAP.name,
            Dimension::LENGTH,
            "initial distance to the structure",
        ),
    ],
    results: &[],
    example: "striker pendulum {\n  mass = 20 kg\n  velocity = 1 m/s\n}",
    doc: "Simulated body that strikes the structure",
};
