//! The steps of a frame on a rig, whatever drives it: predict, command, settle, pause, read, feed back; or, continuous, the floors
//! follow smooth paths together (`gliding`) and are read as they pass their targets. In: who computes the steps and keeps them
//! ([`Stepped`]), how they are gone, the rig behind its guard. Out: every step done, judged and told, or why there are no more.
//! It knows no ground, no striker and no equation.

use std::fmt::Display;

use super::StepReport;
use super::axes::{Monitors, Told, report};
use super::followed::Followed;
use super::gliding::{Gliding, Passing};
use super::session::Session;
use super::stepping::FrameSteps;
use super::stiffer::StifferStoreys;
use super::stop::Stop;
use super::triggers::Triggers;
use crate::mechanics::frame::{FrameInput, FrameState};
use crate::mechanics::monitor::Tracking;
use crate::plan::{Mode, Stepping};
use crate::quantity::Dimension;
use crate::rig::{DeclaredNoise, Reading};

/// What is known when the first step begins.
pub(super) struct Start {
    /// Where the actuators were sent to, m: X starts there.
    pub commanded: Vec<f64>,
    /// What was read there, once: R₀ is in it.
    pub reading: Reading,
    pub noise: DeclaredNoise,
}

impl Start {
    /// What a frame is stepped from, with these loads on its floors (N).
    pub(super) fn input<'a>(&'a self, frame: &'a FrameSteps, plan: &Stepping, load: &'a [f64]) -> FrameInput<'a> {
        let matrices = &frame.properties.matrices;
        FrameInput {
            matrices,
            operator_stiffness: &matrices.stiffness,
            integrator: plan.integrator,
            i_modification: plan.i_modification,
            tangents: frame.tangents,
            time_step: frame.time_step,
            initial_displacement: &self.commanded,
            initial_restoring_force: &self.reading.force,
            initial_load: load,
            force_noise: self.noise.force,
            resolution: self.noise.resolution,
        }
    }
}

/// Why a frame that cannot be stepped by `time_step` (s) is not.
pub(super) fn not_stepped(time_step: f64, error: &impl Display) -> Stop {
    let wanted = format!("one that can be stepped: {error}").into();
    Stop::BadInput { field: "time_step", value: time_step, dimension: Dimension::TIME, wanted }
}

/// The energy of a test at the end of a step, J.
pub(super) struct Balance {
    /// What the balance misses.
    pub error: f64,
    /// What the errors are shares of.
    pub input: f64,
}

/// Computes the steps of a frame, and keeps them.
pub(super) trait Stepped {
    /// The end of the last step.
    fn frame(&self) -> &FrameState;

    /// Where each floor is to be at the end of the next step, m. Asked again in the same step, the same again.
    fn predict(&mut self) -> &[f64];

    /// How fast each floor is foretold to be there, m/s; whether a blow has its share in it.
    fn predicted_velocity(&self, velocity: &mut [f64]) -> bool;

    /// What the recursion takes for the forces at the targets, of those read, N.
    fn taken<'a>(&'a self, read: &'a [f64]) -> &'a [f64];

    /// Ends the step with what was read.
    fn complete(&mut self, reading: &Reading);

    /// Whether a contact force acted in the last step.
    fn is_struck(&self) -> bool;

    /// Keeps the end of a step, with how each axis was followed so far.
    fn keep(&mut self, state: &FrameState, axes: &[Tracking], session: &Session<'_>) -> Balance;

    /// Steps of the procedure done before these.
    fn before(&self) -> u64 {
        0
    }

    /// Whether there is nothing more to follow, before all steps are done.
    fn over(&self) -> bool;
}

/// All steps, from where the rig stands.
pub(super) fn run<S: Stepped>(
    (frame, plan): (&FrameSteps, &Stepping),
    followed: &mut Followed,
    session: &mut Session<'_>,
    begin: impl FnOnce(&Start) -> Result<S, Stop>,
) -> Result<(), Stop> {
    let mut triggers = Triggers::new(&plan.inspect);
    let (commanded, reading) = (session.guard.commanded().to_vec(), session.guard.read()?);
    let start = Start { commanded, reading, noise: session.guard.declared_noise() };
    let mut stepped = begin(&start)?;
    let Start { commanded, reading, noise } = start;
    let operator = plan.i_modification.then_some(&frame.properties.matrices.stiffness);
    let mut monitors = Monitors::new(&commanded, &reading, operator);
    let mut stiffer = StifferStoreys::new(&frame.properties.matrices, plan, frame.time_step, noise, &reading);
    let mut gliding = match plan.mode {
        Mode::Continuous { time_scale } => Some(Gliding::from_rest(&commanded, time_scale, frame.time_step)),
        Mode::StepAndPause => None,
    };
    let mut at_rest = stepped.frame().clone();
    at_rest.measured_displacement.clone_from(&reading.displacement);
    stepped.keep(&at_rest, &vec![Tracking::default(); commanded.len()], session);
    let mut struck = false;
    for _ in 1..=frame.steps {
        let (reading, broken) = if let Some(gliding) = &mut gliding {
            gliding.step(|| foretold(&mut stepped), session)?
        } else {
            session.guard.move_to(stepped.predict(), None)?;
            session.guard.pause(frame.pause)?;
            session.read_kept()?
        };
        stepped.complete(&reading);
        if let Some(stop) = broken {
            let state = stepped.frame().clone();
            let axes = monitors.take(&state.target, &reading, stepped.taken(&reading.force));
            stepped.keep(&state, &axes, session);
            return Err(stop);
        }
        let (before, now) = (struck, stepped.is_struck());
        stiffer.take(&reading, before || now, session);
        struck = now;
        let state = stepped.frame().clone();
        let axes = monitors.take(&state.target, &reading, stepped.taken(&reading.force));
        let Balance { error, input } = stepped.keep(&state, &axes, session);
        let (tracking, tracking_energy_error) = followed.judge(&axes, input, session);
        let energy_error = if error == 0.0 { 0.0 } else { error / input };
        let told = Told { energy_error, tracking, tracking_energy_error };
        session.guard.check_energy_error(told.energy_error)?;
        session.guard.check_tracking(told.tracking_energy_error, told.tracking.nrms_error)?;
        let reported = report(&state, &told);
        session.step_done(StepReport { step: stepped.before() + reported.step, ..reported })?;
        if stepped.over() {
            break;
        }
        let base_shear = state.restoring_force.iter().sum();
        if let Some(reason) = triggers.after(state.step, state.time, base_shear) {
            session.inspect(&reason)?;
        }
    }
    gliding.map_or(Ok(()), |gliding| gliding.brake(session))
}

/// Where each floor is to pass in this step, and how fast.
fn foretold(stepped: &mut impl Stepped) -> Vec<Passing> {
    let places = stepped.predict().to_vec();
    let mut velocities = vec![0.0; places.len()];
    let struck = stepped.predicted_velocity(&mut velocities);
    places.into_iter().zip(velocities).map(|(place, velocity)| Passing { place, velocity, struck }).collect()
}
