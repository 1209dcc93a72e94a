//! A rig that was amended to another speed: from its resumption on it moves at that speed, also to the target that is sent again, and the
//! run log of both parts is replayed.

use std::cell::Cell;

use super::entry::IntentBody;
use super::*;
use crate::tests::testing::{elastic_plan, header, ramp};
use psd_plan::{Interval, Plan};
use psd_testing::forwarded;

/// Speed of the rig at the start of the run, and of the amended rig \[m/s\].
const FAST: f64 = 9e-3;
const SLOW: f64 = 1e-3;

/// A rig with a speed of its own, and the speed of each target that it executed \[m/s\].
#[derive(Clone)]
struct Paced {
    rig: RestingRig,
    own: f64,
    offered: Cell<f64>,
    executed: Rc<RefCell<Vec<f64>>>,
}

impl Rig for Paced {
    forwarded!(rig: identity, degrees_of_freedom, time, pause, read, traverse, follow_paths, hold, declared_noise);

    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<EncodedMove, RigFault> {
        self.offered.set(speed.unwrap());
        self.rig.propose(targets, speed)
    }
    fn execute(&mut self) -> Result<(), RigFault> {
        self.executed.borrow_mut().push(self.offered.get());
        self.rig.execute()
    }
    fn own_speed(&self) -> Option<f64> {
        Some(self.own)
    }
    fn last_move(&self) -> Option<LastMove> {
        self.rig.last_move()
    }
}

/// A ramp with this limit of speed \[m/s\].
fn limited(speed: f64) -> Plan {
    let mut plan = elastic_plan(300.0, vec![ProcedureKind::StiffnessRamp(ramp(1e-4))]);
    plan.limits.speed = Interval {
        low: 0.0,
        high: speed,
    };
    plan
}

/// A run that was killed, and resumed on the amended rig.
struct SlowedDown {
    /// The speeds of the targets before and after the resumption \[m/s\].
    fast: Vec<f64>,
    slow: Vec<f64>,
    amended: Plan,
    disk: PowerLoss,
    /// None: nothing was left to resume.
    resumed: Option<Record>,
}

/// Kills a run at this disk call, and resumes it on the amended rig. None after the last call.
fn slowed_down(call: usize, after: bool) -> Option<SlowedDown> {
    let (plan, amended) = (limited(FAST), limited(2.0 * SLOW));
    let disk = PowerLoss::new();
    let mut rig = Paced {
        rig: RestingRig::new(&plan),
        own: FAST,
        offered: Cell::new(0.0),
        executed: Rc::default(),
    };
    let storage = Killed::at(&disk, call, after);
    let ended = catch_unwind(AssertUnwindSafe(|| {
        let mut journal = journal(storage);
        begin(&mut journal, &header(&plan), &["text".to_owned()]).unwrap();
        record(&plan, &mut rig.clone(), &mut Witness, journal, no_wall())
    }));
    if ended.is_ok() {
        return None;
    }
    let (recovered, before) = logged(&disk.written());
    let fast = rig.executed.take();
    rig.own = SLOW;
    let found = rig.read().unwrap();
    let bands = Bands {
        displacement: vec![1e-9],
        axial: 0,
        force: vec![1e-6],
        stiffness: vec![Interval::ALL],
    };
    let about = RigBody {
        t: before.time,
        ..RigBody::of(&rig)
    };
    let decision = match decide(&before, &about, &found, &bands, false) {
        Err(ResumeRefusal::NothingRecorded | ResumeRefusal::Ended) => {
            return Some(SlowedDown {
                fast,
                slow: Vec::new(),
                amended,
                disk,
                resumed: None,
            });
        }
        other => other.unwrap_or_else(|refusal| panic!("call {call}: {refusal}")),
    };
    let resumption = decision.resumption("A. Witness", "too fast", &found, before.time);
    let mut journal = Journal::reopen(
        Box::new(disk.clone()),
        Durability::EverySyncPoint,
        &recovered,
    );
    let amendment = AmendBody {
        by: "A. Witness".to_owned(),
        reason: "too fast".to_owned(),
        differences: Vec::new(),
        header: header(&amended),
    };
    amend(&mut journal, &amendment, &["text".to_owned()]).unwrap();
    journal.append(EntryKind::Rig, &about).unwrap();
    journal.append(EntryKind::Resume, &resumption).unwrap();
    let (_, again) = logged(&disk.written());
    let mut slow = rig.clone();
    let goes_on = || {
        Ok::<_, ResumeRefusal>(Continuation {
            rig: &mut slow,
            journal,
            logged: again,
        })
    };
    let resumed = resume(&amended, &before, &mut Witness, no_wall(), goes_on)
        .unwrap_or_else(|refusal| panic!("call {call}: {refusal}"));
    let slow = rig.executed.take();
    Some(SlowedDown {
        fast,
        slow,
        amended,
        disk,
        resumed: Some(resumed.record),
    })
}

/// Checks that the resumed run was completed, and that its run log has every target with its speed and is replayed.
fn is_whole(call: usize, ran: &SlowedDown) {
    let Some(resumed) = &ran.resumed else {
        return;
    };
    assert_eq!(
        resumed.outcome,
        Outcome::Completed,
        "call {call}: {:?}",
        resumed.events
    );
    let (recovered, whole) = logged(&ran.disk.written());
    assert_eq!(
        check_consistency(&recovered, &whole, &ran.amended),
        Ok(()),
        "call {call}"
    );
    let intents: Vec<IntentBody> = whole
        .lines
        .iter()
        .filter(|line| line.kind == EntryKind::Intent)
        .map(|line| line.read().unwrap())
        .collect();
    let executed: Vec<f64> = ran.fast.iter().chain(&ran.slow).copied().collect();
    assert_eq!(
        intents.iter().map(|intent| intent.rate).collect::<Vec<_>>(),
        executed,
        "call {call}: each executed target is in the run log, with its speed"
    );
    let replayed = replay(&ran.amended, whole);
    assert_eq!(replayed.mismatch, None, "call {call}");
    assert_eq!(
        format!("{:?}", replayed.record),
        format!("{resumed:?}"),
        "call {call}"
    );
}

#[test]
fn an_amended_rig_moves_at_its_own_speed_from_its_resumption_on() {
    let mut resumed = 0;
    for call in 4.. {
        for after in [false, true] {
            let Some(ran) = slowed_down(call, after) else {
                assert!(resumed > 40, "{resumed}");
                return;
            };
            is_whole(call, &ran);
            let SlowedDown { fast, slow, .. } = ran;
            assert!(
                fast.iter().all(|speed| *speed == FAST),
                "call {call}: {fast:?}"
            );
            assert!(
                slow.iter().all(|speed| *speed == SLOW),
                "call {call}: {slow:?}"
            );
            resumed += usize::from(!slow.is_empty());
        }
    }
}

#[test]
fn without_the_newest_rig_it_would_move_at_the_speed_of_the_start() {
    let ran = without(Guarding::NewestRig, || slowed_down(20, true)).unwrap();
    // The own speed of the rig at the start, within the limit of the amended plan.
    let old = FAST.min(2.0 * SLOW);
    assert!(
        !ran.slow.is_empty() && ran.slow.iter().all(|speed| *speed == old),
        "{:?}",
        ran.slow
    );
}

/// psd can be killed after an amendment and before the resumption: the run did not go on, and is still that of the plan before.
#[test]
fn an_amendment_holds_from_its_resumption_on() {
    let disk = PowerLoss::new();
    let (plan, amended) = (limited(FAST), limited(SLOW));
    let mut rig = RestingRig::new(&plan);
    let killed = catch_unwind(AssertUnwindSafe(|| {
        let mut journal = journal(Killed::at(&disk, 20, true));
        begin(&mut journal, &header(&plan), &["text".to_owned()]).unwrap();
        record(&plan, &mut rig, &mut Witness, journal, no_wall())
    }));
    assert!(killed.is_err());
    let (recovered, before) = logged(&disk.written());
    let mut journal = Journal::reopen(
        Box::new(disk.clone()),
        Durability::EverySyncPoint,
        &recovered,
    );
    let amendment = AmendBody {
        by: "A. Witness".to_owned(),
        reason: "too fast".to_owned(),
        differences: Vec::new(),
        header: header(&amended),
    };
    amend(&mut journal, &amendment, &["another text".to_owned()]).unwrap();
    let (recovered, stopped) = logged(&disk.written());
    assert_eq!(
        (&stopped.header, &stopped.texts),
        (&before.header, &before.texts)
    );
    assert_eq!(stopped.interruptions, []);
    assert_eq!(check_consistency(&recovered, &stopped, &plan), Ok(()));
    assert_eq!(replay(&plan, stopped.clone()).mismatch, None);

    let found = rig.read().unwrap();
    let about = RigBody {
        t: stopped.time,
        ..RigBody::of(&rig)
    };
    let resumption = ResumeBody {
        from: stopped.lines.back().unwrap().seq + 1,
        by: "A. Witness".to_owned(),
        reason: "too fast".to_owned(),
        target_status: TargetStatus::None,
        assured: Vec::new(),
        found: (found.displacement, found.force),
        recorded: None,
        held: None,
        released: None,
        t: stopped.time,
        wall: None,
    };
    journal.append(EntryKind::Rig, &about).unwrap();
    journal.append(EntryKind::Resume, &resumption).unwrap();
    let (_, resumed) = logged(&disk.written());
    assert_eq!(resumed.header, header(&amended));
    assert_eq!(resumed.texts, ["another text"]);
    let kinds: Vec<EventKind> = resumed
        .interruptions
        .iter()
        .map(|event| event.kind)
        .collect();
    assert_eq!(kinds, [EventKind::Amendment, EventKind::Resume]);
}

#[test]
fn a_faster_rig_needs_an_acceptance_of_its_own() {
    let speeds = |was, is| [("own speed", Some(was), Some(is))];
    assert_eq!(no_faster(&speeds(FAST, SLOW), &[]), Ok(()));
    assert_eq!(no_faster(&speeds(FAST, FAST), &[]), Ok(()));
    let refused = no_faster(&speeds(SLOW, FAST), &[Assurance::AcceptedRelaxation]).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "the rig would move faster than before: its own speed, 1 mm/s, became 9 mm/s. If it may, confirm with --accept-speed"
    );
    assert_eq!(
        no_faster(&speeds(SLOW, FAST), &[Assurance::AcceptedSpeed]),
        Ok(())
    );
    let unlimited = [("limit of speed", Some(FAST), Some(f64::INFINITY))];
    assert!(no_faster(&unlimited, &[]).is_err());
}
