//! `report { … }`: the files that a run writes for its readers.

use crate::schema::types::{BlockKind, Field, FieldType, Kind, Naming, Variant};

pub const TITLE: Field =
    Field::text("title", "title of the test report").default_in_words("the plan's");

pub const RESULTS: Field = Field::of_type(
    "results",
    FieldType::ResultNames,
    "results on the second page, beside those that a requirement reads",
)
.default_in_words("the headline results of the procedures, six at most");

pub const ANNEXES: Field = Field::choices(
    "annexes",
    &[
        Variant::word("results", "every result, with the method of its procedure"),
        Variant::word("budgets", "uncertainty budgets"),
        Variant::word(
            "figures",
            "the other figures: all that the plan names, or two of each procedure",
        ),
        Variant::word("equipment", "rig, calibration, conditions, limits"),
        Variant::word("provenance", "program, run log, digests of the files"),
        Variant::word("plan", "text of the plan and of its files"),
    ],
    "annexes after the first two pages; `[]`: none",
)
.default_in_words("every annex without `plan`");

pub const FIGURES: Field = Field::figures(
    "figures",
    "figures, each as `figure(procedure)`, or `figure(one, other)` for several procedures on one chart",
)
.default_in_words("all figures");

pub const FORMATS: Field = Field::choices(
    "formats",
    &[
        Variant::word("html", "the test report as a self-contained page"),
        Variant::word(
            "pdf",
            "the same report, with the plan attached; with a date PDF/A-3a",
        ),
        Variant::word("csv", "tables as text"),
        Variant::word("parquet", "tables in binary columns"),
    ],
    "file formats",
)
.default_in_words("all formats");

pub const LOGO: Field = Field::text(
    "logo",
    "picture at the head of the report: a PNG, JPEG or SVG file of up to 2 MiB",
);

pub const PHOTOS: Field = Field::texts(
    "photos",
    "photographs of the specimen: up to 8 such files, in the annex of the figures",
);

pub const SIGN: Field = Field::texts(
    "sign",
    "signatories: one signature line each on the first page; a simulation has none",
);

pub const REPORT: BlockKind = BlockKind {
    kind: Kind::Report,
    keyword: &["report"],
    naming: Naming::Unnamed,
    fields: &[
        TITLE, RESULTS, ANNEXES, FIGURES, FORMATS, LOGO, PHOTOS, SIGN,
    ],
    exports: &[],
    results: &[],
    example: "report { formats = [html, csv] }",
    doc: "Output of a run: formats, figures, signatories",
};
