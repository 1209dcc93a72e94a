//! What is foretold of tracking before a run, against what the run then shows: lags and increments missed, with and without a
//! stop, of a blow, of blows, and of a frame.

use super::Unwatched;
use super::testing::{elastic_plan, impact, number, run_unwatched, struck_frame};
use crate::check::tracking::foretold;
use crate::formula::Formula::Constant;
use crate::formula::ProcedureId;
use crate::plan::{
    Between, BlowOn, Escalate, Impact, Integrator, Link, Mode, Plan, ProcedureKind, Settle, Stepping, Until, VirtualLink,
};
use crate::record::{History, Outcome};
use crate::rig::virtual_rig;

const STIFFNESS: f64 = 300.0;
const CONTINUOUS: Mode = Mode::Continuous { time_scale: 50.0 };

/// A blow that rings for a second, by explicit steps of 5 ms.
fn ringing(mode: Mode) -> Impact {
    let blow = impact(Constant(STIFFNESS));
    let stepping = Stepping {
        mode,
        integrator: Integrator::Explicit,
        time_step: Constant(0.005),
        i_modification: false,
        ..blow.stepping.clone()
    };
    Impact { stepping, until: Until::Duration, duration: Constant(1.0), ..blow }
}

fn loose(mut plan: Plan, link: VirtualLink) -> Plan {
    plan.rig.link = Link::Virtual(link);
    plan.limits.tracking_energy_error.high = 1e6;
    plan
}

/// The share that is foretold of the plan's only procedure, and the one of its run.
fn shares(plan: &Plan) -> (f64, f64) {
    let record = super::run(plan, virtual_rig(plan).as_mut(), &mut Unwatched);
    assert_eq!(record.outcome, Outcome::Completed);
    (foretold(plan, 0).unwrap().foretold.share, number(&record, 0, "tracking_energy_error").0.unwrap())
}

const LAGGING: VirtualLink = VirtualLink {
    noise: 0.0,
    resolution: 0.0,
    force_resolution: 0.0,
    lag: 0.1,
    tracking: 0.0,
    drift: 0.0,
    seed: 1,
    foretold: None,
};

#[test]
fn a_blow_on_a_lagging_rig_is_foretold() {
    let late = |mode: Mode, link: VirtualLink, settle: Option<Settle>| {
        let mut plan = loose(elastic_plan(STIFFNESS, vec![ProcedureKind::Impact(ringing(mode))]), link);
        plan.rig.settle = settle.unwrap_or(plan.rig.settle);
        plan
    };
    let banded = Settle { band: 1e-5, force_rate: 0.0, dwell: 0.05, timeout: 60.0 };
    let calm = Settle { force_rate: 0.02, ..banded };
    let both = VirtualLink { tracking: 0.05, ..LAGGING };
    // Of paths that curve between the targets the forecast knows the ends alone.
    for (mode, link, settle, within) in [
        (CONTINUOUS, LAGGING, None, 0.05),
        (CONTINUOUS, both, None, 0.05),
        (Mode::StepAndPause, LAGGING, None, 1e-9),
        (Mode::StepAndPause, both, None, 1e-9),
        (Mode::StepAndPause, LAGGING, Some(banded), 1e-9),
        (Mode::StepAndPause, LAGGING, Some(calm), 1e-9),
    ] {
        let (told, found) = shares(&late(mode, link, settle));
        assert!((told / found - 1.0).abs() < within, "{mode:?}, {settle:?}: foretold {told}, found {found}");
    }
    // Late by 0.1 s at a fiftieth of the time: 2 ms, which is a damping ratio of −ω·1 ms.
    let forecast = foretold(&late(CONTINUOUS, LAGGING, None), 0).unwrap();
    assert!((forecast.foretold.late / 0.002 - 1.0).abs() < 0.05, "{forecast:?}");
    assert!((forecast.damping_ratio() + 0.5 * forecast.omega * forecast.foretold.late).abs() < 1e-15);
    assert!((forecast.omega - STIFFNESS.sqrt()).abs() < 1e-12);
    assert_eq!(foretold(&late(CONTINUOUS, VirtualLink { lag: 0.0, ..LAGGING }, None), 0), None);
}

#[test]
fn a_blow_on_a_storey_of_a_lagging_frame_is_foretold() {
    for (mode, link, within) in
        [(CONTINUOUS, VirtualLink { lag: 1.0, ..LAGGING }, 0.1), (Mode::StepAndPause, VirtualLink { lag: 2.0, ..LAGGING }, 1e-9)]
    {
        let mut plan = loose(struck_frame(), link);
        if let ProcedureKind::StoreyImpact(blow) = &mut plan.procedures[0].kind {
            blow.stepping.mode = mode;
        }
        let (told, found) = shares(&plan);
        assert!((told / found - 1.0).abs() < within, "{mode:?}: foretold {told}, found {found}");
    }
}

/// Of blows on an elastic specimen each gives the same share.
#[test]
fn blows_are_foretold() {
    let blow = ringing(Mode::StepAndPause);
    let escalate = Escalate {
        own: ProcedureId(0),
        blow: BlowOn::Specimen(blow),
        velocities: [0.5, 1.0].map(Constant).to_vec(),
        energies: None,
        condition: Vec::new(),
        between: Between::Home,
        inspect_between: false,
    };
    let plan = loose(
        elastic_plan(STIFFNESS, vec![ProcedureKind::Escalate(escalate)]),
        VirtualLink { tracking: 0.1, lag: 0.0, ..LAGGING },
    );
    let record = run_unwatched(&plan);
    let History::Escalate(history) = &record.procedures[0].history else { panic!("no blows") };
    let share = |index: usize| {
        let result = history.blows[index].results.iter().find(|result| result.name == "tracking_energy_error");
        match result.map(|result| &result.value) {
            Some(crate::formula::ResultValue::Number { value: Some(value), .. }) => *value,
            other => panic!("{other:?}"),
        }
    };
    let told = foretold(&plan, 0).unwrap().foretold.share;
    assert!((told / share(0) - 1.0).abs() < 1e-9, "foretold {told}, found {} and {}", share(0), share(1));
}
