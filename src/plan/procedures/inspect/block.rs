//! `inspect`: its block.

use crate::ProcedureBlock;
use crate::schema::{BlockKind, Field, Kind, Naming};

pub const NOTE: Field = Field::text("note", "instruction to the operator")
    .required("note = \"look for cracks at the supports\"");

pub const BLOCK: BlockKind = BlockKind {
    kind: Kind::Procedure(ProcedureBlock::Inspect),
    keyword: &["inspect"],
    naming: Naming::Named,
    fields: &[NOTE],
    exports: &[],
    results: &[],
    example: "inspect look { note = \"look for cracks\" }",
    doc: "Pause until the operator has inspected the specimen",
};
