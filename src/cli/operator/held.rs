//! A rig that holds after the early end of its run, and the person who still looks at it. In: an open rig, who watches it, what was
//! recorded. Out: whether the run is to go on. It moves nothing, and the record is closed: the rig is only heard from.

use std::path::Path;

use super::watch::{Stay, Watcher};
use crate::cli::args::ResumeArguments;
use crate::cli::commands::resume::resume;
use crate::cli::exit::{Exit, Failure};
use crate::cli::files::record_file;
use crate::cli::output::print_message;
use crate::cli::settings::Settings;
use crate::record::{Event, EventKind, Outcome, Record};
use crate::rig::Rig;
use crate::run::replay::Recorded;
use crate::run::{Observer as _, UNLOADING};

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

/// Whether the rig was seen at rest in the end.
pub fn is_held(record: &Record) -> bool {
    let last = record
        .events
        .iter()
        .rev()
        .find(|event| matches!(event.kind, EventKind::Held | EventKind::NotHeld));
    last.is_none_or(|event| event.kind == EventKind::Held)
}

/// Whether the run had begun, and its specimen is still where it was.
pub fn can_go_on(record: &Record) -> bool {
    let unloaded = record
        .events
        .iter()
        .any(|event| event.kind == EventKind::Hold && event.text == UNLOADING);
    !record.procedures.is_empty() && !unloaded
}

/// Goes on with the run, as `psd resume` does, for the person who has looked at the rig all the time. None: it was refused, and the
/// record is what it was.
pub fn go_on(
    folder: &Path,
    operator: &str,
    reason: String,
    recorded: &Recorded,
    settings: Settings,
) -> Result<Option<Exit>, Failure> {
    let arguments = ResumeArguments {
        run: folder.to_owned(),
        operator: operator.to_owned(),
        reason,
        plan: None,
        amend: false,
        re_referenced: false,
        same_power_up: true,
        let_go: true,
        accept_relaxation: false,
        yes: false,
    };
    match resume(&arguments, settings) {
        Ok(exit) => Ok(Some(exit)),
        Err(failure) => {
            let head = record_file::read(folder).map(|read| read.recovered.head().to_owned());
            let unchanged = recorded
                .sealed
                .as_ref()
                .is_some_and(|(_, sealed)| head.is_ok_and(|head| head == *sealed));
            if !unchanged {
                return Err(failure);
            }
            print_message(&failure.report(settings));
            Ok(None)
        }
    }
}
