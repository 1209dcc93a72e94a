//! Uncertainty of frames, compared with the scatter of many virtual runs.

use super::{base_excited_plan, constant, entry, rebuilt, shake, storey, storeys};
use crate::tests::testing::{Uniform, every, run_unwatched, scatter, struck_frame};
use psd_plan::uncertainty::{Source, combined};
use psd_plan::{
    Behaviour, Contact, Link, Part, Plan, ProcedureKind, ShakeDamping, Stepping, Storey,
    VirtualLink,
};

const RUNS: u32 = 150;

/// The virtual rig runs `RUNS` times with random inputs; the scatter is compared with the prediction of one run of `uncertain`. The
/// relative standard deviation of a standard deviation of normal numbers is 1/√(2(n − 1)). For a Monte Carlo prediction it is 1/√(2·64).
/// The limit is three times both combined.
pub(super) fn scatters_as_predicted(
    uncertain: &Plan,
    names: &[(&str, usize)],
    drawn: bool,
    draw: &mut dyn FnMut(&mut Uniform, u64) -> Plan,
) {
    let with_uncertainty = run_unwatched(uncertain);
    let mut uniform = Uniform(20_060_102);
    let mut found: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    for run in 0..RUNS {
        let record = run_unwatched(&draw(&mut uniform, u64::from(run)));
        for (values, (name, index)) in found.iter_mut().zip(names) {
            values.push(entry(&record, name, *index).0);
        }
    }
    let within =
        3.0 * (1.0 / (2.0 * f64::from(RUNS - 1)) + if drawn { 1.0 / 128.0 } else { 0.0 }).sqrt();
    for (values, (name, index)) in found.iter().zip(names) {
        let (_, parts) = entry(&with_uncertainty, name, *index);
        let (scatter, u) = (scatter(values), combined(&parts).unwrap());
        // If the measured path does not determine the motion of the storeys, the largest possible effect is reported and marked.
        let sure = parts
            .iter()
            .all(|part| part.smooth || part.amount.abs() < 0.1 * u);
        let most = if sure { within } else { 1.0 };
        let deviation = u / scatter - 1.0;
        assert!(
            (-within..most).contains(&deviation),
            "{name}[{index}]: {scatter} of runs, {u} predicted"
        );
    }
}

fn yielding(mass: f64, stiffness: f64, yield_force: f64) -> Storey {
    Storey {
        behaviour: Behaviour::Bilinear {
            stiffness,
            yield_force,
            post_yield_ratio: 0.1,
        },
        ..storey(mass, stiffness)
    }
}

/// Two storeys that yield in both directions under ground motion, with random masses, damping and ground factor.
#[test]
fn repeated_ground_motion_tests_scatter_as_predicted() {
    let ground: Vec<f64> = (0..150)
        .map(|step| 3.0 * (0.085 * f64::from(step)).sin() * (0.03 * f64::from(step)).sin())
        .collect();
    let with = |masses: [f64; 2], scale: f64, ratio: f64| {
        let accelerations = ground
            .iter()
            .map(|acceleration| scale * acceleration)
            .collect();
        let mut plan = base_excited_plan(
            vec![
                yielding(masses[0], 900.0, 12.0),
                yielding(masses[1], 700.0, 8.0),
            ],
            accelerations,
            5e-3,
        );
        shake(&mut plan).damping = ShakeDamping::Rayleigh(constant(ratio));
        plan
    };
    let mut uncertain = with([3.0, 2.0], 1.0, 0.05);
    for storey in storeys(&mut uncertain) {
        storey.mass_uncertainty = 0.01 * storey.mass;
    }
    uncertain.grounds[0].scale_uncertainty = 0.01;
    shake(&mut uncertain).damping_uncertainty = 0.01;
    let names = [
        ("max_displacement", 0),
        ("max_displacement", 1),
        ("max_drift", 0),
        ("max_drift", 1),
        ("final_drift", 0),
        ("max_base_shear", 0),
    ];
    scatters_as_predicted(&rebuilt(uncertain), &names, false, &mut |uniform, _| {
        let masses = [3.0, 2.0].map(|mass: f64| mass * (1.0 + 0.01 * uniform.normal()));
        let scale = 1.0 + 0.01 * uniform.normal();
        with(masses, scale, 0.05 + 0.01 * uniform.normal())
    });
}

/// An impact on the upper of two storeys that yield.
#[test]
fn repeated_impacts_on_a_storey_scatter_as_predicted() {
    let with = |mass: f64, velocity: f64, striker: f64| {
        let mut plan = struck_frame();
        storeys(&mut plan)[1].mass = mass;
        plan.strikers[0].velocity = velocity;
        plan.strikers[0].mass = striker;
        let ProcedureKind::Impact(impact) = &mut plan.procedures[0].kind else {
            panic!()
        };
        impact.contact = Contact::Restitution {
            coefficient: constant(0.0),
        };
        impact.stepping = Stepping {
            max_tangent_ratio: constant(2.0),
            ..every(2e-3)
        };
        rebuilt(plan)
    };
    let mut uncertain = with(1.0, 1.0, 10.0);
    storeys(&mut uncertain)[1].mass_uncertainty = 0.02;
    uncertain.strikers[0].velocity_uncertainty = 0.01;
    uncertain.strikers[0].mass_uncertainty = 0.1;
    let names = [
        ("max_displacement", 0),
        ("absorbed_energy", 0),
        ("final_displacement", 0),
        ("max_velocity", 0),
        ("max_drift", 0),
        ("max_drift", 1),
        ("floor_displacement", 0),
        ("final_drift", 0),
        ("final_drift", 1),
        ("storey_energy", 0),
        ("storey_energy", 1),
        ("max_base_shear", 0),
    ];
    scatters_as_predicted(&uncertain, &names, false, &mut |uniform, _| {
        let mass = 1.0 + 0.02 * uniform.normal();
        with(
            mass,
            1.0 + 0.01 * uniform.normal(),
            10.0 + 0.1 * uniform.normal(),
        )
    });
}

/// Noise of the cells of an elastic frame: runs that differ only in the seed. A computed storey has none.
#[test]
fn noise_of_the_load_cells_scatters_as_predicted() {
    for parts in [
        [Part::TESTED; 2],
        [Part::TESTED, Part::Computed],
        [Part::Computed, Part::TESTED],
    ] {
        noise_scatters_as_predicted(parts);
    }
}

fn noise_scatters_as_predicted(parts: [Part; 2]) {
    let part = |mass, stiffness, part| Storey {
        part,
        ..storey(mass, stiffness)
    };
    let with = |seed: u64| {
        let mut plan = base_excited_plan(
            vec![part(3.0, 900.0, parts[0]), part(2.0, 700.0, parts[1])],
            vec![1.0; 60],
            5e-3,
        );
        plan.rig.link = Link::Virtual(VirtualLink {
            noise: 0.3,
            seed,
            ..VirtualLink::default()
        });
        plan
    };
    let names = [
        ("max_displacement", 0),
        ("max_displacement", 1),
        ("max_drift", 1),
        ("final_drift", 0),
    ];
    scatters_as_predicted(&with(1), &names, true, &mut |_, run| with(run + 1));
}

/// For a long record with many inputs, the trials perturb all floors together and all axes together. The result is the same within the
/// scatter of the trials, at the same cost.
#[test]
fn inputs_perturbed_together_have_the_sum_of_their_variances() {
    let plan = |duration: f64| {
        let ground: Vec<f64> = (0..600)
            .map(|step| (0.085 * f64::from(step)).sin())
            .collect();
        let mut plan =
            base_excited_plan((0..8).map(|_| storey(2.0, 9000.0)).collect(), ground, 1e-3);
        for storey in storeys(&mut plan) {
            storey.mass_uncertainty = 0.02;
        }
        plan.rig.calibration.force_uncertainty = 0.01;
        shake(&mut plan).duration = Some(constant(duration));
        rebuilt(plan)
    };
    // 16 inputs, perturbed at least twice each, need 32 runs. This number is allowed for 300 steps of 8 floors, and not for 2200.
    for (duration, together) in [(0.3, false), (2.2, true)] {
        let record = run_unwatched(&plan(duration));
        let (value, parts) = entry(&record, "max_displacement", 7);
        let drawn = parts
            .iter()
            .filter(|part| matches!(part.source, Source::Drawn { .. }))
            .count();
        assert_eq!(drawn > 0, together, "{} parts of {value}", parts.len());
        let u = combined(&parts).unwrap();
        assert!(u > 1e-3 * value && u < 0.05 * value, "{u} of {value}");
    }
}
