//! Runs of an impact, and an exact solution of hard collisions that shares no code with the product.

use psd_physics::contact::ContactLaw;
use psd_physics::impact::summary::{ImpactSummary, SummaryBuilder};
use psd_physics::impact::{ImpactInput, ImpactSolver, ImpactState};
use psd_physics::specimen::{Elastic, RestoringForce};
use psd_physics::statistics::DeclaredNoise;
use psd_plan::Integrator;

/// A striker of 10 kg at 1 m/s that touches an undamped structure at t = 0.
pub fn impact(mass: f64, stiffness: f64, law: ContactLaw, time_step: f64) -> ImpactInput {
    ImpactInput {
        mass,
        damping: 0.0,
        stiffness,
        striker_mass: 10.0,
        striker_velocity: 1.0,
        gap: 0.0,
        gravity: 0.0,
        time_step,
        max_tangent_ratio: 2.0,
        law,
        integrator: Integrator::Tangent,
        operator_stiffness: stiffness,
        i_modification: false,
        noise: DeclaredNoise::NONE,
    }
}

/// A run to its end.
pub struct Run {
    pub states: Vec<ImpactState>,
    pub summary: ImpactSummary,
    /// Largest |integration error| of any step \[J\].
    pub worst_error: f64,
}

impl Run {
    pub fn last(&self) -> &ImpactState {
        self.states.last().expect("a run has its start")
    }

    pub fn stop_time(&self) -> f64 {
        self.summary.stop_time.expect("the striker stopped")
    }
}

/// The run on a linear specimen of the input's stiffness.
pub fn run(input: &ImpactInput) -> Run {
    run_on(
        input,
        &mut Elastic {
            stiffness: input.stiffness,
        },
    )
}

pub fn run_on(input: &ImpactInput, specimen: &mut impl RestoringForce) -> Run {
    run_while(input, specimen, |state| state.time < 10.0)
}

/// The run until it has finished or `go_on` returns false.
pub fn run_while(
    input: &ImpactInput,
    specimen: &mut impl RestoringForce,
    go_on: impl Fn(&ImpactState) -> bool,
) -> Run {
    let mut solver = ImpactSolver::new(input, 0.0, specimen.move_to(0.0)).expect("an impact");
    let mut builder = SummaryBuilder::new(input);
    let mut states = vec![*solver.state()];
    builder.push(solver.state());
    let mut worst_error = 0.0_f64;
    while !solver.finished() && go_on(solver.state()) {
        let displacement = solver.predict();
        let state = *solver.complete(displacement, specimen.move_to(displacement));
        builder.push(&state);
        worst_error = worst_error.max(state.energies.error.abs());
        states.push(state);
    }
    Run {
        states,
        summary: builder.finish(),
        worst_error,
    }
}

/// One body on a spring: x cos ωt + v/ω sin ωt and its rate.
fn arc(omega: f64, x: f64, v: f64, t: f64) -> (f64, f64) {
    let (sine, cosine) = (omega * t).sin_cos();
    (x * cosine + v / omega * sine, v * cosine - x * omega * sine)
}

/// First t in (0, end] where `reached` turns true, found from a bracket at whose end it is.
fn bisect(mut low: f64, mut high: f64, reached: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if reached(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

/// Hard collisions with restitution `e` of a striker with a body on a spring, both touching at t = 0: exact arcs between
/// collisions found by stepping and bisection. Below a separation speed of 1e-10 m/s the two are one body until it is
/// back at X = 0. Largest X, and the time at which the striker's velocity is no longer positive.
pub fn event_driven(
    mass: f64,
    striker_mass: f64,
    speed: f64,
    stiffness: f64,
    e: f64,
) -> (f64, f64) {
    const STEP: f64 = 1e-4;
    let omega = (stiffness / mass).sqrt();
    let joint = (stiffness / (mass + striker_mass)).sqrt();
    let (mut time, mut x, mut v, mut vs, mut peak) = (0.0_f64, 0.0_f64, 0.0_f64, speed, 0.0_f64);
    loop {
        let closing = vs - v;
        let common = (mass * v + striker_mass * vs) / (mass + striker_mass);
        v = common + e * closing * striker_mass / (mass + striker_mass);
        vs = common - e * closing * mass / (mass + striker_mass);
        if e * closing < 1e-10 {
            // One body: it reverses at the time given by the amplitude and phase of x and v.
            let amplitude = x.hypot(common / joint);
            let stop = if common > 0.0 {
                (common / joint).atan2(x) / joint
            } else {
                0.0
            };
            return if common > 0.0 {
                (peak.max(amplitude), time + stop)
            } else {
                (peak.max(x), time)
            };
        }
        if vs <= 0.0 {
            // It rebounded: the structure's own peak may still follow.
            let amplitude = if v > 0.0 { x.hypot(v / omega) } else { x };
            return (peak.max(amplitude), time);
        }
        // Separate until Xs − X, divided by the time of flight so that the start is not a root, is 0 again.
        let gap = |t: f64| x + vs * t - arc(omega, x, v, t).0;
        let mut first = (v - vs) / (stiffness * x / mass).abs().max(1e-12) * 0.5;
        first = first.min(STEP);
        let mut t = first;
        while gap(t) < 0.0 {
            t += first;
        }
        let hit = bisect(t - first, t, |t| gap(t) >= 0.0 && t > 0.0);
        let turn = (v / omega).atan2(x) / omega;
        if v > 0.0 && turn > 0.0 && turn < hit {
            peak = peak.max(x.hypot(v / omega));
        }
        (x, v) = arc(omega, x, v, hit);
        peak = peak.max(x);
        time += hit;
    }
}
