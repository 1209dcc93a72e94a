//! Frames on ground that moves. A harmonic motion is compared with its exact solution. An elastic–plastic building under a record is
//! compared with exact arcs between yielding and unloading.

use psd_physics::integrator::input::FrameInput;
use psd_physics::integrator::solver::FrameSolver;
use psd_physics::integrator::tangents::Tangents;
use psd_physics::specimen::{Bilinear, BilinearCurve, RestoringForce};
use psd_physics::structure::{
    Damping, FrameMatrices, SymmetricBand, damping_matrix, drifts, floor_forces, modes,
    storey_stiffness,
};
use psd_plan::Integrator;

use super::support::{at, run_linear, uniform, uniform_frequency, uniform_shape};

const RATIO: f64 = 0.05;
const SHAKEN_AT: f64 = 14.0;

fn shaken_frame(storeys: usize) -> FrameMatrices {
    let mut frame = uniform(storeys, 1500.0, 2e6);
    let found = modes(&frame.mass, &frame.stiffness).expect("modes");
    let damping = Damping::Modal(vec![RATIO; storeys]);
    frame.damping =
        damping_matrix(&damping, &frame.mass, &frame.stiffness, &found).expect("ratios of modes");
    frame
}

/// Displacements of the floors at `time` under `ü_g` = 2 sin Ωt, long after its start: Σ φ Γ · −2 Im(e^{iΩt} H(Ω)).
fn steady(storeys: usize, time: f64) -> Vec<f64> {
    let mut sum = vec![0.0; storeys];
    for mode in 1..=storeys {
        let (shape, omega) = (
            uniform_shape(storeys, mode),
            uniform_frequency(storeys, mode, 1500.0, 2e6),
        );
        let share =
            shape.iter().sum::<f64>() / shape.iter().map(|entry| entry * entry).sum::<f64>();
        let (real, imaginary) = (
            omega * omega - SHAKEN_AT * SHAKEN_AT,
            2.0 * RATIO * omega * SHAKEN_AT,
        );
        let size = real * real + imaginary * imaginary;
        let (sine, cosine) = (SHAKEN_AT * time).sin_cos();
        let answer = -2.0 * share * (real * sine - imaginary * cosine) / size;
        for (sum, entry) in sum.iter_mut().zip(&shape) {
            *sum += answer * entry;
        }
    }
    sum
}

/// After `end` the effect of the start is below 1e-7: for 20 storeys the first mode decays slowest.
#[test]
fn a_harmonic_ground_motion_ends_in_the_exact_steady_state() {
    for (storeys, end, steps) in [(2, 60.0, 12_000), (5, 60.0, 12_000), (20, 130.0, 72_000)] {
        let (frame, rest) = (shaken_frame(storeys), vec![0.0; storeys]);
        for integrator in [
            Integrator::Tangent,
            Integrator::Explicit,
            Integrator::AlphaOs { alpha: -0.1 },
        ] {
            let found = |steps: u32| {
                let input = at(&frame, integrator, end / f64::from(steps), &rest);
                let shaken = |time: f64, load: &mut [f64]| {
                    frame.ground_load(2.0 * (SHAKEN_AT * time).sin(), load);
                };
                run_linear(&input, &rest, steps, shaken, |_| ()).displacement
            };
            let (coarse, fine, exact) = (found(steps), found(2 * steps), steady(storeys, end));
            let largest = exact.iter().copied().map(f64::abs).fold(0.0, f64::max);
            for floor in 0..storeys {
                let (coarse, fine) = (coarse[floor] - exact[floor], fine[floor] - exact[floor]);
                let case =
                    format!("{storeys} storeys, {integrator:?}: {coarse}, {fine} of {largest} m");
                assert!((fine - coarse / 4.0).abs() < 1e-6 * largest, "{case}");
                assert!(fine.abs() < 1e-3 * largest, "{case}");
            }
        }
    }
}

const MASSES: [f64; 2] = [2000.0, 1500.0];
const STIFFNESSES: [f64; 2] = [3e6, 2e6];
const YIELDS: [f64; 2] = [12e3, 8e3];
const POST_YIELD_RATIO: [f64; 2] = [0.05, 0.1];
/// Between samples of the record \[s\].
const SAMPLE: f64 = 0.02;
const SAMPLES: u32 = 300;

/// \[m/s²\] at sample `index`: a few sines under an envelope.
fn sample(index: u32) -> f64 {
    let time = f64::from(index) * SAMPLE;
    let envelope = (time / 1.5).min(1.0) * (-(time - 1.5).max(0.0) / 2.5).exp();
    envelope
        * (4.0 * (6.3 * time).sin()
            + 3.0 * (14.9 * time + 1.0).sin()
            + 2.0 * (31.0 * time + 2.0).sin())
}

fn ground(time: f64) -> f64 {
    let sample_time = (time / SAMPLE).clamp(0.0, f64::from(SAMPLES));
    let before = sample_time.floor();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "within the record"
    )]
    let index = before as u32;
    sample(index) + (sample_time - before) * (sample(index + 1) - sample(index))
}

fn yielding_frame() -> FrameMatrices {
    let (mass, stiffness) = (
        SymmetricBand::diagonal(&MASSES),
        storey_stiffness(&STIFFNESSES),
    );
    let found = modes(&mass, &stiffness).expect("modes");
    let damping = damping_matrix(&Damping::rayleigh(0.02), &mass, &stiffness, &found)
        .expect("ratios of modes");
    FrameMatrices {
        mass,
        damping,
        stiffness,
        gravity: None,
    }
}

/// The exact motion. While no storey changes its branch, the frame is linear and the load a straight line. The state [x, v, 1, t] then
/// follows from the exponential of a constant matrix, summed as a series.
struct Exact {
    damping: [[f64; 2]; 2],
    state: [f64; 6],
    /// A storey is on its elastic branch through (drift, shear), or on the yield line above (+1) or below (−1).
    branches: [Branch; 2],
}

#[derive(Clone, Copy)]
enum Branch {
    Elastic { drift: f64, shear: f64 },
    Yielding(f64),
}

impl Branch {
    /// Shear = slope · drift + constant.
    fn line(self, storey: usize) -> (f64, f64) {
        match self {
            Self::Elastic { drift, shear } => {
                (STIFFNESSES[storey], shear - STIFFNESSES[storey] * drift)
            }
            Self::Yielding(side) => (
                POST_YIELD_RATIO[storey] * STIFFNESSES[storey],
                side * (1.0 - POST_YIELD_RATIO[storey]) * YIELDS[storey],
            ),
        }
    }
}

fn drift(state: &[f64; 6], storey: usize) -> f64 {
    if storey == 0 {
        state[0]
    } else {
        state[1] - state[0]
    }
}

fn drift_rate(state: &[f64; 6], storey: usize) -> f64 {
    if storey == 0 {
        state[2]
    } else {
        state[3] - state[2]
    }
}

impl Exact {
    /// d/dt of the state under ground acceleration a + b t.
    fn rate(&self, state: &[f64; 6], (a, b): (f64, f64)) -> [f64; 6] {
        let lines = [self.branches[0].line(0), self.branches[1].line(1)];
        let shear = [0, 1]
            .map(|storey| lines[storey].0 * drift(state, storey) + lines[storey].1 * state[4]);
        let force = [shear[0] - shear[1], shear[1]];
        let push = a * state[4] + b * state[5];
        let acceleration = [0, 1].map(|i| {
            let damped = self.damping[i][0] * state[2] + self.damping[i][1] * state[3];
            -push - (force[i] + damped) / MASSES[i]
        });
        [
            state[2],
            state[3],
            acceleration[0],
            acceleration[1],
            0.0,
            state[4],
        ]
    }

    fn after(&self, duration: f64, load: (f64, f64)) -> [f64; 6] {
        let (mut sum, mut term) = (self.state, self.state);
        for power in 1..40 {
            term = self
                .rate(&term, load)
                .map(|entry| entry * duration / f64::from(power));
            sum = std::array::from_fn(|i| sum[i] + term[i]);
        }
        sum
    }

    /// The storeys that have left their branch.
    fn left(&self, state: &[f64; 6]) -> [bool; 2] {
        [0, 1].map(|storey| match self.branches[storey] {
            Branch::Elastic { .. } => {
                let (slope, constant) = self.branches[storey].line(storey);
                let middle = POST_YIELD_RATIO[storey] * STIFFNESSES[storey] * drift(state, storey);
                let shear = slope * drift(state, storey) + constant;
                (shear - middle).abs()
                    > (1.0 - POST_YIELD_RATIO[storey]) * YIELDS[storey] * (1.0 + 1e-13)
            }
            Branch::Yielding(side) => side * drift_rate(state, storey) < 0.0,
        })
    }

    /// Continues through `duration` within one sample of the record, from event to event.
    fn advance(&mut self, duration: f64, load: (f64, f64)) {
        let mut left = duration;
        while left > 0.0 {
            let end = self.after(left, load);
            if self.left(&end) == [false; 2] {
                self.state = end;
                return;
            }
            let (mut low, mut high) = (0.0, left);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if self.left(&self.after(middle, load)) == [false; 2] {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            self.state = self.after(high, load);
            for (storey, gone) in self.left(&self.state).into_iter().enumerate() {
                if gone {
                    let (drift, rate) =
                        (drift(&self.state, storey), drift_rate(&self.state, storey));
                    let (slope, constant) = self.branches[storey].line(storey);
                    self.branches[storey] = match self.branches[storey] {
                        Branch::Elastic { .. } => Branch::Yielding(rate.signum()),
                        Branch::Yielding(_) => Branch::Elastic {
                            drift,
                            shear: slope * drift + constant,
                        },
                    };
                }
            }
            left -= high;
        }
    }

    /// Displacements at the end of every sample.
    fn run() -> Vec<[f64; 2]> {
        let frame = yielding_frame();
        let damping = [0, 1].map(|i| [0, 1].map(|j| frame.damping.entry(i, j)));
        let rest = Branch::Elastic {
            drift: 0.0,
            shear: 0.0,
        };
        let mut exact = Self {
            damping,
            state: [0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
            branches: [rest; 2],
        };
        // Branches are checked four times a millisecond: no event begins and ends between two checks.
        let looks = 80;
        (0..SAMPLES)
            .map(|index| {
                exact.state[5] = 0.0;
                let load = (sample(index), (sample(index + 1) - sample(index)) / SAMPLE);
                for _ in 0..looks {
                    exact.advance(SAMPLE / f64::from(looks), load);
                }
                [exact.state[0], exact.state[1]]
            })
            .collect()
    }
}

/// Largest difference from the exact motion over all floors and samples \[m\], for this number of steps per sample.
fn worst(integrator: Integrator, tangents: Tangents, steps: u32, exact: &[[f64; 2]]) -> f64 {
    let frame = yielding_frame();
    let time_step = SAMPLE / f64::from(steps);
    let mut load = [0.0; 2];
    frame.ground_load(ground(0.0), &mut load);
    let input = FrameInput {
        tangents,
        initial_load: &load.clone(),
        ..at(&frame, integrator, time_step, &[0.0; 2])
    };
    let mut solver = FrameSolver::new(&input).expect("a frame");
    let mut storeys = [0, 1].map(|i| {
        Bilinear::new(BilinearCurve {
            stiffness: STIFFNESSES[i],
            yield_force: YIELDS[i],
            post_yield_ratio: POST_YIELD_RATIO[i],
        })
    });
    let (mut drift, mut force, mut shear) = ([0.0; 2], [0.0; 2], [0.0; 2]);
    let mut largest = 0.0_f64;
    for step in 1..=SAMPLES * steps {
        frame.ground_load(ground(f64::from(step) * time_step), &mut load);
        let target = solver.predict(&load).to_vec();
        drifts(&target, &mut drift);
        for i in 0..2 {
            shear[i] = storeys[i].move_to(drift[i]);
        }
        floor_forces(&shear, &mut force);
        let state = solver.complete(&target, &force);
        if step % steps == 0 {
            let expected = &exact[usize::try_from(step / steps - 1).expect("small")];
            for (found, expected) in state.displacement.iter().zip(expected) {
                largest = largest.max((found - expected).abs());
            }
        }
    }
    largest
}

#[test]
fn a_yielding_building_converges_to_the_exact_motion() {
    let exact = Exact::run();
    let peak = exact
        .iter()
        .flatten()
        .copied()
        .map(f64::abs)
        .fold(0.0, f64::max);
    for (integrator, tangents) in [
        (
            Integrator::Tangent,
            Tangents::Storeys { largest_ratio: 2.0 },
        ),
        (Integrator::Explicit, Tangents::Initial),
        (Integrator::AlphaOs { alpha: 0.0 }, Tangents::Initial),
        (Integrator::AlphaOs { alpha: -0.1 }, Tangents::Initial),
    ] {
        let (coarse, fine) = (
            worst(integrator, tangents, 4, &exact),
            worst(integrator, tangents, 128, &exact),
        );
        let order = (coarse / fine).log2() / 5.0;
        assert!(
            (order - 2.0).abs() < 0.1,
            "{integrator:?}: order {order}, from {coarse} to {fine} m"
        );
        assert!(fine < 2e-5 * peak, "{integrator:?}: {fine} of {peak} m");
    }
    // The tangent form predicts the force by K_t. With K0 on a yielding storey it has an error in every step and is of first order.
    let stale = [64, 128].map(|steps| worst(Integrator::Tangent, Tangents::Initial, steps, &exact));
    assert!(
        ((stale[0] / stale[1]).log2() - 1.0).abs() < 0.1,
        "{stale:?}"
    );
}
