//! `move`: its block.

use crate::ProcedureBlock;
use crate::move_fields;
use crate::schema::{BlockKind, Field, Kind, Naming};
use crate::{fields, names};
use psd_text::units::Dimension;

move_fields!(names);

pub const BLOCK: BlockKind = BlockKind {
    kind: Kind::Procedure(ProcedureBlock::Move),
    keyword: &["move"],
    naming: Naming::Named,
    fields: move_fields!(fields),
    exports: &[],
    results: &[],
    example: "move home { to = 0 mm }",
    doc: "Move of the actuator to a displacement",
};
