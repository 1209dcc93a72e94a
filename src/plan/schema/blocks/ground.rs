//! The block `ground`. Its reader, `language::check::declarations::ground`, names the fields by these constants.

use crate::schema::types::{BlockKind, Field, Kind, Naming};
use psd_text::units::Dimension;

pub const FILE: Field = Field::texts(
    "file",
    "CSV file with the header `time_s,acceleration_m_per_s2`, or an `.AT2` file of the PEER database; or a list of them, from which \
     `record_number` chooses",
)
.required("file = \"ground.csv\"");

pub const RECORD_NUMBER: Field = Field::count(
    "record_number",
    1.0,
    1000.0,
    "number of the file in the list, from 1; a study draws it: `record_number ~ any`",
)
.or(1.0, "");

pub const SCALE: Field =
    Field::quantity("scale", Dimension::NUMBER, "factor on the accelerations").or(1.0, "");

pub const SCALE_UNCERTAINTY: Field = Field::quantity(
    "scale_uncertainty",
    Dimension::NUMBER,
    "relative standard uncertainty of the accelerations",
)
.or(0.0, "%")
.within(0.0, 0.2);

pub const UNIT: Field = Field::quantity(
    "unit",
    Dimension::ACCELERATION,
    "unit of the accelerations, if the header does not state it",
)
.above_zero()
.default_in_words("stated in the header");

pub const GROUND: BlockKind = BlockKind {
    kind: Kind::Ground,
    keyword: &["ground"],
    naming: Naming::Named,
    fields: &[FILE, RECORD_NUMBER, SCALE, SCALE_UNCERTAINTY, UNIT],
    exports: &[],
    results: &[],
    example: "ground quake { file = \"ground.csv\" }",
    doc: "Ground motion from a file",
};
