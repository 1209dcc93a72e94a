//! Altered run logs: none passes as valid, and each is refused with its position, except for a change of the last entry.

use super::super::chain::Chain;
use super::super::{Damage, EntryKind, Wrong, line};
use super::{is_clean, lines, small};
use crate::testing::journal::recover;

/// A run log of these entries, each with the correct check values.
fn written(records: &[(u64, EntryKind, &str)]) -> Vec<u8> {
    let (mut out, mut chain) = (Vec::new(), Chain::START);
    for (seq, kind, json) in records {
        let start = out.len();
        line::open(&mut out, *seq, *kind);
        out.extend_from_slice(json.as_bytes());
        chain = line::close(&mut out, start, &chain);
    }
    out
}

const HEADER: (u64, EntryKind, &str) = (1, EntryKind::Header, r#"{"format":2}"#);

fn damage(records: &[(u64, EntryKind, &str)]) -> Damage {
    recover(&written(records)).expect_err("it is damaged")
}

#[test]
fn no_flipped_bit_passes() {
    let journal = small();
    assert!(is_clean(&journal));
    let last = journal.len() - lines(&journal).last().unwrap().len();
    let mut torn = 0;
    for offset in 0..journal.len() {
        for bit in 0..8 {
            let mut flipped = journal.clone();
            flipped[offset] ^= 1 << bit;
            match recover(&flipped) {
                Err(damage) => assert!(
                    damage.offset <= offset as u64,
                    "bit {bit} of byte {offset}: {damage}"
                ),
                Ok(found) => {
                    assert!(offset >= last, "bit {bit} of byte {offset} passes");
                    assert_eq!(found.torn, Some(last as u64..journal.len() as u64));
                    torn += 1;
                }
            }
        }
    }
    // In the last entry, the line end, the spaces and the @ may become a character that is not a line end, or a NUL.
    assert!((8..20).contains(&torn), "{torn} in the last record");
}

#[test]
fn no_record_is_left_out_doubled_or_moved() {
    let all = lines(&small());
    for one in 0..all.len() {
        let mut less = all.clone();
        less.remove(one);
        assert!(!is_clean(&less.concat()), "without line {}", one + 1);
        let mut more = all.clone();
        more.insert(one, all[one].clone());
        assert!(recover(&more.concat()).is_err(), "line {} twice", one + 1);
        for other in 0..one {
            let mut moved = all.clone();
            moved.swap(one, other);
            let damage = recover(&moved.concat()).unwrap_err();
            assert_eq!(damage.line, other as u64 + 1);
            let expected = Wrong::Sequence {
                expected: other as u64 + 1,
                found: one as u64 + 1,
            };
            assert_eq!(damage.reason, expected);
        }
    }
    let without_end = all[..all.len() - 1].concat();
    assert!(
        !recover(&without_end).unwrap().ended,
        "a journal that lost its END says that it has none"
    );
}

#[test]
fn a_sequence_has_no_gaps_also_when_the_check_words_are_right() {
    for wrong in [1, 3, u64::MAX] {
        let damage = damage(&[HEADER, (wrong, EntryKind::Event, "{}")]);
        assert_eq!(
            damage.reason,
            Wrong::Sequence {
                expected: 2,
                found: wrong
            }
        );
    }
}

#[test]
fn a_record_of_another_run_is_refused() {
    let other = written(&[
        (1, EntryKind::Header, r#"{"format":2,"run":"other"}"#),
        (2, EntryKind::Event, "{}"),
    ]);
    let spliced = [
        lines(&written(&[HEADER]))[0].clone(),
        lines(&other)[1].clone(),
    ]
    .concat();
    assert_eq!(recover(&spliced).unwrap_err().reason, Wrong::Chain);
    let before_zeros = [&spliced[..], &[0; 100]].concat();
    assert_eq!(
        recover(&before_zeros).unwrap_err().reason,
        Wrong::Chain,
        "a sound line is never torn, whatever follows it"
    );
}

#[test]
fn each_check_word_is_checked_alone() {
    let whole = String::from_utf8(written(&[
        HEADER,
        (2, EntryKind::Event, "{}"),
        (3, EntryKind::Event, "{}"),
    ]))
    .unwrap();
    let second = whole.lines().nth(1).unwrap();
    let (rest, crc) = second.rsplit_once(' ').unwrap();
    let (event, chain) = rest.rsplit_once(' ').unwrap();

    let other_crc = format!("{:08x}", !u32::from_str_radix(crc, 16).unwrap());
    let altered = whole.replace(crc, &other_crc);
    assert_eq!(
        recover(altered.as_bytes()).unwrap_err().reason,
        Wrong::Checksum,
        "chain right, checksum wrong"
    );

    let forged = format!("{event} {} ", chain.chars().rev().collect::<String>());
    let forged = format!("{forged}{:08x}", crc32c::crc32c(forged.as_bytes()));
    let altered = whole.replace(second, &forged);
    assert_eq!(
        recover(altered.as_bytes()).unwrap_err().reason,
        Wrong::Chain,
        "checksum right, chain wrong"
    );
    let last = altered.split_inclusive('\n').take(2).collect::<String>();
    assert_eq!(
        recover(last.as_bytes()).unwrap_err().reason,
        Wrong::Chain,
        "also at the end: a sound line is never torn"
    );
}

#[test]
fn another_format_is_refused_by_its_number() {
    let of = |json| damage(&[(1, EntryKind::Header, json)]);
    assert_eq!(
        of(r#"{"format":999}"#).reason,
        Wrong::Format {
            found: "999".to_owned()
        }
    );
    assert!(
        of(r#"{"format":999}"#)
            .to_string()
            .contains("its format is version 999; this psd reads version 2")
    );
    assert_eq!(
        of("{}").reason,
        Wrong::Format {
            found: "missing".to_owned()
        }
    );
    assert_eq!(
        of(r#"{"format":"\u001b"}"#).to_string().find('\x1b'),
        None,
        "a hostile version is inert"
    );
}

#[test]
fn sequence_is_checked_also_with_correct_checksums() {
    let event = (2, EntryKind::Event, r#"{"step":7}"#);
    let second = damage(&[HEADER, event, (3, EntryKind::Header, r#"{"format":2}"#)]);
    assert_eq!(
        (second.line, second.step, &second.reason),
        (3, Some(7), &Wrong::SecondHeader)
    );
    assert_eq!(
        second.to_string(),
        format!(
            "the run log is damaged at line 3 (byte {}, after step 7): a second HEADER",
            second.offset
        )
    );
    assert_eq!(
        damage(&[(1, EntryKind::Event, "{}")]).reason,
        Wrong::NoHeader
    );

    let head = recover(&written(&[HEADER])).unwrap().head().to_owned();
    let end = |count: u64, head: &str| format!(r#"{{"count":{count},"head":"{head}"}}"#);
    let good = end(1, &head);
    assert!(is_clean(&written(&[HEADER, (2, EntryKind::End, &good)])));
    let behind = (3, EntryKind::Event, "{}");
    assert_eq!(
        damage(&[HEADER, (2, EntryKind::End, &good), behind]).reason,
        Wrong::AfterEnd
    );
    for bad in [
        end(2, &head),
        end(1, Chain::START.as_str()),
        "{}".to_owned(),
    ] {
        assert!(
            matches!(
                damage(&[HEADER, (2, EntryKind::End, &bad)]).reason,
                Wrong::EndOfAnother { .. }
            ),
            "{bad}"
        );
    }
}

#[test]
fn only_objects_of_known_kinds_are_records() {
    for json in ["[]", "1", "null", "{", "{}{}", r#"{"a":1e400}"#, "nan"] {
        assert_eq!(
            damage(&[HEADER, (2, EntryKind::Event, json)]).reason,
            Wrong::NotAnObject,
            "{json}"
        );
    }
    let deep = "[".repeat(30_000);
    assert_eq!(
        damage(&[HEADER, (2, EntryKind::Event, &deep)]).reason,
        Wrong::NotAnObject,
        "no stack is lost on it"
    );

    let mut bytes = written(&[HEADER]);
    let (start, chain) = (bytes.len(), recover(&bytes).unwrap().chain);
    bytes.extend_from_slice(b"2 PAUSE {}");
    line::close(&mut bytes, start, &chain);
    assert_eq!(
        recover(&bytes).unwrap_err().reason,
        Wrong::UnknownKind("PAUSE".to_owned())
    );
}
