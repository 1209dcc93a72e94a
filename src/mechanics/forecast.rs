//! What an actuator that falls short of its increments would do to a run: the energy error of its tracking, foretold by
//! integrating on a virtual specimen that is moved as far as such an actuator goes. In: what the run starts from, the share of
//! an increment that is missed. Out: the largest share of the input energy, and when a bound is passed. No rig, no noise.

use super::frame::{FrameInput, FrameSolver, drifts, floor_forces};
use super::impact::{ImpactInput, ImpactSolver};
use super::monitor::Monitor;
use super::specimen::{RestoringForce, SpecimenModel};
use crate::plan::{Behaviour, Frame, Until};

/// Steps that are looked at, at most: a check is to answer at once.
const MOST_STEPS: u64 = 20_000;

/// What is foretold of a run.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Foretold {
    /// Energy error of tracking over the input energy, the largest by size, signed: negative where it puts energy in.
    pub share: f64,
    /// Virtual time at which its size first passes the bound, s.
    pub passed: Option<f64>,
}

impl Foretold {
    fn note(&mut self, share: f64, bound: f64, time: f64) {
        if share.abs() > self.share.abs() {
            self.share = share;
        }
        if share.abs() > bound && self.passed.is_none() {
            self.passed = Some(time);
        }
    }
}

/// Of an impact on a specimen of this behaviour; an actuator misses `missed` of each increment, from where it stands.
#[must_use]
pub fn of_impact(input: &ImpactInput, behaviour: &Behaviour, (until, steps): (Until, u64), missed: f64, bound: f64) -> Foretold {
    let mut specimen = SpecimenModel::new(behaviour);
    let mut solver = ImpactSolver::new(input, 0.0, specimen.move_to(0.0));
    let mut monitor = Monitor::new(0.0, 0.0, 0.0);
    let (mut place, mut foretold) = (0.0, Foretold::default());
    for _ in 0..steps.min(MOST_STEPS) {
        let target = solver.predict();
        place = target - missed * (target - place);
        let force = specimen.move_to(place);
        let taken = solver.taken(place, force);
        let tracking = monitor.take_as(target, place, force, taken);
        let time = solver.complete(place, force).time;
        foretold.note(tracking.share_of(input.striker_energy()).unwrap_or(0.0), bound, time);
        if solver.over(until) || !place.is_finite() {
            break;
        }
    }
    foretold
}

/// The same of a frame whose ground has these accelerations (m/s²) at the ends of its steps; `ground_energy` (J) is what they can
/// put in before they have. None if the frame cannot be stepped.
#[must_use]
pub fn of_frame(
    input: &FrameInput,
    frame: &Frame,
    (ground, steps): (&dyn Fn(f64) -> f64, u64),
    ground_energy: f64,
    missed: f64,
    bound: f64,
) -> Option<Foretold> {
    let order = input.matrices.order();
    let zero = || vec![0.0; order];
    let mut solver = FrameSolver::new(input).ok()?;
    let mut storeys: Vec<SpecimenModel> = frame.storeys.iter().map(|storey| SpecimenModel::new(&storey.behaviour)).collect();
    let mut monitors = vec![Monitor::new(0.0, 0.0, 0.0); order];
    let (mut place, mut force, mut load, mut drift, mut shear) = (zero(), zero(), zero(), zero(), zero());
    let (mut largest, mut foretold) = (ground_energy, Foretold::default());
    for step in 1..=steps.min(MOST_STEPS) {
        #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
        let time = step as f64 * input.time_step;
        input.matrices.ground_load(ground(time), &mut load);
        let target = solver.predict(&load).to_vec();
        for (place, target) in place.iter_mut().zip(&target) {
            *place = target - missed * (target - *place);
        }
        if storeys.is_empty() {
            input.matrices.stiffness.mul_into(&place, &mut force);
        } else {
            drifts(&place, &mut drift);
            for ((shear, drift), storey) in shear.iter_mut().zip(&drift).zip(&mut storeys) {
                *shear = storey.move_to(*drift);
            }
            floor_forces(&shear, &mut force);
        }
        let energies = solver.complete(&place, &force).energies;
        largest = largest.max(energies.input.abs()).max(energies.kinetic);
        let axes = monitors.iter_mut().zip(target.iter().zip(&place)).zip(force.iter().zip(solver.taken(&force)));
        let error: f64 = axes
            .map(|((monitor, (target, place)), (force, taken))| monitor.take_as(*target, *place, *force, *taken).energy_error)
            .sum();
        if !error.is_finite() {
            break;
        }
        foretold.note(if largest > 0.0 { error / largest } else { 0.0 }, bound, time);
    }
    Some(foretold)
}
