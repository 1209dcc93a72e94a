//! Every entry that is written is read back; bytes that were never written are never accepted.

use std::io::Write as _;

use proptest::prelude::*;
use serde_json::Value;

use super::super::{Durability, EntryKind, LogText, Recovered};
use super::{begun, records, small};
use crate::testing::journal::recover;

/// JSON of every shape, with text of any characters and floats with any bits except NaN and infinity.
fn json() -> impl Strategy<Value = Value> {
    let float = any::<u64>()
        .prop_map(f64::from_bits)
        .prop_filter("JSON has no such number", |float| float.is_finite());
    let edge = prop::sample::select(vec![
        0.0,
        -0.0,
        f64::MIN_POSITIVE,
        5e-324,
        f64::MAX,
        f64::MIN,
        0.1,
        1e15,
        1e16,
        9_007_199_254_740_993.0,
    ]);
    let text = any::<Vec<char>>().prop_map(|characters| characters.into_iter().collect::<String>());
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        any::<u64>().prop_map(Value::from),
        float.prop_map(Value::from),
        edge.prop_map(Value::from),
        text.clone().prop_map(Value::from),
    ];
    leaf.prop_recursive(4, 32, 4, move |inside| {
        prop_oneof![
            prop::collection::vec(inside.clone(), 0..4).prop_map(Value::from),
            prop::collection::vec((text.clone(), inside), 0..4).prop_map(Value::from_iter),
        ]
    })
}

fn body() -> impl Strategy<Value = Value> {
    prop::collection::vec((any::<String>(), json()), 0..5).prop_map(Value::from_iter)
}

/// The bits of the numbers, because `==` of JSON treats -0 as 0.
fn bits(value: &Value) -> Vec<u64> {
    match value {
        Value::Number(number) => number.as_f64().map(f64::to_bits).into_iter().collect(),
        Value::Array(values) => values.iter().flat_map(bits).collect(),
        Value::Object(fields) => fields.values().flat_map(bits).collect(),
        _ => Vec::new(),
    }
}

proptest! {
    #[test]
    fn every_body_reads_back(bodies in prop::collection::vec((2..11_usize, body()), 0..6)) {
        let (disk, mut journal) = begun(Durability::EverySyncPoint);
        for (kind, body) in &bodies {
            journal.append(EntryKind::ALL[*kind], body).unwrap();
        }
        let written = disk.written();
        prop_assert!(written.iter().all(|byte| matches!(byte, b' '..=b'~' | b'\n')));
        let found = recover(&written).unwrap();
        prop_assert_eq!(found.head(), journal.head());
        for ((line, seq), (kind, body)) in found.lines[1..].iter().zip(2..).zip(&bodies) {
            prop_assert_eq!(line.kind, EntryKind::ALL[*kind]);
            prop_assert_eq!(&line.body(), body);
            prop_assert_eq!(bits(&line.body()), bits(body));
            prop_assert_eq!(line.seq, seq);
        }
        prop_assert_eq!(found.lines.len(), bodies.len() + 1);
    }

    #[test]
    fn no_bytes_make_it_panic_or_believe(bytes in any::<Vec<u8>>(), at in any::<prop::sample::Index>(), over in any::<bool>()) {
        prop_assert!(recover(&bytes).is_err() || bytes.is_empty() || recover(&bytes).unwrap().lines.is_empty());
        let journal = small();
        let at = at.index(journal.len());
        let behind = if over { (at + bytes.len()).min(journal.len()) } else { at };
        let altered = [&journal[..at], &bytes, &journal[behind..]].concat();
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(&altered).unwrap();
        let from_file = super::super::recover(&LogText::of_file(file).unwrap()).map_err(|fault| fault.to_string());
        let from_memory = recover(&altered).map_err(|fault| fault.to_string());
        let parts = |found: Recovered| (records(&found), found.whole, found.torn.clone(), found.ended, found.head().to_owned());
        prop_assert_eq!(from_file.map(parts), from_memory.map(parts));
        if let Ok(found) = recover(&altered) {
            let whole = records(&recover(&journal).unwrap());
            prop_assert_eq!(&records(&found)[..], &whole[..found.lines.len()]);
            prop_assert!(altered == journal || found.torn.is_some());
        }
    }
}
