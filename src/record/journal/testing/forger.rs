//! A forger who has the program: records altered, and every check word after them made anew. In: a whole journal. Out: one
//! whose lines are all sound.

use serde_json::{Value, json};

use super::super::chain::Chain;
use super::super::{EntryKind, body, line, recover};

/// The journal with each body as `alter` leaves it.
pub(crate) fn forged(journal: &[u8], mut alter: impl FnMut(EntryKind, &mut Value)) -> Vec<u8> {
    let (mut out, mut chain) = (Vec::new(), Chain::START);
    for record in recover(journal).expect("a sound journal").lines {
        let mut said = record.body();
        alter(record.kind, &mut said);
        if record.kind == EntryKind::End {
            said["head"] = json!(chain.as_str());
        }
        let start = out.len();
        line::open(&mut out, record.seq, record.kind);
        body::write(&mut out, &said).expect("a record");
        chain = line::close(&mut out, start, &chain);
    }
    out
}
