//! How the actuators moved and followed: what was corrected, the mode, and what tracking did to the energy. In: a procedure's
//! stepping and tracking. Out: sentences. These are items of the method, not deviations from it.

use super::super::number;
use crate::physics::tracking::monitor::Tracking;
use crate::plan::Mode;
use crate::units::Dimension;

/// Errors below this, m, are rounding.
pub(super) const NOTHING: f64 = 1e-12;

/// How the actuators went, and what was made of the readings.
pub(crate) fn driven(i_modification: bool, mode: Mode) -> Vec<String> {
    let mut sentences = Vec::new();
    if i_modification {
        sentences.push(
            "The force was corrected to where the specimen was to be, r* = r − K(d measured − d commanded), with the initial \
             stiffness (I-modification)."
                .to_owned(),
        );
    }
    if let Mode::Continuous { time_scale } = mode {
        sentences.push(format!(
            "The actuator did not stop at the steps: it moved at {} times the virtual time, and what a damper of the specimen does \
             at that speed is in the restoring force.",
            number::text(time_scale, Dimension::NUMBER)
        ));
    }
    sentences
}

/// What following wrongly did, where it did anything that can be told from rounding; `share` is that of the input energy, signed.
pub(crate) fn followed(found: Tracking, share: Option<f64>, who: &str) -> String {
    if found.peak_error < NOTHING {
        return format!("{who} stood at every target.");
    }
    let energy = share.map_or_else(String::new, |share| {
        let does = if share < 0.0 {
            "put into the test"
        } else {
            "taken out of it"
        };
        format!(
            ", energy {does} by following wrongly {}\u{a0}% of the input",
            number::text(100.0 * share.abs(), Dimension::NUMBER)
        )
    });
    format!(
        "Tracking: largest error {}, NRMS error {}\u{a0}%{energy}.",
        number::text(found.peak_error, Dimension::LENGTH),
        number::text(100.0 * found.nrms_error, Dimension::NUMBER)
    )
}
