//! An actuator with tracking errors, a specimen that fractures, a run with an energy error. In: runs with such a rig. Out: a rig on hold
//! at that point, and a fracture that is an event.

use super::stage::{STIFFNESS, plan, plan_of, run, run_without};
use crate::tests::testing::{every, impact};
use psd_plan::formula::Formula;
use psd_plan::record::{EventKind, Outcome};
use psd_plan::{Impact, InspectTrigger, Interval, Plan, ProcedureKind, Stepping};
use psd_rig::journal::EntryKind;
use psd_rig::safety::failpoint::Guarding;
use psd_testing::plans::ChangeTarget as _;

#[test]
fn an_actuator_that_sticks_or_lags_is_a_following_error() {
    for fault in ["stick", "reach 40 %", "lag 20 s"] {
        let script = format!("after 5 moves: {fault}");
        let ended = run(&plan(), &script);
        ended.held();
        let Outcome::Faulted { reason } = &ended.record.outcome else {
            panic!("{fault}: {:?}", ended.record.outcome)
        };
        assert!(reason.starts_with("following error"), "{fault}: {reason}");
        assert!(
            run_without(Guarding::Following, &plan(), &script).completed(),
            "{fault}"
        );
    }
}

#[test]
fn a_force_beyond_its_limit_holds_the_rig() {
    let mut limited = plan();
    limited.limits.force.high = 55.0;
    let ended = run(&limited, "");
    ended.held();
    assert!(
        matches!(ended.record.outcome, Outcome::Aborted { .. }),
        "{:?}",
        ended.record.outcome
    );
    assert_eq!(ended.events(EventKind::LimitBreach).len(), 1);
    let emulator = ended.emulator.lock();
    assert!(emulator.rig().commanded() < 55.0 / STIFFNESS + 2e-4);
    drop(emulator);
    assert!(run_without(Guarding::ReadingLimits, &limited, "").completed());
}

/// An impact of 1 kg at some mm/s on 2 kg: outwards at first.
pub(super) fn impact_plan(inspect: Vec<InspectTrigger>) -> Plan {
    let strike = Impact {
        stepping: Stepping {
            inspect,
            ..every(0.01)
        },
        duration: Formula::Constant(0.3),
        ..impact(Formula::Constant(STIFFNESS))
    }
    .with_point(|point| point.mass = Formula::Constant(500.0));
    let mut plan = plan_of(vec![ProcedureKind::Impact(strike)]);
    plan.specimens[0].mass = 500.0;
    (plan.strikers[0].mass, plan.strikers[0].velocity) = (500.0, 0.1);
    plan
}

#[test]
fn a_break_is_an_event_and_no_error() {
    let plan = impact_plan(vec![InspectTrigger::ForceDrop(0.5)]);
    let breaks = "at 0 s: fracture at 2 mm to 10 %";
    let ended = run(&plan, breaks);
    assert!(
        !matches!(ended.record.outcome, Outcome::Faulted { .. }),
        "{}",
        ended.reason()
    );
    let looked = ended.events(EventKind::Inspection);
    assert!(
        looked
            .iter()
            .any(|text| text.contains("the restoring force fell by 50 % or more")),
        "{looked:?}"
    );
    assert!(
        run(&plan, "")
            .events(EventKind::Inspection)
            .iter()
            .all(|text| !text.contains("fell by"))
    );
}

#[test]
fn an_energy_error_beyond_its_limit_holds_the_rig() {
    let plan = |ratio: f64| {
        let mut plan = impact_plan(Vec::new());
        plan.limits.energy_error = Interval {
            low: 0.0,
            high: 1e-3,
        };
        if let ProcedureKind::Impact(strike) = &mut plan.procedures[0].kind {
            strike.stepping.max_tangent_ratio = Formula::Constant(ratio);
        }
        plan
    };
    let sound = run(&plan(10.0), "");
    assert!(sound.completed(), "{}", sound.reason());
    // A tangent limited to a hundredth of its value no longer closes the energy balance.
    let ended = run(&plan(0.01), "");
    assert!(
        matches!(&ended.record.outcome, Outcome::Aborted { reason } if reason.contains("energy error")),
        "{}",
        ended.reason()
    );
    assert!(ended.log.contains("actuator > !") && !ended.emulator.lock().rig().moving());
    assert!(run_without(Guarding::EnergyError, &plan(0.01), "").completed());
}

/// An actuator that reaches 80 % of each move, inside a tolerance band that accepts it. The work of the force along the targets then
/// differs from the work along the measured positions.
#[test]
fn tracking_that_changes_the_energy_holds_the_rig() {
    let mut plan = impact_plan(Vec::new());
    plan.rig.settle.band = 5e-3;
    let short = "after 2 moves: reach 80 %";
    let ended = run(&plan, short);
    let stopped = matches!(&ended.record.outcome, Outcome::Aborted { reason } if reason.starts_with("tracking energy error 5."));
    assert!(stopped, "{}", ended.reason());
    let held = ended
        .log
        .find("actuator > !")
        .expect("the rig was commanded to hold");
    assert!(
        !ended.log[held..].contains(" bench move ") && !ended.emulator.lock().rig().moving(),
        "{}",
        ended.tail()
    );
    let warned = ended.events(EventKind::Remark);
    assert!(
        warned
            .iter()
            .any(|text| text.starts_with("tracking ") && text.ends_with("% of the input energy")),
        "{warned:?}"
    );
    assert!(run(&plan, "").completed());
    let missed = run_without(Guarding::Tracking, &plan, short);
    assert!(
        missed.completed() && missed.count(EntryKind::Step) > ended.count(EntryKind::Step),
        "{}",
        missed.reason()
    );
}
