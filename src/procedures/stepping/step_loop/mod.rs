//! The steps of a structure on a rig, whatever excites it: predict, command, settle, pause, read, feed back. In continuous mode the
//! actuators follow smooth paths together (`continuous_motion`) and are read as they pass their targets. In: a [`Stepped`] that computes
//! and keeps the steps, the settings of the steps, the rig behind its guard. Out: every step completed, checked and reported, or the
//! reason of the end. It knows no ground, no striker and no equation.
//!
//! If an actuator was not at its target (lag, resolution), the reading is corrected to the target by the I-modification,
//! r* = `r_m` − `K_I`(`d_m` − d̃). The force of a damper of the specimen is in the reading, at the actuator's velocity:
//! c·v/`time_scale`.

pub(crate) mod continuous_motion;
pub(crate) mod triggers;

use super::axes::{AxesState, Errors, Monitors, report};
use super::operator_stability_watch::StifferSprings;
use super::run::Steps;
use super::start::Start;
use super::tracking::tracking_summary::Followed;
use crate::physics::tracking::monitor::Tracking;
use crate::plan::{Mode, Stepping};
use crate::rig::Reading;
use crate::run::StepReport;
use crate::run::session::Session;
use crate::run::stop::Stop;
use continuous_motion::{ContinuousMotion, Waypoint};
use triggers::Triggers;

/// The energy of a test at the end of a step \[J\].
pub(crate) struct Balance {
    /// Energy error.
    pub error: f64,
    /// Reference of the relative errors.
    pub input: f64,
}

/// Computes the steps of a structure, and keeps them.
pub(crate) trait Stepped {
    /// The end of the last step.
    fn axes(&self) -> AxesState<'_>;

    /// Target of each axis at the end of the next step \[m\]. Within one step it is always the same.
    fn predict(&mut self) -> Vec<f64>;

    /// Predicted velocity of each axis at its target \[m/s\]. True if a contact force contributes to it.
    fn predicted_velocity(&mut self, velocity: &mut [f64]) -> bool;

    /// Effective forces of the recursion at the start \[N\].
    fn effective_force_at_start(&self, start: &Start) -> Vec<f64>;

    /// Effective forces of the recursion at the targets of the last step \[N\].
    fn effective_force(&self) -> Vec<f64>;

    /// Ends the step with a reading.
    fn complete(&mut self, reading: &Reading);

    /// Keeps the reading that exceeded a limit on the way to the target: the step, of this length \[s\], has not ended.
    fn cut_off(&mut self, reading: &Reading, time_step: f64, session: &Session<'_>);

    /// Whether a contact force acted in the last step.
    fn is_struck(&self) -> bool;

    /// Keeps the end of a step, with the tracking of each axis so far.
    fn keep(&mut self, axes: &[Tracking], session: &Session<'_>) -> Balance;

    /// Steps of the procedure done before these.
    fn before(&self) -> u64 {
        0
    }

    /// Whether the run ends before all steps are done.
    fn over(&self) -> bool;
}

/// All steps, from the present position of the rig.
pub(crate) fn run<S: Stepped>(
    steps: &Steps,
    plan: &Stepping,
    followed: &mut Followed,
    session: &mut Session<'_>,
    begin: impl FnOnce(&Start) -> Result<(S, StifferSprings), Stop>,
) -> Result<(), Stop> {
    let mut triggers = Triggers::new(&plan.inspect);
    let (commanded, reading) = (session.guard.commanded().to_vec(), session.guard.read()?);
    let start = Start {
        commanded,
        reading,
        noise: session.guard.declared_noise(),
    };
    let (mut stepped, mut stiffer) = begin(&start)?;
    let mut monitors = Monitors::new(
        &start.commanded,
        &start.reading,
        &stepped.effective_force_at_start(&start),
    );
    let mut motion = match plan.mode {
        Mode::Continuous { time_scale } => Some(ContinuousMotion::from_rest(
            &start.commanded,
            time_scale,
            steps.time_step,
        )),
        Mode::StepAndPause => None,
    };
    stepped.keep(&monitors.tracking(), session);
    let mut struck = false;
    for _ in 0..steps.count {
        let (reading, broken, is_reached) = if let Some(motion) = &mut motion {
            let (reading, broken) = motion.step(|| waypoints(&mut stepped), session)?;
            let is_reached = broken.is_none();
            (reading, broken, is_reached)
        } else {
            let moved = session.guard.move_to(&stepped.predict(), None);
            let is_reached = moved.is_ok();
            let paused = moved.and_then(|()| session.guard.pause(steps.pause));
            let (reading, broken) = session.read_after(paused)?;
            (reading, broken, is_reached)
        };
        if !is_reached {
            stepped.cut_off(&reading, steps.time_step, session);
            return broken.map_or(Ok(()), Err);
        }
        stepped.complete(&reading);
        let axes = monitors.take(stepped.axes().target, &reading, &stepped.effective_force());
        if let Some(stop) = broken {
            stepped.keep(&axes, session);
            return Err(stop);
        }
        let (before, now) = (struck, stepped.is_struck());
        stiffer.take(&reading, before || now, session);
        struck = now;
        let Balance { error, input } = stepped.keep(&axes, session);
        let (tracking, tracking_energy_error) = followed.assess(&axes, input, session);
        let errors = Errors {
            energy_error: if error == 0.0 { 0.0 } else { error / input },
            tracking,
            tracking_energy_error,
        };
        session.guard.check_energy_error(errors.energy_error)?;
        session
            .guard
            .check_tracking(errors.tracking_energy_error, errors.tracking.nrms_error)?;
        let reported = report(&stepped.axes(), &errors);
        session.step_done(StepReport {
            step: stepped.before() + reported.step,
            ..reported
        })?;
        if stepped.over() {
            break;
        }
        let AxesState {
            step, time, force, ..
        } = stepped.axes();
        if let Some(reason) = triggers.after(step, time, force.iter().sum()) {
            session.inspect(&reason)?;
        }
    }
    motion.map_or(Ok(()), |motion| motion.brake(session))
}

/// The waypoint of each axis at the end of this step.
fn waypoints(stepped: &mut impl Stepped) -> Vec<Waypoint> {
    let displacements = stepped.predict();
    let mut velocities = vec![0.0; displacements.len()];
    let struck = stepped.predicted_velocity(&mut velocities);
    displacements
        .into_iter()
        .zip(velocities)
        .map(|(position, velocity)| Waypoint {
            position,
            velocity,
            struck,
        })
        .collect()
}
