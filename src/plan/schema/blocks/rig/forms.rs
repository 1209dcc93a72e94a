//! The values that fields of `rig` can have: a simulated rig, when a reading is settled, the pre-test check, and zero drift, with
//! their arguments.

use super::{NOISE, RESOLUTION, ZERO_DRIFT};
use crate::schema::blocks::devices::LONGEST_WAIT;
use crate::schema::types::{Field, Variant};
use psd_text::units::Dimension;

pub const FORCE_RESOLUTION: Field = Field::quantity(
    "force_resolution",
    Dimension::FORCE,
    "resolution of the force reading",
)
.or(0.0, "N")
.at_least_zero();

pub const LAG: Field = Field::quantity(
    "lag",
    Dimension::TIME,
    "first-order time constant of the actuator",
)
.or(0.0, "s")
.at_least_zero();

pub const TRACKING: Field = Field::quantity(
    "tracking",
    Dimension::NUMBER,
    "fraction of each increment that is not reached",
)
.or(0.0, "")
.within(-1.0, 1.0);

pub const SEED: Field = Field::count(
    "seed",
    0.0,
    9_007_199_254_740_992.0,
    "seed of the random noise",
)
.or(0.0, "");

pub(super) const VIRTUAL: Variant = Variant::with(
    "virtual",
    &[
        Field::quantity(
            NOISE.name,
            Dimension::FORCE,
            "standard deviation of the load cell",
        )
        .or(0.0, "N")
        .at_least_zero(),
        Field::quantity(
            RESOLUTION.name,
            Dimension::LENGTH,
            "resolution of the displacement reading",
        )
        .or(0.0, "mm")
        .at_least_zero(),
        FORCE_RESOLUTION,
        LAG,
        TRACKING,
        Field::quantity(
            ZERO_DRIFT.name,
            Dimension::FORCE_RATE,
            "zero drift of the load cell",
        )
        .or(0.0, "N/s"),
        SEED,
    ],
    "simulated rig: computes the force from the specimen's behaviour",
);

pub const SETTLED_WITHIN: Field = Field::quantity(
    "displacement",
    Dimension::LENGTH,
    "tolerance of the displacement",
)
.required("0.01 mm")
.at_least_zero();

pub const FORCE_RATE: Field = Field::quantity(
    "force_rate",
    Dimension::FORCE_RATE,
    "largest rate of change of the force",
)
.required("5 N/s")
.at_least_zero();

pub const SETTLED_FOR: Field =
    Field::quantity("for", Dimension::TIME, "duration for which both are kept")
        .or(0.0, "s")
        .at_least_zero();

pub const TIMEOUT: Field = Field::quantity(
    "timeout",
    Dimension::TIME,
    "longest wait for a settled reading",
)
.or(10.0, "s")
.above_zero_up_to(LONGEST_WAIT);

pub(super) const SETTLINGS: &[Variant] = &[Variant::with(
    "within",
    &[SETTLED_WITHIN, FORCE_RATE, SETTLED_FOR, TIMEOUT],
    "settled when both tolerances have been kept for this time",
)];

pub const PROBE: Field = Field::quantity(
    "displacement",
    Dimension::LENGTH,
    "displacement of a small move from the start",
)
.required("0.02 mm")
.above_zero();

pub const PROBED_STIFFNESS: Field = Field::interval(
    "stiffness",
    Dimension::STIFFNESS,
    "accepted stiffness; verifies polarity, unit and scale",
)
.required("stiffness: 250 kN/m .. 350 kN/m")
.above_zero();

pub const ZERO_FORCE: Field = Field::quantity(
    "zero",
    Dimension::FORCE,
    "largest absolute force at rest before the move",
)
.required("zero: 20 N")
.above_zero();

pub(super) const PRETEST_CHECKS: &[Variant] = &[Variant::with(
    "probe",
    &[PROBE, PROBED_STIFFNESS, ZERO_FORCE],
    "small move and back that MOVES THE RIG; its stiffness must be as expected",
)];

/// Where the force of a rig is known again when its run is over.
const ZERO_READINGS: &[Variant] = &[
    Variant::word(
        "start",
        "at the start position, to which the rig MOVES back after the test; for an unchanged specimen",
    ),
    Variant::word(
        "free",
        "at the last position, after the operator has freed the specimen from the load cell and confirmed it",
    ),
    Variant::word("nowhere", "no zero reading after the test"),
];

pub const FORCE_DRIFT: Field = Field::quantity(
    "force",
    Dimension::FORCE,
    "largest allowed change of the zero force, absolute",
)
.required("5 N")
.above_zero();

pub const DISPLACEMENT_DRIFT: Field = Field::quantity(
    "displacement",
    Dimension::LENGTH,
    "largest allowed change of (displacement − target), absolute",
)
.above_zero()
.default_in_words("reported, not checked");

pub const OVER: Field = Field::quantity(
    "over",
    Dimension::TIME,
    "averaging time of a zero reading; a dwell of this length also gives a slope",
)
.or(5.0, "s")
.above_zero_up_to(LONGEST_WAIT);

pub const AFTER: Field = Field::choice(
    "after",
    ZERO_READINGS,
    "where the zero is read after the test",
)
.default_in_words("start");

pub(super) const ZERO_DRIFTS: &[Variant] = &[Variant::with(
    "within",
    &[FORCE_DRIFT, DISPLACEMENT_DRIFT, OVER, AFTER],
    "larger zero drift makes requirements on readings inconclusive",
)];
