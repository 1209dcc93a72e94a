//! A frame integrated again on the way that a run recorded, with an input moved a little: on moving ground, or struck on one
//! floor. In: the frame and its load, the way, how it is distorted. Out: what the run comes to, told between the ends of
//! steps, so that it follows the inputs smoothly. It moves no rig and knows no uncertainty.

use super::contact::{ContactLaw, StepState};
use super::extremes::{Extremes, Peak};
use super::frame::impact::{FrameImpactError, FrameImpactInput, FrameImpactSolver, StrikerState};
use super::frame::{FrameError, FrameInput, FrameMatrices, FrameSolver, FrameState, Tangents, drifts, shears};
use super::frame_path::{FrameAgain, FrameDistortion, FramePath};
use super::impact::{ImpactInput, ImpactState};
use super::rerun::{Outcome, Telling};
use crate::plan::{Integrator, Until};

/// How a frame is integrated.
#[derive(Clone, Debug)]
pub struct FrameRun {
    pub matrices: FrameMatrices,
    pub integrator: Integrator,
    pub i_modification: bool,
    pub tangents: Tangents,
    /// s
    pub time_step: f64,
    /// At most.
    pub steps: u64,
    /// N and m, as the run took them.
    pub force_noise: f64,
    pub resolution: f64,
    /// Whether the floors passed their targets without a stop.
    pub gliding: bool,
}

/// A striker on one floor.
#[derive(Clone, Copy, Debug)]
pub struct Blow {
    /// From 0.
    pub struck: usize,
    pub law: ContactLaw,
    pub until: Until,
    /// The struck floor and the striker as an impact on one degree of freedom has them.
    pub body: ImpactInput,
}

/// What the floors come to, SI; an entry a floor or a storey.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Floors {
    pub max_displacement: Vec<f64>,
    pub max_drift: Vec<f64>,
    /// At the end.
    pub final_drift: Vec<f64>,
    pub max_base_shear: f64,
}

/// What a run comes to: as the run itself tells it, at the ends of steps, and as it is between them.
#[derive(Clone, Debug, PartialEq)]
pub struct FloorsOutcome {
    pub ends: Floors,
    pub between: Floors,
    /// Whether the record tells the way to it.
    pub seen: bool,
    /// With which velocities the floors of a run without stops were foretold to pass their targets, m/s: told where the way that it
    /// was taken along does not know them.
    pub velocities: Vec<Vec<f64>>,
}

/// What a blow on one floor comes to.
#[derive(Clone, Debug, PartialEq)]
pub struct BlowOutcome {
    pub blow: Outcome,
    pub floors: FloorsOutcome,
    /// ∫ shear d(drift) of each storey, J.
    pub storey_energy: Vec<f64>,
    /// Steps in contact from the first touch on.
    pub first_blow: u64,
    /// Of the striker at the end, m/s.
    pub striker_velocity: f64,
}

/// The struck floor with the striker, as the end of a step of one degree of freedom; energies are those of the whole frame.
/// Where no storeys are followed, its tangent is `stiffness` (N/m).
#[must_use]
pub fn of_floor(frame: &FrameState, striker: &StrikerState, struck: usize, stiffness: f64) -> ImpactState {
    ImpactState {
        step: frame.step,
        time: frame.time,
        displacement: frame.displacement[struck],
        target: frame.target[struck],
        measured_displacement: frame.measured_displacement[struck],
        velocity: frame.velocity[struck],
        acceleration: frame.acceleration[struck],
        restoring_force: frame.restoring_force[struck],
        force_at_computed: frame.force_at_computed[struck],
        contact_force: striker.contact_force,
        striker_displacement: striker.displacement,
        striker_velocity: striker.velocity,
        tangent_stiffness: frame.storey_stiffness.get(struck).copied().unwrap_or(stiffness),
        indentation: striker.indentation,
        state: striker.state,
        energies: striker.energies,
        input: striker.input,
        contacts: striker.contacts,
    }
}

impl FrameRun {
    fn input<'a>(&'a self, again: &'a FrameAgain, load: &'a [f64]) -> FrameInput<'a> {
        FrameInput {
            matrices: &self.matrices,
            operator_stiffness: &self.matrices.stiffness,
            integrator: self.integrator,
            i_modification: self.i_modification,
            tangents: self.tangents,
            time_step: self.time_step,
            initial_displacement: again.start(),
            initial_restoring_force: again.force(),
            initial_load: load,
            force_noise: self.force_noise,
            resolution: self.resolution,
        }
    }

    /// Takes a shake again, the ground's accelerations (m/s²) at the ends of steps from 0 on.
    ///
    /// # Errors
    /// The frame, with what was moved, cannot be stepped.
    pub fn shaken(&self, ground: &[f64], path: &FramePath, distortion: &FrameDistortion) -> Result<FloorsOutcome, FrameError> {
        let mut again = path.again(distortion);
        let mut load = vec![0.0; self.matrices.order()];
        let at = |step: usize| ground.get(step).copied().unwrap_or(0.0);
        self.matrices.ground_load(at(0), &mut load);
        let mut solver = FrameSolver::new(&self.input(&again, &load))?;
        let mut told = Peaks::new(self.matrices.order(), self.time_step);
        told.take(solver.state(), 1.0);
        let mut passing = Passing::new(self, path);
        for step in (1..).take(usize::try_from(self.steps).unwrap_or(usize::MAX)) {
            self.matrices.ground_load(at(step), &mut load);
            solver.predict(&load);
            let velocities = passing.foretold(&mut |to| solver.predicted_velocity(to));
            again.move_to(solver.predict(&load), velocities);
            told.take(solver.complete(again.displacement(), again.force()), 1.0);
        }
        Ok(told.finish(&again, passing))
    }

    /// Takes a blow on one floor again.
    ///
    /// # Errors
    /// As [`Self::shaken`].
    pub fn struck(&self, blow: &Blow, path: &FramePath, distortion: &FrameDistortion) -> Result<BlowOutcome, FrameImpactError> {
        let mut again = path.again(distortion);
        let order = self.matrices.order();
        let unloaded = vec![0.0; order];
        let Blow { struck, law, until, body } = *blow;
        let mut solver = FrameImpactSolver::new(&FrameImpactInput {
            frame: self.input(&again, &unloaded),
            struck,
            striker_mass: body.striker_mass,
            striker_velocity: body.striker_velocity,
            gap: body.gap,
            gravity: body.gravity,
            law,
        })?;
        let floor = |solver: &FrameImpactSolver| of_floor(solver.frame(), solver.striker(), struck, body.stiffness);
        let mut before = floor(&solver);
        before.measured_displacement = again.displacement()[struck];
        let mut told = Telling::new(&body, until, &before);
        let mut peaks = Peaks::new(order, self.time_step);
        peaks.take(solver.frame(), 1.0);
        let mut passing = Passing::new(self, path);
        let mut energy = StoreyWork::new(solver.frame());
        let (mut first_blow, mut first_is_over) = (0, false);
        for _ in 0..self.steps {
            solver.predict(&unloaded);
            let velocities = passing.foretold(&mut |to| {
                solver.predicted_velocity(to);
            });
            again.move_to(solver.predict(&unloaded), velocities);
            solver.complete(again.displacement(), again.force());
            let (now, over) = (floor(&solver), solver.over(until));
            told.take(&before, &now, over);
            peaks.take(solver.frame(), told.share());
            energy.take(solver.frame(), told.share());
            match now.state {
                StepState::Free => first_is_over |= first_blow > 0,
                _ if !first_is_over => first_blow += 1,
                _ => {}
            }
            before = now;
            if over {
                break;
            }
        }
        Ok(BlowOutcome {
            blow: told.finish(),
            floors: peaks.finish(&again, passing),
            storey_energy: energy.storeys,
            first_blow,
            striker_velocity: before.striker_velocity,
        })
    }
}

/// How fast the floors of a run without stops pass their targets, m/s.
struct Passing {
    /// At the end of the step under way; of a run that stops, nothing.
    now: Vec<f64>,
    gathers: bool,
    gathered: Vec<Vec<f64>>,
}

impl Passing {
    /// From rest.
    fn new(run: &FrameRun, path: &FramePath) -> Self {
        let now = vec![0.0; if run.gliding { run.matrices.order() } else { 0 }];
        let gathers = run.gliding && !path.knows_velocities();
        Self { gathered: if gathers { vec![now.clone()] } else { Vec::new() }, gathers, now }
    }

    fn foretold(&mut self, tell: &mut dyn FnMut(&mut [f64])) -> &[f64] {
        if !self.now.is_empty() {
            tell(&mut self.now);
        }
        if self.gathers {
            self.gathered.push(self.now.clone());
        }
        &self.now
    }
}

/// Peaks of all floors and storeys, step by step.
struct Peaks {
    ends: Floors,
    displacement: Extremes,
    drift: Extremes,
    base_shear: Peak,
    time_step: f64,
    velocity: Vec<f64>,
    /// Drift and its velocity at the end of the last step.
    last: Vec<(f64, f64)>,
    /// Inside the last step, where the run ends.
    final_inside: Vec<f64>,
}

impl Peaks {
    fn new(floors: usize, time_step: f64) -> Self {
        let nothing = || vec![0.0; floors];
        let ends = Floors { max_displacement: nothing(), max_drift: nothing(), final_drift: nothing(), max_base_shear: 0.0 };
        Self {
            ends,
            displacement: Extremes::new(floors, time_step),
            drift: Extremes::new(floors, time_step),
            base_shear: Peak::default(),
            time_step,
            velocity: nothing(),
            last: vec![(0.0, 0.0); floors],
            final_inside: nothing(),
        }
    }

    /// Takes the end of a step, of which the run counts this share.
    fn take(&mut self, state: &FrameState, share: f64) {
        drifts(&state.displacement, &mut self.ends.final_drift);
        drifts(&state.velocity, &mut self.velocity);
        let widen = |largest: &mut [f64], values: &[f64]| {
            for (largest, value) in largest.iter_mut().zip(values) {
                *largest = largest.max(value.abs());
            }
        };
        widen(&mut self.ends.max_displacement, &state.displacement);
        widen(&mut self.ends.max_drift, &self.ends.final_drift);
        let shear = state.restoring_force.iter().sum::<f64>();
        self.ends.max_base_shear = self.ends.max_base_shear.max(shear.abs());
        self.displacement.take(state.displacement.iter().copied().zip(state.velocity.iter().copied()));
        let drift = || self.ends.final_drift.iter().copied().zip(self.velocity.iter().copied());
        self.drift.take(drift());
        for (storey, now) in drift().enumerate() {
            let (before, speed) = self.last[storey];
            let mean = speed + 0.5 * share * (now.1 - speed);
            self.final_inside[storey] = if share < 1.0 { before + share * self.time_step * mean } else { now.0 };
            self.last[storey] = now;
        }
        self.base_shear.take(shear);
    }

    fn finish(self, again: &FrameAgain, passing: Passing) -> FloorsOutcome {
        let between = Floors {
            max_displacement: self.displacement.largest().to_vec(),
            max_drift: self.drift.largest().to_vec(),
            final_drift: self.final_inside,
            max_base_shear: self.base_shear.largest(),
        };
        let seen = again.is_seen(&between.max_drift);
        FloorsOutcome { ends: self.ends, between, seen, velocities: passing.gathered }
    }
}

/// ∫ shear d(drift) of each storey by the trapezoid, J.
struct StoreyWork {
    drift: Vec<f64>,
    shear: Vec<f64>,
    storeys: Vec<f64>,
}

impl StoreyWork {
    fn new(start: &FrameState) -> Self {
        let nothing = || vec![0.0; start.displacement.len()];
        let mut work = Self { drift: nothing(), shear: nothing(), storeys: nothing() };
        drifts(&start.displacement, &mut work.drift);
        shears(&start.force_at_computed, &mut work.shear);
        work
    }

    /// Takes the end of a step, of which the run counts this share.
    fn take(&mut self, state: &FrameState, share: f64) {
        let (mut drift, mut shear) = (vec![0.0; self.drift.len()], vec![0.0; self.shear.len()]);
        drifts(&state.displacement, &mut drift);
        shears(&state.force_at_computed, &mut shear);
        for storey in 0..drift.len() {
            let moved = drift[storey] - self.drift[storey];
            self.storeys[storey] += share * 0.5 * (self.shear[storey] + shear[storey]) * moved;
        }
        (self.drift, self.shear) = (drift, shear);
    }
}
