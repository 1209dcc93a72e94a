//! Steps on an ideal rig, where every reading at rest is the target and the force of the specimen there. In: targets. Out: readings
//! inside every limit. Whatever cannot exceed a limit in such a step is checked once.

use super::{Guard, increment, inside};
use crate::safety::failpoint::{Guarding, on};
use crate::{LimitedQuantity, OWN_SPEED, Reading, RigFault, UnfinishedStep};
use psd_physics::structure::matrix::Vector as _;
use psd_plan::{Interval, Limits};

/// What all steps of a run on an ideal rig have in common.
#[derive(Clone, Copy, Debug)]
pub struct IdealSteps {
    /// As the guard requests it \[m/s\]; None: the rig's own.
    requested: Option<f64>,
    /// \[m/s\]
    speed: f64,
    /// \[s\]
    pause: f64,
}

impl Guard<'_> {
    /// Steps with this pause \[s\], if the rig is ideal and neither its speed nor an error of zero is outside a limit.
    pub fn ideal_steps(&mut self, pause: f64) -> Option<IdealSteps> {
        let requested = self.speed_of(None);
        let speed = requested.unwrap_or(OWN_SPEED);
        let limits = &self.limits;
        let errors = [
            limits.tracking_error,
            self.tracking_energy_limit(),
            limits.nrms_error,
        ];
        let guards = [
            Guarding::TargetLimits,
            Guarding::ReadingLimits,
            Guarding::Tracking,
        ];
        let stays = self.holds.is_none()
            && self.own.is_empty()
            && self.axial.count() == 0
            && speed > 0.0
            && inside(limits.speed, speed)
            && errors.iter().all(|limit| limit.contains(0.0))
            && guards.into_iter().all(on);
        let is_ideal = stays && self.rig.is_ideal();
        is_ideal.then_some(IdealSteps {
            requested,
            speed,
            pause,
        })
    }

    /// [`Guard::step`] in such a run.
    ///
    /// # Errors
    /// As that.
    #[inline]
    pub fn step_ideally(
        &mut self,
        steps: IdealSteps,
        targets: &[f64],
        reading: &mut Reading,
    ) -> Result<(), UnfinishedStep> {
        let Limits {
            displacement,
            force,
            increment: longest,
            ..
        } = self.limits;
        let mut moved: f64 = 0.0;
        let mut is_allowed = targets.len() == self.commanded.len();
        for (to, from) in targets.iter().zip(&self.commanded) {
            is_allowed &= inside(displacement, *to);
            moved = moved.max(increment(*from, *to));
        }
        let rig = self
            .rig
            .at_once()
            .filter(|_| is_allowed && inside(longest, moved));
        let Some(rig) = rig else {
            return self.step(targets, steps.pause, reading);
        };
        let stepped = rig.step(targets, steps.requested, steps.pause, reading);
        if stepped.is_err() || !reading.force.iter().all(|read| inside(force, *read)) {
            return self.end_step(stepped, targets, steps.speed, reading);
        }
        self.proposed = None;
        self.going.clear();
        self.speed = Some(steps.speed);
        self.commanded.set(targets);
        self.settled = true;
        self.last_contact = reading.time;
        Ok(())
    }
}

/// The fault with which a guard stops an ideal rig of one axis in a step from one position to another \[m\], where this force \[N\] is
/// read. Speeds and tracking errors are not checked.
#[must_use]
pub fn fault_of_ideal_step(limits: &Limits, [from, to]: [f64; 2], force: f64) -> Option<RigFault> {
    let checks: [(LimitedQuantity, Interval, f64); 3] = [
        (LimitedQuantity::TargetDisplacement, limits.displacement, to),
        (
            LimitedQuantity::Increment,
            limits.increment,
            increment(from, to),
        ),
        (LimitedQuantity::Force, limits.force, force),
    ];
    let (quantity, limit, value) = checks
        .into_iter()
        .find(|(_, limit, value)| !inside(*limit, *value))?;
    Some(RigFault::LimitBreached {
        quantity,
        value,
        low: limit.low,
        high: limit.high,
        axis: None,
    })
}
