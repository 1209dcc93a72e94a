//! By how much vibrations grow on rigs that miss their targets, against what is foretold of it: one degree of freedom and the modes of
//! a frame, with a stop at every step and without.

use super::frame_doubts_tests::shaken;
use super::testing::{elastic_plan, impact, run_unwatched};
use crate::formula::Formula::Constant;
use crate::mechanics::growth::{Following, Lag, Mode as Vibration};
use crate::plan::{
    Behaviour, Impact, Integrator, Interval, Link, Mode, Plan, ProcedureKind, ShakeDamping, Stepping, Storey, Until, VirtualLink,
};
use crate::record::{Floors as _, History, Outcome};

const STIFFNESS: f64 = 300.0;
const SCALE: f64 = 50.0;
const INTEGRATORS: [Integrator; 3] = [Integrator::Tangent, Integrator::Explicit, Integrator::AlphaOs { alpha: -0.05 }];

/// ln of the growth of a cycle of what is left to vibrate alone: d₁ = p·d − q·d₋₁ with q = |z|² and p = 2·Re z.
fn a_cycle(places: &[f64]) -> f64 {
    let [.., a, b, c, d] = *places else { panic!("too few steps") };
    let size = (c * c - b * d) / (b * b - a * c);
    let twice = (a * d - b * c) / (a * c - b * b);
    std::f64::consts::PI * size.ln() / (0.5 * twice / size.sqrt()).acos()
}

fn with(mut plan: Plan, link: VirtualLink) -> Plan {
    plan.rig.link = Link::Virtual(link);
    plan.limits.tracking_energy_error.high = 1e9;
    // So fast that no move takes time.
    plan.limits.speed = Interval { low: f64::NEG_INFINITY, high: 1e6 };
    plan
}

/// A light striker that leaves at once; what it struck rings for six seconds.
fn ringing(mode: Mode, integrator: Integrator, time_step: f64, link: VirtualLink) -> Vec<f64> {
    let blow = impact(Constant(STIFFNESS));
    let stepping = Stepping { mode, integrator, time_step: Constant(time_step), pause: Constant(0.3), ..blow.stepping.clone() };
    let blow = Impact { stepping, until: Until::Duration, duration: Constant(6.0), ..blow };
    let mut plan = with(elastic_plan(STIFFNESS, vec![ProcedureKind::Impact(blow)]), link);
    plan.strikers[0].mass = 0.2;
    let record = run_unwatched(&plan);
    assert_eq!(record.outcome, Outcome::Completed);
    let History::Impact(history) = &record.procedures[0].history else { panic!() };
    let last = &history.steps[history.steps.len() - 4..];
    assert!(last.iter().all(|step| step.contact_force == 0.0));
    last.iter().map(|step| step.computed).collect()
}

fn told(integrator: Integrator, time_step: f64, following: Following) -> f64 {
    let angle = STIFFNESS.sqrt() * time_step;
    following.growth(integrator, &Vibration { angle, damping_ratio: 0.0, operator: 1.0, i_modification: false }).unwrap()
}

/// With a stop: what is missed of every increment, and what a lag leaves after a pause, to rounding.
#[test]
fn what_grows_on_a_rig_that_stops_is_foretold() {
    let (lag, pause, time_step): (f64, f64, f64) = (0.2, 0.3, 0.01);
    let left = (-pause / lag).exp();
    for integrator in INTEGRATORS {
        let found = |link| a_cycle(&ringing(Mode::StepAndPause, integrator, time_step, link));
        let alone = found(VirtualLink::default());
        for (short, lag, behind) in [(0.05, 0.0, 0.0), (-0.1, 0.0, 0.0), (0.0, lag, left), (0.03, lag, left)] {
            let grown = found(VirtualLink { tracking: short, lag, ..VirtualLink::default() }) - alone;
            let following = Following { short, lag: Lag::Paused { behind, carried: behind } };
            let told = told(integrator, time_step, following);
            assert!((grown / told - 1.0).abs() < 1e-5, "{integrator:?}, {short} short, {lag} s: {grown}, told {told}");
        }
    }
}

/// Without: the path between two targets is not a sine's, by the square of the step, and by that the growth is another.
#[test]
fn what_grows_on_a_rig_that_glides_is_foretold_to_the_second_order() {
    let mode = Mode::Continuous { time_scale: SCALE };
    for integrator in INTEGRATORS {
        for link in [
            VirtualLink { lag: 0.1, ..VirtualLink::default() },
            VirtualLink { tracking: 0.05, ..VirtualLink::default() },
            VirtualLink { lag: 0.1, tracking: 0.05, ..VirtualLink::default() },
        ] {
            let off = |time_step: f64| {
                let found = |link| a_cycle(&ringing(mode, integrator, time_step, link));
                let lag = Lag::Gliding { steps: link.lag / (SCALE * time_step) };
                let told = told(integrator, time_step, Following { short: link.tracking, lag });
                (found(link) - found(VirtualLink::default())) / told - 1.0
            };
            let [coarse, fine] = [8e-3, 4e-3].map(off);
            assert!(fine.abs() < 5e-3, "{integrator:?}, {link:?}: {coarse}, {fine}");
            assert!(fine.abs() < 1e-5 || (coarse / fine).abs() > 2.5, "{integrator:?}, {link:?}: {coarse}, {fine}");
        }
    }
}

/// Every mode of a frame by itself, for the actuators of all floors follow alike.
#[test]
fn every_mode_of_a_frame_grows_as_foretold() {
    let storey = |mass, stiffness| Storey::new(mass, stiffness, Behaviour::Elastic { stiffness });
    let time_step = 0.01;
    for (mode, integrator, short, lag, within) in [
        (Mode::StepAndPause, Integrator::Explicit, 0.02, 0.0, 1e-4),
        (Mode::StepAndPause, Integrator::Tangent, 0.02, 0.2, 1e-4),
        (Mode::Continuous { time_scale: SCALE }, Integrator::Explicit, 0.0, 0.05, 0.02),
    ] {
        let mut accelerations = vec![0.0; 300];
        accelerations[1] = 2.0;
        let mut plan = shaken(vec![storey(1.0, 500.0), storey(2.0, 300.0)], accelerations, time_step);
        let ProcedureKind::Shake(shake) = &mut plan.procedures[0].kind else { panic!() };
        shake.damping = ShakeDamping::Modal(vec![Constant(0.0), Constant(0.0)]);
        shake.stepping =
            Stepping { mode, integrator, time_step: Constant(time_step), pause: Constant(0.3), ..shake.stepping.clone() };
        let masses: Vec<f64> = plan.specimens[0].frame.as_ref().unwrap().storeys.iter().map(|storey| storey.mass).collect();
        let modal = |link: VirtualLink| {
            let record = run_unwatched(&with(plan.clone(), link));
            assert_eq!(record.outcome, Outcome::Completed);
            let History::Shake(history) = &record.procedures[0].history else { panic!() };
            let modes = history.modes.clone().unwrap();
            let last = &history.steps[history.steps.len() - 4..];
            let of = |mode: usize| {
                let along = |place: &[f64]| (0..2).map(|floor| masses[floor] * modes.shapes[mode][floor] * place[floor]).sum();
                let places: Vec<f64> = last.iter().map(|step| along(step.computed())).collect();
                (modes.angular_frequency(mode), a_cycle(&places))
            };
            [of(0), of(1)]
        };
        let left = if lag > 0.0 { f64::exp(-0.3 / lag) } else { 0.0 };
        let follows = match mode {
            Mode::StepAndPause => Lag::Paused { behind: left, carried: left },
            Mode::Continuous { time_scale } => Lag::Gliding { steps: lag / (time_scale * time_step) },
        };
        let missing = modal(VirtualLink { tracking: short, lag, ..VirtualLink::default() });
        for ((omega, alone), (_, grown)) in modal(VirtualLink::default()).into_iter().zip(missing) {
            let vibration = Vibration { angle: omega * time_step, damping_ratio: 0.0, operator: 1.0, i_modification: false };
            let told = Following { short, lag: follows }.growth(integrator, &vibration).unwrap();
            assert!(((grown - alone) / told - 1.0).abs() < within, "{mode:?}, {omega} rad/s: {}, told {told}", grown - alone);
        }
    }
}
