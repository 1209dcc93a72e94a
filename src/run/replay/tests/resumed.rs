//! Every procedure that moves the rig, killed at every write and every sync and resumed: the same end, no target executed
//! twice, and the run log of both parts is replayed. A run without a run log has the same times as one with it.

use super::entry::FaultBody;
use super::procedures::{CONTINUOUS, plans, shaken, short, swept_past_yield, to};
use super::*;
use crate::tests::testing::{elastic_plan, header, ramp, result_of};
use psd_plan::formula::Formula::Constant;
use psd_plan::formula::ResultValue;
use psd_plan::record::History;
use psd_plan::{Impact, Mode, ProcedureKind, StiffnessRamp};
use psd_rig::controllers::DeviceFault;
use psd_rig::journal::Durability;
use psd_rig::safety::failpoint::{Guarding, without};
use psd_rig::{Identity, JUST_STARTED, RigFault};
use psd_testing::journal::PowerLoss;
use psd_testing::plans::ChangeTarget as _;

fn killed(name: &str) {
    let plan = plans().into_iter().find(|(own, _)| *own == name).unwrap().1;
    killed_everywhere(&plan, 30);
}

#[test]
fn a_continuous_impact() {
    killed("continuous");
}

#[test]
fn cycles() {
    killed("cycle");
    killed("cycle without a stop");
}

#[test]
fn a_rising_series() {
    killed("escalate");
}

#[test]
fn a_rising_series_on_a_storey() {
    killed("escalate on a storey");
}

#[test]
fn a_shake_of_two_floors() {
    // Both storeys have yielded, each at 0.2 mm: the force would show a part of a path that is travelled twice.
    let (_, whole, _) = recorded(&shaken(CONTINUOUS));
    let drifts = whole.record.procedures[0]
        .result("max_drift")
        .map(|result| result.value.clone());
    assert!(
        matches!(drifts, Some(ResultValue::List(drifts)) if drifts.iter().all(|drift| *drift > 4e-4))
    );
    killed("shake");
    killed("shake without a stop");
    killed("shake with a computed storey, a scale and weights");
}

#[test]
fn an_impact_on_a_storey_without_a_stop() {
    killed("storey without a stop");
}

#[test]
fn pauses_that_are_watched() {
    killed("watched");
}

/// No reading is made during plastic deformation, and the readings follow the same line on the return: there is no damper.
#[test]
fn a_sweep_about_a_position_past_yield() {
    let (_, whole, _) = recorded(&swept_past_yield());
    let (damping, _) = crate::tests::testing::number(&whole.record, 0, "damping");
    assert!(damping.unwrap().abs() < 1e-9, "{damping:?}");
    let History::DampingSweep(sweep) = &whole.record.procedures[0].history else {
        panic!()
    };
    assert!(
        sweep
            .steps
            .iter()
            .all(|step| (step.displacement - 0.03).abs() < 2.6e-3),
        "the stroke that flows is not read"
    );
    killed("sweep past yield");
}

#[test]
fn zeros_before_and_after() {
    killed("drift");
}

#[test]
fn an_unloading() {
    killed("unload");
}

#[test]
fn each_replays_bit_identically_and_is_reported_at_the_same_times_without_a_record() {
    let ramped = StiffnessRamp {
        pause: Constant(0.1),
        ..ramp(1e-4)
    };
    let looked = vec![
        ProcedureKind::StiffnessRamp(ramped),
        ProcedureKind::Inspect {
            note: "look".to_owned(),
        },
        ProcedureKind::Impact(
            Impact {
                ..short(Mode::RampAndHold)
            }
            .with_point(|point| point.stiffness = result_of(0, "stiffness")),
        ),
        to(0.0),
    ];
    for (name, plan) in plans()
        .into_iter()
        .chain([("a look after a way home", elastic_plan(300.0, looked))])
    {
        let (_, whole, bytes) = recorded(&plan);
        assert_eq!(
            whole.record.outcome,
            Outcome::Completed,
            "{name}: {:?}",
            whole.record.events
        );
        let replayed = replay(&plan, logged(&bytes).1);
        assert_eq!(replayed.mismatch, None, "{name}");
        assert_eq!(
            format!("{:?}", replayed.record),
            format!("{:?}", whole.record),
            "{name}: played back"
        );
        let plain = run(&plan, &mut RestingRig::new(&plan), &mut Witness);
        // In both, the recovered communication errors are counted from the first reading of the rig.
        assert_eq!(
            format!("{plain:?}"),
            format!("{:?}", whole.record),
            "{name}: not recorded"
        );
    }
}

#[test]
fn a_logged_restart_requires_a_reference_whatever_else_is_stated() {
    let plan = crate::tests::testing::empty_plan();
    let fault = DeviceFault::Rebooted {
        was: "running".to_owned(),
        is: "Grbl 1.1h".to_owned(),
    };
    let of = |fault: &str| {
        let disk = PowerLoss::new();
        let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
        begin(&mut journal, &header(&plan), &["text".to_owned()]).unwrap();
        journal
            .append(EntryKind::Rig, &RigBody::of(&RestingRig::new(&plan)))
            .unwrap();
        let fault = RigFault::Device(format!("actuator on /dev/ttyUSB0: {fault}"));
        journal
            .append(
                EntryKind::Fault,
                &FaultBody {
                    t: 0.0,
                    call: Call::Execute,
                    fault,
                    reading: None,
                    wall: None,
                },
            )
            .unwrap();
        journal.sync().unwrap();
        logged(&disk.written()).1
    };
    let restarted = of(&fault.to_string());
    let refused = not_restarted(&restarted, &[Assurance::SamePowerUp, Assurance::LetGo]);
    assert!(
        matches!(refused, Err(ResumeRefusal::Restarted { .. })),
        "{refused:?}"
    );
    assert_eq!(
        not_restarted(&restarted, &[Assurance::ReReferenced]),
        Ok(())
    );
    assert_eq!(
        not_restarted(&of("connection lost: unplugged"), &[]),
        Ok(())
    );
}

#[test]
fn a_rig_that_cannot_report_a_power_cycle_requires_the_statement_of_the_operator() {
    let plan = crate::tests::testing::empty_plan();
    let of = |boot: Option<&str>| Identity {
        boot: boot.map(str::to_owned),
        ..RestingRig::new(&plan).identity()
    };
    let (nothing, word, restarted) = (
        &[][..],
        &[Assurance::SamePowerUp][..],
        &[Assurance::ReReferenced][..],
    );
    let refused = |was, is, assured| same_rig(&of(was), &of(is), assured).err();
    for mute in [
        (None, None),
        (Some(JUST_STARTED), None),
        (Some("7F3A + -"), Some("7F3A + -")),
    ] {
        assert_eq!(
            refused(mute.0, mute.1, nothing),
            Some(ResumeRefusal::PowerUpUnknown),
            "{mute:?}"
        );
        assert_eq!(
            (
                refused(mute.0, mute.1, word),
                refused(mute.0, mute.1, restarted)
            ),
            (None, None),
            "{mute:?}"
        );
        let unguarded = without(Guarding::PowerUp, || refused(mute.0, mute.1, nothing));
        assert_eq!(unguarded, None, "{mute:?}: nothing else sees it");
    }
    for proven in ["7F3A", "7F3A + 11B0"] {
        assert_eq!(refused(Some(proven), Some(proven), nothing), None);
    }
    let started = [
        (Some("7F3A"), Some("11B0")),
        (None, Some(JUST_STARTED)),
        (Some(JUST_STARTED), Some(JUST_STARTED)),
        (Some("7F3A"), None),
        (Some("7F3A + -"), Some("11B0 + -")),
        (Some("7F3A + -"), Some("7F3A")),
    ];
    for (was, is) in started {
        for assured in [nothing, word] {
            assert!(
                matches!(
                    refused(was, is, assured),
                    Some(ResumeRefusal::Rebooted { .. })
                ),
                "no word outweighs what it says: {was:?} {is:?}"
            );
        }
        assert_eq!(refused(was, is, restarted), None, "{was:?} {is:?}");
    }
}
