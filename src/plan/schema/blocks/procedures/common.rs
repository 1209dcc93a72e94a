//! Fields that several procedures have.

use crate::schema::types::{Field, Kind, RigKind};
use psd_text::units::Dimension;

pub const SPECIMEN: Field = Field::specimen("specimen");

pub const SPEED: Field = Field::speed("speed");

/// The initial stiffness of the specimen, of a procedure that needs it.
pub const STIFFNESS: Field = Field::quantity(
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
    pub const fn specimen(name: &'static str) -> Self {
        Self::reference(name, Kind::Specimen, "specimen under test")
            .default_in_words("the only one declared")
    }

    /// The speed of the actuators.
    pub const fn speed(name: &'static str) -> Self {
        Self::quantity(name, Dimension::VELOCITY, "actuator speed")
            .above_zero()
            .default_in_words("the rig's own")
    }
}
