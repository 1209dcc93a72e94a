//! A run that is killed at one write of its run log, and then resumed. In: a plan, an emulator, the disk of the run log. Out: whether psd
//! was killed there; the run completed on the same emulator.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::run::Unwatched;
use crate::run::replay;
use crate::run::replay::{Bands, RigBody};
use crate::tests::fault_table::axes::logged_run;
use crate::tests::fault_table::stage::{emulator, header, open};
use psd_plan::Plan;
use psd_plan::record::{Outcome, Record};
use psd_rig::Rig as _;
use psd_rig::emulator::Log;
use psd_rig::journal::{Durability, EntryKind, Journal};
use psd_testing::emulator::InProcess;
use psd_testing::journal::{Killed, PowerLoss};

/// Runs the plan until the given write or sync of its run log. psd is killed there, before the write or `after` it. Returns whether psd
/// was killed.
pub(crate) fn killed(
    plan: &Plan,
    emulator: &InProcess,
    disk: &PowerLoss,
    (call, after): (usize, bool),
) -> bool {
    let ended = catch_unwind(AssertUnwindSafe(|| {
        let mut rig = open(plan, emulator).unwrap();
        let mut journal = Journal::create(
            Box::new(Killed::at(disk, call, after)),
            Durability::EverySyncPoint,
        );
        replay::begin(&mut journal, &header(plan), &["text".to_owned()]).unwrap();
        replay::record(plan, &mut rig, &mut Unwatched, journal, Box::new(|| None))
    }));
    ended.is_err()
}

/// Outcome of a run that was cut off.
pub(crate) enum Resumed {
    ToItsEnd(Box<Record>),
    /// The record had its end.
    Ended,
    /// The run log contains no entry of the rig.
    NeverBegun,
}

/// Resumes the run on this disk, from its run log and the replies of the rig.
pub(crate) fn resumed(plan: &Plan, emulator: &InProcess, disk: &PowerLoss, call: usize) -> Resumed {
    let (recovered, before) = logged_run(disk);
    if before.ended {
        return Resumed::Ended;
    }
    let datum = before.rigs.first().and_then(|rig| rig.datum.clone());
    let at_its_datum = Plan {
        rig: plan.rig.with_recorded_datum(datum.as_deref()),
        ..plan.clone()
    };
    let mut rig = open(&at_its_datum, emulator).unwrap();
    let (found, about) = (rig.read().unwrap(), RigBody::of(&rig));
    let bands = Bands::of(&plan.rig, plan.rig.link.as_real().unwrap());
    let decision = match replay::decide(&before, &about, &found, &bands, false) {
        Err(replay::ResumeRefusal::NothingRecorded) => return Resumed::NeverBegun,
        decided => decided.unwrap_or_else(|refusal| panic!("call {call}: {refusal}")),
    };
    let resumption = decision.resumption("A. Witness", "power", &found, before.time);
    let mut journal = Journal::reopen(
        Box::new(disk.clone()),
        Durability::EverySyncPoint,
        &recovered,
    );
    journal
        .append(
            EntryKind::Rig,
            &RigBody {
                t: before.time,
                ..about
            },
        )
        .unwrap();
    journal.append(EntryKind::Resume, &resumption).unwrap();
    let goes_on = || {
        Ok::<_, replay::ResumeRefusal>(replay::Continuation {
            rig: &mut rig,
            journal,
            logged: logged_run(disk).1,
        })
    };
    let resumed =
        replay::resume(plan, &before, &mut Unwatched, Box::new(|| None), goes_on).unwrap();
    assert_eq!(
        (resumed.mismatch, resumed.record.outcome.clone()),
        (None, Outcome::Completed),
        "call {call}"
    );
    Resumed::ToItsEnd(Box::new(resumed.record))
}

/// Cuts the run off at every third write or sync of its run log from `first` on. `meanwhile` acts on the emulator, then the run is
/// resumed. Each run log and its disk are compared with `whole`.
pub(crate) fn cut_off_anywhere(
    plan: &Plan,
    first: usize,
    meanwhile: impl Fn(&InProcess),
    whole: impl Fn(&Record, &PowerLoss),
) {
    for (kills, call) in (first..).step_by(3).enumerate() {
        let (emulator, disk) = (emulator(plan, "", Log::none(), 1), PowerLoss::new());
        if !killed(plan, &emulator, &disk, (call, call % 2 == 0)) {
            assert!(kills > 10, "{kills}");
            return;
        }
        meanwhile(&emulator);
        match resumed(plan, &emulator, &disk, call) {
            Resumed::ToItsEnd(record) => whole(&record, &disk),
            Resumed::Ended => {}
            Resumed::NeverBegun => panic!("call {call}: the rig was opened before it"),
        }
    }
}
