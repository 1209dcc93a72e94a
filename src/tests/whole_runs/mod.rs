//! Whole runs of a stiffness ramp and a damping sweep on virtual rigs.

mod identification;
mod stops;

use crate::tests::testing::{elastic_plan, ramp, result_of};
use psd_plan::formula::Formula;
use psd_plan::record::{History, RampStep, SweepStep};
use psd_plan::{DampingSweep, Link, Plan, ProcedureKind, VirtualLink};

pub(super) fn constant(value: f64) -> Formula {
    Formula::Constant(value)
}

pub(super) fn sweep(velocities: &[f64]) -> DampingSweep {
    DampingSweep {
        specimen: 0,
        velocities: velocities.iter().copied().map(Formula::Constant).collect(),
        stroke: constant(1e-3),
        about: None,
        stiffness: result_of(0, "stiffness"),
        rate: None,
    }
}

pub(super) fn ramp_then_sweep() -> Plan {
    let velocities = sweep(&[5e-4, 1e-3, 2e-3, 5e-3, 1e-2]);
    let mut plan = elastic_plan(
        3e5,
        vec![
            ProcedureKind::StiffnessRamp(ramp(1e-4)),
            ProcedureKind::DampingSweep(velocities),
        ],
    );
    plan.specimens[0].mass = 0.5;
    plan.specimens[0].damping = 400.0;
    plan.specimens[0].coulomb = 3.0;
    plan
}

pub(super) fn link(plan: &mut Plan, link: VirtualLink) {
    plan.rig.link = Link::Virtual(link);
}

pub(super) fn ramp_steps(history: &History) -> &[RampStep] {
    match history {
        History::StiffnessRamp(ramp) => &ramp.steps,
        other => panic!("{other:?}"),
    }
}

pub(super) fn sweep_steps(history: &History) -> &[SweepStep] {
    match history {
        History::DampingSweep(sweep) => &sweep.steps,
        other => panic!("{other:?}"),
    }
}
