//! A vandal who uses the program: entries are removed, duplicated, swapped and changed at random, and all check values are recalculated.
//! In: a whole run log and a seed. Out: a run log whose lines are all valid and whose run may be impossible.

use rand::RngExt as _;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng as _;
use serde_json::{Value, json};

use super::{records, written};
use psd_rig::journal::EntryKind;
use psd_text::digest::sha256;

type Records = Vec<(EntryKind, Value)>;

pub struct Vandal(Pcg64);

impl Vandal {
    pub fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    /// The run log after one to four random changes; some of them insert an entry of the `other` run log.
    pub fn mangled(&mut self, journal: &[u8], other: &[u8]) -> Vec<u8> {
        let (mut mangled, other) = (records(journal), records(other));
        for _ in 0..=self.below(4) {
            self.strike(&mut mangled, &other);
        }
        written(mangled)
    }

    fn below(&mut self, count: usize) -> usize {
        self.0.random_range(0..count.max(1))
    }

    fn strike(&mut self, records: &mut Records, other: &Records) {
        // The first entry is not moved: without it there is no run log.
        if records.len() < 3 {
            return;
        }
        let at = 1 + self.below(records.len() - 1);
        let to = 1 + self.below(records.len() - 1);
        match self.below(21) {
            0 => drop(records.remove(at)),
            1 => records.insert(to, records[at].clone()),
            2 => records.swap(at, to),
            3 => {
                let record = records.remove(at);
                records.insert(to.min(records.len()), record);
            }
            4 => records.truncate(at.max(2)),
            5 => records[at].0 = EntryKind::ALL[1 + self.below(EntryKind::ALL.len() - 1)],
            6 => records.insert(at, other[1 + self.below(other.len() - 1)].clone()),
            7 => records[at].1 = records[to].1.clone(),
            8 => self.replan(records),
            10 => resume(records, at),
            9 => {
                let of = self.below(records.len());
                self.change(&mut records[of].1, other);
            }
            _ => self.change(&mut records[at].1, other),
        }
        // Entries after the end are damage that the reader finds without further checks.
        let end = records.iter().position(|(kind, _)| *kind == EntryKind::End);
        records.truncate(end.map_or(records.len(), |end| end + 1));
    }

    /// Changes a digit in a text of the plan, and the digest of that text.
    fn replan(&mut self, records: &mut Records) {
        let Some(index) = records
            .iter()
            .position(|(kind, _)| *kind == EntryKind::Plan)
        else {
            return;
        };
        let Some(text) = records[index].1["text"].as_str() else {
            return;
        };
        let digits: Vec<usize> = text
            .bytes()
            .enumerate()
            .filter(|(_, byte)| byte.is_ascii_digit())
            .map(|(at, _)| at)
            .collect();
        if digits.is_empty() {
            return;
        }
        let at = digits[self.below(digits.len())];
        let text = format!("{}{}{}", &text[..at], self.below(10), &text[at + 1..]);
        let file = records[index].1["file"]
            .as_u64()
            .and_then(|file| usize::try_from(file).ok())
            .unwrap_or(0);
        if let Some(digest) = records[0].1.pointer_mut(&format!("/files/{file}/sha256")) {
            *digest = json!(sha256(text.as_bytes()));
        }
        records[index].1["text"] = json!(text);
    }

    /// Changes one random value in a body.
    fn change(&mut self, body: &mut Value, other: &Records) {
        let mut pointers = Vec::new();
        gather(body, "", &mut pointers);
        if pointers.is_empty() {
            return;
        }
        let pointer = &pointers[self.below(pointers.len())];
        if self.below(8) == 0 {
            let (above, name) = pointer.rsplit_once('/').unwrap_or_default();
            if let Some(Value::Object(fields)) = body.pointer_mut(above) {
                fields.remove(name);
            }
            return;
        }
        if let Some(value) = body.pointer_mut(pointer) {
            self.spoil(value, other);
        }
    }

    fn spoil(&mut self, value: &mut Value, other: &Records) {
        match value {
            Value::Number(number) => *value = self.number(number.as_f64().unwrap_or(0.0)),
            Value::Array(items) => match self.below(4) {
                0 => items.clear(),
                1 => drop(items.pop()),
                2 => items.push(items.last().cloned().unwrap_or_else(|| json!(0.0))),
                _ => items.reverse(),
            },
            Value::Bool(truth) => *truth = !*truth,
            Value::String(text) => match self.below(4) {
                0 => text.clear(),
                1 => text.push_str(" \u{1b}[31m\u{0}"),
                2 => "unloading".clone_into(text),
                _ => *text = other[self.below(other.len())].0.word().to_lowercase(),
            },
            Value::Object(_) | Value::Null => *value = other[self.below(other.len())].1.clone(),
        }
    }

    fn number(&mut self, number: f64) -> Value {
        match self.below(14) {
            0 => json!(0.0),
            1 => json!(-number),
            2 => json!(f64::from_bits(number.to_bits() ^ 1)),
            3 => json!(number * 2.0),
            4 => json!(number + 1.0),
            5 => json!(f64::MAX),
            6 => json!(-f64::MAX),
            7 => json!(5e-324),
            8 => json!(0),
            9 => json!(1),
            10 => json!(2),
            11 => json!(-1),
            12 => json!(u64::MAX),
            _ => json!(number * 1e-3),
        }
    }
}

/// A resumption that did not occur.
fn resume(records: &mut Records, at: usize) {
    let Some((_, rig)) = records
        .iter()
        .find(|(kind, _)| *kind == EntryKind::Rig)
        .cloned()
    else {
        return;
    };
    let reading = records[..at]
        .iter()
        .rfind(|(kind, _)| *kind == EntryKind::Sample);
    let found = reading.map_or_else(
        || json!([[0.0], [0.0]]),
        |(_, body)| json!([body["x"], body["r"]]),
    );
    let resumed = json!({
        "from": at + 1, "by": "R. T", "reason": "no power", "target_status": {"target": "none"}, "found": found, "recorded": found, "t": rig["t"],
    });
    records.insert(at, (EntryKind::Resume, resumed));
    records.insert(at, (EntryKind::Rig, rig));
}

/// The paths of all values inside a value, without the value itself.
fn gather(value: &Value, at: &str, pointers: &mut Vec<String>) {
    match value {
        Value::Object(fields) => fields.iter().for_each(|(name, field)| {
            let at = format!("{at}/{}", name.replace('~', "~0").replace('/', "~1"));
            pointers.push(at.clone());
            gather(field, &at, pointers);
        }),
        Value::Array(items) => items.iter().enumerate().for_each(|(index, item)| {
            let at = format!("{at}/{index}");
            pointers.push(at.clone());
            gather(item, &at, pointers);
        }),
        _ => {}
    }
}
