//! Weights on the floors of a frame, M Ẍ + C Ẋ + R − G X = F, against closed forms and independent recursions.

use std::f64::consts::TAU;

use super::support::{at, number, uniform_frequency};
use psd_physics::integrator::input::FrameInput;
use psd_physics::integrator::solver::FrameSolver;
use psd_physics::integrator::state::FrameState;
use psd_physics::integrator::tangents::Tangents;
use psd_physics::specimen::{RestoringForce as _, SpecimenModel};
use psd_physics::structure::frame_properties::FrameProperties;
use psd_physics::structure::{Damping, FrameMatrices, drifts, floor_forces, storey_stiffness};
use psd_plan::{Behaviour, Frame, Integrator, Part, Storey};

const INTEGRATORS: [Integrator; 4] = [
    Integrator::Tangent,
    Integrator::Explicit,
    Integrator::AlphaOs { alpha: 0.0 },
    Integrator::AlphaOs { alpha: -0.05 },
];

/// A storey of mass \[kg\], weight \[N\] and height \[m\].
fn storey(mass: f64, behaviour: Behaviour, gravity: f64, height: f64) -> Storey {
    Storey {
        height: Some(height),
        gravity,
        ..Storey::new(mass, behaviour.initial_stiffness(), behaviour)
    }
}

const fn elastic(stiffness: f64) -> Behaviour {
    Behaviour::Elastic { stiffness }
}

const fn bilinear(stiffness: f64, yield_force: f64) -> Behaviour {
    Behaviour::Bilinear {
        stiffness,
        yield_force,
        post_yield_ratio: 0.02,
    }
}

fn properties(storeys: Vec<Storey>, damping: &Damping) -> FrameProperties {
    FrameProperties::of(&Frame::of_storeys(storeys), damping).expect("it stands")
}

fn input<'a>(
    frame: &'a FrameProperties,
    integrator: Integrator,
    time_step: f64,
    zero: &'a [f64],
) -> FrameInput<'a> {
    FrameInput {
        operator_stiffness: &frame.operator,
        tangents: if integrator == Integrator::Tangent {
            Tangents::Storeys { largest_ratio: 2.0 }
        } else {
            Tangents::Initial
        },
        ..at(&frame.matrices, integrator, time_step, zero)
    }
}

/// The frame from rest at zero, on models of its storeys, under a ground acceleration \[m/s²\].
fn shaken(
    storeys: &[Storey],
    input: &FrameInput,
    steps: u32,
    ground: impl Fn(f64) -> f64,
    mut observe: impl FnMut(&FrameState) -> bool,
) {
    let mut load = vec![0.0; storeys.len()];
    input.matrices.ground_load(ground(0.0), &mut load);
    let start = FrameInput {
        initial_load: &load.clone(),
        ..*input
    };
    let mut solver = FrameSolver::new(&start).expect("a frame");
    let mut models: Vec<SpecimenModel> = storeys
        .iter()
        .map(|storey| SpecimenModel::new(&storey.behaviour))
        .collect();
    let (mut drift, mut force) = (load.clone(), load.clone());
    for step in 1..=steps {
        let ground = ground(f64::from(step) * input.time_step);
        input.matrices.ground_load(ground, &mut load);
        let target = solver.predict(&load).to_vec();
        drifts(&target, &mut drift);
        let shear: Vec<f64> = models
            .iter_mut()
            .zip(&drift)
            .map(|(model, drift)| model.move_to(*drift))
            .collect();
        floor_forces(&shear, &mut force);
        if observe(solver.complete(&target, &force)) {
            break;
        }
    }
}

/// P/h = g in every storey: a chain of n equal masses with springs k − g.
#[test]
fn periods_are_those_of_the_net_stiffness() {
    let (mass, stiffness, g) = (1000.0, 2e6, 3e5);
    for storeys in 1..=6 {
        let storey = |index: usize| {
            // A weight W on each floor: P = W (n − index), and h = P/g.
            let weight = 2e5;
            let load = weight * number(storeys - index);
            storey(mass, elastic(stiffness), weight, load / g)
        };
        let frame = properties((0..storeys).map(storey).collect(), &Damping::None);
        for (mode, period) in frame.modes.periods.iter().enumerate() {
            let exact = TAU / uniform_frequency(storeys, mode + 1, mass, stiffness - g);
            assert!((period / exact - 1.0).abs() < 1e-12, "{storeys}, {mode}");
        }
    }
}

/// Rayleigh coefficients are of M and K₀ alone; the ratio of the only mode rises as its frequency falls.
#[test]
fn damping_is_computed_without_the_weights() {
    let of = |gravity| {
        let storeys = vec![storey(1000.0, elastic(4e6), gravity, 2.0)];
        properties(storeys, &Damping::rayleigh(0.02))
    };
    let (unloaded, loaded) = (of(0.0), of(2e6));
    assert_eq!(unloaded.matrices.damping, loaded.matrices.damping);
    let ratio = loaded.damping_ratios()[0];
    assert!((ratio / (0.02 * (4.0_f64 / 3.0).sqrt()) - 1.0).abs() < 1e-12);
}

/// An elastic frame with weights is one with the springs k − P/h, by every integrator; and a load H holds it at H/(k − P/h).
#[test]
fn an_elastic_frame_is_one_of_softer_springs() {
    let with = vec![
        storey(2000.0, elastic(6e5), 4e5, 4.0),
        storey(1500.0, elastic(4e5), 3e5, 3.0),
    ];
    let without = vec![
        storey(2000.0, elastic(6e5 - 7e5 / 4.0), 0.0, 4.0),
        storey(1500.0, elastic(4e5 - 3e5 / 3.0), 0.0, 3.0),
    ];
    let ground = |time: f64| 3.0 * (9.0 * time).sin();
    for integrator in INTEGRATORS {
        let motion = |storeys: &[Storey]| {
            let frame = properties(storeys.to_vec(), &Damping::None);
            let mut motion: Vec<f64> = Vec::new();
            let zero = [0.0; 2];
            let input = input(&frame, integrator, 0.004, &zero);
            shaken(storeys, &input, 1000, ground, |state| {
                motion.extend(&state.displacement);
                let e = &state.energies;
                let parts = e.kinetic + e.restoring + e.damping + e.error;
                assert!((parts - e.input - e.gravity).abs() < 1e-9 * e.kinetic.max(1.0));
                false
            });
            motion
        };
        let (with, without) = (motion(&with), motion(&without));
        let largest = without.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        for (found, wanted) in with.iter().zip(&without) {
            assert!((found - wanted).abs() < 1e-10 * largest, "{integrator:?}");
        }
    }
}

/// x₀ = H/(k − P/h) stays at rest under H; without H it is released: x₀ cos(ωt) with ω² = (k − P/h)/m, to second order in Δt.
#[test]
fn one_storey_rests_and_vibrates_as_in_the_closed_form() {
    let (mass, stiffness, load, height) = (1000.0, 5e5, 6e5, 3.0);
    let net: f64 = stiffness - load / height;
    let omega = (net / mass).sqrt();
    let storeys = [storey(mass, elastic(stiffness), load, height)];
    let frame = properties(storeys.to_vec(), &Damping::None);
    let start = [0.03];
    let force = [stiffness * start[0]];
    let run = |integrator, time_step: f64, held: f64, end: f64| {
        let load = [held];
        let input = FrameInput {
            initial_displacement: &start,
            initial_restoring_force: &force,
            initial_load: &load,
            ..input(&frame, integrator, time_step, &load)
        };
        let mut solver = FrameSolver::new(&input).expect("a storey");
        let steps = (end / time_step).round();
        while solver.state().time < (steps - 0.5) * time_step {
            let target = solver.predict(&load).to_vec();
            solver.complete(&target, &[stiffness * target[0]]);
        }
        solver.state().clone()
    };
    for integrator in INTEGRATORS {
        let still = run(integrator, 0.005, net * start[0], 1.0);
        assert!((still.displacement[0] / start[0] - 1.0).abs() < 1e-12);
        assert!(still.velocity[0].abs() < 1e-12);
        let off = |time_step: f64| {
            let end = 0.6;
            let found = run(integrator, time_step, 0.0, end).displacement[0];
            found - start[0] * (omega * end).cos()
        };
        let order = (off(0.002) / off(0.001)).log2();
        assert!((order - 2.0).abs() < 0.1, "{integrator:?}: order {order}");
        assert!(off(0.001).abs() < 5e-4 * start[0]);
    }
}

const YIELDING: [(f64, f64, f64, f64, f64); 3] = [
    (2000.0, 6e5, 4000.0, 1.0e4, 3.0),
    (1500.0, 4e5, 3000.0, 8.0e3, 3.0),
    (1000.0, 3e5, 2000.0, 5.0e3, 2.5),
];

fn yielding(weights: f64) -> Vec<Storey> {
    YIELDING
        .iter()
        .map(|(mass, stiffness, force, weight, height)| {
            storey(
                *mass,
                bilinear(*stiffness, *force),
                weights * weight,
                *height,
            )
        })
        .collect()
}

/// A plain bilinear spring, kinematic hardening.
struct Spring {
    stiffness: f64,
    yield_force: f64,
    ratio: f64,
    plastic: f64,
}

impl Spring {
    fn force(&mut self, drift: f64) -> f64 {
        let hard = self.ratio * self.stiffness;
        let soft = self.stiffness - hard;
        let limit = (1.0 - self.ratio) * self.yield_force;
        let core = (soft * (drift - self.plastic)).clamp(-limit, limit);
        self.plastic = drift - core / soft;
        hard * drift + core
    }
}

/// The central difference x₁ = 2x − x₋₁ + Δt²M⁻¹(f − R + Gx), with sums of its own, is explicit Newmark without damping.
#[test]
fn yielding_storeys_move_as_an_independent_recursion_does() {
    // P/h exceeds the post-yield stiffness of every storey.
    let weights = 8.0;
    let storeys = yielding(weights);
    let frame = Frame::of_storeys(storeys.clone());
    for (storey, g) in storeys.iter().zip(frame.gravity_stiffness()) {
        assert!(g > 0.02 * storey.stiffness && g < 0.3 * storey.stiffness);
    }
    let ground = |time: f64| 2.5 * (8.0 * time).sin();
    let (step, steps) = (0.002, 1500);
    let mut found: Vec<Vec<f64>> = Vec::new();
    let frame = properties(storeys.clone(), &Damping::None);
    let zero = [0.0; 3];
    shaken(
        &storeys,
        &input(&frame, Integrator::Explicit, step, &zero),
        steps,
        ground,
        |state| {
            found.push(state.displacement.clone());
            false
        },
    );
    let mut springs: Vec<Spring> = YIELDING
        .iter()
        .map(|(_, stiffness, yield_force, ..)| Spring {
            stiffness: *stiffness,
            yield_force: *yield_force,
            ratio: 0.02,
            plastic: 0.0,
        })
        .collect();
    let mut pull = |x: &[f64; 3], time: f64| {
        let mut net = [0.0; 3];
        for (index, spring) in springs.iter_mut().enumerate() {
            let drift = x[index] - if index == 0 { 0.0 } else { x[index - 1] };
            let above: f64 = YIELDING[index..].iter().map(|(.., weight, _)| weight).sum();
            let shear = spring.force(drift) - weights * above / YIELDING[index].4 * drift;
            net[index] -= shear;
            if index > 0 {
                net[index - 1] += shear;
            }
        }
        let mut acceleration = [0.0; 3];
        for index in 0..3 {
            acceleration[index] = net[index] / YIELDING[index].0 - ground(time);
        }
        acceleration
    };
    let mut before = [0.0; 3];
    let first = pull(&before, 0.0);
    let mut now = first.map(|acceleration| 0.5 * step * step * acceleration);
    let mut largest: f64 = 0.0;
    let mut time = 0.0;
    for found in &found {
        for (found, wanted) in found.iter().zip(&now) {
            largest = largest.max(wanted.abs());
            assert!((found - wanted).abs() < 1e-9 * largest.max(1e-3), "{time}");
        }
        time += step;
        let acceleration = pull(&now, time);
        let mut next = [0.0; 3];
        for index in 0..3 {
            next[index] = 2.0 * now[index] - before[index] + step * step * acceleration[index];
        }
        (before, now) = (now, next);
    }
    assert!(largest > 0.03, "{largest}: beyond yield");
}

/// All integrators follow a yielding frame with a negative tangent to the same end.
#[test]
fn integrators_agree_on_a_yielding_frame_with_weights() {
    let storeys = yielding(4.0);
    let ground = |time: f64| 2.0 * (8.0 * time).sin() * (1.0 - time / 3.0).max(0.0);
    let peaks = INTEGRATORS.map(|integrator| {
        let frame = properties(storeys.clone(), &Damping::rayleigh(0.02));
        let (mut peak, zero): (f64, _) = (0.0, [0.0; 3]);
        let mut last = None;
        shaken(
            &storeys,
            &input(&frame, integrator, 0.0005, &zero),
            6000,
            ground,
            |state| {
                peak = peak.max(state.displacement[2].abs());
                last = Some(state.energies);
                false
            },
        );
        let e = last.expect("steps");
        let input = e.input + e.gravity;
        assert!(e.gravity > 0.0 && (e.error / input).abs() < 1e-3, "{e:?}");
        peak
    });
    for peak in peaks {
        assert!((peak / peaks[1] - 1.0).abs() < 2e-3, "{peaks:?}");
    }
}

/// A bilinear storey under a constant ground acceleration −a yields at the time of the elastic closed form, and then runs away: with
/// κ² = (P/h − r K)/m the drift is x_y cosh(κt) + … until 0.3 m.
#[test]
fn the_time_of_collapse_is_the_closed_form() {
    let (mass, stiffness, yield_force) = (1000.0_f64, 4e5, 4000.0);
    let (load, height, push) = (9.81e4, 3.0, 5.0);
    let storeys = [storey(mass, bilinear(stiffness, yield_force), load, height)];
    let g = load / height;
    // Elastic: m ẍ = m a − (K − g) x, from rest, to x_y = F_y/K.
    let omega = ((stiffness - g) / mass).sqrt();
    let still = push / (omega * omega);
    let yields = yield_force / stiffness;
    let angle = (1.0 - yields / still).acos();
    let velocity = still * omega * angle.sin();
    // Then m ẍ = m a − F_y(1 − r) − (r K − g) x.
    let kappa2 = (g - 0.02 * stiffness) / mass;
    let kappa = kappa2.sqrt();
    let rest = -(push - 0.98 * yield_force / mass) / kappa2;
    let at = |time: f64| {
        rest + (yields - rest) * (kappa * time).cosh() + velocity / kappa * (kappa * time).sinh()
    };
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if at(middle) < 0.3 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let exact = angle / omega + low;
    for integrator in INTEGRATORS {
        let frame = properties(storeys.to_vec(), &Damping::None);
        let (mut collapse, zero) = (0.0, [0.0]);
        shaken(
            &storeys,
            &input(&frame, integrator, 0.001, &zero),
            10_000,
            |_| -push,
            |state| {
                collapse = state.time;
                state.displacement[0] >= 0.3
            },
        );
        assert!(
            (collapse - exact).abs() < 0.005,
            "{integrator:?}: {collapse} s, exact {exact} s"
        );
    }
}

/// Growth per step of the linear frame, by the power method on its state.
fn growth(frame: &FrameMatrices, given: &FrameInput, stiffness: &[f64]) -> f64 {
    let matrix = storey_stiffness(stiffness);
    let start = [0.001, -0.002];
    let mut force = vec![0.0; 2];
    matrix.mul_into(&start, &mut force);
    let first = force.clone();
    let zero = [0.0; 2];
    let input = FrameInput {
        matrices: frame,
        initial_displacement: &start,
        initial_restoring_force: &first,
        initial_load: &zero,
        ..*given
    };
    let mut solver = FrameSolver::new(&input).expect("a frame");
    let mut largest = [0.0_f64; 2];
    for step in 0..4000 {
        let target = solver.predict(&zero).to_vec();
        matrix.mul_into(&target, &mut force);
        let state = solver.complete(&target, &force);
        let half = &mut largest[usize::from(step >= 2000)];
        *half = state
            .displacement
            .iter()
            .fold(*half, |most, x| most.max(x.abs()));
    }
    largest[1] / largest[0]
}

/// The recursion is bounded just below the longest stable step, and grows just above it; the limit is longer than without weights.
#[test]
fn the_longest_stable_step_includes_the_weights() {
    let cases = [
        (Integrator::Explicit, 1.0),
        (Integrator::AlphaOs { alpha: 0.0 }, 0.5),
    ];
    for (integrator, stated) in cases {
        let of = |weight: f64| {
            let storey = |mass, stiffness: f64, weight, height| Storey {
                stiffness: stated * stiffness,
                height: Some(height),
                gravity: weight,
                part: Part::TESTED,
                ..Storey::new(mass, stiffness, elastic(stiffness))
            };
            Frame::of_storeys(vec![
                storey(2000.0, 6e5, weight, 4.0),
                storey(1500.0, 6e5, weight, 3.0),
            ])
        };
        let limit = |frame: &Frame| {
            let properties = FrameProperties::of(frame, &Damping::None).expect("it stands");
            properties.longest_stable_step(integrator, Some(frame))
        };
        let (light, heavy) = (of(0.0), of(4e5));
        let longest = limit(&heavy);
        assert!(longest >= limit(&light), "{integrator:?}");
        let properties = FrameProperties::of(&heavy, &Damping::None).expect("it stands");
        let zero = [0.0; 2];
        let near = |factor: f64| {
            let input = input(&properties, integrator, factor * longest, &zero);
            growth(&properties.matrices, &input, &[6e5, 6e5])
        };
        assert!(near(0.999) < 1.01, "{integrator:?}: {}", near(0.999));
        assert!(near(1.002) > 2.0, "{integrator:?}: {}", near(1.002));
    }
}
