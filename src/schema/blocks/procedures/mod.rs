//! The procedures of the language, one file each: its block and its results. The list of them is here.

pub(crate) mod base_excitation;
pub(crate) mod cycle;
pub(crate) mod damping_sweep;
pub(crate) mod impact;
pub(crate) mod impact_series;
pub(crate) mod inspect;
pub(crate) mod move_to;
pub(crate) mod stiffness_ramp;
pub(crate) mod tracking;
pub(crate) mod unload;

use crate::schema::types::{BlockKind, Field, Kind, RigKind};
use crate::units::Dimension;

/// The blocks of the procedures, in the order of the reference.
pub(crate) const BLOCKS: &[&BlockKind] = &[
    &stiffness_ramp::BLOCK,
    &damping_sweep::BLOCK,
    &impact::BLOCK,
    &cycle::BLOCK,
    &base_excitation::BLOCK,
    &impact_series::BLOCK,
    &unload::BLOCK,
    &move_to::BLOCK,
    &inspect::BLOCK,
];

pub(crate) const SPECIMEN: Field = Field::specimen("specimen");

pub(crate) const SPEED: Field = Field::speed("speed");

/// The initial stiffness of the specimen, of a procedure that needs it.
pub(crate) const STIFFNESS: Field = Field::quantity(
    "stiffness",
    Dimension::STIFFNESS,
    "initial stiffness K0, before the first tangent",
)
.above_zero()
.required_on(
    RigKind::Real,
    "stiffness = k0.stiffness",
    "the behaviour's initial stiffness",
);

impl Field {
    /// The specimen that a procedure tests.
    pub(crate) const fn specimen(name: &'static str) -> Self {
        Self::reference(name, Kind::Specimen, "specimen under test")
            .default_in_words("the only one declared")
    }

    /// The speed of the actuators.
    pub(crate) const fn speed(name: &'static str) -> Self {
        Self::quantity(name, Dimension::VELOCITY, "actuator speed")
            .above_zero()
            .default_in_words("the rig's own")
    }
}
