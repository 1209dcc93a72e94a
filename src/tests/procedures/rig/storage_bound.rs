//! Estimated size of a run's record compared with the size written: never smaller, and not much larger.

use crate::plan::formula::Formula::Constant;
use crate::plan::{
    Between, Cycle, DampingSweep, FRAME, Interval, Level, Mode, Move, Plan, ProcedureKind, Sides,
    Stepping, StiffnessRamp, Unload, Until,
};
use crate::procedures::storage_bound;
use crate::record::Outcome;
use crate::record::journal::testing::PowerLoss;
use crate::record::journal::{Durability, Journal};
use crate::rig::virtual_rig;
use crate::run::Unwatched;
use crate::run::replay;
use crate::tests::testing;
use crate::tests::testing::{elastic_plan, every, header, impact, ramp, result_of};

/// Bytes of the record.
fn written(plan: &Plan) -> u64 {
    let disk = PowerLoss::new();
    let mut journal = Journal::create(Box::new(disk.clone()), Durability::EveryPromise);
    replay::begin(&mut journal, &header(), &[]).unwrap();
    let mut rig = virtual_rig(plan);
    let recorded = replay::record(
        plan,
        rig.as_mut(),
        &mut Unwatched,
        journal,
        Box::new(|| None),
    );
    assert_eq!(
        recorded.record.outcome,
        Outcome::Completed,
        "{:?}",
        recorded.record.events
    );
    disk.written().len() as u64
}

/// Reckoned bytes over those written.
fn ratio(plan: &Plan) -> f64 {
    let need = storage_bound::of(plan);
    assert!(need.unknown.is_empty() && need.bytes > need.record);
    #[expect(clippy::cast_precision_loss, reason = "some hundred thousand")]
    let (reckoned, written) = (need.record as f64 - FRAME, written(plan) as f64);
    reckoned / written
}

fn sweep() -> DampingSweep {
    DampingSweep {
        specimen: 0,
        velocities: vec![Constant(0.01), Constant(0.02)],
        stroke: Constant(1e-3),
        about: None,
        stiffness: result_of(0, "stiffness"),
        rate: None,
    }
}

fn cycle(rate: Option<f64>) -> Cycle {
    Cycle {
        specimen: 0,
        levels: vec![
            Level {
                amplitude: Constant(0.004),
                cycles: 3,
            },
            Level {
                amplitude: Constant(0.008),
                cycles: 2,
            },
        ],
        sides: Sides::Both,
        about: Constant(0.0),
        points: 10,
        samples: 2,
        pause: Constant(0.0),
        speed: rate.map(|_| Constant(0.01)),
        rate: rate.map(Constant),
        inspect: Vec::new(),
        fit: None,
        evenly: false,
    }
}

#[test]
fn no_procedure_writes_more_than_it_is_reckoned_to() {
    let stiffness = ProcedureKind::StiffnessRamp(StiffnessRamp {
        samples: 3,
        repeats: 4,
        return_path: true,
        ..ramp(1e-4)
    });
    let long = || crate::plan::Impact {
        until: Until::Duration,
        duration: Constant(3.0),
        ..impact(Constant(300.0))
    };
    let mut measured = long();
    measured.point_mut().stiffness = result_of(0, "stiffness");
    let continuous = crate::plan::Impact {
        stepping: Stepping {
            mode: Mode::Continuous { time_scale: 100.0 },
            ..every(0.01)
        },
        ..long()
    };
    let to = |place| {
        ProcedureKind::Move(Move {
            to: Constant(place),
            speed: None,
        })
    };
    let unload = ProcedureKind::Unload(Unload {
        specimen: 0,
        stiffness: Constant(200.0),
        within: None,
        speed: None,
    });
    let plans = [
        ("ramp", vec![stiffness.clone()], 4.0),
        (
            "sweep",
            vec![stiffness.clone(), ProcedureKind::DampingSweep(sweep())],
            4.0,
        ),
        ("impact", vec![ProcedureKind::Impact(long())], 3.0),
        (
            "impact by a ramp",
            vec![stiffness.clone(), ProcedureKind::Impact(measured)],
            4.0,
        ),
        ("continuous", vec![ProcedureKind::Impact(continuous)], 3.0),
        ("cycle", vec![ProcedureKind::Cycle(cycle(None))], 3.0),
        (
            "cycle without a stop",
            vec![ProcedureKind::Cycle(cycle(Some(100.0)))],
            3.0,
        ),
        // Fifty targets are allowed, two are needed.
        ("unload", vec![to(0.01), unload], 40.0),
    ];
    for (name, procedures, most) in plans {
        let ratio = ratio(&elastic_plan(300.0, procedures));
        assert!(
            (1.0..most).contains(&ratio),
            "{name}: reckoned {ratio:.2} times what was written"
        );
    }
    let velocities = [0.4, 0.8];
    let ratio_of = |between| {
        ratio(&crate::tests::procedures::frame::impact_series::rising(
            &velocities,
            between,
        ))
    };
    for (between, most) in [(Between::Home, 8.0), (Between::Unload, 8.0)] {
        let ratio = ratio_of(between);
        assert!(
            (1.0..most).contains(&ratio),
            "blows on a storey, {between:?}: reckoned {ratio:.2} times what was written"
        );
    }
    // Each way home in many increments.
    let mut short = elastic_plan(300.0, vec![to(0.01), to(0.0)]);
    short.limits.displacement = Interval {
        low: 0.0,
        high: 0.01,
    };
    short.limits.increment = Interval {
        low: 0.0,
        high: 1e-4,
    };
    let ratio = ratio(&short);
    assert!((1.0..8.0).contains(&ratio), "{ratio}");
}

#[test]
fn what_hangs_on_what_is_not_measured_yet_is_named() {
    let mut later = impact(Constant(300.0));
    later.duration = result_of(0, "relaxation");
    let plan = elastic_plan(
        300.0,
        vec![
            ProcedureKind::StiffnessRamp(ramp(1e-4)),
            ProcedureKind::Impact(later),
        ],
    );
    assert_eq!(storage_bound::of(&plan).unknown, ["p1"]);
    assert_eq!(testing::run_unwatched(&plan).procedures.len(), 2);
}
