//! The procedures of the language, one file each: its block and its results.

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

use crate::schema::types::{Field, Kind, Variant};
use crate::units::Dimension;

pub(crate) const SPECIMEN: Field = Field::specimen("specimen");

pub(crate) const SPEED: Field = Field::speed("speed");

impl Field {
    /// The specimen that a procedure tests.
    pub(crate) const fn specimen(name: &'static str) -> Self {
        Self::reference(name, Kind::Specimen, "what is tested").or_said("the only one declared")
    }

    /// The speed of the actuators.
    pub(crate) const fn speed(name: &'static str) -> Self {
        Self::quantity(name, Dimension::VELOCITY, "actuator speed")
            .above_zero()
            .or_said("the rig's own")
    }
}

pub(crate) const INSPECT_TRIGGERS: &[Variant] = &[
    Variant::with(
        "every",
        &[Field::count("steps", 1.0, 1e7, "steps between looks").required("20")],
        "every so many steps",
    ),
    Variant::with(
        "force_drop",
        &[Field::quantity(
            "fraction",
            Dimension::NUMBER,
            "of the largest restoring force so far",
        )
        .required("10 %")
        .within(0.0, 1.0)],
        "when the restoring force has fallen",
    ),
    Variant::with(
        "at",
        &[Field::quantity("time", Dimension::TIME, "virtual time")
            .required("5 ms")
            .at_least_zero()],
        "at a virtual time",
    ),
];
