//! Cross-sections in expressions: `rectangle(width: 60 mm, depth: 12 mm)`, and the numbers that each has: `.second_moment`.

use super::types::{Field, ResultKind, Variant};
use psd_text::units::Dimension;

pub const WIDTH: Field = length("width", "across the load").required("width: 60 mm");
pub const DEPTH: Field = length("depth", "along the load").required("depth: 12 mm");
pub const DIAMETER: Field = length("diameter", "outer diameter").required("diameter: 60 mm");
pub const THICKNESS: Field =
    length("thickness", "of the wall; half of the diameter if solid").required("thickness: 4 mm");
pub const FLANGE_THICKNESS: Field =
    length("flange_thickness", "of each flange").required("flange_thickness: 8 mm");
pub const WEB_THICKNESS: Field =
    length("web_thickness", "of the web").required("web_thickness: 5 mm");

const fn length(name: &'static str, doc: &'static str) -> Field {
    Field::quantity(name, Dimension::LENGTH, doc).above_zero()
}

/// The shapes.
pub const SECTIONS: &[Variant] = &[
    Variant::with("rectangle", &[WIDTH, DEPTH], "solid rectangle"),
    Variant::with("pipe", &[DIAMETER, THICKNESS], "round pipe"),
    Variant::with(
        "i_section",
        &[WIDTH, DEPTH, FLANGE_THICKNESS, WEB_THICKNESS],
        "symmetric I without fillets, bent about its strong axis",
    ),
];

pub const AREA: ResultKind = ResultKind::new("area", Dimension::AREA, "A");
pub const SECOND_MOMENT: ResultKind = ResultKind::new(
    "second_moment",
    Dimension::SECOND_MOMENT,
    "I about the neutral axis",
);
pub const PLASTIC_MODULUS: ResultKind = ResultKind::new(
    "plastic_modulus",
    Dimension::SECTION_MODULUS,
    "Z; the plastic moment is Z times the yield stress",
);

/// The numbers of each section.
pub const VALUES: &[ResultKind] = &[AREA, SECOND_MOMENT, PLASTIC_MODULUS];
