//! Run logs cut short: every whole entry is kept, and the rest is called torn only if it can be.

use serde_json::json;

use super::super::{Durability, EntryKind, Journal, LINE_BYTES, Wrong};
use super::{lines, records, small};
use crate::testing::journal::PowerLoss;
use crate::testing::journal::recover;

#[test]
fn every_length_keeps_exactly_the_whole_records() {
    let journal = small();
    let whole = records(&recover(&journal).unwrap());
    let ends: Vec<usize> = lines(&journal)
        .iter()
        .scan(0, |end, line| {
            Some({
                *end += line.len();
                *end
            })
        })
        .collect();
    for length in 0..=journal.len() {
        let found = recover(&journal[..length]).unwrap();
        let kept = ends.iter().filter(|end| **end <= length).count();
        let safe = kept.checked_sub(1).map_or(0, |last| ends[last]);
        assert_eq!(records(&found), whole[..kept], "cut at {length}");
        assert_eq!(found.whole, safe as u64);
        assert_eq!(
            found.torn,
            (safe < length).then_some(safe as u64..length as u64)
        );
        assert_eq!(found.ended, length == journal.len());
    }
}

#[test]
fn a_cut_journal_goes_on_where_it_was_cut() {
    let journal = small();
    for length in 0..journal.len() {
        let found = recover(&journal[..length]).unwrap();
        let whole = usize::try_from(found.whole).unwrap();
        let disk = PowerLoss::holding(&journal[..whole]);
        let mut resumed =
            Journal::reopen(Box::new(disk.clone()), Durability::EverySyncPoint, &found);
        if found.lines.is_empty() {
            resumed.append(EntryKind::Header, &json!({})).unwrap();
        }
        resumed
            .append(EntryKind::Recover, &json!({"bytes": length - whole}))
            .unwrap();
        resumed.end(&json!({})).unwrap();
        let again = recover(&disk.synced()).unwrap();
        assert!(again.ended && again.torn.is_none());
        assert_eq!(records(&again)[..found.lines.len()], records(&found));
        assert_eq!(again.lines.len() as u64, resumed.count());
        assert_eq!(again.head(), resumed.head());
    }
}

#[test]
fn a_record_without_its_line_end_is_torn() {
    let journal = small();
    let found = recover(journal.strip_suffix(b"\n").unwrap()).unwrap();
    assert!(!found.ended);
    assert_eq!(found.lines.len() + 1, lines(&journal).len());
}

#[test]
fn zeros_behind_a_record_are_torn_however_many() {
    let first = &lines(&small())[0];
    for zeros in [1, 511, LINE_BYTES - 1, LINE_BYTES, LINE_BYTES + 1, 1 << 24] {
        let mut bytes = first.clone();
        bytes.resize(first.len() + zeros, 0);
        let found = recover(&bytes).unwrap();
        assert_eq!(found.torn, Some(first.len() as u64..bytes.len() as u64));
        assert_eq!(found.lines.len(), 1);
    }
}

#[test]
fn unwritten_blocks_are_torn_unless_a_record_follows_them() {
    let all = lines(&small());
    let holed =
        |behind: &[u8]| [&all[0], &all[1], &[0; 40][..], &b"\":1} 0123\n"[..], behind].concat();
    let found = recover(&holed(b"also torn")).unwrap();
    assert_eq!(found.lines.len(), 2);
    assert_eq!(
        found.torn,
        Some((all[0].len() + all[1].len()) as u64..holed(b"also torn").len() as u64)
    );

    let damage = recover(&holed(&all[3])).unwrap_err();
    assert_eq!(
        (damage.line, damage.step, &damage.reason),
        (3, Some(1), &Wrong::Shape)
    );
    assert_eq!(damage.offset, (all[0].len() + all[1].len()) as u64);
}

#[test]
fn words_that_are_no_record_are_no_torn_end() {
    let first = &lines(&small())[0];
    let damage = recover(&[first, &b"a note by hand\n"[..]].concat()).unwrap_err();
    assert_eq!(
        (damage.line, damage.step, damage.reason),
        (2, None, Wrong::Shape)
    );
}

#[test]
fn an_overlong_line_is_refused_and_not_read_on() {
    let all = lines(&small());
    let damage =
        |bytes: usize, end: &[u8]| recover(&[&all[0], &vec![b'x'; bytes][..], end].concat());
    assert_eq!(
        damage(LINE_BYTES + 1, b"").unwrap_err().reason,
        Wrong::TooLong
    );
    assert_eq!(
        damage(LINE_BYTES, b"\n").unwrap_err().reason,
        Wrong::TooLong
    );
    assert_eq!(
        damage(LINE_BYTES, b"\0\0\n").unwrap_err().reason,
        Wrong::TooLong,
        "what is behind is not looked at"
    );
    assert_eq!(
        damage(LINE_BYTES - 1, b"\n").unwrap_err().reason,
        Wrong::Shape
    );
    assert!(
        damage(LINE_BYTES, b"").unwrap().torn.is_some(),
        "a line as long as may be, without its end"
    );
}
