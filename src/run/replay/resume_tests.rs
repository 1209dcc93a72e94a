//! Every procedure that moves the rig, killed at every write and every sync and gone on with: the same end, no target carried
//! out twice, and what both parts left plays back. And a run that nobody records is told at the times of one on record.

use super::entry::FaultBody;
use super::tests::{Standing, Witness, killed_everywhere, played, recorded};
use super::*;
use crate::plan::formula::Formula::Constant;
use crate::plan::formula::{Formula, Part, ProcedureId, ResultReference, ResultValue};
use crate::plan::{
    Behaviour, Between, Comparison, Condition, Cycle, DampingSweep, DriftCheck, Escalate, Frame,
    FrameUnload, Ground, Impact, InspectTrigger, Integrator, Level, Mode, Move, Procedure,
    ProcedureKind, Shake, ShakeDamping, Sides, Stepping, StiffnessRamp, Storey, Test, Unload,
    Until, WatchedHold, WatchedModel, ZeroAfter,
};
use crate::record::History;
use crate::record::journal::Durability;
use crate::record::journal::testing::PowerLoss;
use crate::rig::controllers::DeviceFault;
use crate::rig::safety::failpoint::{Guarding, without};
use crate::rig::{Identity, JUST_STARTED, RigFault};
use crate::tests::testing::{elastic_plan, every, header, impact, ramp, result_of, struck_frame};
use crate::units::Dimension;

const CONTINUOUS: Mode = Mode::Continuous { time_scale: 100.0 };

fn to(place: f64) -> ProcedureKind {
    ProcedureKind::Move(Move {
        to: Constant(place),
        speed: None,
    })
}

/// K 300 N/m; yields at 3 N, 10 mm.
fn yielding(procedures: Vec<ProcedureKind>) -> Plan {
    let mut plan = elastic_plan(300.0, procedures);
    plan.specimens[0].behaviour = Some(Behaviour::Bilinear {
        stiffness: 300.0,
        yield_force: 3.0,
        hardening: 0.1,
    });
    plan
}

/// Five steps.
fn short(mode: Mode) -> Impact {
    let stepping = Stepping {
        mode,
        ..every(0.01)
    };
    Impact {
        stepping,
        duration: Constant(0.05),
        until: Until::Duration,
        ..impact(Constant(300.0))
    }
}

fn cycle(rate: Option<f64>) -> Cycle {
    Cycle {
        specimen: 0,
        levels: vec![Level {
            amplitude: Constant(0.02),
            cycles: 1,
        }],
        sides: Sides::Both,
        about: Constant(0.001),
        points: 3,
        samples: 2,
        pause: Constant(0.1),
        speed: rate.map(|_| Constant(0.01)),
        rate: rate.map(Constant),
        inspect: Vec::new(),
        fit: None,
        evenly: false,
    }
}

/// A record of a version whose targets stood evenly is played back so; what this version writes is not.
#[test]
fn a_cycle_is_played_back_by_the_spacing_of_its_time() {
    let plan = |evenly| {
        elastic_plan(
            300.0,
            vec![ProcedureKind::Cycle(Cycle {
                evenly,
                ..cycle(None)
            })],
        )
    };
    for (evenly, rules, fits) in [(true, 2, true), (true, 3, false), (false, 3, true)] {
        let (_, recorded, bytes) = recorded(&plan(evenly));
        assert!(recorded.fault.is_none());
        let (_, mut played) = played(&bytes);
        played.header.rules = rules;
        assert_eq!(
            replay(&plan(false), played).mismatch.is_none(),
            fits,
            "even: {evenly}, rules {rules}"
        );
    }
}

/// Two floors on a ground that shakes, and stops for a look. They yield, so that a way gone twice would show.
fn shaken(mode: Mode) -> Plan {
    let behaviour = |stiffness| Behaviour::Bilinear {
        stiffness,
        yield_force: stiffness * 0.0002,
        hardening: 0.1,
    };
    let storey = |mass, stiffness| Storey::new(mass, stiffness, behaviour(stiffness));
    let mut plan = elastic_plan(300.0, Vec::new());
    plan.specimens[0].behaviour = None;
    plan.specimens[0].frame = Some(Frame::of_storeys(vec![
        storey(2000.0, 3e6),
        storey(1500.0, 2e6),
    ]));
    plan.grounds = vec![Ground {
        name: "quake".to_owned(),
        file: "quake.csv".to_owned(),
        unit: 1.0,
        scale: 1.0,
        scale_uncertainty: 0.0,
        times: vec![0.0, 0.02, 0.04, 0.06],
        accelerations: vec![0.0, 8.0, -6.0, 0.0],
    }];
    let shake = Shake {
        specimen: 0,
        ground: 0,
        damping: ShakeDamping::Rayleigh(Constant(0.02)),
        damping_uncertainty: 0.0,
        stepping: Stepping {
            integrator: Integrator::Explicit,
            mode,
            inspect: if mode == Mode::StepAndPause {
                vec![InspectTrigger::Every(4)]
            } else {
                Vec::new()
            },
            ..every(0.01)
        },
        scale: Constant(1.0),
        duration: None,
    };
    plan.procedures = elastic_plan(300.0, vec![ProcedureKind::Shake(shake)]).procedures;
    plan
}

fn escalating() -> Plan {
    let value = Formula::Result(ResultReference {
        procedure: ProcedureId(0),
        name: "max_velocity",
        part: Part::Value,
    });
    // The blows are over before their peak, which would decide nothing.
    let below = Condition {
        text: String::new(),
        value,
        test: Test::Compare {
            comparison: Comparison::Less,
            limit: Constant(0.8),
        },
        dimension: Dimension::VELOCITY,
    };
    yielding(vec![ProcedureKind::Escalate(Escalate {
        own: ProcedureId(0),
        impact: Impact {
            duration: Constant(0.03),
            ..short(Mode::StepAndPause)
        },
        velocities: [0.2, 0.4, 0.6].map(Constant).to_vec(),
        energies: None,
        condition: vec![below],
        between: Between::Unload,
        inspect_between: true,
    })])
}

fn unloading() -> Plan {
    let unload = Unload {
        specimen: 0,
        stiffness: Constant(500.0),
        within: None,
        speed: None,
    };
    yielding(vec![to(0.03), ProcedureKind::Unload(unload)])
}

/// The upper floor is struck, and the actuators never stop.
fn struck_on_the_way() -> Plan {
    let mut plan = struck_frame();
    if let ProcedureKind::Impact(blow) = &mut plan.procedures[0].kind {
        (blow.stepping.mode, blow.duration) = (CONTINUOUS, Constant(0.05));
    }
    plan
}

/// Out past yield and back, each pause watched; then anew.
fn watched() -> Plan {
    let watched = StiffnessRamp {
        displacements: [0.005, 0.02].map(Constant).to_vec(),
        pause: Constant(0.2),
        samples: 2,
        repeats: 2,
        return_path: true,
        relaxation: Some(WatchedHold {
            model: WatchedModel::Reached {
                law: None,
                rate: 1.0,
            },
            readings: 3,
        }),
        ..ramp(1e-4)
    };
    yielding(vec![ProcedureKind::StiffnessRamp(watched), to(0.0)])
}

/// Zeros are read, also during a look, and the rig goes back for the last.
fn drifting() -> Plan {
    let ramped = StiffnessRamp {
        pause: Constant(0.5),
        displacements: vec![Constant(1e-3), Constant(2e-3)],
        ..ramp(1e-4)
    };
    let looked = ProcedureKind::Inspect {
        note: "look".to_owned(),
    };
    let mut plan = elastic_plan(300.0, vec![ProcedureKind::StiffnessRamp(ramped), looked]);
    plan.rig.drift = Some(DriftCheck {
        force: 1.0,
        displacement: Some(1e-6),
        over: 0.4,
        after: ZeroAfter::Start,
    });
    plan
}

/// Two blows on the upper of two floors, the load taken off both after each, and once more.
fn frame_row() -> Plan {
    let mut plan =
        crate::tests::procedures::frame::impact_series::rising(&[0.4, 0.8], Between::Unload);
    let ProcedureKind::Escalate(escalate) = &mut plan.procedures[0].kind else {
        panic!()
    };
    escalate.inspect_between = true;
    let blow = &mut escalate.impact;
    blow.duration = Constant(0.03);
    let unload = ProcedureKind::FrameUnload(FrameUnload {
        specimen: 0,
        within: Some(Constant(1e-6)),
        speed: None,
    });
    plan.procedures.push(Procedure {
        name: "rest".to_owned(),
        kind: unload,
    });
    plan
}

/// A sweep about a place past yield: one stroke that is not read takes the flow before those that are.
fn swept_past_yield() -> Plan {
    let sweep = DampingSweep {
        specimen: 0,
        velocities: vec![Constant(0.01), Constant(0.02)],
        stroke: Constant(5e-3),
        about: Some(Constant(0.03)),
        stiffness: Constant(300.0),
        rate: Some(Constant(24.0)),
    };
    yielding(vec![ProcedureKind::DampingSweep(sweep), to(0.0)])
}

/// Every plan here, by what it shows.
fn plans() -> Vec<(&'static str, Plan)> {
    vec![
        (
            "continuous",
            yielding(vec![ProcedureKind::Impact(short(CONTINUOUS))]),
        ),
        ("cycle", yielding(vec![ProcedureKind::Cycle(cycle(None))])),
        (
            "cycle without a stop",
            yielding(vec![ProcedureKind::Cycle(cycle(Some(2.0)))]),
        ),
        ("escalate", escalating()),
        ("drift", drifting()),
        ("shake", shaken(Mode::StepAndPause)),
        ("shake without a stop", shaken(CONTINUOUS)),
        ("storey without a stop", struck_on_the_way()),
        ("unload", unloading()),
        ("escalate on a storey", frame_row()),
        ("watched", watched()),
        ("sweep past yield", swept_past_yield()),
    ]
}

fn killed(name: &str) {
    let plan = plans().into_iter().find(|(own, _)| *own == name).unwrap().1;
    killed_everywhere(&plan, 30);
}

#[test]
fn a_continuous_blow() {
    killed("continuous");
}

#[test]
fn cycles() {
    killed("cycle");
    killed("cycle without a stop");
}

#[test]
fn rising_blows() {
    killed("escalate");
}

#[test]
fn rising_blows_on_a_storey() {
    killed("escalate on a storey");
}

#[test]
fn a_shake_of_two_floors() {
    // Both storeys have yielded, each at 0.2 mm: a part of a way gone twice would be felt.
    let (_, whole, _) = recorded(&shaken(CONTINUOUS));
    let drifts = whole.record.procedures[0]
        .result("max_drift")
        .map(|result| result.value.clone());
    assert!(
        matches!(drifts, Some(ResultValue::List(drifts)) if drifts.iter().all(|drift| *drift > 4e-4))
    );
    killed("shake");
    killed("shake without a stop");
}

#[test]
fn a_blow_on_a_storey_without_a_stop() {
    killed("storey without a stop");
}

#[test]
fn pauses_that_are_watched() {
    killed("watched");
}

/// Nothing of a stroke that flowed is read, and what is read comes back over the line that it went: there is no damper.
#[test]
fn a_sweep_about_a_place_past_yield() {
    let (_, whole, _) = recorded(&swept_past_yield());
    let (damping, _) = crate::tests::testing::number(&whole.record, 0, "damping");
    assert!(damping.unwrap().abs() < 1e-9, "{damping:?}");
    let History::Sweep(sweep) = &whole.record.procedures[0].history else {
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
fn each_is_played_back_to_the_last_bit_and_told_at_the_same_times_without_a_record() {
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
                ..short(Mode::StepAndPause)
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
        let replayed = replay(&plan, played(&bytes).1);
        assert_eq!(replayed.mismatch, None, "{name}");
        assert_eq!(
            format!("{:?}", replayed.record),
            format!("{:?}", whole.record),
            "{name}: played back"
        );
        let plain = run(&plan, &mut Standing::new(&plan), &mut Witness);
        // What the rig mended is counted from its first reading on in either.
        assert_eq!(
            format!("{plain:?}"),
            format!("{:?}", whole.record),
            "{name}: not recorded"
        );
    }
}

#[test]
fn a_restart_on_record_needs_a_reference_whatever_else_is_said() {
    let plan = crate::tests::testing::empty_plan();
    let fault = DeviceFault::Rebooted {
        was: "running".to_owned(),
        is: "Grbl 1.1h".to_owned(),
    };
    let of = |fault: &str| {
        let disk = PowerLoss::new();
        let mut journal = Journal::create(Box::new(disk.clone()), Durability::EveryPromise);
        begin(&mut journal, &header(), &["text".to_owned()]).unwrap();
        journal
            .append(EntryKind::Rig, &RigBody::of(&Standing::new(&plan)))
            .unwrap();
        let fault = RigFault::Device(format!("actuator on /dev/ttyUSB0: {fault}"));
        journal
            .append(
                EntryKind::Fault,
                &FaultBody {
                    t: 0.0,
                    call: Call::Execute,
                    fault,
                    wall: None,
                },
            )
            .unwrap();
        journal.sync().unwrap();
        played(&disk.written()).1
    };
    let restarted = of(&fault.to_string());
    let refused = not_restarted(&restarted, &[Assurance::SamePowerUp, Assurance::LetGo]);
    assert!(
        matches!(refused, Err(Refusal::Restarted { .. })),
        "{refused:?}"
    );
    assert_eq!(
        not_restarted(&restarted, &[Assurance::ReReferenced]),
        Ok(())
    );
    assert_eq!(
        not_restarted(&of("the line is gone: unplugged"), &[]),
        Ok(())
    );
}

#[test]
fn a_rig_that_cannot_say_that_it_was_not_switched_off_needs_the_word_of_a_person() {
    let plan = crate::tests::testing::empty_plan();
    let of = |boot: Option<&str>| Identity {
        boot: boot.map(str::to_owned),
        ..Standing::new(&plan).identity()
    };
    let (nothing, word, anew) = (
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
            Some(Refusal::PowerUpUnknown),
            "{mute:?}"
        );
        assert_eq!(
            (refused(mute.0, mute.1, word), refused(mute.0, mute.1, anew)),
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
                matches!(refused(was, is, assured), Some(Refusal::Rebooted { .. })),
                "no word outweighs what it says: {was:?} {is:?}"
            );
        }
        assert_eq!(refused(was, is, anew), None, "{was:?} {is:?}");
    }
}
