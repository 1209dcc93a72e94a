//! `move`: its block.

use crate::plan::ProcedureBlock;
use crate::plan::declaration::{fields, names};
use crate::plan::procedures::move_to::parameters::move_fields;
use crate::schema::{BlockKind, Field, Kind, Naming};
use crate::units::Dimension;

move_fields!(names);

pub(crate) const BLOCK: BlockKind = BlockKind {
    kind: Kind::Procedure(ProcedureBlock::Move),
    keyword: &["move"],
    naming: Naming::Named,
    fields: move_fields!(fields),
    exports: &[],
    results: &[],
    example: "move home { to = 0 mm }",
    doc: "Move of the actuator to a displacement",
};
