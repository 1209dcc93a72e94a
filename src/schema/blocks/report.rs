//! `report { … }`: the files that a run writes for its readers.

use crate::schema::types::{BlockKind, Field, Kind, Naming, Variant};

pub(crate) const REPORT: BlockKind = BlockKind {
    kind: Kind::Report,
    keyword: &["report"],
    naming: Naming::Unnamed,
    procedure: false,
    fields: &[
        Field::text("title", "title of the certificate").or_said("the plan's"),
        Field::figures("figures", "what is drawn, each as `figure(procedure)`, or `figure(one, other)` for several on one chart")
            .or_said("every figure"),
        Field::choices(
            "formats",
            &[
                Variant::word("html", "a self-contained certificate"),
                Variant::word("pdf", "the same certificate on paper"),
                Variant::word("csv", "tables as text"),
                Variant::word("parquet", "tables in columns"),
            ],
            "what is written",
        )
        .or_said("every format"),
        Field::texts("sign", "who signs: a line each on the certificate"),
    ],
    exports: &[],
    results: &[],
    example: "report { formats = [html, csv] }",
    doc: "What a run leaves for people",
};
