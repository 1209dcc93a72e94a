//! An impact without a stop (Melo et al. 2006, sec. 1.2): the actuator follows a smooth path
//! at a time scale (`gliding`), and is read as it passes its targets. In: what is known before the first step, the rig behind its
//! guard. Out: every step as it ended.
//!
//! Where the actuator stood elsewhere than at its target (lag, resolution) the reading is corrected to it by the
//! I-modification, r* = `r_m` − `K_I`(`d_m` − d̃). What a damper of the specimen does is in the force, at the actuator's
//! velocity: c·v/`time_scale`. A blow ends with its step: the velocity foretold for the next one has what is left of its
//! impulse, and no more of it to come, for a damper would be felt at whatever velocity is foretold.

use super::gliding::{Gliding, Passing};
use super::impact::Setting;
use super::session::{Session, first};
use super::stop::Stop;
use super::strike::Strike;
use crate::mechanics::impact::{ImpactSolver, ImpactState};
use crate::mechanics::monitor::Monitor;
use crate::plan::Impact;

pub(super) fn run(strike: &mut Strike, plan: &Impact, time_scale: f64, session: &mut Session<'_>) -> Result<(), Stop> {
    let Setting { input, steps, .. } = strike.setting;
    let start = session.commanded();
    let (measured, restoring_force) = session.read()?;
    let mut solver = ImpactSolver::new(&input, start, restoring_force);
    let taken = solver.taken_at(start, measured, restoring_force);
    let mut monitor = Monitor::new_as(start, measured, restoring_force, taken);
    strike.take(&ImpactState { measured_displacement: measured, ..*solver.state() }, monitor.tracking(), session);
    let mut gliding = Gliding::from_rest(&[start], time_scale, input.time_step);
    let mut stiffer = strike.stiffer(&plan.stepping, (measured, restoring_force), session);
    for _ in 0..steps {
        let mut foretell = || {
            let place = solver.predict();
            let (velocity, struck) = solver.predicted_velocity();
            Passing { place, velocity, struck }
        };
        let (reading, broken) = gliding.step(|| vec![foretell()], session)?;
        let (measured, force) = first(&reading);
        let (target, taken) = (solver.predict(), solver.taken(measured, force));
        let tracking = monitor.take_as(target, measured, force, taken);
        if let Some(stop) = broken {
            strike.take(solver.complete(measured, force), tracking, session);
            return Err(stop);
        }
        let before = solver.state().contact_force > 0.0;
        let state = *solver.complete(measured, force);
        let struck = before || state.contact_force > 0.0;
        stiffer.take((measured, force), struck, "the specimen", session);
        strike.step(&state, tracking, session)?;
        if solver.over(plan.until) {
            break;
        }
    }
    gliding.brake(session)
}
