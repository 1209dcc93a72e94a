//! Uncertainty of frames whose matrices have one common uncertainty, and of the lists of an impact series. It is compared with re-runs of
//! the virtual rig with one input perturbed.

use super::frame::{base_excited_plan, constant, entry, from, storey};
use crate::run::Unwatched;
use crate::tests::procedures::frame::escalate::rising;
use crate::tests::testing::{every, number, run_unwatched};
use psd_plan::formula::ResultValue;
use psd_plan::record::Record;
use psd_plan::uncertainty::{Contribution, Source, combined};
use psd_plan::{Behaviour, Between, Contact, Frame, Plan, ProcedureKind, ShakeDamping, Stepping};
use psd_rig::virtual_rig;

/// Two storeys by their matrices, damped, on ground that jumps to 1 m/s².
fn of_matrices() -> Plan {
    let mut plan = base_excited_plan(
        vec![storey(2.0, 3000.0), storey(1.5, 1800.0)],
        vec![1.0; 31],
        5e-4,
    );
    let ProcedureKind::Shake(shake) = &mut plan.procedures[0].kind else {
        panic!()
    };
    shake.damping = ShakeDamping::Rayleigh(constant(0.05));
    let frame = plan.specimens[0].frame.as_mut().unwrap();
    frame.storeys.clear();
    plan
}

/// The plan with its matrices times these factors; the rig keeps its original specimen.
fn run_on(rig_of: &Plan, plan: &Plan) -> Record {
    crate::run::run(plan, virtual_rig(rig_of).as_mut(), &mut Unwatched)
}

const NAMES: [(&str, usize); 8] = [
    ("max_displacement", 0),
    ("max_displacement", 1),
    ("max_drift", 0),
    ("max_drift", 1),
    ("final_drift", 1),
    ("max_base_shear", 0),
    ("periods", 0),
    ("periods", 1),
];

#[test]
fn a_matrix_moves_as_a_whole() {
    let share = [0.01, 0.02];
    let mut plan = of_matrices();
    plan.specimens[0].frame.as_mut().unwrap().matrix_uncertainty = share;
    let with_uncertainty = run_unwatched(&plan);
    let with = |factors: [f64; 2]| {
        let mut plan = of_matrices();
        let frame: Frame = plan.specimens[0].frame.clone().unwrap();
        plan.specimens[0].frame = Some(frame.scaled(factors));
        run_on(&of_matrices(), &plan)
    };
    let mut compared = 0;
    for (source, [up, down]) in [
        (
            Source::MassMatrix(0),
            [with([1.0 + share[0], 1.0]), with([1.0 - share[0], 1.0])],
        ),
        (
            Source::StiffnessMatrix(0),
            [with([1.0, 1.0 + share[1]]), with([1.0, 1.0 - share[1]])],
        ),
    ] {
        for (name, index) in NAMES {
            let (value, parts) = entry(&with_uncertainty, name, index);
            let found = 0.5 * (entry(&up, name, index).0 - entry(&down, name, index).0);
            let predicted = from(&parts, source);
            // The re-runs report the values at the ends of steps; the values between them are reported here.
            assert!(
                (found - predicted).abs() < 2e-4 * value.abs(),
                "{name}[{index}] by {source:?}: {predicted}, of reruns {found}"
            );
            compared += usize::from(found.abs() > 2e-3 * value.abs());
        }
    }
    assert!(compared >= 9, "only {compared} that are any");
    // T = 2π√(M/K) of both modes; the mass hit by the striker scales with the whole matrix.
    for mode in 0..2 {
        let (value, parts) = entry(&with_uncertainty, "periods", mode);
        assert!((combined(&parts).unwrap() / value - 0.5 * 0.01_f64.hypot(0.02)).abs() < 1e-4);
    }
    let frame = plan.specimens[0].frame.as_ref().unwrap();
    assert!((frame.total_mass_uncertainty() - 0.035).abs() < 1e-12);
}

/// An elastic frame of two storeys, hit at three velocities.
fn row(velocities: &[f64], striker: f64) -> Plan {
    let mut plan = rising(velocities, Between::Unload);
    let ProcedureKind::Escalate(row) = &mut plan.procedures[0].kind else {
        panic!()
    };
    let impact = &mut row.impact;
    impact.contact = Contact::Restitution {
        coefficient: constant(0.0),
    };
    impact.stepping = Stepping {
        max_tangent_ratio: constant(2.0),
        ..every(2e-3)
    };
    for storey in &mut plan.specimens[0].frame.as_mut().unwrap().storeys {
        storey.behaviour = Behaviour::Elastic {
            stiffness: storey.stiffness,
        };
    }
    plan.strikers[0].mass = striker;
    plan
}

fn parts_of(record: &Record, name: &str, index: usize) -> (f64, Vec<Contribution>) {
    let result = record.procedures[0].result(name).unwrap();
    match &result.value {
        ResultValue::List(_) => entry(record, name, index),
        ResultValue::Number { value, .. } => (value.unwrap(), result.contributions.clone()),
    }
}

/// Every list of an impact series on a storey: half the difference between series with a heavier and a lighter striker, or with a faster
/// and a slower one.
#[test]
fn the_lists_of_an_impact_series_are_as_uncertain_as_its_striker() {
    let velocities = [0.4, 0.7, 1.0];
    let mut plan = row(&velocities, 10.0);
    plan.strikers[0].mass_uncertainty = 0.1;
    plan.strikers[0].velocity_uncertainty = 0.01;
    let with_uncertainty = run_unwatched(&plan);
    // The striker's stated velocity is 1 m/s: the uncertainty of each impact is proportional to its velocity.
    let faster = |by: f64| {
        run_unwatched(&row(
            &velocities.map(|velocity| velocity * (1.0 + by)),
            10.0,
        ))
    };
    let heavier = |by: f64| run_unwatched(&row(&velocities, 10.0 + by));
    let moved = [
        (Source::StrikerVelocity(0), [faster(0.01), faster(-0.01)]),
        (Source::StrikerMass(0), [heavier(0.1), heavier(-0.1)]),
    ];
    let lists = [
        ("velocities", 3),
        ("impact_energies", 3),
        ("max_displacements", 3),
        ("absorbed_energies", 3),
        ("impulses", 3),
        ("max_drift", 2),
        ("storey_energy", 2),
        ("last_passed_energy", 1),
        ("max_displacement", 1),
    ];
    let mut compared = 0;
    for (source, [up, down]) in &moved {
        for (name, count) in lists {
            for index in 0..count {
                let (value, parts) = parts_of(&with_uncertainty, name, index);
                let found = 0.5 * (parts_of(up, name, index).0 - parts_of(down, name, index).0);
                let predicted = from(&parts, *source);
                let smooth = parts
                    .iter()
                    .all(|part| part.smooth || part.amount.abs() < 1e-3 * value.abs());
                let within = if smooth { 1e-3 } else { 1e-2 };
                assert!(
                    (found - predicted).abs() < within * value.abs(),
                    "{name}[{index}] by {source:?}: {predicted}, of reruns {found}"
                );
                compared += usize::from(found.abs() > 2e-3 * value.abs());
            }
        }
    }
    assert!(compared >= 24, "only {compared} that are any");
    // The unloaded position of an elastic frame does not depend on its striker.
    let (rest, parts) = parts_of(&with_uncertainty, "residual_displacements", 2);
    assert!(rest.abs() < 1e-12 && parts.is_empty(), "{parts:?}");
    assert_eq!(
        number(&with_uncertainty, 0, "residual_displacement").1,
        None
    );
}
