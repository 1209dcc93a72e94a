//! Multilinear curves that are fitted to readings: the variant that requests one, and its results.

use crate::schema::types::{Field, ResultKind, Variant};
use psd_physics::identification::multilinear_fit::MOST_BREAKS;
use psd_text::units::Dimension;

#[expect(clippy::cast_precision_loss, reason = "a handful")]
const MOST: f64 = MOST_BREAKS as f64;

pub const BREAK_COUNT: Field =
    Field::count("breaks", 1.0, MOST, "number of breakpoints").default_in_words("chosen by BIC");

pub const LARGEST_BREAK_COUNT: Field = Field::count(
    "most",
    1.0,
    MOST,
    "largest number of breakpoints that BIC may choose",
)
.or(4.0, "")
.advanced();

pub const MULTILINEAR: Variant = Variant::with(
    "multilinear",
    &[BREAK_COUNT, LARGEST_BREAK_COUNT],
    "straight segments that meet at breakpoints, at least three points each",
);

pub const BREAKS: ResultKind = ResultKind::measured_list(
    "breaks",
    Dimension::LENGTH,
    "breakpoints of a multilinear curve",
);

pub const BREAK_FORCES: ResultKind = ResultKind::measured_list(
    "break_forces",
    Dimension::FORCE,
    "force of the curve at each breakpoint",
);

pub const CURVE_STIFFNESSES: ResultKind = ResultKind::measured_list(
    "curve_stiffnesses",
    Dimension::STIFFNESS,
    "stiffness of each segment of a multilinear curve",
);
