//! Several blows on one specimen: `unload` between them.

use super::types::{BlockKind, Field, Kind, Naming, ResultKind, RigKind};
use crate::quantity::Dimension;

pub(super) const UNLOAD: BlockKind = BlockKind {
    kind: Kind::Unload,
    keyword: &["unload"],
    naming: Naming::Named,
    procedure: true,
    fields: &[
        Field::reference("specimen", Kind::Specimen, "what is unloaded").or_said("the only one declared"),
        Field::quantity("stiffness", Dimension::STIFFNESS, "with which the force is expected to fall").above_zero().required_on(
            RigKind::Real,
            "stiffness = k0.stiffness",
            "the behaviour's initial stiffness",
        ),
        Field::quantity("within", Dimension::FORCE, "largest force that counts as none")
            .above_zero()
            .or_said("a thousandth of the force at the start, or what noise and resolution can tell"),
        Field::quantity("speed", Dimension::VELOCITY, "actuator speed").above_zero().or_said("the rig's own"),
    ],
    exports: &[],
    results: &[
        ResultKind::new("residual_displacement", Dimension::LENGTH, "where the specimen rests"),
        ResultKind::new("residual_force", Dimension::FORCE, "what it still carries there"),
    ],
    example: "unload rest { }",
    doc: "Takes the load off: moves to where the restoring force is none",
};
