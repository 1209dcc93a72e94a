//! The uncertainty of displacement cycles against closed forms and repeated runs.

use crate::tests::testing::{elastic_plan, number, result_of, run_unwatched};
use psd_plan::formula::{Formula, Function, ResultValue};
use psd_plan::uncertainty::Source;
use psd_plan::{
    Behaviour, Bolted, Calibration, Cycle, Level, Link, Plan, ProcedureKind, Sides, VirtualLink,
};

const STIFFNESS: f64 = 1000.0;
const POINTS: u32 = 10;

fn plan(behaviour: Behaviour, link: VirtualLink, calibration: Calibration) -> Plan {
    let cycle = Cycle {
        specimen: 0,
        levels: vec![Level {
            amplitude: Formula::Constant(0.02),
            cycles: 2,
        }],
        sides: Sides::Both,
        about: Formula::Constant(0.0),
        points: POINTS,
        samples: 4,
        pause: Formula::Constant(0.0),
        speed: None,
        rate: None,
        inspect: Vec::new(),
        fit: None,
    };
    let mut plan = elastic_plan(STIFFNESS, vec![ProcedureKind::Cycle(cycle)]);
    plan.specimens[0].behaviour = Some(behaviour);
    plan.rig.link = Link::Virtual(link);
    plan.rig.calibration = calibration;
    plan
}

/// Energy is proportional to both factors, stiffness to their ratio, a ratio of energies to neither; a zero offset shifts forces.
#[test]
fn a_calibration_reaches_the_loops_by_its_powers() {
    let behaviour = Behaviour::Bilinear {
        stiffness: STIFFNESS,
        yield_force: 10.0,
        post_yield_ratio: 0.1,
    };
    let calibration = Calibration {
        force_uncertainty: 0.01,
        displacement_uncertainty: 0.003,
        zero_uncertainty: 0.3,
        zero_drift: 0.4,
        ..Calibration::default()
    };
    let record = run_unwatched(&plan(behaviour, VirtualLink::default(), calibration));
    let cases = [
        ("dissipated_energy", [1.0, 1.0], 0.0),
        ("max_force", [1.0, 0.0], 0.5),
        ("min_force", [1.0, 0.0], 0.5),
        ("equivalent_damping_ratio", [0.0, 0.0], 0.0),
        ("stiffness", [1.0, -1.0], 0.0),
        ("last_stiffness", [1.0, -1.0], 0.0),
    ];
    for (name, [force, displacement], zero) in cases {
        let value = number(&record, 0, name).0.unwrap();
        let parts = &record.procedures[0].result(name).unwrap().contributions;
        let of = |source| {
            parts
                .iter()
                .find(|part| part.source == source)
                .map_or(0.0, |part| part.amount)
        };
        for (source, by_hand) in [
            (Source::ForceScale(0), 0.01 * force * value),
            (Source::DisplacementScale(0), 0.003 * displacement * value),
            (Source::ForceZero(0), zero),
        ] {
            let found = of(source);
            assert!(
                (found - by_hand).abs() < 1e-4 * 0.01 * value.abs(),
                "{name}: {found}, by hand {by_hand}"
            );
        }
    }
}

/// A bilinear loop to 12 mm with eight points a quarter: the chords lose 0.068 J of 4(1 − α)F_y(a − x_y) = 24.064 J at a corner that stands
/// 33 N above its chord. At noise of 0.1 N to 8 N this is in U.
#[test]
fn noise_hides_no_corner() {
    let behaviour = || Behaviour::Bilinear {
        stiffness: 2e5,
        yield_force: 800.0,
        post_yield_ratio: 0.06,
    };
    for noise in [0.1, 2.0, 5.0, 8.0] {
        let mut inside = 0;
        for seed in 1..=40 {
            let link = VirtualLink {
                noise,
                seed,
                ..VirtualLink::default()
            };
            let mut plan = plan(behaviour(), link, Calibration::default());
            let ProcedureKind::Cycle(cycle) = &mut plan.procedures[0].kind else {
                panic!()
            };
            cycle.levels[0].amplitude = Formula::Constant(0.012);
            (cycle.points, cycle.samples) = (8, 1);
            let record = run_unwatched(&plan);
            let energies = record.procedures[0].result("energies").unwrap();
            let corner = |part: &&psd_plan::uncertainty::Contribution| {
                part.entry == 1 && matches!(part.source, Source::LoopSampling { .. })
            };
            let corner = energies.contributions.iter().find(corner);
            let open = corner.map_or(0.0, |part| part.amount);
            assert!(open > 0.0, "{noise} N, seed {seed}");
            let u = energies.entry_uncertainties()[1].unwrap();
            let ResultValue::List(found) = &energies.value else {
                panic!()
            };
            inside += u32::from((found[1] - 24.064).abs() <= 2.0 * u);
        }
        // 95 % of 40 are 38, with a standard deviation of 1.4.
        assert!(inside >= 35, "{noise} N: {inside} of 40");
    }
}

/// A number has one uncertainty, under its own name and as an entry of its list. Energies add up source by source.
#[test]
fn the_lists_are_as_uncertain_as_the_numbers() {
    let behaviour = Behaviour::Bilinear {
        stiffness: STIFFNESS,
        yield_force: 10.0,
        post_yield_ratio: 0.1,
    };
    let calibration = Calibration {
        force_uncertainty: 0.01,
        displacement_uncertainty: 0.003,
        zero_uncertainty: 0.3,
        ..Calibration::default()
    };
    let link = VirtualLink {
        noise: 0.1,
        seed: 4,
        ..VirtualLink::default()
    };
    let record = run_unwatched(&plan(behaviour, link, calibration));
    let listed = |name: &str| {
        record.procedures[0]
            .result(name)
            .unwrap()
            .entry_uncertainties()
    };
    let reported = |name: &str| number(&record, 0, name).1;
    assert_eq!(
        listed("stiffnesses"),
        [reported("stiffness"), reported("last_stiffness")]
    );
    assert_eq!(
        listed("damping_ratios")[1],
        reported("equivalent_damping_ratio")
    );
    let all = result_of(0, "energies");
    let sum = Formula::Call(Function::Sum, vec![all])
        .evaluate(&record, None)
        .unwrap()
        .uncertainty
        .unwrap();
    assert!((sum / reported("dissipated_energy").unwrap() - 1.0).abs() < 1e-9);
    let amplitude = listed("amplitudes")[0].unwrap();
    assert!(
        (amplitude / (0.003 * 0.02) - 1.0).abs() < 1e-9,
        "{amplitude}"
    );
    // After rounding, the numbers still have the uncertainties of their entries.
    let link = VirtualLink {
        noise: 0.1,
        resolution: 1e-5,
        force_resolution: 0.05,
        seed: 4,
        ..VirtualLink::default()
    };
    let record = run_unwatched(&plan(
        Behaviour::Elastic {
            stiffness: STIFFNESS,
        },
        link,
        Calibration::default(),
    ));
    let listed = record.procedures[0]
        .result("stiffnesses")
        .unwrap()
        .entry_uncertainties();
    assert_eq!(
        listed,
        [
            number(&record, 0, "stiffness").1,
            number(&record, 0, "last_stiffness").1
        ]
    );
}

/// Bolted supports with corners that ten points per quarter lose: 131.1 of 135.75 J, the friction alone, 4·1.5 kN·(23 mm − 1.5 kN/4
/// kN/mm).
fn of_points(points: u32) -> psd_plan::record::Record {
    let supports = Bolted {
        stiffness: 4e6,
        bearing_force: 8e3,
        clearance: 1e-3,
        slip_force: 1.5e3,
    };
    let mut plan = plan(
        Behaviour::Bolted(supports),
        VirtualLink::default(),
        Calibration::default(),
    );
    let ProcedureKind::Cycle(cycle) = &mut plan.procedures[0].kind else {
        panic!()
    };
    cycle.points = points;
    cycle.levels[0].amplitude = Formula::Constant(0.023);
    run_unwatched(&plan)
}

/// However few the points, U contains the energy of the loop and its damping ratio. With many points little is undetermined; with few an
/// observation is made.
#[test]
fn what_the_points_of_a_loop_leave_open_is_in_its_uncertainty() {
    let exact = 4.0 * 1.5e3 * (0.023 - 1.5e3 / 4e6);
    let mut last = f64::INFINITY;
    let fine = of_points(3000);
    let ratio = number(&fine, 0, "equivalent_damping_ratio").0.unwrap();
    for (points, few) in [
        (1, true),
        (2, true),
        (5, true),
        (10, true),
        (25, false),
        (100, false),
        (400, false),
    ] {
        let record = of_points(points);
        let energies = record.procedures[0].result("energies").unwrap();
        let ResultValue::List(values) = &energies.value else {
            panic!()
        };
        let (energy, u) = (values[1], energies.entry_uncertainties()[1].unwrap());
        assert!(
            (energy - exact).abs() <= 2.0 * u,
            "{points} points: {energy} J ± {u} J of {exact} J"
        );
        // With one and two points, the position of the corners is the only contribution.
        assert!(
            points <= 5 || u < last,
            "{points} points: {u} J, {last} J of fewer"
        );
        last = u;
        let (found, u) = number(&record, 0, "equivalent_damping_ratio");
        assert!(
            (found.unwrap() - ratio).abs() <= 2.0 * u.unwrap() + 1e-4 * ratio,
            "{points} points: {found:?} ± {u:?} of {ratio}"
        );
        let has_remark = record
            .events
            .iter()
            .any(|event| event.text.starts_with("few points"));
        assert_eq!(has_remark, few, "{points} points");
    }
    assert!(last < 1e-4 * exact, "{last} J");
    // The default number loses 0.2 % at most.
    let energies = of_points(25);
    let ResultValue::List(values) = &energies.procedures[0].result("energies").unwrap().value
    else {
        panic!()
    };
    assert!((values[1] / exact - 1.0).abs() < 0.002, "{} J", values[1]);
}

/// An elastic loop has no corners to lose, with noise as without.
#[test]
fn the_points_of_an_elastic_loop_leave_nothing_open() {
    for noise in [0.0, 0.1] {
        let link = VirtualLink {
            noise,
            seed: 7,
            ..VirtualLink::default()
        };
        let record = run_unwatched(&plan(
            Behaviour::Elastic {
                stiffness: STIFFNESS,
            },
            link,
            Calibration::default(),
        ));
        let parts = &record.procedures[0]
            .result("dissipated_energy")
            .unwrap()
            .contributions;
        assert!(
            !parts
                .iter()
                .any(|part| matches!(part.source, Source::LoopSampling { .. })),
            "{parts:?}"
        );
        assert!(
            !record
                .events
                .iter()
                .any(|event| event.text.starts_with("few points"))
        );
    }
}

/// A constant plastic force in both directions: neither the largest nor the smallest reading has the bias of noise.
#[test]
fn largest_and_smallest_of_noisy_cycles_are_those_of_the_force() {
    let records = (1..=60).map(|seed| {
        let behaviour = Behaviour::Bilinear {
            stiffness: STIFFNESS,
            yield_force: 10.0,
            post_yield_ratio: 0.0,
        };
        let link = VirtualLink {
            noise: 0.3,
            seed,
            ..VirtualLink::default()
        };
        run_unwatched(&plan(behaviour, link, Calibration::default()))
    });
    let records: Vec<psd_plan::record::Record> = records.collect();
    for (name, truth) in [("max_force", 10.0), ("min_force", -10.0)] {
        let held = records.iter().filter(|record| {
            let (value, u) = number(record, 0, name);
            (value.unwrap() - truth).abs() <= 2.0 * u.unwrap()
        });
        let held = held.count();
        assert!(held >= 53, "{name}: {held} of 60");
    }
}

/// ∫R dX by the trapezoidal rule has the weight (x₊ − x₋)/2 on each R: u = σ/√n·√Σ w². Uniform steps have the weight h, except the
/// reversals with 0 and the two ends of the whole path with h/2.
#[test]
fn noise_reaches_the_energy_of_a_loop_by_its_weights() {
    let noise = 0.2;
    let link = VirtualLink {
        noise,
        seed: 3,
        ..VirtualLink::default()
    };
    let record = run_unwatched(&plan(
        Behaviour::Elastic {
            stiffness: STIFFNESS,
        },
        link,
        Calibration::default(),
    ));
    let step = 0.02 / f64::from(POINTS);
    // Two cycles of 40 steps: 81 readings, four of them reversals, two ends, and the middle one passed twice.
    let weights = f64::from(81 - 4 - 2) + 2.0 * 0.25;
    let by_hand = noise / 4.0_f64.sqrt() * step * weights.sqrt();
    let u = number(&record, 0, "dissipated_energy").1.unwrap();
    assert!(
        (u / by_hand - 1.0).abs() < 3.0 / 128.0_f64.sqrt(),
        "{u}, by hand {by_hand}"
    );
}
