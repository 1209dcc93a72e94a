//! What actuators that lag and fall short would do to a run: the energy error of their tracking, foretold by integrating on a virtual
//! specimen that is moved as far as such actuators go. In: what the run starts from, how they follow. Out: the largest share of the
//! input energy, when a bound is passed, how late they are. No rig, no noise.

use super::following::{Followers, Manner};
use super::frame::impact::{FrameImpactInput, FrameImpactSolver};
use super::frame::{FrameInput, FrameSolver, drifts, floor_forces};
use super::impact::{ImpactInput, ImpactSolver};
use super::monitor::{Monitor, Tracking};
use super::specimen::{RestoringForce, SpecimenModel};
use crate::plan::{Behaviour, Frame, Until};

/// Steps that are looked at, at most: a check is to answer at once.
pub const MOST_STEPS: u64 = 20_000;

/// What is foretold of a run.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Foretold {
    /// Energy error of tracking over the input energy, the largest by size, signed: negative where it puts energy in.
    pub share: f64,
    /// Virtual time at which its size first passes the bound, s.
    pub passed: Option<f64>,
    /// By which the actuators are late, s of virtual time.
    pub late: f64,
}

/// How far, and how closely, a run is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scope {
    pub manner: Manner,
    pub steps: u64,
    /// Share of the input energy at which a run is held.
    pub bound: f64,
}

/// Of an impact on a specimen of this behaviour.
#[must_use]
pub fn of_impact(input: &ImpactInput, behaviour: &Behaviour, until: Until, scope: &Scope) -> Foretold {
    let mut specimen = SpecimenModel::new(behaviour);
    let mut blow = Blow { solver: ImpactSolver::new(input, 0.0, specimen.move_to(0.0)), until };
    follow(&mut blow, &mut |place, force| force[0] = specimen.move_to(place[0]), (1, input.time_step), scope)
}

/// Of a frame whose ground has these accelerations (m/s²) at the ends of its steps; `ground_energy` (J) is what they can put in
/// before they have. None if the frame cannot be stepped.
#[must_use]
pub fn of_frame(
    input: &FrameInput,
    frame: &Frame,
    ground: &dyn Fn(f64) -> f64,
    ground_energy: f64,
    scope: &Scope,
) -> Option<Foretold> {
    let order = input.matrices.order();
    let load = vec![0.0; order];
    let mut shaken = Shaken { solver: FrameSolver::new(input).ok()?, input, ground, load, largest: ground_energy };
    Some(follow(&mut shaken, &mut storeys(frame, input), (order, input.time_step), scope))
}

/// Of an impact on one storey of a frame. None if the frame cannot be stepped.
#[must_use]
pub fn of_storey_impact(input: &FrameImpactInput, frame: &Frame, until: Until, scope: &Scope) -> Option<Foretold> {
    let order = input.frame.matrices.order();
    let mut struck = Struck { solver: FrameImpactSolver::new(input).ok()?, unloaded: vec![0.0; order], until };
    Some(follow(&mut struck, &mut storeys(frame, &input.frame), (order, input.frame.time_step), scope))
}

/// Places (m) in, forces (N) out.
type Springs<'a> = dyn FnMut(&[f64], &mut [f64]) + 'a;

/// What computes the steps.
trait Steps {
    /// Targets of the step of this number, m.
    fn predict(&mut self, step: u64) -> Vec<f64>;

    /// Ends it with places (m) and forces (N): the energy put in so far, J, and the forces that the recursion takes, N.
    fn complete(&mut self, place: &[f64], force: &[f64]) -> (f64, Vec<f64>);

    fn over(&self) -> bool;
}

fn follow(steps: &mut dyn Steps, springs: &mut Springs<'_>, (axes, time_step): (usize, f64), scope: &Scope) -> Foretold {
    let mut followers = Followers::new(scope.manner, axes);
    let mut monitors = vec![Monitor::new(0.0, 0.0, 0.0); axes];
    let (mut place, mut force) = (vec![0.0; axes], vec![0.0; axes]);
    let mut foretold = Foretold::default();
    for step in 1..=scope.steps.min(MOST_STEPS) {
        let target = steps.predict(step);
        followers.go(&target, &mut place);
        springs(&place, &mut force);
        let (energy, taken) = steps.complete(&place, &force);
        let axes = monitors.iter_mut().zip(target.iter().zip(&place)).zip(force.iter().zip(&taken));
        let all: Vec<Tracking> =
            axes.map(|((monitor, (target, place)), (force, taken))| monitor.take_as(*target, *place, *force, *taken)).collect();
        let share = Tracking::together(&all).share_of(energy).unwrap_or(0.0);
        if !share.is_finite() {
            break;
        }
        if share.abs() > foretold.share.abs() {
            foretold.share = share;
        }
        if share.abs() > scope.bound && foretold.passed.is_none() {
            #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
            let time = step as f64 * time_step;
            foretold.passed = Some(time);
        }
        if steps.over() {
            break;
        }
    }
    foretold.late = time_step * followers.delay();
    foretold
}

/// The storeys of a frame, or its matrix.
fn storeys<'a>(frame: &Frame, input: &'a FrameInput<'_>) -> impl FnMut(&[f64], &mut [f64]) + 'a {
    let mut storeys: Vec<SpecimenModel> = frame.storeys.iter().map(|storey| SpecimenModel::new(&storey.behaviour)).collect();
    let (mut drift, mut shear) = (vec![0.0; storeys.len()], vec![0.0; storeys.len()]);
    move |place, force| {
        if storeys.is_empty() {
            input.matrices.stiffness.mul_into(place, force);
            return;
        }
        drifts(place, &mut drift);
        for ((shear, drift), storey) in shear.iter_mut().zip(&drift).zip(&mut storeys) {
            *shear = storey.move_to(*drift);
        }
        floor_forces(&shear, force);
    }
}

struct Blow {
    solver: ImpactSolver,
    until: Until,
}

impl Steps for Blow {
    fn predict(&mut self, _: u64) -> Vec<f64> {
        vec![self.solver.predict()]
    }

    fn complete(&mut self, place: &[f64], force: &[f64]) -> (f64, Vec<f64>) {
        let taken = self.solver.taken(place[0], force[0]);
        let input = self.solver.complete(place[0], force[0]).input;
        (input, vec![taken])
    }

    fn over(&self) -> bool {
        self.solver.over(self.until)
    }
}

struct Shaken<'a> {
    solver: FrameSolver,
    input: &'a FrameInput<'a>,
    /// m/s², at a time in s.
    ground: &'a dyn Fn(f64) -> f64,
    load: Vec<f64>,
    /// J
    largest: f64,
}

impl Steps for Shaken<'_> {
    fn predict(&mut self, step: u64) -> Vec<f64> {
        #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
        let time = step as f64 * self.input.time_step;
        self.input.matrices.ground_load((self.ground)(time), &mut self.load);
        self.solver.predict(&self.load).to_vec()
    }

    fn complete(&mut self, place: &[f64], force: &[f64]) -> (f64, Vec<f64>) {
        let energies = self.solver.complete(place, force).energies;
        self.largest = self.largest.max(energies.input.abs()).max(energies.kinetic);
        (self.largest, self.solver.taken(force).to_vec())
    }

    fn over(&self) -> bool {
        false
    }
}

struct Struck {
    solver: FrameImpactSolver,
    unloaded: Vec<f64>,
    until: Until,
}

impl Steps for Struck {
    fn predict(&mut self, _: u64) -> Vec<f64> {
        self.solver.predict(&self.unloaded).to_vec()
    }

    fn complete(&mut self, place: &[f64], force: &[f64]) -> (f64, Vec<f64>) {
        self.solver.complete(place, force);
        (self.solver.striker().input, self.solver.taken(force).to_vec())
    }

    fn over(&self) -> bool {
        self.solver.over(self.until)
    }
}
