//! A rig that holds after the early end of its run, and the person who still looks at it. In: an open rig, who watches it, what was
//! recorded. Out: whether the run is to go on. It moves nothing, and the record is closed: the rig is only heard from.

use super::hold_status::{can_go_on, is_held};
use super::watch::{Stay, Watcher};
use crate::record::{Event, EventKind, Outcome, Record};
use crate::rig::Rig;
use crate::run::Observer as _;

/// How long the rig is left alone between two looks at what the person wants, s.
const BREATH: f64 = 0.05;

/// Stays as long as somebody looks at the rig. Gives the reason for which the run is to go on, where it is to.
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
