//! The guard: the only access of `run` and `procedures` to a rig. In: requested motions and
//! readings. Out: readings, each inside every limit. It proposes nothing beyond a limit, clamps
//! nothing, and holds the rig on any fault. It knows no procedure.

pub(crate) mod about;
pub(crate) mod final_hold;
pub(crate) mod glide;
pub(crate) mod path;
pub(crate) mod read;
pub(crate) mod speed;

use super::guard::read::is_finite;
use super::holds::Holds;
use super::safety::failpoint::{Guarding, on};
use super::{LimitedQuantity, Reading, Rig, RigFault, named_axis};
use crate::plan::{Interval, Limits};

/// A rig and what nothing may drive it past.
pub struct Guard<'rig> {
    pub(super) rig: &'rig mut dyn Rig,
    pub(super) limits: Limits,
    /// Of each axis, where one has limits of its own; empty: those above hold for all.
    pub(super) own: Vec<Limits>,
    /// The last target carried out, m; at first where the rig was found.
    pub(super) commanded: Vec<f64>,
    /// Velocities at the end of the last path, m/s; none at rest.
    pub(super) going: Vec<f64>,
    /// Whether the rig has settled at `commanded`, so that a reading shows the tracking error.
    pub(super) settled: bool,
    /// Checked, and not yet carried out: targets, m, and the speed that the bytes say, m/s.
    pub(super) proposed: Option<(Vec<f64>, f64)>,
    /// Of the last way, m/s.
    pub(super) speed: Option<f64>,
    /// Rig time when the rig last answered, s.
    pub(super) heard: f64,
    /// Where holds are to be told.
    pub(super) holds: Option<Holds>,
    /// The first reading: displacements, m, and forces, N.
    pub(super) found: (Vec<f64>, Vec<f64>),
    /// The reading that broke a limit last, if it is one.
    pub(super) broken: Option<Reading>,
}

/// Readings of a traverse, all inside the limits, and what ended it early.
#[derive(Debug)]
pub struct Traversed {
    pub readings: Vec<Reading>,
    pub fault: Option<RigFault>,
}

impl<'rig> Guard<'rig> {
    /// Reads where the rig stands.
    ///
    /// # Errors
    /// It cannot be read, or stands outside a limit already.
    pub fn new(rig: &'rig mut dyn Rig, limits: Limits) -> Result<Self, RigFault> {
        Self::of_axes(rig, limits, Vec::new())
    }

    /// The same with displacement and force of each axis inside its `own` limits.
    ///
    /// # Errors
    /// As [`Guard::new`].
    pub fn of_axes(
        rig: &'rig mut dyn Rig,
        limits: Limits,
        own: Vec<Limits>,
    ) -> Result<Self, RigFault> {
        let heard = rig.time();
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
            heard,
            holds: None,
            found,
            broken: None,
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

    /// The last targets carried out, m.
    #[must_use]
    pub fn commanded(&self) -> &[f64] {
        &self.commanded
    }

    /// Rig time of the last reading, or of the fault after it, s: what the record knows too. A move or a pause that nothing was
    /// read after has taken time that no record tells, so that no event may be told at a time within it.
    #[must_use]
    pub const fn time(&self) -> f64 {
        self.heard
    }

    /// Moves to `targets` (m) in one increment and settles. Without a speed (m/s): the rig's own, else the highest
    /// that the plan allows.
    ///
    /// # Errors
    /// A limit stands in the way, or the rig fails.
    pub fn move_to(&mut self, targets: &[f64], speed: Option<f64>) -> Result<(), RigFault> {
        self.propose(targets, speed)?;
        self.execute()
    }

    /// The first half of [`Guard::move_to`]: everything is checked, nothing moves. What was proposed before is forgotten.
    ///
    /// # Errors
    /// A limit stands in the way, or the rig refuses.
    pub fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<(), RigFault> {
        self.proposed = None;
        let high = Some(self.limits.speed.high).filter(|high| high.is_finite());
        let own = || {
            self.rig
                .own_speed()
                .map(|own| own.min(self.limits.speed.high))
        };
        let speed = speed.or_else(|| own().or(high));
        self.check_targets(targets)?;
        let increments = targets
            .iter()
            .zip(&self.commanded)
            .map(|(to, from)| increment(*from, *to));
        let longest = increments.fold(0.0, f64::max);
        self.check(LimitedQuantity::Increment, self.limits.increment, longest)?;
        if let Some(speed) = speed {
            self.check(LimitedQuantity::Speed, self.limits.speed, speed)?;
        }
        let proposed = self.rig.propose(targets, speed);
        let offer = self.or_hold(proposed)?;
        // What the bytes say is what moves: they are held against the limits once more, as they will be sent.
        self.check_targets(&offer.targets)?;
        self.check(LimitedQuantity::Speed, self.limits.speed, offer.speed)?;
        self.proposed = Some((targets.to_vec(), offer.speed));
        Ok(())
    }

    /// The other half: carries out what was proposed last, and settles.
    ///
    /// # Errors
    /// The rig fails, or nothing was proposed that may be carried out.
    pub fn execute(&mut self) -> Result<(), RigFault> {
        let Some((targets, told)) = self.proposed.take() else {
            self.hold();
            return Err(RigFault::Device(
                "nothing was proposed to execute".to_owned(),
            ));
        };
        self.leave();
        self.going.clear();
        let executed = self.rig.execute();
        self.or_hold(executed)?;
        self.went(told);
        self.commanded = targets;
        self.settled = true;
        Ok(())
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

    /// Moves at constant velocity (m/s, signed) to `targets`, reading on the way; the last reading is the one that broke a limit, if
    /// any did. The limit on the increment is not for it, since its target goes along evenly; the one on the tracking error is for
    /// settled readings.
    pub fn traverse(&mut self, targets: &[f64], velocity: f64, samples: usize) -> Traversed {
        let refused = |fault| Traversed {
            readings: Vec::new(),
            fault: Some(fault),
        };
        let allowed = self
            .check_targets(targets)
            .and_then(|()| self.check(LimitedQuantity::Speed, self.limits.speed, velocity.abs()));
        if let Err(fault) = allowed {
            return refused(fault);
        }
        self.leave();
        self.going.clear();
        self.speed = Some(velocity.abs());
        let (limits, own) = (self.limits, self.own.clone());
        let mut readings = Vec::with_capacity(samples);
        let (mut heard, mut broken) = (self.heard, None);
        // Each reading is judged as it comes: a rig that is past a limit is held before its stroke ends.
        let traversed = self
            .rig
            .traverse(targets, velocity, samples, &mut |reading| {
                heard = reading.time;
                if let Some(fault) = outside(&limits, &own, &reading) {
                    broken = Some(reading).filter(is_finite);
                    return Err(fault);
                }
                readings.push(reading);
                Ok(())
            });
        self.heard = heard;
        readings.extend(broken.clone());
        self.broken = broken;
        let fault = self.or_hold(traversed).err();
        if fault.is_none() {
            self.commanded.copy_from_slice(targets);
        }
        Traversed { readings, fault }
    }

    /// Holds the rig if the energy error (a fraction of the input) lies outside its limit, where one is set.
    ///
    /// # Errors
    /// It does.
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

    /// Holds the rig if what tracking puts into the test or takes out (a share of its input energy), or the NRMS tracking
    /// error, lies outside its limit. The first has a limit always.
    ///
    /// # Errors
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

    /// Share of the input energy up to which tracking may err: the plan's, else the default.
    #[must_use]
    pub fn tracking_energy_limit(&self) -> Interval {
        self.limits.held().tracking_energy_error
    }

    /// Stops all motion and keeps the load. What was proposed is forgotten.
    pub fn hold(&mut self) {
        self.proposed = None;
        self.going.clear();
        self.rig.hold();
    }

    pub(super) fn check_targets(&mut self, targets: &[f64]) -> Result<(), RigFault> {
        if targets.len() != self.commanded.len() {
            self.hold();
            let reason = format!(
                "{} targets for a rig of {} degrees of freedom",
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
            .try_for_each(|(place, target)| self.check_target(place, *target))
    }

    /// Whether the axis at `place` may go to `target` (m).
    pub(super) fn check_target(&mut self, place: usize, target: f64) -> Result<(), RigFault> {
        let limit = self.own.get(place).unwrap_or(&self.limits).displacement;
        if inside(limit, target) {
            return Ok(());
        }
        Err(self.breach(
            LimitedQuantity::TargetDisplacement,
            Some(place),
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

    /// `place`: of the axis, where it is the quantity of one.
    pub(super) fn breach(
        &mut self,
        quantity: LimitedQuantity,
        place: Option<usize>,
        limit: Interval,
        value: f64,
    ) -> RigFault {
        self.hold();
        let axis = place.and_then(|place| named_axis(place, self.commanded.len()));
        RigFault::LimitBreached {
            quantity,
            value,
            low: limit.low,
            high: limit.high,
            axis,
        }
    }

    pub(super) fn or_hold<T>(&mut self, outcome: Result<T, RigFault>) -> Result<T, RigFault> {
        if let Err(fault) = &outcome {
            // A limit is the guard's own word.
            if !matches!(fault, RigFault::LimitBreached { .. }) {
                self.heard = self.rig.time();
            }
            self.hold();
        }
        outcome
    }
}

/// Infinity is inside "no limit", but no place for a rig.
fn inside(limit: Interval, value: f64) -> bool {
    limit.contains(value) && value.is_finite()
}

/// The first value of a reading that lies outside its limit: those of its axis, where it has any of its own.
pub(super) fn outside(limits: &Limits, own: &[Limits], reading: &Reading) -> Option<RigFault> {
    let of = |place: usize| own.get(place).unwrap_or(limits);
    let places = (0..).zip(&reading.displacement);
    let displacements = places.map(|(at, x)| {
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

/// Size of a change of target, m. The rounding of the subtraction is not held against the plan: 0.3 − 0.2 is not quite 0.1.
pub(super) fn increment(from: f64, to: f64) -> f64 {
    let rounding = 4.0 * f64::EPSILON * from.abs().max(to.abs());
    ((to - from).abs() - rounding).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::{DeclaredNoise, EachReading, Identity, Offer};

    /// Says what it is told to say, and remembers what it was asked.
    #[derive(Default)]
    struct Scripted {
        displacement: f64,
        /// Added to the displacement after a move.
        error: f64,
        force: f64,
        /// Added to a target on its way into the bytes.
        misspoken: f64,
        proposed: Vec<(f64, Option<f64>)>,
        held: bool,
    }

    impl Rig for Scripted {
        fn identity(&self) -> Identity {
            let nothing = String::new;
            Identity {
                name: nothing(),
                model: nothing(),
                serial: nothing(),
                firmware: nothing(),
                boot: None,
                simulated: true,
            }
        }
        fn degrees_of_freedom(&self) -> usize {
            1
        }
        fn time(&self) -> f64 {
            0.0
        }
        fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<Offer, RigFault> {
            self.proposed.push((targets[0], speed));
            let said = targets[0] + self.misspoken;
            Ok(Offer {
                targets: vec![said],
                speed: speed.unwrap_or(0.0),
                wire: Vec::new(),
                move_id: None,
                at_the_rig: None,
            })
        }
        fn execute(&mut self) -> Result<(), RigFault> {
            self.displacement = self.proposed.last().unwrap().0 + self.error;
            Ok(())
        }
        fn pause(&mut self, _: f64) -> Result<(), RigFault> {
            Ok(())
        }
        fn read(&mut self) -> Result<Reading, RigFault> {
            Ok(Reading {
                time: 0.0,
                displacement: vec![self.displacement],
                force: vec![self.force],
                raw: Vec::new(),
            })
        }
        fn traverse(
            &mut self,
            _: &[f64],
            _: f64,
            samples: usize,
            each: EachReading<'_>,
        ) -> Result<(), RigFault> {
            let force = |sample: usize| if sample < 2 { self.force } else { f64::NAN };
            let reading = |sample| Reading {
                time: 0.0,
                displacement: vec![0.0],
                force: vec![force(sample)],
                raw: Vec::new(),
            };
            (0..samples).map(reading).try_for_each(each)
        }
        fn hold(&mut self) {
            self.held = true;
        }
        fn declared_noise(&self) -> DeclaredNoise {
            DeclaredNoise::default()
        }
    }

    const LIMITS: Limits = Limits {
        displacement: Interval {
            low: -0.002,
            high: 0.025,
        },
        force: Interval {
            low: -100.0,
            high: 100.0,
        },
        speed: Interval {
            low: 0.0,
            high: 0.01,
        },
        increment: Interval {
            low: 0.0,
            high: 0.001,
        },
        tracking_error: Interval {
            low: 0.0,
            high: 1e-4,
        },
        energy_error: Interval {
            low: 0.0,
            high: 0.05,
        },
        ..Limits::NONE
    };

    fn quantity(fault: RigFault) -> LimitedQuantity {
        match fault {
            RigFault::LimitBreached { quantity, .. } => quantity,
            other => panic!("{other:?}"),
        }
    }

    /// What one move breaches, having proposed nothing.
    fn refused(target: f64, speed: Option<f64>) -> LimitedQuantity {
        let mut rig = Scripted::default();
        let fault = Guard::new(&mut rig, LIMITS)
            .unwrap()
            .move_to(&[target], speed)
            .unwrap_err();
        assert!(
            rig.proposed.is_empty(),
            "nothing beyond a limit is proposed"
        );
        assert!(rig.held);
        quantity(fault)
    }

    #[test]
    fn targets_increments_and_speeds_beyond_a_limit_are_never_proposed() {
        assert_eq!(refused(-0.003, None), LimitedQuantity::TargetDisplacement);
        assert_eq!(refused(f64::NAN, None), LimitedQuantity::TargetDisplacement);
        assert_eq!(refused(0.0015, None), LimitedQuantity::Increment);
        assert_eq!(refused(0.001, Some(0.02)), LimitedQuantity::Speed);
        assert_eq!(refused(0.001, Some(f64::NAN)), LimitedQuantity::Speed);
    }

    #[test]
    fn what_the_bytes_say_is_held_against_the_limits_too() {
        // 25 mm is allowed; rounded into the bytes it would be more.
        let mut rig = Scripted {
            displacement: 0.0248,
            misspoken: 3e-4,
            ..Scripted::default()
        };
        let fault = Guard::new(&mut rig, LIMITS)
            .unwrap()
            .move_to(&[0.0249], None)
            .unwrap_err();
        assert_eq!(quantity(fault), LimitedQuantity::TargetDisplacement);
        assert!(rig.held && rig.displacement == 0.0248, "not carried out");
    }

    #[test]
    fn what_was_refused_or_carried_out_is_not_carried_out_again() {
        let mut rig = Scripted::default();
        let mut guard = Guard::new(&mut rig, LIMITS).unwrap();
        assert!(guard.execute().is_err(), "nothing was proposed");
        guard.propose(&[0.0005], None).unwrap();
        assert_eq!(guard.commanded(), [0.0], "nothing moved yet");
        assert!(guard.propose(&[0.03], None).is_err());
        assert!(
            guard.execute().is_err(),
            "the proposal before it is forgotten"
        );
        guard.propose(&[0.0005], None).unwrap();
        guard.hold();
        assert!(guard.execute().is_err(), "held in between");
        guard.propose(&[0.0005], None).unwrap();
        guard.execute().unwrap();
        assert_eq!(guard.commanded(), [0.0005]);
        assert!(guard.execute().is_err());
        assert_eq!(rig.displacement, 0.0005);
    }

    #[test]
    fn without_limits_a_target_that_is_no_number_still_never_passes() {
        for target in [f64::NAN, f64::INFINITY] {
            let mut rig = Scripted::default();
            assert!(
                Guard::new(&mut rig, Limits::NONE)
                    .unwrap()
                    .move_to(&[target], None)
                    .is_err()
            );
            assert!(rig.held && rig.proposed.is_empty());
        }
    }

    #[test]
    fn a_reading_that_is_no_number_or_beyond_a_limit_holds_the_rig() {
        for (force, error, expected) in [
            (f64::NAN, 0.0, LimitedQuantity::Force),
            (101.0, 0.0, LimitedQuantity::Force),
            (0.0, f64::NAN, LimitedQuantity::MeasuredDisplacement),
            (0.0, 2e-4, LimitedQuantity::TrackingError),
        ] {
            let mut rig = Scripted {
                error,
                ..Scripted::default()
            };
            let mut guard = Guard::new(&mut rig, LIMITS).unwrap();
            guard.move_to(&[0.001], None).unwrap();
            rig.force = force;
            let (commanded, own, going, holds, speed) =
                (vec![0.001], Vec::new(), Vec::new(), None, None);
            let (settled, proposed, heard, found) = (true, None, 0.0, (Vec::new(), Vec::new()));
            let mut guard = Guard {
                rig: &mut rig,
                limits: LIMITS,
                own,
                commanded,
                going,
                settled,
                proposed,
                speed,
                heard,
                holds,
                found,
                broken: None,
            };
            assert_eq!(quantity(guard.read().unwrap_err()), expected);
            assert!(rig.held);
        }
        let mut rig = Scripted {
            force: f64::NAN,
            ..Scripted::default()
        };
        assert!(Guard::new(&mut rig, Limits::NONE).is_err());
    }

    #[test]
    fn the_bound_itself_is_inside_and_rounding_of_an_increment_is_not_held_against_it() {
        let mut rig = Scripted::default();
        let mut guard = Guard::new(&mut rig, LIMITS).unwrap();
        for step in 1..=25 {
            guard
                .move_to(&[f64::from(step) * 0.001], Some(0.01))
                .unwrap();
        }
        assert_eq!(guard.commanded(), [0.025]);
        assert_eq!(guard.way_to(&[0.0]).len(), 25);
        for target in guard.way_to(&[0.0]) {
            guard.move_to(&target, None).unwrap();
        }
        assert_eq!(
            rig.proposed.last(),
            Some(&(0.0, Some(0.01))),
            "the limit is the speed where none is asked"
        );
    }

    #[test]
    fn a_traverse_keeps_what_was_read_before_a_bad_reading() {
        let mut rig = Scripted::default();
        let mut guard = Guard::new(&mut rig, LIMITS).unwrap();
        let traversed = guard.traverse(&[0.01], 0.01, 5);
        assert_eq!(traversed.readings.len(), 2);
        assert_eq!(quantity(traversed.fault.unwrap()), LimitedQuantity::Force);
        assert_eq!(
            quantity(guard.traverse(&[0.01], -0.02, 5).fault.unwrap()),
            LimitedQuantity::Speed
        );
        assert!(guard.check_energy_error(-0.05).is_ok());
        assert_eq!(
            quantity(guard.check_energy_error(f64::NAN).unwrap_err()),
            LimitedQuantity::EnergyError
        );
        assert!(rig.held);
    }
}
