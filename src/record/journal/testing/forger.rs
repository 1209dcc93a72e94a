//! A forger who has the program: entries altered, and every check word after them made again. In: a whole run log. Out: one
//! whose lines are all valid.

use serde_json::{Value, json};

use super::super::chain::Chain;
use super::super::{EntryKind, body, line, recover};

/// The records of a journal, as they count in [`written`].
pub(crate) fn records(journal: &[u8]) -> Vec<(EntryKind, Value)> {
    let lines = recover(journal).expect("a sound journal").lines;
    lines.iter().map(|line| (line.kind, line.body())).collect()
}

/// The journal of these records: numbers, count, chain and checksums are right.
pub(crate) fn written(records: impl IntoIterator<Item = (EntryKind, Value)>) -> Vec<u8> {
    let (mut out, mut chain) = (Vec::new(), Chain::START);
    for ((kind, mut said), seq) in records.into_iter().zip(1_u64..) {
        if kind == EntryKind::End && said.is_object() {
            (said["count"], said["head"]) = (json!(seq - 1), json!(chain.as_str()));
        }
        let start = out.len();
        line::open(&mut out, seq, kind);
        body::write(&mut out, &said).expect("a record");
        chain = line::close(&mut out, start, &chain);
    }
    out
}

/// The journal with each body as `alter` leaves it.
pub(crate) fn forged(journal: &[u8], mut alter: impl FnMut(EntryKind, &mut Value)) -> Vec<u8> {
    let altered = records(journal).into_iter().map(|(kind, mut said)| {
        alter(kind, &mut said);
        (kind, said)
    });
    written(altered)
}
