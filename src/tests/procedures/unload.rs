//! Unloaded position of a specimen, compared with its model moved back in steps of a hundred-thousandth of the distance.

use super::frame::three;
use crate::procedures::unload::run::{of_frame, to_rest};
use crate::run::Unwatched;
use crate::run::session::Session;
use crate::tests::testing;
use crate::tests::testing::{elastic_plan, impact, number, run_unwatched};
use psd_physics::specimen::{RestoringForce, SpecimenModel};
use psd_plan::formula::Formula::Constant;
use psd_plan::formula::ProcedureId;
use psd_plan::record::{History, Record, UnloadStep};
use psd_plan::{
    Behaviour, Between, Bolted, Escalate, Impact, Link, Move, Plan, ProcedureKind, Unload,
    VirtualLink,
};
use psd_rig::virtual_rig;

/// End supports of a beam: 40 kN/m that carry 400 N after 3 mm, and faces that slip at 90 N.
fn bolted() -> Behaviour {
    Behaviour::Bolted(Bolted {
        stiffness: 4e4,
        bearing_force: 400.0,
        clearance: 3e-3,
        slip_force: 90.0,
    })
}

fn bouc_wen(beta: f64) -> Behaviour {
    Behaviour::BoucWen {
        stiffness: 4e4,
        yield_force: 400.0,
        post_yield_ratio: 0.02,
        sharpness: 2.0,
        beta,
    }
}

/// Moved to `to` \[m\], and unloaded with this stiffness \[N/m\].
fn unloaded(
    behaviour: &Behaviour,
    coulomb: f64,
    to: f64,
    stiffness: f64,
    link: VirtualLink,
) -> Record {
    let away = ProcedureKind::Move(Move {
        to: Constant(to),
        speed: None,
    });
    let unload = ProcedureKind::Unload(Unload {
        specimen: 0,
        stiffness: Some(Constant(stiffness)),
        within: None,
        speed: None,
        keep_axial_load: false,
    });
    let mut plan = elastic_plan(1.0, vec![away, unload]);
    plan.specimens[0].behaviour = Some(behaviour.clone());
    plan.specimens[0].coulomb = coulomb;
    plan.rig.link = Link::Virtual(link);
    run_unwatched(&plan)
}

fn moves(record: &Record) -> &[UnloadStep] {
    match &record.procedures[1].history {
        History::Unload(history) => &history.steps,
        other => panic!("{other:?}"),
    }
}

/// Unloaded position on the path back from the last of these positions, with `friction` opposing the motion.
fn truly_rests(behaviour: &Behaviour, displacements: &[f64], friction: f64) -> f64 {
    let mut model = SpecimenModel::new(behaviour);
    let mut force = 0.0;
    for displacement in displacements {
        force = model.move_to(*displacement);
    }
    let from = displacements[displacements.len() - 1];
    let step = 1e-5
        * force.signum()
        * displacements
            .iter()
            .fold(0.0_f64, |most, displacement| most.max(displacement.abs()));
    let net_force = |force: f64| force * step.signum() - friction;
    (1..200_000)
        .map(|index| from - step * f64::from(index))
        .find(|displacement| net_force(model.move_to(*displacement)) <= 0.0)
        .unwrap()
}

/// Supports that unload at twice their stiffness, a Bouc–Wen spring, a beam behind its supports, with and without friction. Unloading
/// never loads them in the opposite direction. The rest position is correct for any stated stiffness. By hand, the supports from 20 mm:
/// 4.5 mm back at 80 kN/m, over which the friction reverses, then 3.25 mm at 40 kN/m.
#[test]
fn the_unloaded_position_does_not_depend_on_the_stated_stiffness() {
    let beam = Behaviour::Series(vec![Behaviour::Elastic { stiffness: 3e5 }, bolted()]);
    let beside = Behaviour::Parallel(vec![bouc_wen(0.5), bolted()]);
    for (behaviour, coulomb) in [
        (bolted(), 0.0),
        (bolted(), 60.0),
        (bouc_wen(1.0), 0.0),
        (bouc_wen(0.8), 20.0),
        (beam, 0.0),
        (beside, 0.0),
        (Behaviour::Elastic { stiffness: 4e4 }, 50.0),
    ] {
        let rests = truly_rests(&behaviour, &[0.02], coulomb);
        for stiffness in [2e4, 4e4, 6e4, 8e4, 3e5] {
            let record = unloaded(&behaviour, coulomb, 0.02, stiffness, VirtualLink::default());
            let (moves, found) = (
                moves(&record),
                number(&record, 1, "residual_displacement").0.unwrap(),
            );
            let start = behaviour.initial_stiffness() * 0.02;
            assert!(
                moves
                    .iter()
                    .all(|step| step.restoring_force[0] > -1e-3 * start),
                "by {stiffness} N/m: {behaviour:?}: {moves:?}"
            );
            assert!(
                (found - rests).abs() < 1e-3 * 0.02,
                "by {stiffness} N/m: {found} m, not {rests} m: {behaviour:?}"
            );
            assert!(
                moves.len() < 25,
                "{} moves by {stiffness} N/m: {behaviour:?}",
                moves.len()
            );
        }
    }
    assert!((truly_rests(&bolted(), &[0.02], 0.0) - 0.01225).abs() < 1e-6);
}

/// With noise, with the stiffness from a ramp and with half of it.
#[test]
fn noise_does_not_move_it() {
    for stiffness in [4e4, 8e4] {
        for seed in 1..30 {
            let link = VirtualLink {
                noise: 0.5,
                resolution: 1e-6,
                seed,
                ..VirtualLink::default()
            };
            let record = unloaded(&bolted(), 0.0, 0.02, stiffness, link);
            let (found, u) = number(&record, 1, "residual_displacement");
            let incomplete = record.procedures[1]
                .result("residual_displacement")
                .unwrap();
            assert_eq!(incomplete.withheld.is_none(), u.is_some());
            // An incomplete unloading has no U: it is as far from rest as its remaining load is on the slope.
            let remaining = number(&record, 1, "residual_force").0.unwrap().abs();
            let known = u.map_or(remaining / 4e4, |u| 2.0 * u);
            // 3σ is the smallest load that readings can resolve.
            assert!(
                (found.unwrap() - 0.01225).abs() < 3.0 * 0.5 / 4e4 + known,
                "{found:?} m ± {u:?} m"
            );
        }
    }
}

/// A soft spring k beside a stiff one that yields at 60 N, from 20 mm: 120 N back over 0.3 mm, then along k to zero at 60 N/k. With the cell's
/// noise of 0.5 N the path ends there, without reversing the friction: less than six standard deviations past zero. The stated u holds.
#[test]
fn a_soft_unloading_branch_is_followed_to_its_end() {
    let (mut inside, mut runs) = (0, 0);
    for stiffness in [1e4, 2e4, 4e4, 1e5, 2e5, 4e5] {
        let stiff = Behaviour::Bilinear {
            stiffness: 4e5,
            yield_force: 60.0,
            post_yield_ratio: 0.0,
        };
        let behaviour = Behaviour::Parallel(vec![Behaviour::Elastic { stiffness }, stiff]);
        for seed in 1..=8 {
            let link = VirtualLink {
                noise: 0.5,
                resolution: 1e-6,
                seed,
                ..VirtualLink::default()
            };
            let record = unloaded(&behaviour, 0.0, 0.02, stiffness + 4e5, link);
            let (found, u) = number(&record, 1, "residual_displacement");
            let (off, u) = ((found.unwrap() - 60.0 / stiffness).abs(), u.unwrap());
            assert!(
                record.events.is_empty() && off < 3.5 * u,
                "{stiffness} N/m, seed {seed}: off by {off} m, u {u} m: {:?}",
                record.events
            );
            assert!(
                moves(&record)
                    .iter()
                    .all(|step| step.restoring_force[0] > -3.0),
                "{stiffness} N/m, seed {seed}: {:?}",
                moves(&record)
            );
            (inside, runs) = (inside + usize::from(off < 2.0 * u), runs + 1);
        }
    }
    // 95 % of 48 are 45.6, with a standard deviation of 1.5.
    assert!(inside >= runs - 7, "{inside} of {runs}");
}

/// A specimen at rest within its friction is not moved: one short move shows it, and an observation states the remaining load.
#[test]
fn a_load_within_the_friction_is_reported_as_remaining() {
    let record = unloaded(
        &Behaviour::Elastic { stiffness: 4e4 },
        500.0,
        0.01,
        4e4,
        VirtualLink::default(),
    );
    assert_eq!(moves(&record).len(), 1);
    assert!(record.events.iter().any(|event| {
        event
            .text
            .starts_with("unloading incomplete: remaining force")
    }));
    // The position is not that of zero force: its uncertainty is withheld. The remaining force was read.
    let withheld = |name| {
        let result = record.procedures[1].result(name).unwrap();
        (result.withheld.is_some(), result.contributions.is_empty())
    };
    assert_eq!(withheld("residual_displacement"), (true, true));
    assert!(!withheld("residual_force").0);
}

/// After an impact of a series, the supports rest at the position of their model on the same path. The next impact begins there.
#[test]
fn an_impact_series_ends_there_too() {
    let struck = Impact {
        duration: Constant(0.2),
        ..impact(Constant(4e4))
    };
    let row = Escalate {
        own: ProcedureId(0),
        impact: Impact {
            stepping: testing::every(2e-4),
            ..struck
        },
        velocities: [0.8, 1.0].map(Constant).to_vec(),
        energies: None,
        condition: Vec::new(),
        between: Between::Unload,
        inspect_between: false,
    };
    let mut plan = elastic_plan(4e4, vec![ProcedureKind::Escalate(row)]);
    plan.specimens[0].behaviour = Some(bolted());
    let record = run_unwatched(&plan);
    let History::Escalate(history) = &record.procedures[0].history else {
        panic!()
    };
    let mut displacements = Vec::new();
    for struck in &history.impacts {
        displacements.extend(struck.history.steps.iter().map(|step| step.command));
        let rests = truly_rests(&bolted(), &displacements, 0.0);
        let found = struck.rest_of_struck().unwrap().0;
        assert!((found - rests).abs() < 2e-5, "{found} m, not {rests} m");
        displacements.push(found);
    }
    assert!(
        displacements
            .iter()
            .any(|displacement| *displacement > 0.008),
        "the supports bear"
    );
}

/// Storeys with twice the stiffness on unloading come to rest, each with its own friction.
#[test]
fn storeys_are_never_loaded_in_the_other_direction() {
    let mut plan: Plan = three(0.05);
    let frame = plan.specimens[0].frame.as_mut().unwrap();
    for (storey, coulomb) in frame.storeys.iter_mut().zip([0.0, 1e3, 0.0]) {
        storey.behaviour = Behaviour::BoucWen {
            stiffness: storey.stiffness,
            yield_force: 0.01 * storey.stiffness,
            post_yield_ratio: 0.05,
            sharpness: 1.0,
            beta: 1.0,
        };
        storey.coulomb = coulomb;
    }
    let storeys = frame.storeys.clone();
    let mut rig = virtual_rig(&plan);
    let mut watched = Unwatched;
    let mut session = Session::begin(&plan, rig.as_mut(), &mut watched)
        .unwrap_or_else(|_| panic!("the rig is refused"));
    let pushed = [0.025, 0.03, 0.015];
    session.go_to_all(&[0.025, 0.055, 0.07], None).unwrap();
    let mut steps = Vec::new();
    let unloading = of_frame(plan.specimens[0].frame.as_ref().unwrap()).unwrap();
    let rest = to_rest(unloading, None, None, 0, &mut session, &mut steps).unwrap();
    for (index, storey) in storeys.iter().enumerate() {
        let rests = truly_rests(&storey.behaviour, &[pushed[index]], storey.coulomb);
        let found = rest.drift()[index];
        assert!(
            (found - rests).abs() < 1e-3 * pushed[index],
            "storey {index}: {found} m, not {rests} m"
        );
    }
    for step in &steps {
        let shears: Vec<f64> = (0..3)
            .map(|storey| step.restoring_force[storey..].iter().sum())
            .collect();
        assert!(shears.iter().all(|shear| *shear > -100.0), "{shears:?} N");
    }
}
