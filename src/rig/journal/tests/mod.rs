//! Tests of the run log: written here, then read back whole, cut or altered.

mod altered;
mod power;
mod round_trip;
mod torn;
mod writing;

use serde_json::{Value, json};

use super::{Durability, EntryKind, Journal, Recovered};
use crate::testing::journal::PowerLoss;
use crate::testing::journal::recover;

/// A run log that was begun on a disk in memory.
fn begun(durability: Durability) -> (PowerLoss, Journal) {
    let disk = PowerLoss::new();
    let mut journal = Journal::create(Box::new(disk.clone()), durability);
    journal
        .append(EntryKind::Header, &json!({"plan": "é", "@": "J"}))
        .unwrap();
    (disk, journal)
}

/// Two steps from HEADER to END, as a run writes them.
fn small() -> Vec<u8> {
    let (disk, mut journal) = begun(Durability::EverySyncPoint);
    for step in 1..3 {
        journal
            .append(EntryKind::Intent, &json!({"step": step, "target": 1e-3}))
            .unwrap();
        journal
            .append(EntryKind::Sample, &json!({"step": step, "force": -0.1}))
            .unwrap();
        journal
            .append(
                EntryKind::Step,
                &json!({"step": step, "x": [0.1, 5e-324], "text": "J @ *"}),
            )
            .unwrap();
    }
    journal.end(&json!({"outcome": "completed"})).unwrap();
    drop(journal);
    disk.written()
}

/// The lines of a run log, each with its LF.
fn lines(journal: &[u8]) -> Vec<Vec<u8>> {
    journal
        .split_inclusive(|byte| *byte == b'\n')
        .map(<[u8]>::to_vec)
        .collect()
}

/// Kinds and bodies read back.
fn records(recovered: &Recovered) -> Vec<(EntryKind, Value)> {
    recovered
        .lines
        .iter()
        .map(|line| (line.kind, line.body()))
        .collect()
}

/// Whether a run log is complete, from HEADER to END.
fn is_clean(journal: &[u8]) -> bool {
    recover(journal).is_ok_and(|recovered| recovered.ended && recovered.torn.is_none())
}
