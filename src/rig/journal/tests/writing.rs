//! Writing: order of entries, refusals, final faults, final entries.

use serde_json::json;

use super::super::{
    Doing, Durability, EntryKind, Journal, JournalFault, LINE_BYTES, Refusal, Storage,
};
use super::{begun, records};
use crate::testing::journal::recover;
use crate::testing::journal::{PowerLoss, SickDisk, Sickness};
use psd_plan::record::failpoint::{Guarding, without};

fn on(disk: &(impl Storage + Clone + 'static)) -> Journal {
    let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
    journal.append(EntryKind::Header, &json!({})).unwrap();
    journal
}

#[test]
fn header_is_first_and_only_and_nothing_follows_end() {
    let disk = PowerLoss::new();
    let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
    let misplaced = |kind| Err(JournalFault::Refused(Refusal::OutOfSequence(kind)));
    assert_eq!(
        journal.append(EntryKind::Event, &json!({})),
        misplaced(EntryKind::Event)
    );
    assert_eq!(journal.end(&json!({})), misplaced(EntryKind::End));
    let reserved = Err(JournalFault::Refused(Refusal::Reserved("format")));
    assert_eq!(
        journal.append(EntryKind::Header, &json!({"format": 1})),
        reserved
    );
    journal.append(EntryKind::Header, &json!({})).unwrap();
    assert_eq!(
        journal.append(EntryKind::Header, &json!({})),
        misplaced(EntryKind::Header)
    );
    assert_eq!(
        journal.append(EntryKind::End, &json!({})),
        misplaced(EntryKind::End)
    );
    assert_eq!(
        journal.final_entry(EntryKind::End, &json!({})),
        misplaced(EntryKind::End)
    );
    let head = journal.head().to_owned();
    journal.end(&json!({"why": "done"})).unwrap();
    assert_eq!(
        journal.append(EntryKind::Event, &json!({})),
        misplaced(EntryKind::Event)
    );
    assert_eq!(journal.end(&json!({})), misplaced(EntryKind::End));
    assert_eq!(
        journal.final_entry(EntryKind::Fault, &json!({})),
        misplaced(EntryKind::Fault)
    );

    let found = recover(&disk.written()).unwrap();
    let expected = [
        (EntryKind::Header, json!({"format": 2})),
        (
            EntryKind::End,
            json!({"count": 1, "head": head, "why": "done"}),
        ),
    ];
    assert_eq!(records(&found), expected);
    assert!(found.ended && found.torn.is_none());
    let mut ended = Journal::reopen(Box::new(disk), Durability::EverySyncPoint, &found);
    assert_eq!(
        ended.append(EntryKind::Resume, &json!({})),
        misplaced(EntryKind::Resume)
    );
}

#[test]
fn a_refused_record_leaves_no_trace_and_the_journal_goes_on() {
    let (disk, mut journal) = begun(Durability::EverySyncPoint);
    let before = (disk.written(), journal.count(), journal.head().to_owned());
    let refused = |refusal| Err(JournalFault::Refused(refusal));
    assert_eq!(
        journal.append(EntryKind::Sample, &json!([1])),
        refused(Refusal::NotAnObject)
    );
    let nan = std::collections::BTreeMap::from([("force", f64::NAN)]);
    assert_eq!(
        journal.append(EntryKind::Sample, &nan),
        refused(Refusal::NotFinite)
    );
    assert_eq!(
        journal.final_entry(EntryKind::Fault, &nan),
        refused(Refusal::NotFinite)
    );
    assert_eq!(
        journal.end(&json!({"count": 3})),
        refused(Refusal::Reserved("count"))
    );
    assert_eq!(
        (disk.written(), journal.count(), journal.head().to_owned()),
        before
    );
    assert_eq!(journal.fault, None);
    journal
        .append(EntryKind::Sample, &json!({"force": 1.0}))
        .unwrap();
    assert_eq!(recover(&disk.written()).unwrap().lines.len(), 2);
}

#[test]
fn a_line_of_the_limit_is_written_and_one_byte_more_is_not() {
    let (disk, mut journal) = begun(Durability::EverySyncPoint);
    let begins = disk.written().len();
    let frame = r#"2 EVENT {"text":""}"#.len() + 1 + 64 + 1 + 8 + 1;
    let text = |bytes: usize| json!({"text": "x".repeat(bytes - frame)});
    let too_long = Refusal::TooLong {
        bytes: LINE_BYTES + 1,
    };
    assert_eq!(
        journal.append(EntryKind::Event, &text(LINE_BYTES + 1)),
        Err(JournalFault::Refused(too_long))
    );
    assert_eq!(disk.written().len(), begins);
    journal.append(EntryKind::Event, &text(LINE_BYTES)).unwrap();
    assert_eq!(disk.written().len() - begins, LINE_BYTES);
    assert_eq!(recover(&disk.written()).unwrap().lines.len(), 2);
}

#[test]
fn a_promise_is_a_sync_on_a_real_rig_only() {
    let (disk, mut journal) = begun(Durability::EverySyncPoint);
    assert!(disk.synced().is_empty());
    journal.sync_point().unwrap();
    assert_eq!((disk.synced(), disk.syncs()), (disk.written(), 1));

    let (disk, mut journal) = begun(Durability::Buffered);
    journal.sync_point().unwrap();
    assert_eq!((disk.written().len(), disk.syncs()), (0, 0));
    let digest = json!({ "steps": 1000 });
    journal.append(EntryKind::Digest, &digest).unwrap();
    let written = recover(&disk.written()).unwrap().lines.len();
    assert_eq!((written, disk.syncs()), (2, 0), "of a long run");
    journal.sync().unwrap();
    assert_eq!((disk.synced(), disk.syncs()), (disk.written(), 1));
    assert_eq!(recover(&disk.synced()).unwrap().lines.len(), 2);
    for step in 0..1000 {
        journal
            .append(EntryKind::Step, &json!({ "step": step }))
            .unwrap();
    }
    assert!(
        disk.written().len() > LINE_BYTES,
        "it does not keep back for ever"
    );
    drop(journal);
    assert_eq!(
        recover(&disk.written()).unwrap().lines.len(),
        1002,
        "a journal that is left gives what it kept back"
    );
}

#[test]
fn the_bytes_are_the_same_buffered_or_not() {
    let written = [Durability::Buffered, Durability::EverySyncPoint].map(|durability| {
        let (disk, mut journal) = begun(durability);
        journal
            .append(EntryKind::Event, &json!({"text": "\u{2028}"}))
            .unwrap();
        journal.end(&json!({})).unwrap();
        disk.synced()
    });
    assert_eq!(written[0], written[1]);
}

#[test]
fn a_failed_sync_is_final() {
    let disk = SickDisk::new(Sickness {
        failed_sync: Some(2),
        ..Sickness::default()
    });
    let mut journal = on(&disk);
    journal.sync_point().unwrap();
    journal.append(EntryKind::Intent, &json!({})).unwrap();
    let fault = journal.sync_point().unwrap_err();
    assert!(
        matches!(
            fault,
            JournalFault::Storage {
                doing: Doing::Sync,
                ..
            }
        ),
        "{fault}"
    );
    let asked = (disk.appends(), disk.syncs());
    assert_eq!(journal.sync_point(), Err(fault.clone()));
    assert_eq!(journal.sync(), Err(fault.clone()));
    assert_eq!(
        journal.append(EntryKind::Sample, &json!({})),
        Err(fault.clone())
    );
    assert_eq!(journal.end(&json!({})), Err(fault.clone()));
    assert_eq!(
        (disk.appends(), disk.syncs()),
        asked,
        "the disk is not asked again"
    );
    assert_eq!(
        without(Guarding::FailedSync, || journal.sync_point()),
        Ok(()),
        "without the guard the disk lies: all is well"
    );

    let syncs = disk.syncs();
    journal
        .final_entry(EntryKind::Fault, &json!({"text": "sync"}))
        .unwrap();
    assert_eq!(disk.syncs(), syncs, "no sync is tried again");
    assert_eq!(
        recover(&disk.written()).unwrap().lines.last().unwrap().kind,
        EntryKind::Fault
    );
    assert_eq!(journal.sync_point(), Err(fault), "last words heal nothing");
}

#[test]
fn last_words_fit_on_a_full_disk_thanks_to_the_reserve() {
    for room in 200..600 {
        let disk = SickDisk::new(Sickness {
            room: Some(room),
            reserve: 4096,
            ..Sickness::default()
        });
        let mut journal = on(&disk);
        let filled = (1..).find_map(|step| {
            journal
                .append(EntryKind::Step, &json!({ "step": step }))
                .err()
        });
        let fault = filled.expect("the disk is small");
        assert!(
            matches!(
                fault,
                JournalFault::Storage {
                    doing: Doing::Append,
                    ..
                }
            ),
            "{fault}"
        );
        let asked = disk.appends();
        assert_eq!(
            journal.append(EntryKind::Step, &json!({})),
            Err(fault.clone())
        );
        assert_eq!(disk.appends(), asked, "a full disk is not asked again");

        journal
            .final_entry(EntryKind::Fault, &json!({"text": "disk full"}))
            .unwrap();
        let found = recover(&disk.written()).unwrap();
        assert_eq!(found.torn, None);
        assert_eq!(
            found.lines.len() as u64,
            journal.count(),
            "the record that did not fit is there too"
        );
        assert_eq!(
            found.lines.last().unwrap().body(),
            json!({"text": "disk full"})
        );
        assert_eq!(found.head(), journal.head());
        assert_eq!(journal.fault, Some(fault));
    }
}

#[test]
fn a_disk_that_fills_in_a_resumed_run_loses_nothing_of_the_first() {
    let disk = SickDisk::new(Sickness {
        room: Some(700),
        reserve: 4096,
        ..Sickness::default()
    });
    drop(on(&disk));
    let found = recover(&disk.written()).unwrap();
    let mut resumed = Journal::reopen(Box::new(disk.clone()), Durability::EverySyncPoint, &found);
    while resumed
        .append(EntryKind::Resume, &json!({"who": "J. Doe"}))
        .is_ok()
    {}
    resumed.final_entry(EntryKind::Fault, &json!({})).unwrap();
    let found = recover(&disk.written()).unwrap();
    assert_eq!(found.lines.len() as u64, resumed.count());
    assert_eq!((found.lines[0].kind, found.torn), (EntryKind::Header, None));
}

#[test]
fn without_a_reserve_last_words_fail_and_harm_nothing() {
    for uncuttable in [false, true] {
        let disk = SickDisk::new(Sickness {
            room: Some(300),
            uncuttable,
            ..Sickness::default()
        });
        let mut journal = on(&disk);
        while journal.append(EntryKind::Event, &json!({})).is_ok() {}
        for _ in 0..3 {
            assert!(journal.final_entry(EntryKind::Fault, &json!({})).is_err());
        }
        let left = disk.written();
        let found = recover(&left).expect("what is left is at worst torn");
        assert!(
            found.torn.is_some() && found.lines.len() >= 2,
            "{}",
            String::from_utf8_lossy(&left)
        );
    }
}

#[test]
fn an_end_that_found_no_room_leaves_room_for_last_words() {
    let disk = SickDisk::new(Sickness {
        room: Some(150),
        reserve: 4096,
        ..Sickness::default()
    });
    let mut journal = on(&disk);
    assert!(journal.end(&json!({})).is_err());
    assert_eq!(journal.count(), 1);
    journal.final_entry(EntryKind::Fault, &json!({})).unwrap();
    let found = recover(&disk.written()).unwrap();
    let kinds: Vec<EntryKind> = found.lines.iter().map(|line| line.kind).collect();
    assert_eq!(kinds, [EntryKind::Header, EntryKind::Fault]);
}
