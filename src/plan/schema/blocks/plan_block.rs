//! `plan "Title" { … }`: the edition of the language and the administrative data of the report.

use crate::schema::types::{BlockKind, Field, Kind, Naming, Variant};

pub const EDITION: Field =
    Field::count("edition", 1.0, f64::INFINITY, "edition of the language").or(1.0, "");

pub const STANDARD: Field = Field::text("standard", "standard or procedure the test follows");

pub const SPECIMEN_ID: Field = Field::text("specimen_id", "the specimen's identification");

pub const LABORATORY: Field = Field::text("laboratory", "laboratory that carries out the test");

pub const ADDRESS: Field = Field::text("address", "address of the laboratory");

pub const CUSTOMER: Field = Field::text("customer", "name of the customer");

pub const CONTACT: Field = Field::text("contact", "contact details of the customer");

pub const OPERATOR: Field = Field::text("operator", "person who carries out the test");

pub const DATE: Field = Field::text(
    "date",
    "date of the test, ISO 8601; without it, the day on which the run begins",
);

pub const ISSUED: Field = Field::text("issued", "day on which the report is issued, ISO 8601");

pub const AUTHORISED_BY: Field = Field::text("authorised_by", "person who authorises the report");

pub const REVISION: Field = Field::text("revision", "revision of the plan");

pub const PROJECT: Field = Field::text("project", "project the test belongs to");

pub const MATERIAL: Field = Field::text("material", "material of the specimen");

pub const EQUIPMENT: Field = Field::text("equipment", "equipment used");

pub const PLACE: Field =
    Field::text("place", "location of the test, if not the laboratory").advanced();

pub const RECEIPT_DATE: Field = Field::text(
    "receipt_date",
    "day on which the specimen was received, ISO 8601",
)
.advanced();

pub const CONDITION: Field = Field::text(
    "condition",
    "condition of the specimen when it was received",
)
.advanced();

pub const TEMPERATURE: Field = Field::text(
    "temperature",
    "temperature during the test, as in `23 degC`; or a string",
);

pub const HUMIDITY: Field = Field::text("humidity", "humidity during the test");

pub const SAMPLING: Field = Field::text(
    "sampling",
    "sampling plan and method, if the specimen was sampled",
)
.advanced();

pub const EXTERNAL: Field = Field::text(
    "external",
    "results from external providers, with their names",
)
.advanced();

pub const VALIDATION: Field = Field::text(
    "validation",
    "reference to the validation of this program on this rig",
)
.advanced();

pub const OPINIONS: Field =
    Field::text("opinions", "opinions and interpretations, with their basis").advanced();

pub const DEVIATIONS: Field = Field::text(
    "deviations",
    "known deviations from the standard or procedure",
);

pub const NOTES: Field = Field::text("notes", "further notes for the report");

pub const DECISION_RULE: Field = Field::choice(
    "decision_rule",
    &[
        Variant::word(
            "simple",
            "simple acceptance: the value decides, unless its U is withheld, or too large for a tolerance (P < 50 %)",
        ),
        Variant::word(
            "guarded",
            "guarded acceptance with w = U = k·u: a value inside the guard band is inconclusive",
        ),
    ],
    "decision rule for requirements",
)
.default_in_words("simple");

pub const PLAN: BlockKind = BlockKind {
    kind: Kind::Plan,
    keyword: &["plan"],
    naming: Naming::Titled,
    fields: &[
        EDITION,
        STANDARD,
        SPECIMEN_ID,
        LABORATORY,
        ADDRESS,
        CUSTOMER,
        CONTACT,
        OPERATOR,
        DATE,
        ISSUED,
        AUTHORISED_BY,
        REVISION,
        PROJECT,
        MATERIAL,
        EQUIPMENT,
        PLACE,
        RECEIPT_DATE,
        CONDITION,
        TEMPERATURE,
        HUMIDITY,
        SAMPLING,
        EXTERNAL,
        VALIDATION,
        OPINIONS,
        DEVIATIONS,
        NOTES,
        DECISION_RULE,
    ],
    exports: &[],
    results: &[],
    example: "plan \"My test\" { edition = 1 }",
    doc: "Title and report data of the plan",
};
