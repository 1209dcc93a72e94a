//! The blocks of the procedures, and the fields and results that several of them have. The block and the results of each are in its
//! folder of `plan::procedures`.

pub mod tracking;

use crate::ProcedureBlock;
use crate::procedures::{
    cycle, damping_sweep, escalate, impact, inspect, move_to, preload, shake, stiffness_ramp,
    unload,
};
use crate::schema::types::{BlockKind, Field, Kind, RigKind};
use psd_text::units::Dimension;

/// Lists the blocks of the procedures in the order of the reference. The compiler asks for each.
macro_rules! blocks {
    ($($procedure:ident: $folder:ident),+ $(,)?) => {
        /// The blocks of the procedures, in the order of the reference.
        pub const BLOCKS: &[&BlockKind] = &[$(&$folder::block::BLOCK),+];

        /// The entry of a procedure.
        pub(in crate::schema) const fn block(procedure: ProcedureBlock) -> &'static BlockKind {
            match procedure {
                $(ProcedureBlock::$procedure => &$folder::block::BLOCK),+
            }
        }
    };
}

blocks! {
    StiffnessRamp: stiffness_ramp,
    DampingSweep: damping_sweep,
    Impact: impact,
    Cycle: cycle,
    Shake: shake,
    Escalate: escalate,
    Unload: unload,
    Move: move_to,
    Preload: preload,
    Inspect: inspect,
}

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
