//! Multilinear curves that are fitted to readings: the variant that requests one, and its results.

use crate::physics::identification::multilinear_fit::MOST_BREAKS;
use crate::schema::types::{Field, ResultKind, Variant};
use crate::units::Dimension;

#[expect(clippy::cast_precision_loss, reason = "a handful")]
const MOST: f64 = MOST_BREAKS as f64;

pub(crate) const MULTILINEAR: Variant = Variant::with(
    "multilinear",
    &[
        Field::count("breaks", 1.0, MOST, "how many there are").or_said("by the criterion BIC"),
        Field::count(
            "most",
            1.0,
            MOST,
            "breaks that the criterion may choose, at most",
        )
        .or(4.0, ""),
    ],
    "straight stretches that meet at breaks, three points each at least",
);

pub(crate) const BREAKS: ResultKind = ResultKind::measured_list(
    "breaks",
    Dimension::LENGTH,
    "where the stretches of a multilinear curve meet",
);

pub(crate) const BREAK_UNCERTAINTIES: ResultKind = ResultKind::list(
    "break_uncertainties",
    Dimension::LENGTH,
    "standard uncertainty of each of `breaks`",
);

pub(crate) const BREAK_FORCES: ResultKind = ResultKind::measured_list(
    "break_forces",
    Dimension::FORCE,
    "force of the curve at each break",
);

pub(crate) const BREAK_FORCE_UNCERTAINTIES: ResultKind = ResultKind::list(
    "break_force_uncertainties",
    Dimension::FORCE,
    "standard uncertainty of each of `break_forces`",
);

pub(crate) const CURVE_STIFFNESSES: ResultKind = ResultKind::measured_list(
    "curve_stiffnesses",
    Dimension::STIFFNESS,
    "stiffness of each stretch of a multilinear curve",
);

pub(crate) const CURVE_STIFFNESS_UNCERTAINTIES: ResultKind = ResultKind::list(
    "curve_stiffness_uncertainties",
    Dimension::STIFFNESS,
    "standard uncertainty of each of `curve_stiffnesses`",
);
