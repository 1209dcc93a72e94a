//! The block `ground`. Its reader, `language::check::declarations::ground`, names the fields by these constants.

use crate::schema::types::{BlockKind, Field, Kind, Naming};
use crate::units::Dimension;

pub(crate) const RECORD: Field = Field::text(
            "record",
            "file: a table with the header `time_s,acceleration_m_per_s2`, or an `.AT2` file of the PEER database",
        )
        .required("record = \"ground.csv\"");

pub(crate) const SCALE: Field =
    Field::quantity("scale", Dimension::NUMBER, "factor on the record").or(1.0, "");

pub(crate) const SCALE_UNCERTAINTY: Field = Field::quantity(
    "scale_uncertainty",
    Dimension::NUMBER,
    "standard uncertainty of the accelerations, of them",
)
.or(0.0, "%")
.within(0.0, 0.2);

pub(crate) const UNIT: Field = Field::quantity(
    "unit",
    Dimension::ACCELERATION,
    "what 1 in the record is worth, where its header does not say",
)
.above_zero()
.or_said("as its header says");

pub(crate) const GROUND: BlockKind = BlockKind {
    kind: Kind::Ground,
    keyword: &["ground"],
    naming: Naming::Named,
    procedure: false,
    fields: &[RECORD, SCALE, SCALE_UNCERTAINTY, UNIT],
    exports: &[],
    results: &[],
    example: "ground quake { record = \"ground.csv\" }",
    doc: "The motion of the ground, from a file",
};
