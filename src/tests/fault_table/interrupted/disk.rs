//! A disk that fails at any write or flush of a run. In: the number of the call. Out: the run says where the rig holds, and its run log is
//! replayed to the same record.

use crate::run::Unwatched;
use crate::run::replay::{self, LoggedRun};
use crate::tests::fault_table::stage::{emulator, header, open, plan_of, to};
use psd_plan::Plan;
use psd_plan::record::{Event, EventKind, Outcome, Record};
use psd_rig::emulator::Log;
use psd_rig::journal::{Durability, Journal};
use psd_testing::journal::{SickDisk, Sickness, recover};

/// Runs the plan on this disk. Returns whether the disk failed.
fn fails(plan: &Plan, sickness: Sickness) -> bool {
    let emulator = emulator(plan, "", Log::none(), 1);
    let mut rig = open(plan, &emulator).unwrap();
    let disk = SickDisk::new(sickness);
    let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
    if replay::begin(&mut journal, &header(plan), &["text".to_owned()]).is_err() {
        return true;
    }
    let recorded = replay::record(plan, &mut rig, &mut Unwatched, journal, Box::new(|| None));
    let record = recorded.record;
    let is_hold = |event: &Event| event.kind == EventKind::Held;
    let held = record.events.iter().any(is_hold);
    let moved = !emulator.lock().rig().moves().is_empty();
    assert!(
        held || !moved || record.outcome == Outcome::Completed,
        "{sickness:?}: {:?}",
        record.events
    );
    assert!(!emulator.lock().rig().moving());
    let recovered = recover(&disk.written()).unwrap();
    let logged = LoggedRun::of(&recovered).unwrap();
    assert_eq!(
        replay::check_consistency(&recovered, &logged, plan),
        Ok(()),
        "{sickness:?}"
    );
    let replayed = replay::replay(plan, logged);
    assert_eq!(replayed.mismatch, None, "{sickness:?}");
    let completed = |record: &Record| record.outcome == Outcome::Completed;
    assert_eq!(
        completed(&replayed.record),
        completed(&record),
        "{sickness:?}"
    );
    recorded.fault.is_some()
}

#[test]
fn a_run_whose_disk_fails_says_where_the_rig_holds_and_its_log_is_consistent() {
    let plan = plan_of(vec![to(1e-4)]);
    let syncs = (1..).take_while(|failed_sync| {
        let failed_sync = Some(*failed_sync);
        fails(
            &plan,
            Sickness {
                failed_sync,
                ..Sickness::default()
            },
        )
    });
    // The header, the rig, and a target or a reading at each of three moves.
    assert!(syncs.count() > 8);
    let rooms = (0..).step_by(61).take_while(|room| {
        fails(
            &plan,
            Sickness {
                room: Some(*room),
                reserve: 4096,
                ..Sickness::default()
            },
        )
    });
    assert!(rooms.count() > 30);
}
