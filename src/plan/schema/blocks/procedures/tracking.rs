//! How the actuators of a specimen were followed, as every procedure that integrates results in it: of several actuators, energies and
//! areas add, of the others the largest counts; and the same of the actuator of each floor.

use crate::schema::types::ResultKind;
use psd_text::units::Dimension;

pub const TRACKING_ENERGY_ERROR: ResultKind = ResultKind::new(
    "tracking_energy_error",
    Dimension::NUMBER,
    "peak energy error due to actuator tracking, relative to the input energy; negative = energy added (destabilising)",
)
.in_percent();

pub const TRACKING_INDICATOR: ResultKind = ResultKind::new(
    "tracking_indicator",
    Dimension::AREA,
    "area enclosed by command against measurement; falling: the actuator lags",
);

pub const NRMS_ERROR: ResultKind = ResultKind::new(
    "nrms_error",
    Dimension::NUMBER,
    "rms tracking error relative to rms command",
)
.in_percent();

pub const PEAK_ERROR: ResultKind = ResultKind::new(
    "peak_error",
    Dimension::LENGTH,
    "peak absolute tracking error",
);

pub const FLOOR_TRACKING_ENERGY_ERROR: ResultKind = ResultKind::list(
    "floor_tracking_energy_error",
    Dimension::NUMBER,
    "`tracking_energy_error` of each floor's or element's actuator",
)
.in_percent()
.of_each_member();

pub const FLOOR_TRACKING_INDICATOR: ResultKind = ResultKind::list(
    "floor_tracking_indicator",
    Dimension::AREA,
    "`tracking_indicator` of each floor's or element's actuator",
)
.of_each_member();

pub const FLOOR_NRMS_ERROR: ResultKind = ResultKind::list(
    "floor_nrms_error",
    Dimension::NUMBER,
    "`nrms_error` of each floor's or element's actuator",
)
.in_percent()
.of_each_member();

pub const FLOOR_PEAK_ERROR: ResultKind = ResultKind::list(
    "floor_peak_error",
    Dimension::LENGTH,
    "`peak_error` of each floor's or element's actuator",
)
.of_each_member();
