//! `preload`: its block.

use crate::ProcedureBlock;
use crate::schema::{BlockKind, Field, Kind, Naming, ResultKind};
use psd_text::units::Dimension;

pub const STOREY: Field = Field::count(
    "storey",
    1.0,
    64.0,
    "storey to load, which has an axial axis; counted from the ground up",
)
.required("storey = 1");

pub const FORCE: Field = Field::quantity(
    "force",
    Dimension::FORCE,
    "axial force on the specimen on the rig; positive in compression",
)
.required("force = 262.5 kN")
.above_zero();

pub const AXIAL_FORCE: ResultKind = ResultKind::measured(
    "axial_force",
    Dimension::FORCE,
    "axial force at the end, as measured",
);

pub const AXIAL_DISPLACEMENT: ResultKind = ResultKind::measured(
    "axial_displacement",
    Dimension::LENGTH,
    "displacement of the axial axis at the end; positive if it shortens the storey",
);

/// What it leaves, in the order of the tables and of `summary.json`.
pub const RESULTS: &[ResultKind] = &[AXIAL_FORCE, AXIAL_DISPLACEMENT];

pub const BLOCK: BlockKind = BlockKind {
    kind: Kind::Procedure(ProcedureBlock::Preload),
    keyword: &["preload"],
    naming: Naming::Named,
    fields: &[STOREY, FORCE],
    exports: &[],
    results: RESULTS,
    example: "preload column {\n  storey = 1\n  force = 262.5 kN\n}",
    doc: "Constant axial load on a tested storey, held until `unload`",
};
