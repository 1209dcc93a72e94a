//! `plan "Title" { … }`: the edition of the language and the administrative data of the report.

use crate::schema::types::{BlockKind, Field, Kind, Naming, Variant};

pub(crate) const PLAN: BlockKind = BlockKind {
    kind: Kind::Plan,
    keyword: &["plan"],
    naming: Naming::Titled,
    procedure: false,
    fields: &[
        Field::count("edition", 1.0, f64::INFINITY, "edition of the language").or(1.0, ""),
        Field::text("standard", "standard or procedure the test follows"),
        Field::text("specimen_id", "the specimen's identification"),
        Field::text("laboratory", "laboratory that tests"),
        Field::text("address", "address of the laboratory"),
        Field::text("customer", "who asked for the test"),
        Field::text("contact", "how the customer is reached"),
        Field::text("operator", "who runs the test"),
        Field::text("date", "date of the test, ISO 8601"),
        Field::text("issued", "day on which the report is issued, ISO 8601"),
        Field::text("authorised_by", "who authorises the report"),
        Field::text("revision", "revision of the plan"),
        Field::text("project", "project the test belongs to"),
        Field::text("material", "material of the specimen"),
        Field::text("equipment", "equipment used"),
        Field::text("place", "where the test is made, if not in the laboratory"),
        Field::text("receipt_date", "day on which the specimen was received, ISO 8601"),
        Field::text("condition", "condition of the specimen when it was received"),
        Field::text("temperature", "temperature during the test, with its unit"),
        Field::text("humidity", "humidity during the test"),
        Field::text("sampling", "sampling plan and method, where the specimen was sampled"),
        Field::text("external", "results that come from somebody else, and from whom"),
        Field::text("validation", "where the validation of this program on this rig is on record"),
        Field::text("opinions", "opinions and interpretations, and what they rest on"),
        Field::text("deviations", "known deviations from the standard or procedure"),
        Field::text("notes", "remarks for the certificate"),
        Field::choice(
            "decision_rule",
            &[
                Variant::word("simple", "the value decides, whatever its uncertainty"),
                Variant::word(
                    "guarded",
                    "a value passes or fails only if it is further from its limit than its expanded uncertainty U = k·u, and is inconclusive else",
                ),
            ],
            "how a value is held against a limit",
        )
        .or_said("simple"),
    ],
    exports: &[],
    results: &[],
    example: "plan \"My test\" { edition = 1 }",
    doc: "Title and certificate data of the plan",
};
