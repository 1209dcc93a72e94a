//! Motion of the actuators: force correction, mode of motion, tracking error. In: the stepping and tracking of a procedure. Out:
//! sentences. They describe the method; they are not deviations from it.

use crate::report::number::{self, small_percent};
use crate::report::wording::actuators as wording;
use psd_physics::tracking::monitor::Tracking;
use psd_plan::Mode;
use psd_text::units::Dimension;

/// Tracking errors below this are rounding \[m\].
pub(super) const ROUNDING: f64 = 1e-12;

/// Force correction and mode of motion, if they differ from plain ramp-and-hold.
pub(crate) fn motion(i_modification: bool, mode: Mode) -> Vec<String> {
    let mut sentences = Vec::new();
    if i_modification {
        sentences.push(wording::I_MODIFICATION.to_owned());
    }
    if let Mode::Continuous { time_scale } = mode {
        sentences.push(wording::continuous(number::text(
            time_scale,
            Dimension::NUMBER,
        )));
    }
    sentences
}

/// The tracking error of an actuator, or of several together. `energy` is the error's energy as a signed fraction of the input.
pub(crate) fn tracking_error(tracking: Tracking, energy: Option<f64>, subject: &str) -> String {
    if tracking.peak_error < ROUNDING {
        return wording::at_every_target(subject);
    }
    let energy = energy.map_or_else(String::new, |energy| {
        let direction = if energy < 0.0 {
            wording::PUT_IN
        } else {
            wording::REMOVED
        };
        wording::energy(direction, small_percent(energy.abs()))
    });
    wording::tracking(
        number::text(tracking.peak_error, Dimension::LENGTH),
        small_percent(tracking.nrms_error),
        energy,
    )
}
