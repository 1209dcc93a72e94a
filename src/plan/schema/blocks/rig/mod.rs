//! `rig NAME { … }`: the rig that moves the specimen. Its readers name the fields by these constants.

mod axis;
mod forms;

use super::devices::{LONGEST_WAIT, SERIAL, TCP};
use crate::schema::types::{BlockKind, Field, Kind, Naming, RigKind, Variant};
use axis::AXIS;
pub use axis::{
    AXIAL, AXIS_ELEMENT, AXIS_STOREY, CONTROL, CONTROL_RATE, CONTROL_TOLERANCE, P_DELTA,
};
pub use forms::{
    AFTER, DISPLACEMENT_DRIFT, FORCE_DRIFT, FORCE_RATE, FORCE_RESOLUTION, LAG, OVER, PROBE,
    PROBED_STIFFNESS, SEED, SETTLED_FOR, SETTLED_WITHIN, TIMEOUT, TRACKING, ZERO_FORCE,
};
use forms::{PRETEST_CHECKS, SETTLINGS, VIRTUAL, ZERO_DRIFTS};
use psd_text::units::Dimension;

const POLARITIES: &[Variant] = &[
    Variant::word(
        "positive",
        "positive displacement of the rig is in the direction of impact, as in the plan",
    ),
    Variant::word(
        "negative",
        "positive displacement of the rig is against the direction of impact",
    ),
];

/// The zero of the plan's displacements.
const DATUMS: &[Variant] = &[
    Variant::word(
        "machine",
        "zero of the rig; psd refuses to start at another position",
    ),
    Variant::word(
        "here",
        "position of the rig at the start of the run, with the specimen unloaded; logged",
    ),
];

pub const LINK: Field = Field::choice(
    "link",
    &[VIRTUAL, SERIAL, TCP],
    "connection to the rig; or separate `actuator` and `load_cell`",
)
.required("link = virtual(noise: 2 N, seed: 7)");

pub const ACTUATOR: Field =
    Field::choice("actuator", &[SERIAL, TCP], "device that moves").of_real_rigs();

pub const LOAD_CELL: Field =
    Field::choice("load_cell", &[SERIAL, TCP], "device that reads the force").of_real_rigs();

pub const SETTLE: Field = Field::choice("settle", SETTLINGS, "when a reading is settled")
    .required_on(
        RigKind::Real,
        "settle = within(0.01 mm, 5 N/s, for: 0.3 s)",
        "immediately",
    );

pub const SAFE_STATE: Field = Field::choice(
    "safe_state",
    &[
        Variant::word("hold", "stops and keeps the load"),
        Variant::word(
            "unload",
            "holds; after a limit, MOVES back to the start of the run; after a stop by \
                 the operator, MOVES only if confirmed",
        ),
    ],
    "action when a run ends early",
)
.required_on(RigKind::Real, "safe_state = hold", "")
.of_real_rigs();

pub const PRETEST_CHECK: Field = Field::choice(
    "pretest_check",
    PRETEST_CHECKS,
    "pre-test check before the first step",
)
.required_on(
    RigKind::Real,
    "pretest_check = probe(0.02 mm, stiffness: 250 kN/m .. 350 kN/m, zero: 20 N)",
    "",
)
.of_real_rigs();

pub const ZERO_DRIFT: Field = Field::choice(
    "zero_drift",
    ZERO_DRIFTS,
    "largest zero drift during a run, and how zeros are read",
)
.default_in_words("not checked");

pub const LIMITS: Field = Field::reference(
    "limits",
    Kind::Limits,
    "named `limits` block that applies to every motion of this rig",
);

pub const AXES: Field = Field::choices(
    "axes",
    AXIS,
    "actuators with their load cells, one per tested storey from the ground up; then the axial ones",
)
.default_in_words("one axis");

pub const POLARITY: Field =
    Field::choice("polarity", POLARITIES, "polarity of displacement and force")
        .default_in_words("positive");

pub const DATUM: Field = Field::choice(
    "datum",
    DATUMS,
    "position at which the plan's displacement is zero",
)
.default_in_words("machine")
.of_real_rigs();

pub const SPEED: Field = Field::quantity(
    "speed",
    Dimension::VELOCITY,
    "speed of moves without a speed of their own",
)
.or(1.0, "mm/s")
.above_zero()
.of_real_rigs();

pub const WATCHDOG: Field = Field::quantity(
    "watchdog",
    Dimension::TIME,
    "longest time without communication; the rig must then hold",
)
.or(3.0, "s")
.above_zero_up_to(LONGEST_WAIT)
.of_real_rigs()
.advanced();

pub const RATE: Field = Field::quantity(
    "rate",
    Dimension::FREQUENCY,
    "readings per second while settling",
)
.or(20.0, "Hz")
.above_zero_up_to(1e4)
.of_real_rigs()
.advanced();

pub const SAMPLES: Field = Field::count(
    "samples",
    1.0,
    999.0,
    "number of settled readings, of which the median is used; odd",
)
.or(3.0, "")
.of_real_rigs()
.advanced();

pub const FROZEN_AFTER: Field = Field::count(
    "frozen_after",
    2.0,
    1e6,
    "identical consecutive force readings during motion that trip the frozen-sensor check",
)
.or(8.0, "")
.of_real_rigs()
.advanced();

pub const RESOLUTION: Field = Field::quantity(
    "resolution",
    Dimension::LENGTH,
    "resolution of the displacement reading",
)
.or(0.0, "mm")
.at_least_zero()
.of_real_rigs();

pub const NOISE: Field = Field::quantity(
    "noise",
    Dimension::FORCE,
    "standard deviation of a single force reading",
)
.or(0.0, "N")
.at_least_zero()
.of_real_rigs();

pub const FORCE_RANGE: Field = Field::bounds(
    "force_range",
    Dimension::FORCE,
    true,
    "measuring range of the load cell; a reading at its ends is saturated",
)
.of_real_rigs();

pub const FORCE_PER_COUNT: Field = Field::quantity(
    "force_per_count",
    Dimension::FORCE,
    "scale factor of a load cell that gives raw counts; not 0",
)
.of_real_rigs();

pub const ZERO_OFFSET: Field = Field::quantity(
    "zero_offset",
    Dimension::NUMBER,
    "count at zero force, of a load cell that gives raw counts",
)
.or(0.0, "")
.of_real_rigs();

pub const FORCE_UNCERTAINTY: Field = Field::quantity(
    "force_uncertainty",
    Dimension::NUMBER,
    "relative standard uncertainty of the force calibration",
)
.or(0.0, "%")
.within(0.0, 0.2);

pub const DISPLACEMENT_UNCERTAINTY: Field = Field::quantity(
    "displacement_uncertainty",
    Dimension::NUMBER,
    "relative standard uncertainty of the displacement calibration",
)
.or(0.0, "%")
.within(0.0, 0.2);

pub const ZERO_UNCERTAINTY: Field = Field::quantity(
    "zero_uncertainty",
    Dimension::FORCE,
    "standard uncertainty of the zero reading of the load cell",
)
.or(0.0, "N")
.at_least_zero();

pub const CALIBRATION: Field = Field::text(
    "calibration",
    "calibration reference; of the force only if `displacement_calibration` is given",
);

pub const CALIBRATION_DUE: Field =
    Field::text("calibration_due", "calibration due date, `YYYY-MM-DD`");

pub const FORCE_CLASS: Field = Field::text(
    "force_class",
    "class of the force measurement, for example of ISO 7500-1",
);

pub const FORCE_CALIBRATION_RANGE: Field = Field::bounds(
    "force_calibration_range",
    Dimension::FORCE,
    false,
    "calibrated range of absolute force; required for a test report",
)
.default_in_words("not stated");

pub const DISPLACEMENT_CALIBRATION: Field = Field::text(
    "displacement_calibration",
    "calibration reference of the displacement, if separate",
);

pub const DISPLACEMENT_CALIBRATION_DUE: Field = Field::text(
    "displacement_calibration_due",
    "due date of the displacement calibration, `YYYY-MM-DD`",
);

pub const DISPLACEMENT_CLASS: Field = Field::text(
    "displacement_class",
    "class of the displacement measurement, for example of ISO 9513",
);

pub const DISPLACEMENT_CALIBRATION_RANGE: Field = Field::bounds(
    "displacement_calibration_range",
    Dimension::LENGTH,
    false,
    "calibrated range of absolute displacement; required for a test report",
)
.default_in_words("not stated");

pub const RIG: BlockKind = BlockKind {
    kind: Kind::Rig,
    keyword: &["rig"],
    naming: Naming::Named,
    fields: &[
        LINK,
        ACTUATOR,
        LOAD_CELL,
        SETTLE,
        SAFE_STATE,
        PRETEST_CHECK,
        ZERO_DRIFT,
        LIMITS,
        AXES,
        POLARITY,
        DATUM,
        SPEED,
        WATCHDOG,
        RATE,
        SAMPLES,
        FROZEN_AFTER,
        RESOLUTION,
        NOISE,
        FORCE_RANGE,
        FORCE_PER_COUNT,
        ZERO_OFFSET,
        FORCE_UNCERTAINTY,
        DISPLACEMENT_UNCERTAINTY,
        ZERO_UNCERTAINTY,
        CALIBRATION,
        CALIBRATION_DUE,
        FORCE_CLASS,
        FORCE_CALIBRATION_RANGE,
        DISPLACEMENT_CALIBRATION,
        DISPLACEMENT_CALIBRATION_DUE,
        DISPLACEMENT_CLASS,
        DISPLACEMENT_CALIBRATION_RANGE,
    ],
    exports: &[],
    results: &[],
    example: "rig simulated { link = virtual(noise: 2 N, seed: 7) }",
    doc: "Simulated rig, or real hardware, which MOVES only if `--rig` names it",
};
