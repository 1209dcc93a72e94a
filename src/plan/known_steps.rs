//! How many steps a procedure that integrates takes, where the plan alone tells. In: a procedure, the plan around it. Out: an
//! upper bound of its steps, or none where it hangs on what is measured before. It runs nothing.

use super::{BlowOn, Impact, Mode, Plan, ProcedureKind, Shake, StoreyImpact, Striker, step_count};
use crate::formula::{Formula, NoResults};
use crate::mechanics::frame::Damping;
use crate::mechanics::frame_properties::FrameProperties;

impl Impact {
    /// Of one blow of this striker.
    #[must_use]
    pub fn known_steps(&self, striker: &Striker) -> Option<u64> {
        let critical = self.critical_time_step(striker, Formula::constant)?;
        let time_step = self.stepping.time_step.evaluate(&NoResults, Some(critical)).ok()?.value;
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
        let time_step = self.stepping.time_step.evaluate(&NoResults, Some(critical)).ok()?.value;
        Some(step_count(self.duration.constant()?, time_step))
    }
}

impl Shake {
    #[must_use]
    pub fn known_steps(&self, plan: &Plan) -> Option<u64> {
        let frame = plan.specimens.get(self.specimen)?.frame.as_ref()?;
        let critical = FrameProperties::of(frame, &Damping::None).ok()?.critical_time_step();
        let time_step = self.stepping.time_step.evaluate(&NoResults, Some(critical)).ok()?.value;
        let duration = match &self.duration {
            Some(duration) => duration.constant()?,
            None => plan.grounds.get(self.ground)?.duration(),
        };
        Some(step_count(duration, time_step))
    }
}

impl Plan {
    /// How a procedure that integrates steps, and how often; of a row of blows, all of them. None of any other.
    #[must_use]
    pub fn known_steps(&self, kind: &ProcedureKind) -> Option<(Mode, u64)> {
        match kind {
            ProcedureKind::Impact(impact) => {
                Some((impact.stepping.mode, impact.known_steps(self.strikers.get(impact.striker)?)?))
            }
            ProcedureKind::StoreyImpact(impact) => {
                Some((impact.stepping.mode, impact.known_steps(self, self.strikers.get(impact.striker)?)?))
            }
            ProcedureKind::Shake(shake) => Some((shake.stepping.mode, shake.known_steps(self)?)),
            ProcedureKind::Escalate(escalate) => {
                let fastest = escalate.fastest(self.strikers.get(escalate.striker())?);
                let (mode, steps) = match &escalate.blow {
                    BlowOn::Specimen(blow) => (blow.stepping.mode, blow.known_steps(&fastest)?),
                    BlowOn::Storey(blow) => (blow.stepping.mode, blow.known_steps(self, &fastest)?),
                };
                Some((mode, steps.saturating_mul(escalate.velocities.len() as u64)))
            }
            _ => None,
        }
    }
}
