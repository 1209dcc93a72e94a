//! Cycles as run on virtual rigs.

use crate::tests::testing::{elastic_plan, list, number, run_unwatched};
use psd_plan::formula::Formula::Constant;
use psd_plan::record::{CycleHistory, EventKind, History, Outcome, Record};
use psd_plan::{Behaviour, Cycle, CycleInspection, Level, Plan, ProcedureKind, Sides};

fn cycle(amplitudes: &[f64], cycles: u32) -> Cycle {
    Cycle {
        specimen: 0,
        levels: amplitudes
            .iter()
            .map(|amplitude| Level {
                amplitude: Constant(*amplitude),
                cycles,
            })
            .collect(),
        sides: Sides::Both,
        about: Constant(0.0),
        points: 10,
        samples: 1,
        pause: Constant(0.0),
        speed: None,
        rate: None,
        inspect: Vec::new(),
        fit: None,
    }
}

fn plan(cycle: Cycle) -> Plan {
    elastic_plan(1000.0, vec![ProcedureKind::Cycle(cycle)])
}

/// K 1000 N/m, `F_y` 10 N at 10 mm, α 0.1.
fn yielding(cycle: Cycle) -> Plan {
    let mut plan = plan(cycle);
    plan.specimens[0].behaviour = Some(Behaviour::Bilinear {
        stiffness: 1000.0,
        yield_force: 10.0,
        post_yield_ratio: 0.1,
    });
    plan
}

fn history(record: &Record) -> &CycleHistory {
    match &record.procedures[0].history {
        History::Cycle(history) => history,
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_elastic_specimen_gives_everything_back() {
    let record = run_unwatched(&plan(cycle(&[0.001, 0.004], 2)));
    assert_eq!(record.outcome, Outcome::Completed);
    assert!(number(&record, 0, "dissipated_energy").0.unwrap().abs() < 1e-16);
    assert_eq!(
        (
            number(&record, 0, "max_force").0,
            number(&record, 0, "min_force").0
        ),
        (Some(4.0), Some(-4.0))
    );
    assert!((number(&record, 0, "stiffness").0.unwrap() - 1000.0).abs() < 1e-9);
    assert_eq!(
        (
            list(&record, 0, "energies").len(),
            number(&record, 0, "cycles").0
        ),
        (4, Some(4.0))
    );
    assert_eq!(history(&record).steps.len(), 1 + 4 * 40);
    assert_eq!(history(&record).steps.last().unwrap().command, 0.0);
}

/// The second cycle at 20 mm is a closed parallelogram: 4·10·0.9·(0.02 − 0.01) J. Its yield points are 20 mm back from each end, in the
/// middle, which is a target. The trapezoid is therefore exact.
#[test]
fn a_yielding_specimen_spends_the_area_of_its_loop() {
    let record = run_unwatched(&yielding(Cycle {
        points: 30,
        ..cycle(&[0.02], 2)
    }));
    let energies = list(&record, 0, "energies");
    assert!((energies[1] - 0.36).abs() < 1e-12, "{} J", energies[1]);
    // The first cycle begins on the backbone curve: the sum of the areas under it, by hand.
    // 0 → 20 mm: ½·10·10 mm + 10.5·10 mm; → −20 mm over the yield point at 0, −9 N; → 0, 9 N.
    let by_curve = 0.155
        + (0.5 * (11.0 - 9.0) * -0.02 + 0.5 * (-9.0 - 11.0) * -0.02)
        + 0.5 * (-11.0 + 9.0) * 0.02;
    // The chord between the targets beside the first yield point, at 10 mm and 10 N, leaves out a triangle.
    let steps = &history(&record).steps;
    let after = steps.iter().position(|step| step.command > 0.01).unwrap();
    let [before, after] = [after - 1, after].map(|at| steps[at].command);
    let (force_before, force_after) = (1000.0 * before, 10.0 + 100.0 * (after - 0.01));
    let chord = force_before + (force_after - force_before) * (0.01 - before) / (after - before);
    let by_hand = by_curve - 0.5 * (after - before) * (10.0 - chord);
    assert!(
        (energies[0] - by_hand).abs() < 1e-12,
        "{} J is not {by_hand} J",
        energies[0]
    );
    assert!((number(&record, 0, "dissipated_energy").0.unwrap() - by_hand - 0.36).abs() < 1e-12);
    assert!((number(&record, 0, "last_stiffness").0.unwrap() - 550.0).abs() < 1e-9);
    // ζ = E_D/(4π·½·K_sec·a²) = 0.36/(2π·550·4e-4).
    let ratio = 0.36 / (2.0 * std::f64::consts::PI * 550.0 * 4e-4);
    assert!((number(&record, 0, "equivalent_damping_ratio").0.unwrap() - ratio).abs() < 1e-12);
}

/// Friction on the cell keeps the sign of the last motion, so each cycle dissipates 4·F_c·a. At the reversals the trapezoid crosses the
/// jump and loses F_c·h at each of the two ends. The first step back h is less than half of a regular one.
#[test]
fn friction_costs_its_force_times_the_travel() {
    let energy = |points: u32| {
        let mut plan = plan(Cycle {
            points,
            ..cycle(&[0.01], 2)
        });
        plan.specimens[0].coulomb = 3.0;
        list(&run_unwatched(&plan), 0, "energies")[1]
    };
    let exact = 4.0 * 3.0 * 0.01;
    for points in [10, 20, 40] {
        let even = 0.01 / f64::from(points);
        let step = 2.0
            * 0.01
            * psd_physics::identification::loop_sampling::spaced(0.5 / f64::from(points));
        assert!(0.25 * even < step && step < 0.5 * even, "{step} m");
        let lost = 2.0 * 3.0 * step;
        assert!(
            (energy(points) - (exact - lost)).abs() < 1e-12,
            "{points}: {}",
            energy(points)
        );
    }
}

#[test]
fn one_sided_cycles_go_to_one_side_and_elsewhere() {
    let record = run_unwatched(&plan(Cycle {
        sides: Sides::Push,
        about: Constant(0.002),
        ..cycle(&[0.001], 1)
    }));
    let commands = history(&record).steps.iter().map(|step| step.command);
    let (low, high) = commands.fold((f64::MAX, f64::MIN), |(low, high), x| {
        (low.min(x), high.max(x))
    });
    assert_eq!(
        (low, high, history(&record).steps.len()),
        (0.002, 0.003, 21)
    );
    assert!((history(&record).cycles[0].found.amplitude - 0.0005).abs() < 1e-15);
    assert!((number(&record, 0, "stiffness").0.unwrap() - 1000.0).abs() < 1e-9);
    let pulled = run_unwatched(&plan(Cycle {
        sides: Sides::Pull,
        ..cycle(&[0.001], 1)
    }));
    assert!((number(&pulled, 0, "min_force").0.unwrap() + 1.0).abs() < 1e-12);
    assert_eq!(number(&pulled, 0, "max_force").0, Some(0.0));
}

/// Viscous damping c on the cell: a cycle of ±a at speed v dissipates c·v·4a, minus the loss of the trapezoid at the ends.
#[test]
fn moved_without_stopping_it_is_read_at_its_rate() {
    let (speed, amplitude, damping) = (0.01, 0.01, 50.0);
    let energy = |rate: f64| {
        let mut plan = plan(Cycle {
            rate: Some(Constant(rate)),
            speed: Some(Constant(speed)),
            ..cycle(&[amplitude], 2)
        });
        plan.specimens[0].damping = damping;
        let record = run_unwatched(&plan);
        assert_eq!(history(&record).cycles.len(), 2);
        list(&record, 0, "energies")[1]
    };
    let exact = damping * speed * 4.0 * amplitude;
    let (coarse, fine) = (exact - energy(100.0), exact - energy(1000.0));
    assert!(
        coarse > 0.0 && fine > 0.0 && (coarse / fine - 10.0).abs() < 0.1,
        "{coarse} J, {fine} J"
    );
    assert!(fine < 0.01 * exact);
}

#[test]
fn a_person_looks_between_amplitudes_and_when_the_force_has_fallen() {
    let inspect = vec![CycleInspection::Every(2), CycleInspection::ForceDrop(0.2)];
    let record = run_unwatched(&plan(Cycle {
        inspect,
        ..cycle(&[0.001, 0.002, 0.001, 0.001], 1)
    }));
    let looks: Vec<&str> = record
        .events
        .iter()
        .filter(|event| event.kind == EventKind::Inspection)
        .map(|event| event.text.as_str())
        .collect();
    // The third falls by half; after the fourth nothing follows.
    assert_eq!(
        looks,
        [
            "inspection after the cycles to 2.000 mm",
            "the largest force of the cycles to 1.000 mm fell by 20 % or more",
        ]
    );
}

#[test]
fn a_limit_stops_it_with_what_was_recorded() {
    let mut plan = plan(cycle(&[0.001, 0.004], 1));
    plan.limits.force = psd_plan::Interval {
        low: -2.0,
        high: 2.0,
    };
    let record = run_unwatched(&plan);
    assert!(matches!(record.outcome, Outcome::Aborted { .. }));
    assert_eq!(
        (
            history(&record).cycles.len(),
            number(&record, 0, "cycles").0
        ),
        (1, Some(1.0))
    );
    let (last, before) = history(&record).steps.split_last().unwrap();
    assert!(
        last.restoring_force > 2.0 && before.iter().all(|step| step.restoring_force <= 2.0),
        "{last:?}"
    );
    assert_eq!(
        number(&record, 0, "max_force").0,
        Some(last.restoring_force)
    );
}
