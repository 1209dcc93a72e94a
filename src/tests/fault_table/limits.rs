//! A force limit that ends a motion. In: moves, ramps, cycles and impacts on a rig whose limit is exceeded during a move, not at a
//! target. Out: the reading that exceeded it is in the run log and is the last row of the table; with `safe_state = unload` the rig goes
//! back to the start, although it exceeds its limit where it holds.

use super::motion::impact_plan;
use super::stage::{Ended, STIFFNESS, emulator, header, link, open, plan_of, run, run_watched, to};
use crate::run::replay::LoggedRun;
use crate::run::{Inspection, Motion, Observer, Unwatched, replay};
use crate::tests::testing::{number, ramp};
use psd_plan::record::{EventKind, History, Outcome, Record, UNLOADING};
use psd_plan::{Limits, Plan, ProcedureKind, SafeState};
use psd_rig::emulator::Log;
use psd_rig::journal::{Durability, EntryKind, Journal};
use psd_rig::real::RealRig;
use psd_rig::{Rig, RigFault};
use psd_testing::forwarded;
use psd_testing::journal::PowerLoss;
use psd_testing::journal::recover;

/// Force limit \[N\]: exceeded between the positions of two readings, and far from every target.
const LIMIT: f64 = 125.0;

/// The same plan with the force limit, on a slow rig.
fn limited(mut plan: Plan) -> Plan {
    plan.limits.force.high = LIMIT;
    link(&mut plan).own_speed = 1e-3;
    plan
}

/// Displacement \[m\] and force \[N\] of the last row.
fn last_row(ended: &Ended) -> (f64, f64) {
    let history = &ended.record.procedures.last().unwrap().history;
    let row = match history {
        History::StiffnessRamp(ramp) => ramp
            .steps
            .last()
            .map(|step| (step.displacement, step.restoring_force)),
        History::Move(steps) => steps
            .last()
            .map(|step| (step.displacement, step.restoring_force)),
        History::Cycle(cycle) => cycle
            .steps
            .last()
            .map(|step| (step.displacement, step.restoring_force)),
        History::Impact(impact) => impact
            .steps
            .last()
            .map(|step| (step.displacement, step.restoring_force)),
        other => panic!("{other:?}"),
    };
    row.unwrap()
}

#[test]
fn the_reading_that_exceeded_a_limit_during_a_move_is_the_last_row() {
    let mut blow = impact_plan(Vec::new());
    blow.strikers[0].velocity = 0.4;
    for plan in [
        plan_of(vec![to(2e-3)]),
        plan_of(vec![ProcedureKind::StiffnessRamp(ramp(5e-4))]),
        blow,
    ] {
        let kind = plan.procedures[0].kind.keyword();
        let ended = run(&limited(plan), "");
        ended.held();
        assert!(
            matches!(ended.record.outcome, Outcome::Aborted { .. }),
            "{kind}: {:?}",
            ended.record.outcome
        );
        let fault = ended.body(EntryKind::Fault, 0);
        assert_eq!(fault["call"], "execute", "{kind}: {fault}");
        let logged = |quantity: &str| fault["reading"][quantity][0].as_f64().unwrap();
        assert_eq!(last_row(&ended), (logged("x"), logged("r")), "{kind}");
        assert!(
            (LIMIT..1.2 * LIMIT).contains(&logged("r")),
            "{kind}: {fault}"
        );
        assert!(
            !fault["reading"]["raw"].as_array().unwrap().is_empty(),
            "{kind}: its bytes are kept"
        );
        assert!(
            (last_row(&ended).0 - last_row(&ended).1 / STIFFNESS).abs() < 1e-6,
            "{kind}"
        );
        if kind == "impact" {
            // The specimen was moved to this reading, not to the target of the step.
            let largest = number(&ended.record, 0, "max_displacement").0;
            assert_eq!(largest, Some(last_row(&ended).0));
            let tracking = number(&ended.record, 0, "nrms_error").0.unwrap();
            assert!(tracking < 0.01, "{tracking}");
        }
    }
}

/// An operator who thinks for a while, then unloads.
struct Slow {
    waits: u32,
}

impl Observer for Slow {
    fn inspect(&mut self, _: &str) -> Inspection {
        Inspection::GoOn {
            note: None,
            by: Some("A. Tester".to_owned()),
        }
    }

    fn may_unload(&mut self, _: &str, motion: &Motion) -> Option<Inspection> {
        assert!(motion.limits.force.high > LIMIT, "{:?}", motion.limits);
        if self.waits > 0 {
            self.waits -= 1;
            return Some(Inspection::Wait);
        }
        Some(Inspection::GoOn {
            note: None,
            by: Some("A. Tester".to_owned()),
        })
    }
}

#[test]
fn an_operator_who_takes_time_to_decide_unloads_a_rig_beyond_its_limit() {
    let plan = limited(plan_of(vec![to(2e-3)]));
    // Two watchdogs.
    let ended = run_watched(&plan, "", &mut Slow { waits: 600 }).unwrap();
    assert_eq!(ended.events(EventKind::LimitBreach).len(), 1);
    assert_eq!(ended.emulator.lock().rig().commanded(), 0.0);
}

/// A rig that does not answer when it receives the extended limits.
struct Refusing(RealRig);

impl Rig for Refusing {
    forwarded!(0: identity, degrees_of_freedom, time, propose, execute, pause, read, traverse, hold, halt, take_broken, declared_noise);

    fn set_limits(&mut self, _: &[Limits]) -> Result<(), RigFault> {
        Err(RigFault::Device("no reply".to_owned()))
    }
}

#[test]
fn limits_that_do_not_reach_the_rig_leave_it_on_hold_and_the_run_replays() {
    let mut plan = limited(plan_of(vec![to(2e-3)]));
    link(&mut plan).safe_state = SafeState::Unload;
    let emulator = emulator(&plan, "", Log::none(), 1);
    let mut rig = Refusing(open(&plan, &emulator).unwrap());
    let disk = PowerLoss::new();
    let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
    replay::begin(&mut journal, &header(&plan), &["text".to_owned()]).unwrap();
    let recorded = replay::record(&plan, &mut rig, &mut Unwatched, journal, Box::new(|| None));
    let reported = |record: &Record| {
        let mut texts = record.events.iter().map(|event| event.text.as_str());
        texts.any(|text| text == "not unloaded: no reply")
    };
    assert!(reported(&recorded.record), "{:#?}", recorded.record.events);
    assert!(emulator.lock().rig().commanded() > 1e-3, "it did not move");
    let logged = LoggedRun::of(&recover(&disk.written()).unwrap()).unwrap();
    let replayed = replay::replay(&plan, logged);
    assert_eq!(replayed.mismatch, None);
    assert!(reported(&replayed.record));
}

#[test]
fn a_rig_beyond_its_limit_is_unloaded_where_the_plan_says_so() {
    let mut plan = limited(plan_of(vec![to(2e-3)]));
    link(&mut plan).safe_state = SafeState::Unload;
    let ended = run(&plan, "");
    assert!(matches!(ended.record.outcome, Outcome::Aborted { .. }));
    let said = ended.events(EventKind::Hold);
    assert!(said.contains(&UNLOADING), "{said:?}");
    let all: Vec<&str> = ended
        .record
        .events
        .iter()
        .map(|event| event.text.as_str())
        .collect();
    assert!(
        !all.iter().any(|text| text.contains("not unloaded")),
        "{all:#?}"
    );
    assert_eq!(ended.events(EventKind::LimitBreach).len(), 1, "{all:#?}");
    let emulator = ended.emulator.lock();
    assert!(
        !emulator.rig().moving() && emulator.rig().commanded() == 0.0,
        "{}",
        emulator.rig().commanded()
    );
}

#[test]
fn a_force_that_rises_during_the_unloading_ends_it_at_the_extended_limit() {
    let mut plan = limited(plan_of(vec![to(2e-3)]));
    link(&mut plan).safe_state = SafeState::Unload;
    let ended = run(&plan, "after 4 moves: drift force 400 N/s");
    let events: Vec<&str> = ended
        .record
        .events
        .iter()
        .map(|event| event.text.as_str())
        .collect();
    let not_unloaded = events.iter().find(|text| text.starts_with("not unloaded"));
    assert!(
        not_unloaded.is_some_and(|text| text.contains("is outside its limit")),
        "{events:#?}"
    );
    assert_eq!(ended.count(EntryKind::Held), 2, "it holds again");
    let emulator = ended.emulator.lock();
    assert!(!emulator.rig().moving() && emulator.rig().violations().is_empty());
}
