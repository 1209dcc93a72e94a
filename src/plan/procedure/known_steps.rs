//! How many steps a procedure that integrates takes, where the plan alone tells. In: a procedure, the plan around it. Out: an
//! upper bound of its steps, or none where it hangs on what is measured before. It runs nothing.

use crate::physics::frame::Damping;
use crate::physics::structure::frame_properties::FrameProperties;
use crate::plan::formula::{Formula, NoResults};
use crate::plan::{BlowOn, Escalate, Impact, Plan, Shake, StoreyImpact, Striker, step_count};

impl Impact {
    /// Of one blow of this striker.
    #[must_use]
    pub fn known_steps(&self, striker: &Striker) -> Option<u64> {
        let critical = self.critical_time_step(striker, Formula::constant)?;
        let time_step = self
            .stepping
            .time_step
            .evaluate(&NoResults, Some(critical))
            .ok()?
            .value;
        Some(step_count(self.duration.constant()?, time_step))
    }
}

impl StoreyImpact {
    /// Of one blow of this striker.
    #[must_use]
    pub fn known_steps(&self, plan: &Plan, striker: &Striker) -> Option<u64> {
        let frame = plan.specimens.get(self.specimen)?.frame.as_ref()?;
        let properties = FrameProperties::of(frame, &Damping::None).ok()?;
        let approach = self.contact.approach(striker, Formula::constant)?;
        let critical = properties.critical_on_impact(self.struck, &approach);
        let time_step = self
            .stepping
            .time_step
            .evaluate(&NoResults, Some(critical))
            .ok()?
            .value;
        Some(step_count(self.duration.constant()?, time_step))
    }
}

impl Shake {
    #[must_use]
    pub fn known_steps(&self, plan: &Plan) -> Option<u64> {
        let frame = plan.specimens.get(self.specimen)?.frame.as_ref()?;
        let critical = FrameProperties::of(frame, &Damping::None)
            .ok()?
            .critical_time_step();
        let time_step = self
            .stepping
            .time_step
            .evaluate(&NoResults, Some(critical))
            .ok()?
            .value;
        let duration = match &self.duration {
            Some(duration) => duration.constant()?,
            None => plan.grounds.get(self.ground)?.duration(),
        };
        Some(step_count(duration, time_step))
    }
}

impl Escalate {
    /// Of its longest blow.
    #[must_use]
    pub fn known_steps_of_a_blow(&self, plan: &Plan) -> Option<u64> {
        let fastest = self.fastest(plan.strikers.get(self.striker())?);
        match &self.blow {
            BlowOn::Specimen(blow) => blow.known_steps(&fastest),
            BlowOn::Storey(blow) => blow.known_steps(plan, &fastest),
        }
    }
}
