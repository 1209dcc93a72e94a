//! The runs of the self-test, on ideal specimens. In: a law, an integrator, a step. Out: peaks and displacements.

use crate::contact::Approaching;
use crate::contact::ContactLaw;
use crate::impact::summary::{ImpactSummary, SummaryBuilder};
use crate::impact::{FrameImpactSolver, ImpactInput, ImpactSetup, ImpactSolver, Until, simulate};
use crate::integrator::Integrator;
use crate::integrator::input::FrameInput;
use crate::integrator::solver::FrameSolver;
use crate::integrator::tangents::Tangents;
use crate::specimen::Elastic;
use crate::structure::{FrameMatrices, SymmetricBand, storey_stiffness};

/// Ten times the steps of the paper's longest case.
const STEPS: u32 = 4000;

/// A striker of 10 kg at 1 m/s that touches an undamped, linear structure at t = 0.
pub(super) fn input(mass: f64, stiffness: f64, law: ContactLaw, time_step: f64) -> ImpactInput {
    ImpactInput {
        law,
        ..ImpactInput::rigid(
            stiffness,
            Approaching {
                mass,
                striker_mass: 10.0,
                velocity: 1.0,
                time_step,
            },
        )
    }
}

/// That impact by the tangent form, to its end.
pub(super) fn impact(mass: f64, stiffness: f64, law: ContactLaw, time_step: f64) -> ImpactSummary {
    impact_of(&input(mass, stiffness, law, time_step))
}

pub(super) fn impact_of(input: &ImpactInput) -> ImpactSummary {
    let mut summary = SummaryBuilder::new(input);
    if let Ok(solver) = ImpactSolver::new(input, 0.0, 0.0) {
        summary.push(solver.state());
    }
    // A case that cannot be integrated fails by its result.
    let _ = simulate(
        input,
        &mut Elastic {
            stiffness: input.stiffness,
        },
        Some(Until::StrikerStop),
        STEPS.into(),
        &mut summary,
    );
    summary.finish()
}

/// 1 kg on 400 N/m, released at 1 m with the striker out of reach: displacement after 4 steps of 50 ms \[m\].
pub(super) fn free_vibration(integrator: Integrator) -> f64 {
    const STIFFNESS: f64 = 400.0;
    let far = ImpactInput {
        gap: 1e9,
        striker_velocity: 0.0,
        integrator,
        ..input(1.0, STIFFNESS, ContactLaw::Rigid, 0.05)
    };
    let Ok(mut solver) = ImpactSolver::new(&far, 1.0, STIFFNESS) else {
        return f64::NAN;
    };
    for _ in 0..4 {
        let target = solver.predict();
        solver.complete(target, STIFFNESS * target);
    }
    solver.state().displacement
}

fn frame(storeys: usize, mass: f64, stiffness: f64) -> FrameMatrices {
    FrameMatrices {
        mass: SymmetricBand::diagonal(&vec![mass; storeys]),
        damping: SymmetricBand::zero(storeys, 0),
        stiffness: storey_stiffness(&vec![stiffness; storeys]),
        gravity: None,
    }
}

/// A frame at rest under `load` \[N\], with a tangent stiffness of each storey.
fn at_rest<'a>(
    matrices: &'a FrameMatrices,
    integrator: Integrator,
    time_step: f64,
    [zero, load]: [&'a [f64]; 2],
) -> FrameInput<'a> {
    FrameInput {
        matrices,
        operator_stiffness: &matrices.stiffness,
        integrator,
        i_modification: false,
        tangents: Tangents::Storeys { largest_ratio: 2.0 },
        time_step,
        initial_displacement: zero,
        initial_restoring_force: zero,
        initial_load: load,
        readings: &[],
        elements: None,
    }
}

/// Two storeys of 1000 kg and 1000 kN/m on ground that accelerates by 1 m/s² from t = 0 on: displacement of the upper floor after 6
/// steps of 20 ms \[m\].
pub(super) fn displacement_on_moving_ground(integrator: Integrator) -> f64 {
    let matrices = frame(2, 1e3, 1e6);
    let (mut force, mut load) = ([0.0; 2], [0.0; 2]);
    matrices.ground_load(1.0, &mut load);
    let Ok(mut solver) =
        FrameSolver::new(&at_rest(&matrices, integrator, 0.02, [&[0.0; 2], &load]))
    else {
        return f64::NAN;
    };
    for _ in 0..6 {
        let target = solver.predict(&load).to_vec();
        matrices.stiffness.mul_into(&target, &mut force);
        solver.complete(&target, &force);
    }
    solver.state().displacement[1]
}

/// One storey of 1 kg, struck as the structure of [`input`]: peak displacement \[m\] and peak contact force \[N\].
pub(super) fn struck_storey(
    integrator: Integrator,
    stiffness: f64,
    law: ContactLaw,
    time_step: f64,
) -> (f64, f64) {
    let matrices = frame(1, 1.0, stiffness);
    let frame = at_rest(&matrices, integrator, time_step, [&[0.0], &[0.0]]);
    let setup = ImpactSetup {
        struck: 0,
        mass: 10.0,
        velocity: 1.0,
        gap: 0.0,
        gravity: 0.0,
        law,
    };
    let Ok(mut solver) = FrameImpactSolver::on(&frame, &setup) else {
        return (f64::NAN, f64::NAN);
    };
    let (mut farthest, mut hardest) = (0.0_f64, 0.0_f64);
    for _ in 0..STEPS {
        if solver.finished() {
            break;
        }
        let target = solver.predict()[0];
        let state = solver.complete(&[target], &[stiffness * target]);
        farthest = farthest.max(state.displacement);
        hardest = hardest.max(state.contact_force);
    }
    (farthest, hardest)
}
