//! A frame on a rig, step by step: targets out, readings in. In: matrices, an integrator, loads. Out: the motion and its
//! energy. It commands no rig: whoever does asks for the next targets and gives back what was measured there.

use thiserror::Error;

use super::FrameMatrices;
use super::band::SymmetricBand;
use super::energy::{End, FrameEnergies};
use super::factor::{BandFactor, NotPositiveDefinite};
use super::schemes::{Course, Decide, Moment, Pass, Schemes};
use super::storeys::storeys_of;
use super::tangents::{StoreyTangents, Tangents};
use crate::plan::Integrator;

/// All a run starts from; the frame is at rest.
#[derive(Clone, Copy, Debug)]
pub struct FrameInput<'a> {
    pub matrices: &'a FrameMatrices,
    /// `K_I` of α-OS and of the I-modification, N/m: the initial stiffness, or one above it.
    pub operator_stiffness: &'a SymmetricBand,
    pub integrator: Integrator,
    /// Whether the recursion takes r* = `r_m` − `K_I`(`d_m` − d̃) in place of the reading.
    pub i_modification: bool,
    /// Of the tangent form.
    pub tangents: Tangents,
    /// Δt, s
    pub time_step: f64,
    /// m
    pub initial_displacement: &'a [f64],
    /// Read once before the first step, N.
    pub initial_restoring_force: &'a [f64],
    /// F(0), N
    pub initial_load: &'a [f64],
    /// Standard deviation of a load cell, N.
    pub force_noise: f64,
    /// Of a displacement reading, m.
    pub resolution: f64,
}

/// Why a frame cannot be stepped.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FrameError {
    #[error("a frame has at least one degree of freedom")]
    Empty,
    #[error("{what} is of order {found}, not {expected}")]
    Order { what: &'static str, found: usize, expected: usize },
    #[error("the mass matrix is {0}")]
    Mass(NotPositiveDefinite),
    #[error("mass, damping and stiffness over a step are {0}")]
    Step(NotPositiveDefinite),
    #[error("storeys are followed by their own tangents only where the stiffness is that of a shear building")]
    NoStoreys,
    #[error("a step of {0} s is none")]
    TimeStep(f64),
}

/// The end of a step; step 0 is the start. One entry a degree of freedom.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameState {
    pub step: u64,
    /// s
    pub time: f64,
    /// Computed X, m.
    pub displacement: Vec<f64>,
    /// Imposed on the specimen, m: X itself, but under α-OS the place it was foretold at.
    pub target: Vec<f64>,
    /// m
    pub measured_displacement: Vec<f64>,
    /// m/s
    pub velocity: Vec<f64>,
    /// m/s²
    pub acceleration: Vec<f64>,
    /// Measured, N.
    pub restoring_force: Vec<f64>,
    /// What the recursion takes for the force at X, N: the reading, but for what the I-modification and α-OS correct.
    pub force_at_computed: Vec<f64>,
    /// F at the end of the step, N.
    pub load: Vec<f64>,
    /// `k_t` of each storey for the step to come, N/m; empty where no storeys are followed.
    pub storey_stiffness: Vec<f64>,
    pub energies: FrameEnergies,
}

/// The run on a rig: `predict`, command, read, `complete`.
#[derive(Clone, Debug)]
pub struct FrameSolver {
    schemes: Schemes,
    tangents: Option<StoreyTangents>,
    modification: Option<SymmetricBand>,
    state: FrameState,
    /// The step under way; it becomes the state.
    next: Course,
    load_end: Vec<f64>,
    predicted: bool,
    /// Under I-modification: the force the recursion takes, N, and how far the specimen is from the target, m.
    felt: Vec<f64>,
    away: Vec<f64>,
    /// What dampers took in a step that a law found its own way through, J.
    damping_work: Option<f64>,
}

impl FrameSolver {
    /// M Ẍ₀ = F₀ − R₀.
    ///
    /// # Errors
    /// If vectors and matrices are not of one order, or no acceleration follows from them.
    pub fn new(input: &FrameInput) -> Result<Self, FrameError> {
        let matrices = input.matrices;
        let order = matrices.order();
        check(input, order)?;
        let zero = || vec![0.0; order];
        let mut acceleration = zero();
        for ((to, load), force) in acceleration.iter_mut().zip(input.initial_load).zip(input.initial_restoring_force) {
            *to = load - force;
        }
        BandFactor::new(&matrices.mass).map_err(FrameError::Mass)?.solve_in_place(&mut acceleration);
        let (displacement, force) = (input.initial_displacement, input.initial_restoring_force);
        let tangents = match (input.integrator, input.tangents) {
            (Integrator::Tangent, Tangents::Storeys { largest_ratio }) => {
                let storeys = storeys_of(&matrices.stiffness).ok_or(FrameError::NoStoreys)?;
                let spread = (input.force_noise, input.resolution);
                Some(StoreyTangents::new(storeys, largest_ratio, spread, displacement, force))
            }
            _ => None,
        };
        let operator = if input.integrator == Integrator::Tangent { &matrices.stiffness } else { input.operator_stiffness };
        let schemes = Schemes::new(matrices, operator, input.integrator, input.time_step).map_err(FrameError::Step)?;
        Ok(Self {
            schemes,
            modification: input.i_modification.then(|| input.operator_stiffness.clone()),
            state: FrameState {
                step: 0,
                time: 0.0,
                displacement: displacement.to_vec(),
                target: displacement.to_vec(),
                measured_displacement: displacement.to_vec(),
                velocity: zero(),
                acceleration,
                restoring_force: force.to_vec(),
                force_at_computed: force.to_vec(),
                load: input.initial_load.to_vec(),
                storey_stiffness: tangents.as_ref().map(|followed| followed.stiffnesses().to_vec()).unwrap_or_default(),
                energies: FrameEnergies::default(),
            },
            tangents,
            next: Course { displacement: zero(), velocity: zero(), acceleration: zero(), force: zero() },
            load_end: zero(),
            predicted: false,
            felt: zero(),
            away: zero(),
            damping_work: None,
        })
    }

    /// A body may strike the degree of freedom `place`.
    pub(super) fn strike(&mut self, place: usize) -> Result<(), FrameError> {
        self.schemes.strike(place).map_err(FrameError::Mass)
    }

    /// Displacements to command in this step, m, under the loads at its end (N). Asked again before `complete`, they are
    /// the same whatever the loads.
    pub fn predict(&mut self, load_end: &[f64]) -> &[f64] {
        self.predict_with(load_end, &mut |_, _| 0.0)
    }

    /// Velocities that the step is foretold to end with, m/s: exact under `tangent`, with the acceleration kept under the
    /// others. The step is the one predicted last.
    pub fn predicted_velocity(&self, velocity: &mut [f64]) {
        if self.schemes.integrator == Integrator::Tangent {
            velocity.copy_from_slice(&self.next.velocity);
            return;
        }
        let kept = self.state.velocity.iter().zip(&self.state.acceleration);
        for (to, (now, acceleration)) in velocity.iter_mut().zip(kept) {
            *to = now + self.schemes.time_step * acceleration;
        }
    }

    /// x ← x + `force` M⁻¹e_s of the struck degree of freedom.
    pub(super) fn push(&self, force: f64, x: &mut [f64]) {
        self.schemes.push(force, x);
    }

    /// [`FrameSolver::predict`] with a body that may strike.
    pub(super) fn predict_with(&mut self, load_end: &[f64], decide: Decide) -> &[f64] {
        if !self.predicted {
            self.predicted = true;
            self.load_end.copy_from_slice(load_end);
            let from = self.state.moment();
            self.damping_work = None;
            if self.schemes.integrator == Integrator::Tangent {
                self.schemes.foretell(from, &self.load_end, &mut self.next, decide);
            } else {
                self.schemes.impose(from, &mut self.next);
            }
        }
        &self.next.displacement
    }

    /// The same in tangent form, with a law that finds its own way through the step and tells what dampers took on it, J.
    pub(super) fn predict_by(&mut self, load_end: &[f64], pass: Pass) -> &[f64] {
        if !self.predicted {
            self.predicted = true;
            self.load_end.copy_from_slice(load_end);
            self.damping_work = Some(pass(&self.schemes, self.state.moment(), &self.load_end, &mut self.next));
        }
        &self.next.displacement
    }

    /// Whether the contact of a step is decided on once its force is read.
    pub(super) fn decides_afterwards(&self) -> bool {
        self.schemes.integrator != Integrator::Tangent
    }

    /// Whether the step under way has its targets.
    pub(super) const fn is_predicted(&self) -> bool {
        self.predicted
    }

    /// Ends the step with what was measured at the targets. Without a prediction before it, under the loads of its start.
    pub fn complete(&mut self, measured_displacement: &[f64], restoring_force: &[f64]) -> &FrameState {
        self.complete_with(measured_displacement, restoring_force, &mut |_, _| 0.0)
    }

    pub(super) fn complete_with(
        &mut self,
        measured_displacement: &[f64],
        restoring_force: &[f64],
        decide: Decide,
    ) -> &FrameState {
        if !self.predicted {
            let load = self.state.load.clone();
            self.predict_with(&load, decide);
        }
        self.predicted = false;
        self.state.target.copy_from_slice(&self.next.displacement);
        let felt = if let Some(stiffness) = &self.modification {
            self.felt.copy_from_slice(restoring_force);
            let away = measured_displacement.iter().zip(&self.state.target);
            for (away, (measured, target)) in self.away.iter_mut().zip(away) {
                *away = measured - target;
            }
            stiffness.mul_add(-1.0, &self.away, &mut self.felt);
            &self.felt
        } else {
            restoring_force
        };
        if self.schemes.integrator == Integrator::Tangent {
            self.next.force.copy_from_slice(felt);
        } else {
            let (schemes, from) = (&mut self.schemes, self.state.moment());
            schemes.correct(from, &self.load_end, felt, &mut self.next, decide);
        }
        if let Some(tangents) = &mut self.tangents
            && tangents.take(measured_displacement, restoring_force)
        {
            // A storey's tangent is not negative, so that M̂ has a factor as M has; if rounding ever denied it, the last
            // one serves on.
            let _ = self.schemes.set_storeys(tangents.stiffnesses());
            self.state.storey_stiffness.copy_from_slice(tangents.stiffnesses());
        }
        self.accept(measured_displacement, restoring_force);
        &self.state
    }

    /// What the recursion took for the forces at the targets of the last step, where `read` was read, N.
    #[must_use]
    pub fn taken<'a>(&'a self, read: &'a [f64]) -> &'a [f64] {
        if self.modification.is_some() { &self.felt } else { read }
    }

    /// Contact force of the last step, N.
    pub(super) fn contact_force(&self) -> f64 {
        self.schemes.contact_force()
    }

    fn accept(&mut self, measured_displacement: &[f64], restoring_force: &[f64]) {
        let Self { schemes, state, next, load_end, damping_work, .. } = self;
        let time_step = schemes.time_step;
        let from = End {
            displacement: &state.displacement,
            velocity: &state.velocity,
            restoring_force: &state.force_at_computed,
            load: &state.load,
        };
        let to = End { displacement: &next.displacement, velocity: &next.velocity, restoring_force: &next.force, load: load_end };
        let (frame, first, second) = schemes.scratch();
        state.energies = state.energies.advance(frame, time_step, from, to, *damping_work, (first, second));
        std::mem::swap(&mut state.displacement, &mut next.displacement);
        std::mem::swap(&mut state.velocity, &mut next.velocity);
        std::mem::swap(&mut state.acceleration, &mut next.acceleration);
        std::mem::swap(&mut state.force_at_computed, &mut next.force);
        std::mem::swap(&mut state.load, load_end);
        state.measured_displacement.copy_from_slice(measured_displacement);
        state.restoring_force.copy_from_slice(restoring_force);
        state.step += 1;
        #[expect(clippy::cast_precision_loss, reason = "no run has 2^53 steps")]
        let time = state.step as f64 * time_step;
        state.time = time;
    }

    /// All floors at the end of the last step.
    #[must_use]
    pub const fn state(&self) -> &FrameState {
        &self.state
    }
}

impl FrameState {
    fn moment(&self) -> Moment<'_> {
        Moment {
            displacement: &self.displacement,
            velocity: &self.velocity,
            acceleration: &self.acceleration,
            force: &self.force_at_computed,
            load: &self.load,
        }
    }
}

fn check(input: &FrameInput, order: usize) -> Result<(), FrameError> {
    if order == 0 {
        return Err(FrameError::Empty);
    }
    if !(input.time_step > 0.0 && input.time_step.is_finite()) {
        return Err(FrameError::TimeStep(input.time_step));
    }
    let orders = [
        ("damping", input.matrices.damping.order()),
        ("stiffness", input.matrices.stiffness.order()),
        ("the operator's stiffness", input.operator_stiffness.order()),
        ("the initial displacement", input.initial_displacement.len()),
        ("the initial restoring force", input.initial_restoring_force.len()),
        ("the initial load", input.initial_load.len()),
    ];
    let other = orders.into_iter().find(|(_, found)| *found != order);
    other.map_or(Ok(()), |(what, found)| Err(FrameError::Order { what, found, expected: order }))
}
