//! `inspect`: its block.

use crate::schema::types::{BlockKind, Field, Kind, Naming};

pub(crate) const BLOCK: BlockKind = BlockKind {
    kind: Kind::Inspect,
    keyword: &["inspect"],
    naming: Naming::Named,
    procedure: true,
    fields: &[Field::text("note", "what to look at")
        .required("note = \"look for cracks at the supports\"")],
    exports: &[],
    results: &[],
    example: "inspect look { note = \"look for cracks\" }",
    doc: "Stops until a person has looked at the specimen",
};
