//! `move`: its block.

use crate::ProcedureBlock;
use crate::schema::procedures::SPEED;
use crate::schema::{BlockKind, Field, Kind, Naming};
use psd_text::units::Dimension;

pub const TO: Field =
    Field::quantity("to", Dimension::LENGTH, "absolute target").required("to = 0 mm");

pub const BLOCK: BlockKind = BlockKind {
    kind: Kind::Procedure(ProcedureBlock::Move),
    keyword: &["move"],
    naming: Naming::Named,
    fields: &[TO, SPEED],
    exports: &[],
    results: &[],
    example: "move home { to = 0 mm }",
    doc: "Move of the actuator to a displacement",
};
