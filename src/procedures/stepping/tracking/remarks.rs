//! Observes the energy that tracking errors add to a test or remove from it. In: its fraction of the input energy, step by step. Out: one
//! event, and the largest fraction. It stops nothing: the guard does.

use crate::physics::tracking::monitor::WARN;
use crate::record::EventKind;
use crate::run::session::Session;
use crate::units::display::significant;

#[derive(Debug, Default)]
pub(crate) struct Watch {
    /// Energy error of tracking over the input, signed: the peak absolute value so far.
    pub worst: Option<f64>,
    warned: bool,
}

impl Watch {
    /// Records once that tracking adds or removes more energy than usual practice accepts.
    pub(crate) fn assess(&mut self, share: Option<f64>, session: &mut Session<'_>) {
        let Some(share) = share else { return };
        if self.worst.is_none_or(|worst| share.abs() > worst.abs()) {
            self.worst = Some(share);
        }
        // A narrower limit has a proportionally lower warning threshold.
        let warn = WARN.min(0.4 * session.guard.tracking_energy_limit().high);
        if share.abs() > warn && !self.warned {
            self.warned = true;
            let does = if share < 0.0 {
                "puts energy into"
            } else {
                "takes energy out of"
            };
            let text = format!(
                "tracking {does} the test: {} % of the input energy",
                significant(100.0 * share.abs(), 2)
            );
            session.event(EventKind::Remark, text);
        }
    }
}
