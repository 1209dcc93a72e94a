//! A rig on hold after the early end of its run, while the operator still observes it. In: an open rig, its observer, the record. Out:
//! whether the run is to resume. It moves nothing, and the run log is closed: the rig is only polled.

use super::hold_status::{can_go_on, is_held};
use super::question::Stay;
use super::watch::Watcher;
use psd::run::Observer as _;
use psd_plan::record::{Event, EventKind, Outcome, Record};
use psd_rig::Rig;

/// Time between two checks for the operator's choice \[s\]. The rig is not polled in between.
const BREATH: f64 = 0.05;

/// Returns when the operator stops observing the rig. Gives the reason to resume the run, if the operator wants that.
pub fn stay(rig: &mut dyn Rig, watcher: &mut Watcher, record: &Record) -> Option<String> {
    let mut held = is_held(record);
    let unmoved = matches!(record.outcome, Outcome::NotReleased { .. }) && held;
    if record.outcome == Outcome::Completed || unmoved {
        return None;
    }
    loop {
        match watcher.stay(held && can_go_on(record)) {
            Stay::Leave => return None,
            Stay::Resume(reason) => return Some(reason),
            Stay::Wait => {}
        }
        if held && rig.pause(BREATH).is_err() {
            let time = rig.time();
            let Some(halted) = rig.halt() else { continue };
            held = halted.is_held();
            let kind = if held {
                EventKind::Held
            } else {
                EventKind::NotHeld
            };
            watcher.event(&Event {
                time,
                procedure: None,
                step: None,
                kind,
                text: halted.to_string(),
            });
        }
    }
}
