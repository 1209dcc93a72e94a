//! Unloading of a frame to zero floor forces, inside the limits.

use super::{close, rest, three, unloaded};
use crate::procedures::unload::run::{of_frame, to_rest};
use crate::run::Unwatched;
use crate::run::session::Session;
use crate::tests::testing::{elastic_plan, number, run_unwatched};
use psd_plan::formula::Formula::Constant;
use psd_plan::record::{History, Outcome, Record, Unloaded};
use psd_plan::{
    Behaviour, Frame, Interval, Link, Part, Procedure, ProcedureKind, Storey, Unload, VirtualLink,
};
use psd_rig::virtual_rig;

/// A bilinear storey beyond its yield drift δy has the shear Fy + hk(δ − δy), and unloads along k. The residual drift is its plastic
/// drift (1 − h)(δ − δy), independent of the other storeys. Three moves are sufficient: a short one, most of the path, the rest.
#[test]
fn the_residual_drift_of_a_bilinear_storey_is_plastic() {
    for post_yield_ratio in [0.0, 0.05, 0.2] {
        let (rest, steps) = unloaded(&three(post_yield_ratio), [0.025, -0.03, 0.004], None);
        let stays = [
            (1.0 - post_yield_ratio) * 0.015,
            -(1.0 - post_yield_ratio) * 0.02,
            0.0,
        ];
        close(&rest.drift(), &stays, 1e-15);
        close(&rest.shear(), &[0.0; 3], 1e-9);
        assert_eq!(steps.len(), 4);
        close(
            &[
                steps[1].tangent_stiffness[0].unwrap(),
                steps[1].tangent_stiffness[2].unwrap(),
            ],
            &[4e6, 1e6],
            1e-4,
        );
        assert_eq!(rest.largest().0, rest.displacement[0]);
    }
}

/// Beyond a shear of 2Fy a storey yields in reverse during unloading, by 2δy along k and the rest along hk. No single move finds that
/// position, but each move is nearer.
#[test]
fn a_storey_that_yields_in_unloading_is_followed() {
    let post_yield_ratio = 0.5;
    // V = Fy + hk(δ − δy) at δ = 5δy is 3Fy. Unloading by 2δy gives Fy, and Fy/(hk) = 2δy more gives zero.
    let (rest, steps) = unloaded(&three(post_yield_ratio), [0.05, 0.05, 0.012], Some(1e-3));
    close(
        &rest.drift(),
        &[0.01, 0.01, (1.0 - post_yield_ratio) * 0.002],
        1e-9,
    );
    assert!(steps.len() > 2 && steps.len() < 10, "{}", steps.len());
    let left: Vec<f64> = steps
        .iter()
        .map(|step| {
            step.restoring_force
                .iter()
                .fold(0.0, |most: f64, r| most.max(r.abs()))
        })
        .collect();
    assert!(
        left.windows(2).all(|pair| pair[1] < pair[0]) && left[left.len() - 1] <= 1e-3,
        "{left:?}"
    );
}

/// If increments are limited, the path is divided into equal parts of all axes. The frame comes to rest at the same position. A limit on
/// the path ends the unloading.
#[test]
fn all_floors_move_together_inside_the_limits() {
    let mut plan = three(0.1);
    let wanted = unloaded(&plan, [0.025, 0.03, 0.015], None).0;
    plan.limits.increment = Interval {
        low: 0.0,
        high: 1e-3,
    };
    let (found, steps) = unloaded(&plan, [0.025, 0.03, 0.015], None);
    close(&found.displacement, &wanted.displacement, 1e-15);
    assert_eq!(steps.len(), 4);
    // Pushed beyond yield and half of the path back, it springs outwards again: moves beyond a limit are refused.
    let mut rig = virtual_rig(&plan);
    plan.limits.increment = Interval::ALL;
    let unloading = of_frame(plan.specimens[0].frame.as_ref().unwrap()).unwrap();
    {
        let mut watched = Unwatched;
        let mut session = Session::begin(&plan, rig.as_mut(), &mut watched)
            .unwrap_or_else(|_| panic!("the rig is refused"));
        for displacement in [0.05, 0.03] {
            session.go_to_all(&[displacement; 3], None).unwrap();
        }
    }
    plan.limits.displacement = Interval {
        low: 0.0,
        high: 0.033,
    };
    let mut watched = Unwatched;
    let mut session = Session::begin(&plan, rig.as_mut(), &mut watched)
        .unwrap_or_else(|_| panic!("the rig is refused"));
    let mut steps = Vec::new();
    let stop = to_rest(unloading, None, None, 0, &mut session, &mut steps).unwrap_err();
    assert!(matches!(stop.outcome(), Outcome::Aborted { .. }), "{stop}");
    assert!(
        steps.len() == 2
            && session
                .guard
                .commanded()
                .iter()
                .all(|displacement| (0.03..0.033).contains(displacement))
    );
}

/// With noise, the frame comes to rest within the resolution of its cells, and is not moved further.
#[test]
fn noise_is_not_mistaken_for_load() {
    let mut plan = three(0.05);
    let ideal = unloaded(&plan, [0.02, 0.02, 0.02], None).0;
    for seed in 1..20 {
        plan.rig.link = Link::Virtual(VirtualLink {
            noise: 20.0,
            resolution: 1e-6,
            seed,
            ..VirtualLink::default()
        });
        let (found, steps) = unloaded(&plan, [0.02, 0.02, 0.02], None);
        // The rows of |K| are at most 8, 6 and 2 MN/m. A resolution of 1 µm is 9 N at the second floor; 3σ are 60 N.
        assert!(
            found.force.iter().all(|force| force.abs() <= 60.0),
            "{found:?}"
        );
        // Three moves, and one more if noise changes the slope of the last.
        assert!(steps.len() <= 5, "{}", steps.len());
        let off = found
            .drift()
            .iter()
            .zip(ideal.drift())
            .map(|(found, ideal)| (found - ideal).abs())
            .fold(0.0, f64::max);
        assert!(off < 3.0 * 3.0 * 20.0 / 1e6 + 2e-6, "{off} m");
    }
}

/// A frame given by its matrices is not a shear building: K⁻¹ unloads all floors together.
#[test]
fn a_frame_of_matrices_is_unloaded_as_a_whole() {
    let mut plan = three(0.05);
    let frame = plan.specimens[0].frame.as_mut().unwrap();
    frame.storeys.clear();
    frame.stiffness = vec![
        vec![6e6, -2e6, 1e5],
        vec![-2e6, 3e6, -1e6],
        vec![1e5, -1e6, 1.2e6],
    ];
    let (rest, steps) = unloaded(&plan, [0.01, 0.02, -0.01], None);
    close(&rest.displacement, &[0.0; 3], 1e-16);
    assert!(steps.len() == 4 && steps[1].tangent_stiffness == [None; 3]);
}

/// Unloading of one storey is bit-identical to that of one degree of freedom.
#[test]
fn one_storey_is_unloaded_as_one_degree_of_freedom() {
    let behaviour = Behaviour::Bilinear {
        stiffness: 500.0,
        yield_force: 5.0,
        post_yield_ratio: 0.3,
    };
    let mut frame = elastic_plan(1.0, vec![rest(None)]);
    let floor = Storey {
        mass: 1.0,
        mass_uncertainty: 0.0,
        stiffness_uncertainty: 0.0,
        stiffness: 500.0,
        height: None,
        behaviour: behaviour.clone(),
        damping: 0.0,
        coulomb: 0.2,
        gravity: 0.0,
        part: Part::TESTED,
        axial_load: 0.0,
    };
    frame.specimens[0].frame = Some(Frame::of_storeys(vec![floor]));
    let unload = Unload {
        specimen: 0,
        stiffness: Some(Constant(500.0)),
        within: None,
        speed: None,
        keep_axial_load: false,
    };
    let mut single = elastic_plan(1.0, vec![ProcedureKind::Unload(unload)]);
    single.specimens[0].coulomb = 0.2;
    single.specimens[0].behaviour = Some(behaviour.clone());
    frame.specimens[0].behaviour = Some(behaviour);
    let away = psd_plan::Move {
        to: Constant(0.08),
        speed: None,
    };
    for plan in [&mut frame, &mut single] {
        plan.procedures.insert(
            0,
            Procedure {
                name: "away".to_owned(),
                kind: ProcedureKind::Move(away.clone()),
            },
        );
    }
    let (frame, single) = (run_unwatched(&frame), run_unwatched(&single));
    let moved = |record: &Record, of: Unloaded| match &record.procedures[1].history {
        History::Unload(history) if history.of == of => history.steps.clone(),
        other => panic!("{other:?}"),
    };
    let (floors, moves) = (
        moved(&frame, Unloaded::Floors),
        moved(&single, Unloaded::OneAxis),
    );
    assert!(moves.len() > 2 && floors.len() == moves.len() + 1);
    for (floor, step) in floors[1..].iter().zip(&moves) {
        assert_eq!(
            (&floor.command, &floor.displacement),
            (&step.command, &step.displacement)
        );
        assert_eq!(
            (&floor.restoring_force, &floor.tangent_stiffness),
            (&step.restoring_force, &step.tangent_stiffness)
        );
    }
    for name in ["residual_displacement", "residual_force"] {
        assert_eq!(number(&frame, 1, name), number(&single, 1, name));
    }
}
