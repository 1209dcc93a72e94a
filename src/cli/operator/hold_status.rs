//! Whether a run that ended early left its rig on hold, and whether it can be resumed. In: the record.

use psd_plan::record::UNLOADING;
use psd_plan::record::{EventKind, Record};

/// Whether the rig was at rest in its last reading.
pub fn is_held(record: &Record) -> bool {
    let last = record
        .events
        .iter()
        .rev()
        .find(|event| matches!(event.kind, EventKind::Held | EventKind::NotHeld));
    last.is_none_or(|event| event.kind == EventKind::Held)
}

/// Whether the run had begun, and the specimen has not moved since.
pub fn can_go_on(record: &Record) -> bool {
    let unloaded = record
        .events
        .iter()
        .any(|event| event.kind == EventKind::Hold && event.text == UNLOADING);
    !record.procedures.is_empty() && !unloaded
}
