//! `reproduces NAME { … }`: a number of the run beside one that was published.

use crate::schema::types::{BlockKind, Field, FieldType, Kind, Naming};

pub const VALUE: Field = Field::of_type(
    "value",
    FieldType::Formula,
    "number of the run, as in `require`",
)
.required("value = hit.max_displacement");

pub const PUBLISHED: Field = Field::of_type(
    "published",
    FieldType::Formula,
    "published number, in a unit of `value`",
)
.required("published = 0.157 m");

pub const TOLERANCE: Field = Field::of_type(
    "tolerance",
    FieldType::Tolerance,
    "largest difference; `%` is of the published number",
)
.required("tolerance = 1 %");

pub const SOURCE: Field = Field::text("source", "publication, with its figure, table or equation")
    .required("source = \"Melo et al. 2006, example 1\"");

pub const REPRODUCES: BlockKind = BlockKind {
    kind: Kind::Reproduces,
    keyword: &["reproduces"],
    naming: Naming::Named,
    fields: &[VALUE, PUBLISHED, TOLERANCE, SOURCE],
    exports: &[],
    results: &[],
    example: "reproduces peak { value = hit.max_displacement, published = 0.157 m, tolerance = 1 %, source = \"…\" }",
    doc: "Comparison of a number of the run with a published one. It states the difference. It is not a requirement and not a statement on a specimen",
};
