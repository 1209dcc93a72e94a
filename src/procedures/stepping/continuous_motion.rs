//! Continuous motion: the actuators do not stop at the steps. They follow smooth paths together, and are read as they pass their
//! targets. In: for each step the waypoints with their velocities. Out: the reading there. It knows no equation of motion.
//!
//! A step of Δt takes `time_scale`·Δt of laboratory time. While its reading is stored and its targets are computed, the actuators
//! continue along parabolas, from their position and velocity with the mean acceleration of the step before. This part does not depend on
//! the reading. If a contact force contributed to that acceleration, it is not a trend, and the velocity stays constant. For the rest of
//! the step each actuator follows a cubic to its target. It passes the target with the velocity that the integrator predicts there,
//! divided by the time scale. Position and velocity are continuous everywhere (the guard refuses a path that does not join). The last
//! reading is made at the target.

use crate::run::session::Session;
use crate::run::stop::Stop;
use psd_physics::tracking::trajectory::{ActuatorMotion, Path};
use psd_rig::{Reading, RigFault};

/// Readings while the targets are not known, and on the path to them: each is compared with the limits.
const READINGS: (usize, usize) = (1, 4);
/// Fraction of a step in which its target is not known yet.
const AHEAD: f64 = 0.2;
/// Duration of the braking at the end, in steps.
const BRAKING: f64 = 5.0;

/// The point that an actuator passes at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Waypoint {
    /// \[m\]
    pub position: f64,
    /// \[m/s\] of simulated time.
    pub velocity: f64,
    /// Whether a contact force contributes to the velocity.
    pub struck: bool,
}

/// All actuators of a rig in continuous motion.
pub(crate) struct ContinuousMotion {
    /// At the end of the last path, in laboratory time; the acceleration is the mean over the last step, which the next parabola uses.
    axes: Vec<ActuatorMotion>,
    time_scale: f64,
    /// Laboratory time of a step \[s\].
    step_time: f64,
}

impl ContinuousMotion {
    /// From rest at these positions \[m\]; `time_step` in simulated time \[s\].
    pub(crate) fn from_rest(displacements: &[f64], time_scale: f64, time_step: f64) -> Self {
        let axes = displacements
            .iter()
            .map(|position| ActuatorMotion {
                position: *position,
                velocity: 0.0,
                acceleration: 0.0,
            })
            .collect();
        Self {
            axes,
            time_scale,
            step_time: time_scale * time_step,
        }
    }

    /// One step: the reading at its end. If a reading violates a limit, that reading with the stop that follows. `predict` is called
    /// while the actuators move.
    pub(crate) fn step(
        &mut self,
        predict: impl FnOnce() -> Vec<Waypoint>,
        session: &mut Session<'_>,
    ) -> Result<(Reading, Option<Stop>), Stop> {
        let seconds = AHEAD * self.step_time;
        let ahead = self
            .axes
            .iter()
            .map(|axis| Path::accelerated(*axis, seconds));
        let ahead: Vec<Path> = ahead.collect();
        let (reading, broken) = follow(&ahead, READINGS.0, session)?;
        if broken.is_some() {
            return Ok((reading, broken));
        }
        let seconds = (1.0 - AHEAD) * self.step_time;
        let on = |(axis, (ahead, waypoint)): (&mut ActuatorMotion, (&Path, Waypoint))| {
            let velocity = waypoint.velocity / self.time_scale;
            let gained = (velocity - axis.velocity) / self.step_time;
            *axis = ActuatorMotion {
                position: waypoint.position,
                velocity,
                acceleration: if waypoint.struck { 0.0 } else { gained },
            };
            Path {
                from: ahead.to,
                to: waypoint.position,
                start_velocity: ahead.end_velocity,
                end_velocity: velocity,
                seconds,
            }
        };
        let paths: Vec<Path> = self
            .axes
            .iter_mut()
            .zip(ahead.iter().zip(predict()))
            .map(on)
            .collect();
        follow(&paths, READINGS.1, session)
    }

    /// Stops with constant deceleration.
    pub(crate) fn brake(&self, session: &mut Session<'_>) -> Result<(), Stop> {
        let seconds = BRAKING * self.step_time;
        let brake = |axis: &ActuatorMotion| {
            let braking = ActuatorMotion {
                acceleration: -axis.velocity / seconds,
                ..*axis
            };
            Path::accelerated(braking, seconds)
        };
        let (_, broken) = follow(
            &self.axes.iter().map(brake).collect::<Vec<Path>>(),
            READINGS.1,
            session,
        )?;
        broken.map_or(Ok(()), Err)
    }
}

/// Follows paths and returns the reading at their end. If a reading violates a limit, that reading with the stop that follows.
fn follow(
    paths: &[Path],
    readings: usize,
    session: &mut Session<'_>,
) -> Result<(Reading, Option<Stop>), Stop> {
    let mut followed = session.guard.follow_paths(paths, readings);
    let broken = session.guard.take_broken();
    match (followed.fault, broken) {
        (Some(fault), Some(reading)) => Ok((reading, Some(fault.into()))),
        (Some(fault), None) => Err(fault.into()),
        (None, _) => {
            let last = followed
                .readings
                .pop()
                .ok_or_else(|| RigFault::Device("no reading during the motion".to_owned()))?;
            Ok((last, None))
        }
    }
}
