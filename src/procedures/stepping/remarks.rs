//! What tracking puts into a test or takes out of it, said once it is worth a remark. In: its share of the input energy, step
//! by step. Out: an event, and the worst share. It stops nothing: that is the guard's.

use crate::physics::impact::energy::UNBALANCED;
use crate::physics::tracking::monitor::WARN;
use crate::record::EventKind;
use crate::run::session::Session;
use crate::units::display::significant;

#[derive(Debug, Default)]
pub(crate) struct Watch {
    /// Energy error of tracking over the input, the largest by size so far, signed.
    pub worst: Option<f64>,
    warned: bool,
}

impl Watch {
    /// Says once that tracking makes or takes more energy than the field lets pass unsaid.
    pub(crate) fn judge(&mut self, share: Option<f64>, session: &mut Session<'_>) {
        let Some(share) = share else { return };
        if self.worst.is_none_or(|worst| share.abs() > worst.abs()) {
            self.worst = Some(share);
        }
        // A limit narrower than the usual one is warned of as early in proportion.
        let warn = WARN.min(0.4 * session.guard.tracking_energy_limit().high);
        if share.abs() > warn && !self.warned {
            self.warned = true;
            let does = if share < 0.0 {
                "puts energy into"
            } else {
                "takes energy out of"
            };
            let text = format!(
                "tracking {does} the test: {} % of the input",
                significant(100.0 * share.abs(), 2)
            );
            session.event(EventKind::Remark, text);
        }
    }
}

/// Says that the scheme made or lost more of the energy than a reader may take for the specimen's.
pub(crate) fn unbalanced(energy_error: f64, session: &mut Session<'_>) {
    if energy_error.is_nan() || energy_error.abs() > UNBALANCED {
        let off = if energy_error.is_nan() {
            "the energy balance cannot be computed: its energies are not finite".to_owned()
        } else {
            format!(
                "the energy balance is off by {} % of the energy put in",
                significant(100.0 * energy_error, 3)
            )
        };
        let text = format!("{off}: a shorter time step is needed");
        session.event(EventKind::Remark, text);
    }
}
