//! `unload`: its block and results.

use crate::ProcedureBlock;
use crate::schema::methods::TRUTH;
use crate::schema::procedures::{SPECIMEN, SPEED, STIFFNESS};
use crate::schema::{BlockKind, Field, Kind, Naming, ResultKind};
use psd_text::units::Dimension;

pub const RESIDUAL_DISPLACEMENT: ResultKind = ResultKind::measured(
    "residual_displacement",
    Dimension::LENGTH,
    "unloaded position; of a frame, the largest of all floors or elements",
);

pub const RESIDUAL_FORCE: ResultKind = ResultKind::measured(
    "residual_force",
    Dimension::FORCE,
    "remaining force there; of a frame, the largest of a floor or element",
);

pub const FLOOR_DISPLACEMENT: ResultKind = ResultKind::measured_list(
    "floor_displacement",
    Dimension::LENGTH,
    "unloaded position of each floor; not of elements",
)
.of_storey();

pub const RESIDUAL_DRIFT: ResultKind = ResultKind::measured_list(
    "residual_drift",
    Dimension::LENGTH,
    "drift of each unloaded storey, or deformation of each element",
)
.of_storey()
.of_each_member();

pub const RESIDUAL_SHEAR: ResultKind = ResultKind::measured_list(
    "residual_shear",
    Dimension::FORCE,
    "remaining shear of each storey, or force of each element",
)
.of_storey()
.of_each_member();

/// What it leaves, in the order of the tables and of `summary.json`.
pub const RESULTS: &[ResultKind] = &[
    RESIDUAL_DISPLACEMENT,
    RESIDUAL_FORCE,
    FLOOR_DISPLACEMENT,
    RESIDUAL_DRIFT,
    RESIDUAL_SHEAR,
];

pub const WITHIN: Field = Field::quantity(
    "within",
    Dimension::FORCE,
    "largest force that counts as zero; of a frame, on a floor or element",
)
.above_zero()
.default_in_words("0.1 % of the initial force, or the smallest detectable force if larger");

pub const KEEP_AXIAL_LOAD: Field = Field::choice(
    "keep_axial_load",
    TRUTH,
    "whether the axial load of a `preload` stays on",
)
.default_in_words("false");

pub const BLOCK: BlockKind = BlockKind {
    kind: Kind::Procedure(ProcedureBlock::Unload),
    keyword: &["unload"],
    naming: Naming::Named,
    fields: &[
        SPECIMEN.described("specimen to unload"),
        STIFFNESS.described("expected unloading stiffness; the storeys of a frame have their own"),
        WITHIN,
        SPEED,
        KEEP_AXIAL_LOAD,
    ],
    exports: &[],
    results: RESULTS,
    example: "unload rest { }",
    doc: "Move to zero restoring force; of a frame, all floors or elements together",
};
