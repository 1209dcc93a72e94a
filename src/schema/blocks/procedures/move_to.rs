//! `move`: its block.

use super::SPEED;
use crate::schema::types::{BlockKind, Field, Kind, Naming};
use crate::units::Dimension;

pub(crate) const BLOCK: BlockKind = BlockKind {
    kind: Kind::Move,
    keyword: &["move"],
    naming: Naming::Named,
    procedure: true,
    fields: &[
        Field::quantity("to", Dimension::LENGTH, "absolute target").required("to = 0 mm"),
        SPEED,
    ],
    exports: &[],
    results: &[],
    example: "move home { to = 0 mm }",
    doc: "Moves the actuator to a displacement",
};
