//! Inspection triggers of a procedure that integrates. In: every step. Out: the reason of an inspection, when one is due.

use crate::plan::InspectTrigger;

/// The triggers of the plan with their states.
pub(crate) struct Triggers {
    armed: Vec<Armed>,
}

struct Armed {
    trigger: InspectTrigger,
    /// Largest |R| since its last trigger \[N\].
    largest_force: f64,
    fired: bool,
}

impl Triggers {
    pub(crate) fn new(triggers: &[InspectTrigger]) -> Self {
        let armed = |trigger: &InspectTrigger| Armed {
            trigger: trigger.clone(),
            largest_force: 0.0,
            fired: false,
        };
        Self {
            armed: triggers.iter().map(armed).collect(),
        }
    }

    /// The first reason for an inspection after `step` at the simulated time `time` \[s\] with restoring force `force` \[N\].
    pub(crate) fn after(&mut self, step: u64, time: f64, force: f64) -> Option<String> {
        let mut reason = None;
        for armed in &mut self.armed {
            if let Some(found) = armed.after(step, time, force) {
                reason.get_or_insert(found);
            }
        }
        reason
    }
}

impl Armed {
    fn after(&mut self, step: u64, time: f64, force: f64) -> Option<String> {
        match self.trigger {
            InspectTrigger::Every(steps) => (steps > 0 && step.is_multiple_of(u64::from(steps)))
                .then(|| format!("inspection every {steps} steps")),
            InspectTrigger::ForceDrop(fraction) => {
                let size = force.abs();
                let dropped = size < (1.0 - fraction) * self.largest_force;
                // After an inspection, only a further fall from here counts.
                self.largest_force = if dropped {
                    size
                } else {
                    self.largest_force.max(size)
                };
                dropped
                    .then(|| format!("the restoring force fell by {} % or more", fraction * 100.0))
            }
            InspectTrigger::At(moment) => {
                // Half a billionth for a step end that rounding put just before the moment.
                let due = !self.fired && time >= moment * (1.0 - 5e-10);
                self.fired |= due;
                due.then(|| format!("inspection at {moment} s of test time"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goes_off_every_n_steps_once_at_a_time_and_once_a_drop() {
        let steps = |triggers: &[InspectTrigger]| {
            let mut triggers = Triggers::new(triggers);
            let forces = [10.0, 50.0, 100.0, 95.0, 89.0, 85.0, 81.0, 80.0, 100.0];
            let due = |(step, force): (u64, &f64)| {
                #[expect(clippy::cast_precision_loss, reason = "nine steps")]
                let time = step as f64 * 0.1;
                triggers.after(step, time, *force).map(|_| step)
            };
            (1..).zip(&forces).filter_map(due).collect::<Vec<_>>()
        };
        assert_eq!(steps(&[InspectTrigger::Every(4)]), [4, 8]);
        assert_eq!(steps(&[InspectTrigger::At(0.3)]), [3]);
        // 89 is below 90 % of 100; 80 is below 90 % of 89.
        assert_eq!(steps(&[InspectTrigger::ForceDrop(0.1)]), [5, 8]);
        assert_eq!(
            steps(&[InspectTrigger::At(0.4), InspectTrigger::Every(4)]),
            [4, 8]
        );
    }
}
