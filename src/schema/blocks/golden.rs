//! `golden { … }`: how near a rerun must come to the accepted results.

use crate::schema::types::{BlockKind, Field, FieldType, Kind, Naming, Variant};
use crate::units::Dimension;

const WITHIN: Field = Field::of_type("within", FieldType::Tolerance, "how near").required("1 us");

const NEAR_RESULT: &[Variant] = &[Variant::with(
    "near",
    &[
        Field::of_type(
            "result",
            FieldType::ResultName,
            "the result; its uncertainty is held alike",
        )
        .required("hit.stop_time"),
        WITHIN,
    ],
    "a tolerance of its own",
)];

const NEAR_COLUMN: &[Variant] = &[Variant::with(
    "near",
    &[
        Field::of_type(
            "column",
            FieldType::ColumnName,
            "the column, of one procedure or of all",
        )
        .required("hit.restoring_force_n"),
        WITHIN,
    ],
    "a tolerance of its own",
)];

pub(crate) const GOLDEN: BlockKind = BlockKind {
    kind: Kind::Golden,
    keyword: &["golden"],
    naming: Naming::Unnamed,
    procedure: false,
    fields: &[
        Field::quantity(
            "tolerance",
            Dimension::NUMBER,
            "of every number, relative to its size, of a column to its largest",
        )
        .or(1e-9, "")
        .within(0.0, 1.0),
        Field::choices(
            "results",
            NEAR_RESULT,
            "results with a tolerance of their own",
        ),
        Field::choices(
            "columns",
            NEAR_COLUMN,
            "columns of tables with a tolerance of their own",
        ),
    ],
    exports: &[],
    results: &[],
    example: "golden { tolerance = 1e-9 }",
    doc: "How near a rerun must come to the blessed results",
};
