//! One axis of a rig of several: the fields that it may have in place of the rig's own, by their names.

use super::forms::PRETEST_CHECKS;
use super::{
    ACTUATOR, CALIBRATION, CALIBRATION_DUE, DISPLACEMENT_CALIBRATION, DISPLACEMENT_CALIBRATION_DUE,
    DISPLACEMENT_CALIBRATION_RANGE, DISPLACEMENT_CLASS, DISPLACEMENT_UNCERTAINTY,
    FORCE_CALIBRATION_RANGE, FORCE_CLASS, FORCE_PER_COUNT, FORCE_RANGE, FORCE_UNCERTAINTY,
    LOAD_CELL, NOISE, POLARITIES, POLARITY, PRETEST_CHECK, RESOLUTION, ZERO_OFFSET,
    ZERO_UNCERTAINTY,
};
use crate::schema::blocks::devices::{SERIAL, TCP};
use crate::schema::blocks::limits;
use crate::schema::types::{Field, Variant};
use psd_text::units::Dimension;

/// The argument of an axis that names its storey.
pub const AXIS_STOREY: &str = "storey";
pub const AXIS_ELEMENT: &str = "element";

/// The argument of an axis that loads a storey along its height.
pub const AXIAL: &str = "axial";

pub const P_DELTA: Field = Field::quantity(
    "p_delta",
    Dimension::NUMBER,
    "share of N u/h in the lateral reading: 100 % if the axial load stays vertical, 0 % if it points at the base of the column",
)
.at_least_zero();

pub const CONTROL: Field = Field::choice(
    "control",
    CONTROLS,
    "controlled quantity of an axial axis; every other axis controls its displacement",
);

pub const CONTROL_RATE: Field = Field::quantity(
    "rate",
    Dimension::FORCE_RATE,
    "rate at which the axial force changes",
)
.required("rate: 5 kN/s")
.above_zero();

pub const CONTROL_TOLERANCE: Field = Field::quantity(
    "tolerance",
    Dimension::FORCE,
    "largest difference of the axial force from its target",
)
.required("tolerance: 0.5 kN")
.above_zero();

const CONTROLS: &[Variant] = &[Variant::with(
    "force",
    &[CONTROL_RATE, CONTROL_TOLERANCE],
    "force control: the controller holds the axial force",
)];

/// The entries of one axis, each in place of the rig's own.
pub(super) const AXIS: &[Variant] = &[Variant::with(
    "axis",
    &[
        Field::choice(
            POLARITY.name,
            POLARITIES,
            "polarity of displacement and force",
        )
        .default_in_words("the rig's"),
        Field::choice(
            PRETEST_CHECK.name,
            PRETEST_CHECKS,
            "pre-test check of the axis",
        )
        .default_in_words("the rig's"),
        Field::choice(
            ACTUATOR.name,
            &[SERIAL, TCP],
            "device that moves the axis, if it is a separate one",
        )
        .default_in_words("the rig's"),
        Field::choice(
            LOAD_CELL.name,
            &[SERIAL, TCP],
            "device that reads the force, if it is a separate one",
        )
        .default_in_words("the rig's"),
        Field::quantity(
            FORCE_PER_COUNT.name,
            Dimension::FORCE,
            "scale factor of a load cell that gives raw counts; not 0",
        )
        .default_in_words("the rig's"),
        Field::quantity(ZERO_OFFSET.name, Dimension::NUMBER, "count at zero force")
            .default_in_words("the rig's"),
        Field::bounds(
            limits::DISPLACEMENT.name,
            Dimension::LENGTH,
            true,
            "limit of its targets and readings, in addition to the limits of the run",
        ),
        Field::bounds(
            limits::FORCE.name,
            Dimension::FORCE,
            true,
            "limit of its readings, in addition to the limits of the run",
        ),
        Field::quantity(
            RESOLUTION.name,
            Dimension::LENGTH,
            "resolution of its displacement reading",
        )
        .at_least_zero()
        .default_in_words("the rig's"),
        Field::quantity(
            NOISE.name,
            Dimension::FORCE,
            "standard deviation of a single force reading",
        )
        .at_least_zero()
        .default_in_words("the rig's"),
        Field::bounds(
            FORCE_RANGE.name,
            Dimension::FORCE,
            true,
            "measuring range of the load cell",
        )
        .default_in_words("the rig's"),
        Field::text(
            CALIBRATION.name,
            "calibration reference; of the force only if the displacement has its own",
        )
        .default_in_words("the rig's"),
        Field::text(CALIBRATION_DUE.name, "calibration due date").default_in_words("the rig's"),
        Field::text(FORCE_CLASS.name, "class of its force measurement")
            .default_in_words("the rig's"),
        Field::bounds(
            FORCE_CALIBRATION_RANGE.name,
            Dimension::FORCE,
            false,
            "calibrated range of absolute force",
        )
        .default_in_words("the rig's"),
        Field::text(
            DISPLACEMENT_CALIBRATION.name,
            "calibration reference of the displacement",
        )
        .default_in_words("the rig's"),
        Field::text(
            DISPLACEMENT_CALIBRATION_DUE.name,
            "due date of the displacement calibration",
        )
        .default_in_words("the rig's"),
        Field::text(
            DISPLACEMENT_CLASS.name,
            "class of its displacement measurement",
        )
        .default_in_words("the rig's"),
        Field::bounds(
            DISPLACEMENT_CALIBRATION_RANGE.name,
            Dimension::LENGTH,
            false,
            "calibrated range of absolute displacement",
        )
        .default_in_words("the rig's"),
        Field::quantity(
            FORCE_UNCERTAINTY.name,
            Dimension::NUMBER,
            "relative standard uncertainty of the force calibration",
        )
        .within(0.0, 0.2)
        .default_in_words("the rig's"),
        Field::quantity(
            DISPLACEMENT_UNCERTAINTY.name,
            Dimension::NUMBER,
            "relative standard uncertainty of the displacement calibration",
        )
        .within(0.0, 0.2)
        .default_in_words("the rig's"),
        Field::quantity(
            ZERO_UNCERTAINTY.name,
            Dimension::FORCE,
            "standard uncertainty of the zero reading of the load cell",
        )
        .at_least_zero()
        .default_in_words("the rig's"),
        Field::count(
            AXIS_STOREY,
            1.0,
            64.0,
            "storey that the axis moves, counted from the ground up",
        )
        .default_in_words("the tested storeys in their order"),
        Field::count(
            AXIS_ELEMENT,
            1.0,
            64.0,
            "element of a frame of matrices that the axis moves, counted from the first",
        )
        .default_in_words("the tested elements in their order"),
        Field::count(
            AXIAL,
            1.0,
            64.0,
            "storey that the axis loads along its height; such axes are last in the list",
        ),
        CONTROL,
        P_DELTA,
    ],
    "actuator with its load cell",
)];
