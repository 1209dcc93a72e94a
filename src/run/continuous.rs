//! An impact without a stop (Melo et al. 2006, sec. 1.2; Nakashima and Masaoka 1999): the actuator follows a smooth path
//! at a time scale, and is read as it passes its targets. In: what is known before the first step, the rig behind its
//! guard. Out: every step as it ended.
//!
//! **Scheme.** A step of Δt takes `time_scale`·Δt of rig time. While its reading is made durable and its target computed
//! the actuator moves on along a parabola, with the place and velocity that it has and the mean acceleration of the step
//! before: nothing in it knows the reading. For the rest of the step it follows the cubic from there to the target, which it
//! passes with the velocity that the integrator foretells there, over the time scale. Place and velocity are continuous
//! everywhere (the guard refuses a path that does not join), and the path is of third order. The last reading is made at
//! the target; where the actuator stood elsewhere (lag, resolution) it is corrected to the target by the I-modification,
//! r* = `r_m` − `K_I`(`d_m` − d̃). At the end the actuator brakes at constant deceleration.
//!
//! What a damper of the specimen does is in the force, at the actuator's velocity: c·v/`time_scale`.

use super::impact::Setting;
use super::session::{Session, first};
use super::stop::Stop;
use super::strike::Strike;
use crate::mechanics::impact::{ImpactSolver, ImpactState};
use crate::mechanics::monitor::Monitor;
use crate::mechanics::path::Path;
use crate::plan::Impact;
use crate::rig::Reading;

/// Share of a step in which the target is not known yet.
const AHEAD: f64 = 0.2;
/// Readings while it is not, and on the way to it: each is held against the limits.
const READINGS: (usize, usize) = (1, 4);
/// Steps' time in which the actuator comes to rest at the end.
const BRAKING: f64 = 5.0;

/// The actuator as the last path left it.
struct Motion {
    /// m
    place: f64,
    /// m/s, of rig time
    velocity: f64,
    /// Mean over the last step, m/s².
    acceleration: f64,
}

pub(super) fn run(strike: &mut Strike, plan: &Impact, time_scale: f64, session: &mut Session<'_>) -> Result<(), Stop> {
    let Setting { input, steps, .. } = strike.setting;
    let step_time = time_scale * input.time_step;
    let start = session.commanded();
    let (measured, restoring_force) = session.read()?;
    let mut solver = ImpactSolver::new(&input, start, restoring_force);
    let mut monitor = Monitor::new(start, measured, restoring_force);
    strike.take(&ImpactState { measured_displacement: measured, ..*solver.state() }, monitor.tracking(), session);
    let mut motion = Motion { place: start, velocity: 0.0, acceleration: 0.0 };
    for _ in 0..steps {
        let ahead = Path::accelerated(motion.place, motion.velocity, motion.acceleration, AHEAD * step_time);
        follow(ahead, READINGS.0, session)?;
        let target = solver.predict();
        let velocity = solver.predicted_velocity() / time_scale;
        let rest = (1.0 - AHEAD) * step_time;
        let on = Path { from: ahead.to, to: target, start_velocity: ahead.end_velocity, end_velocity: velocity, seconds: rest };
        let (measured, force) = first(&follow(on, READINGS.1, session)?);
        motion = Motion { place: target, velocity, acceleration: (velocity - motion.velocity) / step_time };
        let tracking = monitor.take(target, measured, force);
        let state = *solver.complete(measured, force);
        strike.step(&state, tracking, session)?;
        if solver.over(plan.until) {
            break;
        }
    }
    let seconds = BRAKING * step_time;
    follow(Path::accelerated(motion.place, motion.velocity, -motion.velocity / seconds, seconds), READINGS.1, session)?;
    Ok(())
}

/// Follows a path; the reading at its end.
fn follow(path: Path, readings: usize, session: &mut Session<'_>) -> Result<Reading, Stop> {
    let mut followed = session.guard.glide(&[path], readings);
    if let Some(fault) = followed.fault {
        return Err(fault.into());
    }
    let none = || crate::rig::RigFault::Device("nothing was read on the way".to_owned());
    followed.readings.pop().ok_or_else(|| none().into())
}
