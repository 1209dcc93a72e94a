//! `move`: its block.

use crate::plan::procedure::declaration::fields;
use crate::plan::procedure::move_to::move_fields;
use crate::schema::types::{BlockKind, Field, Kind, Naming};
use crate::units::Dimension;

pub(crate) const BLOCK: BlockKind = BlockKind {
    kind: Kind::Move,
    keyword: &["move"],
    naming: Naming::Named,
    procedure: true,
    fields: move_fields!(fields),
    exports: &[],
    results: &[],
    example: "move home { to = 0 mm }",
    doc: "Moves the actuator to a displacement",
};
