//! `unload`: its block and results.

use crate::schema::types::{BlockKind, Field, Kind, Naming, ResultKind, RigKind};
use crate::units::Dimension;

pub(crate) const RESIDUAL_DISPLACEMENT: ResultKind = ResultKind::measured(
    "residual_displacement",
    Dimension::LENGTH,
    "where the specimen rests; of a frame, the floor that rests farthest out",
);

pub(crate) const RESIDUAL_FORCE: ResultKind = ResultKind::measured(
    "residual_force",
    Dimension::FORCE,
    "what it still carries there; of a frame, the floor that carries most",
);

pub(crate) const FLOOR_DISPLACEMENT: ResultKind = ResultKind::measured_list(
    "floor_displacement",
    Dimension::LENGTH,
    "where each floor rests",
)
.of_storey();

pub(crate) const RESIDUAL_DRIFT: ResultKind = ResultKind::measured_list(
    "residual_drift",
    Dimension::LENGTH,
    "each storey's drift there",
)
.of_storey();

pub(crate) const RESIDUAL_SHEAR: ResultKind = ResultKind::measured_list(
    "residual_shear",
    Dimension::FORCE,
    "what each storey still carries there",
)
.of_storey();

/// What it leaves, in the order of the tables and of `summary.json`.
pub(crate) const RESULTS: &[ResultKind] = &[
    RESIDUAL_DISPLACEMENT,
    RESIDUAL_FORCE,
    FLOOR_DISPLACEMENT,
    RESIDUAL_DRIFT,
    RESIDUAL_SHEAR,
];

pub(crate) const BLOCK: BlockKind = BlockKind {
    kind: Kind::Unload,
    keyword: &["unload"],
    naming: Naming::Named,
    procedure: true,
    fields: &[
        Field::reference("specimen", Kind::Specimen, "what is unloaded")
            .or_said("the only one declared"),
        Field::quantity(
            "stiffness",
            Dimension::STIFFNESS,
            "with which the force is expected to fall; the storeys of a frame have their own",
        )
        .above_zero()
        .required_on(
            RigKind::Real,
            "stiffness = k0.stiffness",
            "the behaviour's initial stiffness",
        ),
        Field::quantity(
            "within",
            Dimension::FORCE,
            "largest force, of a frame that of a floor, that counts as none",
        )
        .above_zero()
        .or_said("a thousandth of the force at the start, or what noise and resolution can tell"),
        Field::quantity("speed", Dimension::VELOCITY, "actuator speed")
            .above_zero()
            .or_said("the rig's own"),
    ],
    exports: &[],
    results: RESULTS,
    example: "unload rest { }",
    doc: "Takes the load off: moves to where the restoring force is none, of a frame all floors together",
};
