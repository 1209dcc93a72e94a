//! `golden { … }`: how near a rerun must come to the accepted results.

use crate::schema::types::{BlockKind, Field, FieldType, Kind, Naming, Variant};
use psd_text::units::Dimension;

pub const WITHIN: Field =
    Field::of_type("within", FieldType::Tolerance, "largest difference").required("1 us");

pub const RESULT: Field = Field::of_type(
    "result",
    FieldType::ResultName,
    "result; its uncertainty is compared with the same tolerance",
)
.required("hit.stop_time");

pub const COLUMN: Field = Field::of_type(
    "column",
    FieldType::ColumnName,
    "column, of one procedure or of all",
)
.required("hit.restoring_force_n");

const RESULT_TOLERANCE: &[Variant] = &[Variant::with(
    "tolerance",
    &[RESULT, WITHIN],
    "tolerance of this result",
)];

const COLUMN_TOLERANCE: &[Variant] = &[Variant::with(
    "tolerance",
    &[COLUMN, WITHIN],
    "tolerance of this column",
)];

pub const TOLERANCE: Field = Field::quantity(
    "tolerance",
    Dimension::NUMBER,
    "for every number, relative to its value; in a column, relative to the largest value",
)
.or(1e-9, "")
.within(0.0, 1.0);

pub const RESULTS: Field = Field::choices(
    "results",
    RESULT_TOLERANCE,
    "results with a separate tolerance",
);

pub const COLUMNS: Field = Field::choices(
    "columns",
    COLUMN_TOLERANCE,
    "columns of tables with a separate tolerance",
);

pub const GOLDEN: BlockKind = BlockKind {
    kind: Kind::Golden,
    keyword: &["golden"],
    naming: Naming::Unnamed,
    fields: &[TOLERANCE, RESULTS, COLUMNS],
    exports: &[],
    results: &[],
    example: "golden { tolerance = 1e-9 }",
    doc: "Tolerances of the comparison with accepted results",
};
