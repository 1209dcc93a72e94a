//! Continuous runs on the virtual rig: compared with ramp-and-hold and with closed forms, and replayed from their run log.

use crate::tests::testing::{elastic_plan, every, impact, run_unwatched};
use psd_plan::formula::Formula::Constant;
use psd_plan::record::{History, ImpactStep, Outcome, Record};
use psd_plan::{
    Contact, Impact, Integrator, Interval, Link, Mode, Move, Plan, ProcedureKind, Stepping, Until,
    VirtualLink,
};
use psd_testing::journal::AlterEntry as _;

const STIFFNESS: f64 = 300.0;
const SCALE: f64 = 100.0;

fn steps(record: &Record) -> Vec<ImpactStep> {
    assert_eq!(record.outcome, Outcome::Completed);
    match &record.procedures.last().unwrap().history {
        History::Impact(impact) => impact.steps.iter().collect(),
        other => panic!("{other:?}"),
    }
}

/// Steps by explicit Newmark, corrected to the targets in continuous mode.
fn explicit(mode: Mode, time_step: f64) -> Stepping {
    Stepping {
        mode,
        integrator: Integrator::Explicit,
        i_modification: mode != Mode::RampAndHold,
        ..every(time_step)
    }
}

/// Released at 10 mm from rest, with the striker out of reach, for half a second.
fn let_go(mode: Mode, damping: f64, coulomb: f64, time_step: f64) -> Plan {
    let struck = Impact {
        stepping: explicit(mode, time_step),
        duration: Constant(0.5),
        until: Until::Duration,
        ..impact(Constant(STIFFNESS))
    };
    let out = Move {
        to: Constant(0.01),
        speed: None,
    };
    let mut plan = elastic_plan(
        STIFFNESS,
        vec![ProcedureKind::Move(out), ProcedureKind::Impact(struck)],
    );
    plan.strikers[0].gap = 1000.0;
    plan.specimens[0].damping = damping;
    plan.specimens[0].coulomb = coulomb;
    plan
}

const CONTINUOUS: Mode = Mode::Continuous { time_scale: SCALE };

/// Energy that the structure has lost at the end \[J\]: initial energy minus final energy.
fn lost(plan: &Plan) -> f64 {
    let record = run_unwatched(plan);
    let last = *steps(&record).last().unwrap();
    0.5 * STIFFNESS * (1e-4 - last.computed * last.computed) - 0.5 * last.velocity * last.velocity
}

/// A damper of c on the cell acts as C = c/scale: E(t) of d'' + (C/M)d' + (K/M)d = 0 in closed form, M = 1 kg.
#[test]
fn a_damper_absorbs_the_energy_of_the_closed_form_and_ramp_and_hold_shows_none_of_it() {
    let (damper, end) = (50.0, 0.5);
    let rate = damper / SCALE / 2.0;
    let damped = f64::sqrt(STIFFNESS - rate * rate);
    let decay = 0.01 * f64::exp(-rate * end);
    let (sine, cosine) = ((damped * end).sin(), (damped * end).cos());
    let displacement = decay * (cosine + rate / damped * sine);
    let velocity = -decay * (damped + rate * rate / damped) * sine;
    let exact = 0.5 * STIFFNESS * (1e-4 - displacement * displacement) - 0.5 * velocity * velocity;
    assert!(exact > 0.15 * 0.5 * STIFFNESS * 1e-4, "enough to be seen");
    let error = |time_step| lost(&let_go(CONTINUOUS, damper, 0.0, time_step)) - exact;
    let (coarse, fine) = (error(1e-3), error(5e-4));
    assert!((coarse / fine).log2() > 0.9, "{coarse} J, {fine} J");
    assert!(fine.abs() < 2e-3 * exact, "{fine} J of {exact} J");
    assert!(lost(&let_go(Mode::RampAndHold, damper, 0.0, 5e-4)).abs() < 1e-4 * exact);
}

/// Friction dissipates F_c over the whole path, in either mode: the cell keeps its sign through a pause.
#[test]
fn friction_dissipates_its_force_times_the_travel() {
    let friction = 0.05;
    for mode in [CONTINUOUS, Mode::RampAndHold] {
        let plan = let_go(mode, 0.0, friction, 5e-4);
        let record = run_unwatched(&plan);
        let travel: f64 = steps(&record)
            .windows(2)
            .map(|pair| (pair[1].computed - pair[0].computed).abs())
            .sum();
        let found = lost(&plan);
        assert!(
            (found - friction * travel).abs() < 0.02 * friction * travel,
            "{mode:?}: {found} J of {} J",
            friction * travel
        );
    }
}

/// Without damping, an ideal rig gets the same targets and reads the same forces there, in either mode. The same applies to the paper's
/// first example with its impacts.
#[test]
fn without_damping_both_modes_are_the_same_run() {
    let by = |mode| {
        let struck = Impact {
            stepping: explicit(mode, 1e-3),
            ..impact(Constant(327.65))
        };
        run_unwatched(&elastic_plan(327.65, vec![ProcedureKind::Impact(struck)]))
    };
    let (one, other) = (by(CONTINUOUS), by(Mode::RampAndHold));
    assert_eq!(steps(&one).len(), steps(&other).len());
    for (one, other) in steps(&one).iter().zip(steps(&other)) {
        assert!(
            (one.command - other.command).abs() < 1e-14
                && (one.restoring_force - other.restoring_force).abs() < 1e-11
        );
        assert_eq!(one.state, other.state);
    }
    // A step takes the time scale times Δt of laboratory time, for every path.
    let wall: Vec<f64> = steps(&one).iter().map(|step| step.wall_time).collect();
    assert!(
        wall.windows(2)
            .all(|pair| (pair[1] - pair[0] - 0.1).abs() < 1e-9),
        "{wall:?}"
    );
}

/// The reading is K·d̃ plus the damper force at the velocity at the target, to first order of the step. This also applies directly after
/// an impact. An impact is an impulse and has no lasting effect. With the acceleration of the impact kept, half its velocity jump would
/// also be measured, at any step. A limit force lasts, and is kept.
#[test]
fn after_an_impact_the_damper_acts_at_the_velocity_of_the_structure() {
    let damper = 50.0;
    let worst = |contact: Contact, time_step: f64| {
        let struck = Impact {
            stepping: explicit(CONTINUOUS, time_step),
            contact,
            duration: Constant(0.2),
            until: Until::Duration,
            ..impact(Constant(STIFFNESS))
        };
        let mut plan = elastic_plan(STIFFNESS, vec![ProcedureKind::Impact(struck)]);
        plan.specimens[0].damping = damper;
        let record = run_unwatched(&plan);
        let steps = steps(&record);
        let (mut worst, mut jump) = (0.0_f64, 0.0_f64);
        for three in steps.windows(3) {
            let forces = [0, 1, 2].map(|step: usize| three[step].contact_force);
            let velocity = (three[2].command - three[0].command) / (three[2].time - three[0].time);
            jump = jump.max(forces[1] * time_step);
            // The impact at the end of a step is not smooth motion. The same applies to the first and last step of a lasting impact.
            if forces[1] == 0.0 || (forces[0] == forces[1] && forces[1] == forces[2]) {
                let damping_force = three[1].restoring_force - STIFFNESS * three[1].command;
                worst = worst.max((damping_force - damper / SCALE * velocity).abs());
            }
        }
        (worst, damper / SCALE * jump)
    };
    for (contact, share) in [
        (Contact::Rigid, 0.02),
        (
            Contact::Limit {
                force: Constant(1500.0),
            },
            0.6,
        ),
    ] {
        let ((coarse, jump), (fine, _)) =
            (worst(contact.clone(), 2e-4), worst(contact.clone(), 1e-4));
        assert!(coarse < share * jump, "{contact:?}: {coarse} N of {jump} N");
        assert!(
            (1.7..4.5).contains(&(coarse / fine)),
            "{contact:?}: {coarse} N and {fine} N"
        );
    }
}

/// While a target is computed, the actuator continues at its last acceleration, but not at that of an impact. A velocity jump is not a
/// trend.
#[test]
fn an_impact_is_not_extrapolated_as_a_trend() {
    use crate::run::Unwatched;
    use crate::run::replay::{begin, record};
    use psd_rig::VirtualRig;
    use psd_rig::journal::{Durability, EntryKind, Journal};
    use psd_testing::journal::PowerLoss;
    use psd_testing::journal::recover;

    let time_step = 1e-3;
    let struck = Impact {
        stepping: explicit(CONTINUOUS, time_step),
        ..impact(Constant(STIFFNESS))
    };
    let plan = elastic_plan(STIFFNESS, vec![ProcedureKind::Impact(struck)]);
    let disk = PowerLoss::new();
    let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
    begin(
        &mut journal,
        &crate::tests::testing::header(&plan),
        &["text".to_owned()],
    )
    .unwrap();
    let whole = record(
        &plan,
        &mut VirtualRig::of_plan(&plan),
        &mut Unwatched,
        journal,
        Box::new(|| None),
    );
    let hardest = steps(&whole.record)
        .iter()
        .map(|step| STIFFNESS * step.computed.abs())
        .fold(0.0, f64::max);
    assert!(
        steps(&whole.record)
            .iter()
            .filter(|step| step.contact_force > 0.0)
            .count()
            > 1
    );
    let lines = recover(&disk.written()).unwrap().lines;
    let number = |path: &serde_json::Value, name: &str| path[name].as_f64().unwrap();
    let paths: Vec<serde_json::Value> = lines
        .into_iter()
        .filter(|line| line.kind == EntryKind::Intent)
        .map(|line| line.body()["path"][0].clone())
        .collect();
    // Every other path is one ahead; the last is the brake.
    for ahead in paths.iter().step_by(2).take(paths.len() / 2) {
        let gained = (number(ahead, "end_velocity") - number(ahead, "start_velocity")).abs();
        let smooth = 1.01 * hardest * number(ahead, "seconds") / SCALE.powi(2);
        assert!(
            gained <= smooth,
            "{gained} m/s gained, {smooth} m/s by the specimen alone: {ahead}"
        );
    }
}

/// A lag leaves the piston v·lag behind its target. With the correction, the run is near the ideal run. With raw readings, the lag adds
/// energy, and the monitor holds the rig.
#[test]
fn the_reading_is_corrected_to_the_target() {
    let lagging = |correct: bool| {
        let mut plan = let_go(CONTINUOUS, 0.0, 0.0, 5e-4);
        plan.rig.link = Link::Virtual(VirtualLink {
            lag: 0.1,
            ..VirtualLink::default()
        });
        // The striker passes without contact: its energy is the reference of the relative errors.
        plan.limits.tracking_energy_error = Interval {
            low: 0.0,
            high: 1e6,
        };
        if let ProcedureKind::Impact(impact) = &mut plan.procedures[1].kind {
            impact.stepping.i_modification = correct;
        }
        plan
    };
    let start = 0.5 * STIFFNESS * 1e-4;
    let (corrected, raw) = (lost(&lagging(true)), lost(&lagging(false)));
    assert!(corrected.abs() < 0.01 * start, "{corrected} J of {start} J");
    // x(t) is read at x(t − lag/scale): C = −K·lag/scale, and the energy grows by exp(K·lag/scale·t).
    let grown = f64::exp(STIFFNESS * 0.1 / SCALE * 0.5) - 1.0;
    assert!(
        (-raw / start - grown).abs() < 0.1 * grown,
        "{} against {grown}",
        -raw / start
    );
}

#[test]
fn a_continuous_run_is_stopped_by_a_reading_during_the_motion() {
    let mut plan = let_go(CONTINUOUS, 50.0, 0.0, 1e-3);
    plan.limits.speed = Interval {
        low: 0.0,
        high: 1e-3,
    };
    let record = run_unwatched(&plan);
    assert!(
        matches!(&record.outcome, Outcome::Aborted { reason } if reason.contains("speed")),
        "{:?}",
        record.outcome
    );
    let mut plan = let_go(CONTINUOUS, 50.0, 0.0, 1e-3);
    plan.limits.force = Interval {
        low: -1.0,
        high: 10.0,
    };
    let record = run_unwatched(&plan);
    assert!(
        matches!(&record.outcome, Outcome::Aborted { reason } if reason.contains("force")),
        "{:?}",
        record.outcome
    );
}

/// The recorded continuous run is replayed bit-identically. With one bit of a path changed, the replay differs.
#[test]
fn a_continuous_run_is_played_back_from_its_record() {
    use crate::run::Unwatched;
    use crate::run::replay::{LoggedRun, begin, record, replay};
    use psd_rig::VirtualRig;
    use psd_rig::journal::{Durability, EntryKind, Journal};
    use psd_testing::journal::PowerLoss;
    use psd_testing::journal::recover;

    let mut plan = let_go(CONTINUOUS, 50.0, 0.05, 5e-3);
    plan.rig.link = Link::Virtual(VirtualLink {
        lag: 0.02,
        noise: 0.01,
        seed: 5,
        ..VirtualLink::default()
    });
    let disk = PowerLoss::new();
    let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
    begin(
        &mut journal,
        &crate::tests::testing::header(&plan),
        &["text".to_owned()],
    )
    .unwrap();
    let mut rig = VirtualRig::of_plan(&plan);
    let whole = record(&plan, &mut rig, &mut Unwatched, journal, Box::new(|| None));
    assert_eq!(
        whole.record.outcome,
        Outcome::Completed,
        "{:?}",
        whole.record.events
    );
    let recovered = recover(&disk.written()).unwrap();
    let again = replay(&plan, LoggedRun::of(&recovered).unwrap());
    assert_eq!(again.mismatch, None);
    assert_eq!(format!("{:?}", again.record), format!("{:?}", whole.record));

    let path = recovered
        .lines
        .iter()
        .rposition(|line| line.kind == EntryKind::Intent && !line.body()["path"].is_null())
        .unwrap();
    let mut forged = recovered;
    let velocity = forged.lines[path].body()["path"][0]["start_velocity"]
        .as_f64()
        .unwrap();
    forged.lines[path].alter(|body| {
        body["path"][0]["start_velocity"] =
            serde_json::json!(f64::from_bits(velocity.to_bits() ^ 1));
    });
    assert!(
        replay(&plan, LoggedRun::of(&forged).unwrap())
            .mismatch
            .is_some()
    );
}

/// A lag of 0.35 rad of a free vibration makes the actuator trail by a third of the energy twice a cycle. The actuator still reaches the
/// target. With the correction by the spring's own K this is not an error, and the run continues as if without lag. Without the
/// correction the rig is put on hold.
#[test]
fn a_corrected_lag_holds_no_run() {
    let with = |lag: f64, i_modification: bool| {
        let mut plan = let_go(CONTINUOUS, 0.0, 0.0, 1e-3);
        plan.strikers[0].mass = 1e-6;
        plan.rig.link = Link::Virtual(VirtualLink {
            lag,
            ..VirtualLink::default()
        });
        // It begins at the commanded position.
        plan.rig.settle.band = 1e-10;
        let ProcedureKind::Impact(impact) = &mut plan.procedures[1].kind else {
            panic!()
        };
        impact.stepping.i_modification = i_modification;
        run_unwatched(&plan)
    };
    let (late, prompt) = (with(2.0, true), with(0.0, true));
    let behind = steps(&late)
        .iter()
        .map(|step| (step.displacement - step.computed).abs())
        .fold(0.0, f64::max);
    assert!(behind > 3e-3, "{behind} m");
    for (late, prompt) in steps(&late).iter().zip(steps(&prompt)) {
        assert!((late.computed - prompt.computed).abs() < 1e-9);
        // Relative to ½K(10 mm)².
        assert!(
            late.tracking.energy_error.abs() < 1e-6 * 0.015,
            "{:?}",
            late.tracking
        );
    }
    assert!(
        matches!(&with(2.0, false).outcome, Outcome::Aborted { reason } if reason.contains("tracking energy"))
    );
}
