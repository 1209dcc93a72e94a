//! How the actuators of a specimen were followed, as every procedure that integrates results in it: of several actuators, energies and
//! areas add, of the others the largest counts; and the same of the actuator of each floor.

use crate::schema::types::ResultKind;
use crate::units::Dimension;

pub(crate) const TRACKING_ENERGY_ERROR: ResultKind = ResultKind::new(
    "tracking_energy_error",
    Dimension::NUMBER,
    "energy that following wrongly took out of the test (put in: negative), over the input energy, at its largest",
);

pub(crate) const TRACKING_INDICATOR: ResultKind = ResultKind::new(
    "tracking_indicator",
    Dimension::AREA,
    "area that command against measurement encloses; falling: the actuator lags",
);

pub(crate) const NRMS_ERROR: ResultKind = ResultKind::new(
    "nrms_error",
    Dimension::NUMBER,
    "tracking error over command, root mean squares",
);

pub(crate) const PEAK_ERROR: ResultKind = ResultKind::new(
    "peak_error",
    Dimension::LENGTH,
    "largest measured less commanded displacement, by size",
);

pub(crate) const FLOOR_TRACKING_ENERGY_ERROR: ResultKind = ResultKind::list(
    "floor_tracking_energy_error",
    Dimension::NUMBER,
    "of each floor's actuator: energy that following wrongly took out (put in: negative), over the input energy, at its largest",
);

pub(crate) const FLOOR_TRACKING_INDICATOR: ResultKind = ResultKind::list(
    "floor_tracking_indicator",
    Dimension::AREA,
    "of each floor's actuator: the tracking indicator",
);

pub(crate) const FLOOR_NRMS_ERROR: ResultKind = ResultKind::list(
    "floor_nrms_error",
    Dimension::NUMBER,
    "of each floor's actuator: tracking error over command",
);

pub(crate) const FLOOR_PEAK_ERROR: ResultKind = ResultKind::list(
    "floor_peak_error",
    Dimension::LENGTH,
    "of each floor's actuator: largest tracking error, by size",
);
