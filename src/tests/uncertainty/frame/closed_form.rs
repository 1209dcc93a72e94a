//! One storey compared with one degree of freedom, two elastic storeys with their modes.

use super::{base_excited_plan, constant, entry, from, rebuilt, storey, storeys};
use crate::tests::testing::{elastic_plan, every, impact, number, run_unwatched, struck_frame};
use psd_plan::procedures::impact::block::RESULTS;
use psd_plan::uncertainty::{Contribution, Source, combined};
use psd_plan::{
    Calibration, Contact, Impact, Link, Plan, ProcedureKind, ShakeDamping, Storey, Until,
    VirtualLink,
};
use psd_testing::plans::ChangeTarget as _;

/// A plastic impact on a frame of one storey equals the impact on one degree of freedom, including its uncertainty. The contributions of
/// the inputs are equal, and those of the simulated reading errors.
#[test]
fn one_storey_has_the_uncertainty_of_one_degree_of_freedom() {
    const STIFFNESS: f64 = 327.65;
    let uncertain = |mut plan: Plan, link: VirtualLink| {
        plan.strikers[0].mass_uncertainty = 0.1;
        plan.strikers[0].velocity_uncertainty = 0.01;
        plan.rig.calibration = Calibration {
            force_uncertainty: 0.01,
            displacement_uncertainty: 0.005,
            zero_uncertainty: 0.2,
            ..Calibration::default()
        };
        plan.rig.link = Link::Virtual(link);
        plan
    };
    let contact = Contact::Restitution {
        coefficient: constant(0.3),
    };
    let alone = |link| {
        let struck = Impact {
            contact: contact.clone(),
            stepping: every(1e-3),
            ..impact(constant(STIFFNESS))
        }
        .with_point(|point| point.mass_uncertainty = 0.02);
        run_unwatched(&uncertain(
            elastic_plan(STIFFNESS, vec![ProcedureKind::Impact(struck)]),
            link,
        ))
    };
    let framed = |link| {
        let mut plan = struck_frame();
        *storeys(&mut plan) = vec![Storey {
            mass_uncertainty: 0.02,
            ..storey(1.0, STIFFNESS)
        }];
        let ProcedureKind::Impact(impact) = &mut plan.procedures[0].kind else {
            panic!()
        };
        *impact = Impact {
            contact: contact.clone(),
            stepping: every(1e-3),
            duration: constant(0.5),
            until: Until::StrikerStop,
            ..impact.clone()
        }
        .with_storey(|storey| {
            storey.storey = 0;
            storey.damping = ShakeDamping::Rayleigh(constant(0.0));
        });
        run_unwatched(&uncertain(rebuilt(plan), link))
    };
    let of_mass = Source::SpecimenMass(0);
    for (link, within) in [
        (VirtualLink::default(), 1e-7),
        (
            VirtualLink {
                noise: 0.3,
                seed: 3,
                ..VirtualLink::default()
            },
            0.1,
        ),
    ] {
        let (alone, framed) = (alone(link), framed(link));
        let of_any = RESULTS
            .iter()
            .filter(|kind| kind.measured && !kind.of_storey);
        for name in of_any.map(|kind| kind.name) {
            let ((value, u), (same, u_of_frame)) =
                (number(&alone, 0, name), number(&framed, 0, name));
            let near = |a: f64, b: f64| (a - b).abs() <= within * a.abs().max(b.abs());
            assert!(value.is_some() == same.is_some(), "{name}");
            let (Some(u), Some(u_of_frame)) = (u, u_of_frame) else {
                assert_eq!(u, u_of_frame, "{name}");
                continue;
            };
            assert!(
                near(u, u_of_frame),
                "{name}: {u} of one degree of freedom, {u_of_frame} of one storey"
            );
            if within < 1e-3 {
                for part in &alone.procedures[0].result(name).unwrap().contributions {
                    let source = if part.source == of_mass {
                        Source::StoreyMass {
                            specimen: 0,
                            storey: 0,
                        }
                    } else {
                        part.source
                    };
                    let (_, parts) = entry(&framed, name, 0);
                    let found = from(&parts, source);
                    assert!(
                        (found - part.amount).abs() <= 1e-7 * u,
                        "{name} by {source:?}: {found} and {}",
                        part.amount
                    );
                }
            }
        }
        // The drift of the only storey is the displacement of its floor.
        let (_, drift) = entry(&framed, "max_drift", 0);
        let (_, floor) = entry(&framed, "floor_displacement", 0);
        assert!((combined(&drift).unwrap() / combined(&floor).unwrap() - 1.0).abs() < 1e-12);
    }
}

type Matrix = [[f64; 2]; 2];

fn times(a: Matrix, x: [f64; 2]) -> [f64; 2] {
    [
        a[0][0] * x[0] + a[0][1] * x[1],
        a[1][0] * x[0] + a[1][1] * x[1],
    ]
}

/// Two elastic storeys on ground that jumps to 1 m/s² and stays: Ẍ + A X = −ι, A = M⁻¹D_f K D_d⁻¹ with the factors of the cells and of
/// the transducers. Then X = −g(A)ι, g(λ) = (1 − cos √λ t)/λ, by its two modes (Sylvester's formula). Compared are the largest
/// displacements, drifts and base shear over 0.2 s.
fn two_storeys(
    masses: [f64; 2],
    stiffnesses: [f64; 2],
    force: [f64; 2],
    displacement: [f64; 2],
) -> [f64; 5] {
    let [lower, upper] = stiffnesses;
    let stiffness = [[lower + upper, -upper], [-upper, upper]];
    let read =
        |row: usize, column: usize| force[row] * stiffness[row][column] / displacement[column];
    let restoring = [[read(0, 0), read(0, 1)], [read(1, 0), read(1, 1)]];
    let a = [0, 1].map(|row| [0, 1].map(|column| restoring[row][column] / masses[row]));
    let (half, product) = (
        0.5 * (a[0][0] + a[1][1]),
        a[0][0] * a[1][1] - a[0][1] * a[1][0],
    );
    let root = (half * half - product).sqrt();
    let (first, second) = (half - root, half + root);
    let mut largest = [0.0_f64; 5];
    for step in 0..=20_000 {
        let time = 1e-5 * f64::from(step);
        let g = |squared: f64| (1.0 - (squared.sqrt() * time).cos()) / squared;
        let of = |row: usize, column: usize| {
            let unit = if row == column { 1.0 } else { 0.0 };
            (g(second) * (a[row][column] - first * unit)
                - g(first) * (a[row][column] - second * unit))
                / (second - first)
        };
        let x = [0, 1].map(|row| -(of(row, 0) + of(row, 1)));
        let r = times(restoring, x);
        for (largest, now) in largest
            .iter_mut()
            .zip([x[0], x[1], x[0], x[1] - x[0], r[0] + r[1]])
        {
            *largest = largest.max(now.abs());
        }
    }
    largest
}

const NAMES: [(&str, usize); 5] = [
    ("max_displacement", 0),
    ("max_displacement", 1),
    ("max_drift", 0),
    ("max_drift", 1),
    ("max_base_shear", 0),
];

#[test]
fn two_elastic_storeys_have_the_uncertainty_of_their_modes() {
    let (masses, stiffnesses) = ([2.0, 1.5], [3000.0, 1800.0]);
    let mut plan = base_excited_plan(
        vec![storey(2.0, 3000.0), storey(1.5, 1800.0)],
        vec![1.0; 21],
        1e-4,
    );
    for storey in storeys(&mut plan) {
        storey.mass_uncertainty = 0.01 * storey.mass;
    }
    plan.grounds[0].scale_uncertainty = 0.02;
    plan.rig.calibration = Calibration {
        force_uncertainty: 0.01,
        displacement_uncertainty: 0.005,
        ..Calibration::default()
    };
    let record = run_unwatched(&rebuilt(plan));
    let at = |masses, force, displacement| two_storeys(masses, stiffnesses, force, displacement);
    let by_hand = at(masses, [1.0; 2], [1.0; 2]);
    let mut compared = 0;
    for (index, (name, entry_index)) in NAMES.into_iter().enumerate() {
        let (value, parts) = entry(&record, name, entry_index);
        assert!(
            (value / by_hand[index] - 1.0).abs() < 1e-4,
            "{name}[{entry_index}]: {value}, by hand {}",
            by_hand[index]
        );
        for axis in 0..2 {
            let moved = |unit: f64, by: f64| {
                let mut moved = [unit; 2];
                moved[axis] += by;
                moved
            };
            let mass = |by: f64| [0, 1].map(|floor| masses[floor] * moved(1.0, by)[floor]);
            let half = |up: [f64; 5], down: [f64; 5]| 0.5 * (up[index] - down[index]);
            let cases = [
                (
                    Source::StoreyMass {
                        specimen: 0,
                        storey: axis,
                    },
                    half(
                        at(mass(0.01), [1.0; 2], [1.0; 2]),
                        at(mass(-0.01), [1.0; 2], [1.0; 2]),
                    ),
                ),
                (
                    Source::ForceScale(axis),
                    half(
                        at(masses, moved(1.0, 0.01), [1.0; 2]),
                        at(masses, moved(1.0, -0.01), [1.0; 2]),
                    ),
                ),
                (
                    Source::DisplacementScale(axis),
                    half(
                        at(masses, [1.0; 2], moved(1.0, 0.005)),
                        at(masses, [1.0; 2], moved(1.0, -0.005)),
                    ),
                ),
            ];
            for (source, expected) in cases {
                let (found, within) = (from(&parts, source), 2e-3 * 0.01 * value);
                // If the two one-sided differences of a small effect disagree, the larger is reported.
                let rough = parts
                    .iter()
                    .any(|part| part.source == source && !part.smooth);
                let agrees = if rough {
                    found.abs() + within > expected.abs()
                } else {
                    (found - expected).abs() < within
                };
                assert!(
                    agrees,
                    "{name}[{entry_index}] by {source:?}: {found}, by hand {expected}, of {value}"
                );
                compared += usize::from(expected.abs() > 1e-3 * value);
            }
        }
        let scale = from(&parts, Source::GroundScale(0));
        // The contribution includes peaks between the ends of steps; the value is that at the end of a step.
        assert!(
            (scale / (0.02 * value) - 1.0).abs() < 1e-4,
            "{name}[{entry_index}] of the ground: {scale}"
        );
        // The one-sided differences of a negligible effect may disagree.
        let rough = parts
            .iter()
            .filter(|part| !part.smooth && part.amount.abs() > 1e-3 * value);
        assert_eq!(rough.count(), 0, "{parts:?}");
    }
    assert!(compared >= 20, "only {compared} contributions that are any");
}

/// ω² of two storeys by hand: the periods go as √(m/k) of each, and the ratios of Rayleigh damping as they are stated.
#[test]
fn periods_have_the_uncertainty_of_masses_and_stiffnesses() {
    let mut plan = base_excited_plan(
        vec![storey(2.0, 3000.0), storey(2.0, 3000.0)],
        vec![1.0; 11],
        1e-3,
    );
    for storey in storeys(&mut plan) {
        storey.mass_uncertainty = 0.02;
        storey.stiffness_uncertainty = 60.0;
    }
    let record = run_unwatched(&rebuilt(plan));
    let periods = |masses: [f64; 2], [lower, upper]: [f64; 2]| {
        let (half, product) = (
            0.5 * ((lower + upper) / masses[0] + upper / masses[1]),
            lower * upper / (masses[0] * masses[1]),
        );
        let root = (half * half - product).sqrt();
        [half - root, half + root].map(|squared| std::f64::consts::TAU / squared.sqrt())
    };
    for mode in 0..2 {
        let (value, parts) = entry(&record, "periods", mode);
        assert!((value / periods([2.0; 2], [3000.0; 2])[mode] - 1.0).abs() < 1e-9);
        for storey in 0..2 {
            let moved = |unit: f64, by: f64| {
                let mut moved = [unit; 2];
                moved[storey] += by;
                moved
            };
            let of_mass = 0.5
                * (periods(moved(2.0, 0.02), [3000.0; 2])[mode]
                    - periods(moved(2.0, -0.02), [3000.0; 2])[mode]);
            let stiffness = |by| periods([2.0; 2], moved(3000.0, by))[mode];
            let of_stiffness = 0.5 * (stiffness(60.0) - stiffness(-60.0));
            for (source, by_hand) in [
                (
                    Source::StoreyMass {
                        specimen: 0,
                        storey,
                    },
                    of_mass,
                ),
                (
                    Source::StoreyStiffness {
                        specimen: 0,
                        storey,
                    },
                    of_stiffness,
                ),
            ] {
                let found = from(&parts, source);
                assert!(
                    (found - by_hand).abs() < 1e-9 * value,
                    "mode {mode} by {source:?}: {found}, by hand {by_hand}"
                );
            }
        }
    }
    // Undamped, the motion depends on the measured forces only: a stated stiffness is not an input.
    let (value, parts) = entry(&record, "max_drift", 0);
    assert!(
        from(
            &parts,
            Source::StoreyStiffness {
                specimen: 0,
                storey: 0
            }
        )
        .abs()
            < 1e-6 * value
    );
}

/// Without uncertain inputs, the time step alone has an effect. Only a duration that is counted in whole steps is uncertain.
#[test]
fn an_exact_frame_has_the_effect_of_its_time_step() {
    for plan in [
        struck_frame(),
        base_excited_plan(
            vec![storey(2.0, 3000.0), storey(1.5, 1800.0)],
            vec![1.0; 11],
            1e-3,
        ),
    ] {
        let record = run_unwatched(&plan);
        for result in &record.procedures[0].results {
            let of_step = |part: &Contribution| {
                matches!(part.source, Source::TimeStep(_) | Source::WholeSteps { .. })
            };
            assert!(result.contributions.iter().all(of_step), "{result:?}");
        }
        assert!(
            !record
                .events
                .iter()
                .any(|event| event.text.contains("uncertainty")),
            "{:?}",
            record.events
        );
    }
}
