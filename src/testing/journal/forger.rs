//! A forger who uses the program: entries are altered, and all check values after them are recalculated. In: a whole run log. Out: a run
//! log whose lines are all valid.

use serde_json::{Value, json};

use super::recover;
use psd_rig::journal::chain::Chain;
use psd_rig::journal::{EntryKind, body, line};

/// The entries of a run log, in the form that [`written`] accepts.
pub fn records(journal: &[u8]) -> Vec<(EntryKind, Value)> {
    let lines = recover(journal).expect("a sound journal").lines;
    lines.iter().map(|line| (line.kind, line.body())).collect()
}

/// The run log of these entries: numbers, count, chain and checksums are correct.
pub fn written(records: impl IntoIterator<Item = (EntryKind, Value)>) -> Vec<u8> {
    let (mut out, mut chain) = (Vec::new(), Chain::START);
    for ((kind, mut body), seq) in records.into_iter().zip(1_u64..) {
        if kind == EntryKind::End && body.is_object() {
            (body["count"], body["head"]) = (json!(seq - 1), json!(chain.as_str()));
        }
        let start = out.len();
        line::open(&mut out, seq, kind);
        body::write(&mut out, &body).expect("a record");
        chain = line::close(&mut out, start, &chain);
    }
    out
}

/// The run log with each body altered by `alter`.
pub fn forged(journal: &[u8], mut alter: impl FnMut(EntryKind, &mut Value)) -> Vec<u8> {
    let altered = records(journal).into_iter().map(|(kind, mut body)| {
        alter(kind, &mut body);
        (kind, body)
    });
    written(altered)
}
