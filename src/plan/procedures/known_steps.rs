//! The number of steps of a procedure that integrates, if the plan alone determines it. In: a procedure, and its plan. Out: an upper
//! bound of the number of steps, or None if it depends on measured results. It runs nothing.

use crate::formula::{Formula, NoResults};
use crate::{Escalate, Impact, ImpactTarget, Plan, Shake, Stepping, Striker, step_count};
use psd_physics::structure::Damping;
use psd_physics::structure::frame_properties::FrameProperties;

impl Impact {
    /// The steps of one impact of this striker.
    #[must_use]
    pub fn known_steps(&self, plan: &Plan, striker: &Striker) -> Option<u64> {
        let critical = match &self.target {
            ImpactTarget::Point(_) => self.critical_time_step(striker, Formula::constant)?,
            ImpactTarget::Storey(target) => {
                let approach = self.approach(striker, Formula::constant)?;
                undamped(plan, self.specimen)?.critical_on_impact(target.storey, &approach)
            }
        };
        let time_step = known_time_step(&self.stepping, critical)?;
        Some(step_count(self.duration.constant()?, time_step))
    }
}

impl Shake {
    #[must_use]
    pub fn known_steps(&self, plan: &Plan) -> Option<u64> {
        let critical = undamped(plan, self.specimen)?.critical_time_step();
        let time_step = known_time_step(&self.stepping, critical)?;
        let duration = match &self.duration {
            Some(duration) => duration.constant()?,
            None => plan.grounds.get(self.ground)?.duration(),
        };
        Some(step_count(duration, time_step))
    }
}

impl Escalate {
    /// The steps of its longest impact.
    #[must_use]
    pub fn known_steps_of_an_impact(&self, plan: &Plan) -> Option<u64> {
        let fastest = self.fastest(plan.strikers.get(self.impact.striker)?);
        self.impact.known_steps(plan, &fastest)
    }
}

/// The frame of a specimen without damping; None if the specimen has no frame.
fn undamped(plan: &Plan, specimen: usize) -> Option<FrameProperties> {
    let frame = plan.specimens.get(specimen)?.frame.as_ref()?;
    FrameProperties::of(frame, &Damping::None).ok()
}

/// Δt \[s\] for this critical time step \[s\]; None if it reads results.
fn known_time_step(stepping: &Stepping, critical: f64) -> Option<f64> {
    let time_step = stepping.time_step.evaluate(&NoResults, Some(critical));
    Some(time_step.ok()?.value)
}
