//! The guard: the only access of `run` and `procedures` to a rig. In: requested motions and
//! readings. Out: readings, each inside every limit. It proposes nothing beyond a limit, clamps
//! nothing, and holds the rig on any fault. It knows no procedure.

pub mod about;
mod axial;
pub mod final_hold;
mod holds;
mod ideal;
pub mod path;
pub mod read;
pub mod smooth_paths;
pub mod speed;

use super::safety::failpoint::{Guarding, on};
use super::{
    EachReading, LimitedQuantity, OWN_SPEED, Reading, Rig, RigFault, UnfinishedStep, named_axis,
};
use axial::AxialAxes;
use holds::Holds;
pub use ideal::{IdealSteps, fault_of_ideal_step};
use psd_plan::{AxialAxis, Interval, Limits};

/// A rig and the limits of its motion.
pub struct Guard<'rig> {
    pub(super) rig: &'rig mut dyn Rig,
    pub(super) limits: Limits,
    /// Limits of each axis, if one has separate limits. Empty: `limits` apply to all axes.
    pub(super) own: Vec<Limits>,
    /// The last executed target \[m\]; at first the position at which the rig was found.
    pub(super) commanded: Vec<f64>,
    /// Velocities at the end of the last path \[m/s\]; none at rest.
    pub(super) going: Vec<f64>,
    /// Whether the rig has settled at `commanded`, so that a reading shows the tracking error.
    pub(super) settled: bool,
    /// Checked, and not yet executed: targets \[m\] and the speed decoded from the bytes \[m/s\].
    pub(super) proposed: Option<(Vec<f64>, f64)>,
    /// Speed of the last motion \[m/s\].
    pub(super) speed: Option<f64>,
    /// Rig time when the rig last answered \[s\].
    pub(super) last_contact: f64,
    /// The evaluation of dwells, if it is requested.
    holds: Option<Holds>,
    /// The first reading: displacements, m, and forces \[N\].
    pub(super) found: (Vec<f64>, Vec<f64>),
    /// The last reading that exceeded a limit, if it is a reading.
    pub(super) broken: Option<Reading>,
    /// The axes in force control. All else in the guard is about the other axes.
    axial: AxialAxes,
}

/// Readings of a traverse, all inside the limits, and the fault that ended it early.
#[derive(Debug)]
pub struct Traversed {
    pub readings: Vec<Reading>,
    pub fault: Option<RigFault>,
}

impl<'rig> Guard<'rig> {
    /// Reads the present position of the rig. Displacement and force of each axis stay inside its `own` limits, or inside `limits`.
    ///
    /// # Errors
    /// It cannot be read, or is outside a limit already.
    pub fn new(rig: &'rig mut dyn Rig, limits: Limits, own: Vec<Limits>) -> Result<Self, RigFault> {
        Self::with_axial_axes(rig, limits, own, std::iter::empty())
    }

    /// The same with axes in force control, each with its limits, as the last axes of the rig.
    ///
    /// # Errors
    /// As [`Guard::new`].
    pub fn with_axial_axes(
        rig: &'rig mut dyn Rig,
        limits: Limits,
        own: Vec<Limits>,
        axial: impl Iterator<Item = (AxialAxis, Limits)>,
    ) -> Result<Self, RigFault> {
        let last_contact = rig.time();
        let (commanded, going, found) = (Vec::new(), Vec::new(), (Vec::new(), Vec::new()));
        let mut guard = Self {
            rig,
            limits,
            own,
            commanded,
            going,
            settled: false,
            proposed: None,
            speed: None,
            last_contact,
            holds: None,
            found,
            broken: None,
            axial: AxialAxes::new(axial),
        };
        let Reading {
            displacement,
            force,
            ..
        } = guard.read()?;
        guard.commanded.clone_from(&displacement);
        guard.found = (displacement, force);
        Ok(guard)
    }

    /// The last targets carried out \[m\].
    #[must_use]
    pub fn commanded(&self) -> &[f64] {
        &self.commanded
    }

    /// Rig time of the last reading \[s\], or of the fault after it: the time that the run log also contains. A later move or pause
    /// without a reading takes time that is not in the run log. So no event may have a time within it.
    #[must_use]
    pub const fn time(&self) -> f64 {
        self.last_contact
    }

    /// Moves to `targets` (m) in one increment and settles. Without a speed \[m/s\]: the rig's own, else the highest that the
    /// plan allows.
    ///
    /// # Errors
    /// A limit is exceeded, or the rig fails.
    pub fn move_to(&mut self, targets: &[f64], speed: Option<f64>) -> Result<(), RigFault> {
        self.propose(targets, speed)?;
        self.execute()
    }

    /// The first half of [`Guard::move_to`]: everything is checked, nothing moves. An earlier proposal is forgotten.
    ///
    /// # Errors
    /// A limit is exceeded, or the rig refuses.
    pub fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<(), RigFault> {
        self.proposed = None;
        self.check_move(targets)?;
        let all = self.axial.with_others(targets);
        let before = self.rig.before_motion(&all, self.speed_of(speed));
        self.or_hold(before)?;
        let speed = self.speed_of(speed);
        if let Some(speed) = speed {
            self.check_speed(speed)?;
        }
        let proposed = self.rig.propose(&all, speed);
        let encoded = self.or_hold(proposed)?;
        // The decoded bytes are the motion that will happen, so they are compared with the limits again.
        let others = encoded.targets.len().saturating_sub(self.axial.count());
        self.check_targets(&encoded.targets[..others])?;
        self.check_speed(encoded.speed)?;
        self.proposed = Some((targets.to_vec(), encoded.speed));
        Ok(())
    }

    /// The second half: executes the last proposal and settles.
    ///
    /// # Errors
    /// The rig fails, or no proposal can be executed.
    pub fn execute(&mut self) -> Result<(), RigFault> {
        let Some((targets, commanded_speed)) = self.proposed.take() else {
            self.hold();
            return Err(RigFault::Device(
                "nothing was proposed to execute".to_owned(),
            ));
        };
        self.leave();
        self.going.clear();
        let executed = self.rig.execute();
        self.or_hold(executed)?;
        self.note_speed(commanded_speed);
        self.commanded = targets;
        self.settled = true;
        Ok(())
    }

    /// Moves to `targets` \[m\] without a requested speed, stays there for `pause` \[s\] of rig time and reads: `move_to`, `pause` and
    /// `read`. A rig that is [`Rig::at_once`] does all of it in one call.
    ///
    /// # Errors
    /// As those, with the part of the step that is done.
    pub fn step(
        &mut self,
        targets: &[f64],
        pause: f64,
        reading: &mut Reading,
    ) -> Result<(), UnfinishedStep> {
        if self.holds.is_none() && self.rig.at_once().is_some() {
            let ended = |is_reached| move |fault| UnfinishedStep { is_reached, fault };
            self.check_move(targets).map_err(ended(false))?;
            let requested = self.speed_of(None);
            let speed = requested.unwrap_or(OWN_SPEED);
            self.check_speed(speed).map_err(ended(false))?;
            let is_valid = speed > 0.0 && speed.is_finite();
            if let Some(rig) = self.rig.at_once().filter(|_| is_valid) {
                let stepped = rig.step(targets, requested, pause, reading);
                return self.end_step(stepped, targets, speed, reading);
            }
        }
        let moved = self.move_to(targets, None);
        let is_reached = moved.is_ok();
        let read = moved
            .and_then(|()| self.pause(pause))
            .and_then(|()| self.read());
        *reading = read.map_err(|fault| UnfinishedStep { is_reached, fault })?;
        Ok(())
    }

    /// A step in one call, at this commanded speed \[m/s\], has ended, and its reading is checked.
    fn end_step(
        &mut self,
        stepped: Result<(), UnfinishedStep>,
        targets: &[f64],
        speed: f64,
        reading: &mut Reading,
    ) -> Result<(), UnfinishedStep> {
        self.proposed = None;
        self.going.clear();
        let is_reached = stepped
            .as_ref()
            .map_or_else(|end| end.is_reached, |()| true);
        if is_reached {
            self.note_speed(speed);
            self.commanded.copy_from_slice(targets);
            self.settled = true;
        }
        let read = self.or_hold(stepped.map_err(|end| end.fault));
        read.and_then(|()| self.checked(reading))
            .map_err(|fault| UnfinishedStep { is_reached, fault })
    }

    /// Stays for `seconds` of rig time.
    ///
    /// # Errors
    /// The rig fails.
    pub fn pause(&mut self, seconds: f64) -> Result<(), RigFault> {
        if seconds > 0.0 {
            let paused = self.rig.pause(seconds);
            self.or_hold(paused)?;
        }
        Ok(())
    }

    /// Moves at constant velocity (\[m/s\], signed) to `targets` and reads during the motion. If a limit was exceeded, the
    /// last reading is the one that exceeded it. The limit of the increment does not apply, because the target moves
    /// uniformly; the limit of the tracking error applies to settled readings only.
    pub fn traverse(&mut self, targets: &[f64], velocity: f64, samples: usize) -> Traversed {
        let refused = |fault| Traversed {
            readings: Vec::new(),
            fault: Some(fault),
        };
        let all = self.axial.with_others(targets);
        let allowed = self.check_targets(targets).and_then(|()| {
            let before = self.rig.before_motion(&all, Some(velocity));
            self.or_hold(before)?;
            self.check_speed(velocity.abs())
        });
        if let Err(fault) = allowed {
            return refused(fault);
        }
        self.leave();
        self.going.clear();
        self.speed = Some(velocity.abs());
        let traversed = self.read_during(samples, |rig, each| {
            rig.traverse(&all, velocity, samples, each)
        });
        if traversed.fault.is_none() {
            self.commanded.copy_from_slice(targets);
        }
        traversed
    }

    /// Moves and checks each reading as it is made: a rig beyond a limit is held before its motion ends.
    fn read_during(
        &mut self,
        samples: usize,
        motion: impl FnOnce(&mut dyn Rig, EachReading<'_>) -> Result<(), RigFault>,
    ) -> Traversed {
        let (limits, own) = (self.limits, self.own.clone());
        let mut readings = Vec::with_capacity(samples);
        let (mut last_contact, mut broken) = (self.last_contact, None);
        let axial = &mut self.axial;
        let moved = motion(self.rig, &mut |mut reading| {
            last_contact = reading.time;
            let of_axial = axial.take(&mut reading, true);
            if let Some(fault) = outside(&limits, &own, &reading).or(of_axial) {
                broken = Some(reading).filter(Reading::is_finite);
                return Err(fault);
            }
            readings.push(reading);
            Ok(())
        });
        self.last_contact = last_contact;
        self.broken = broken;
        let fault = self.or_hold(moved).err();
        readings.extend(self.broken.clone());
        Traversed { readings, fault }
    }

    /// Holds the rig if the energy error (a fraction of the input energy) is outside its limit, if there is one.
    ///
    /// # Errors
    /// The error is outside its limit.
    #[inline]
    pub fn check_energy_error(&mut self, fraction: f64) -> Result<(), RigFault> {
        if !self.limits.energy_error.is_bounded() || !on(Guarding::EnergyError) {
            return Ok(());
        }
        self.check(
            LimitedQuantity::EnergyError,
            self.limits.energy_error,
            fraction.abs(),
        )
    }

    /// Holds the rig if the tracking-error energy (a fraction of the input energy) or the NRMS tracking error is outside its limit. The
    /// first always has a limit.
    ///
    /// # Errors
    /// An error is outside its limit.
    /// It does.
    pub fn check_tracking(&mut self, energy_share: Option<f64>, nrms: f64) -> Result<(), RigFault> {
        if !on(Guarding::Tracking) {
            return Ok(());
        }
        let energy = self.tracking_energy_limit();
        if let Some(share) = energy_share {
            self.check(LimitedQuantity::TrackingEnergyError, energy, share.abs())?;
        }
        if self.limits.nrms_error.is_bounded() {
            self.check(LimitedQuantity::NrmsError, self.limits.nrms_error, nrms)?;
        }
        Ok(())
    }

    /// Allowed tracking-error energy as a fraction of the input energy: the plan's limit, else the default.
    #[must_use]
    pub fn tracking_energy_limit(&self) -> Interval {
        self.limits.held_tracking_energy_error()
    }

    /// Stops all motion and keeps the load. A proposed move is discarded.
    pub fn hold(&mut self) {
        self.proposed = None;
        self.going.clear();
        self.rig.hold();
    }

    /// Whether the targets \[m\], and the increments to them, are inside their limits.
    fn check_move(&mut self, targets: &[f64]) -> Result<(), RigFault> {
        self.check_targets(targets)?;
        let increments = targets
            .iter()
            .zip(&self.commanded)
            .map(|(to, from)| increment(*from, *to));
        let longest = increments.fold(0.0, f64::max);
        self.check(LimitedQuantity::Increment, self.limits.increment, longest)
    }

    pub(super) fn check_targets(&mut self, targets: &[f64]) -> Result<(), RigFault> {
        if targets.len() != self.commanded.len() {
            self.hold();
            let reason = format!(
                "{} targets, but the rig has {} degrees of freedom",
                targets.len(),
                self.commanded.len()
            );
            return Err(RigFault::Device(reason));
        }
        if !on(Guarding::TargetLimits) {
            return Ok(());
        }
        (0..)
            .zip(targets)
            .try_for_each(|(index, target)| self.check_target(index, *target))
    }

    /// Whether the axis with this index may move to `target` \[m\].
    pub(super) fn check_target(&mut self, axis: usize, target: f64) -> Result<(), RigFault> {
        let limit = self.own.get(axis).unwrap_or(&self.limits).displacement;
        if inside(limit, target) {
            return Ok(());
        }
        Err(self.breach(
            LimitedQuantity::TargetDisplacement,
            Some(axis),
            limit,
            target,
        ))
    }

    pub(super) fn check(
        &mut self,
        quantity: LimitedQuantity,
        limit: Interval,
        value: f64,
    ) -> Result<(), RigFault> {
        if inside(limit, value) {
            Ok(())
        } else {
            Err(self.breach(quantity, None, limit, value))
        }
    }

    /// `index` is the index of the axis, for a quantity of one axis.
    pub(super) fn breach(
        &mut self,
        quantity: LimitedQuantity,
        index: Option<usize>,
        limit: Interval,
        value: f64,
    ) -> RigFault {
        self.hold();
        let axis = index.and_then(|index| self.named_axis(index));
        RigFault::LimitBreached {
            quantity,
            value,
            low: limit.low,
            high: limit.high,
            axis,
        }
    }

    /// The number of the axis with this index, from 1, if the rig has several, the axial ones among them.
    #[must_use]
    pub fn named_axis(&self, index: usize) -> Option<usize> {
        named_axis(index, self.commanded.len() + self.axial.count())
    }

    pub(super) fn or_hold<T>(&mut self, outcome: Result<T, RigFault>) -> Result<T, RigFault> {
        if let Err(fault) = &outcome {
            // The guard itself finds a limit exceeded by a reading that it has; the rig finds it during a motion.
            if !matches!(fault, RigFault::LimitBreached { .. }) {
                self.last_contact = self.rig.time();
            } else if let Some(mut reading) = self.rig.take_broken() {
                let _ = self.axial.take(&mut reading, false);
                self.last_contact = reading.time;
                self.broken = Some(reading);
            }
            self.hold();
        }
        outcome
    }
}

/// Infinity is inside "no limit", but is not a position of a rig.
fn inside(limit: Interval, value: f64) -> bool {
    limit.contains(value) && value.is_finite()
}

/// The first value of a reading that is outside its limit: that of its axis, if the axis has its own.
pub(super) fn outside(limits: &Limits, own: &[Limits], reading: &Reading) -> Option<RigFault> {
    let of = |index: usize| own.get(index).unwrap_or(limits);
    let displacements_by_axis = (0..).zip(&reading.displacement);
    let displacements = displacements_by_axis.map(|(at, x)| {
        (
            LimitedQuantity::MeasuredDisplacement,
            at,
            of(at).displacement,
            *x,
        )
    });
    let forces = (0..)
        .zip(&reading.force)
        .map(|(at, force)| (LimitedQuantity::Force, at, of(at).force, *force));
    displacements
        .chain(forces)
        .find(|(.., limit, value)| !inside(*limit, *value))
        .map(|(quantity, at, limit, value)| {
            let axis = named_axis(at, reading.displacement.len());
            RigFault::LimitBreached {
                quantity,
                value,
                low: limit.low,
                high: limit.high,
                axis,
            }
        })
}

/// Absolute change of a target \[m\]. The rounding of the subtraction is ignored: 0.3 − 0.2 is not exactly 0.1.
pub(super) fn increment(from: f64, to: f64) -> f64 {
    let rounding = 4.0 * f64::EPSILON * from.abs().max(to.abs());
    ((to - from).abs() - rounding).max(0.0)
}

#[cfg(test)]
mod tests;
