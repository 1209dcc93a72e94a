//! What holds in every life, whatever befalls it. Each law is stated once, here, and is checked at every command that a rig receives, at
//! every release and at the end of every session. In: what the rig received, what was released, what the run log says. Out: the breaches.

use super::disk::{Disk, Logged};
use crate::run::replay::ResumeDecision;
use psd_plan::record::{EventKind, Outcome, Record};
use psd_plan::{Interval, Plan};
use psd_rig::emulator::EmulatedRig;

/// A law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Law {
    Released,
    InsideLimits,
    NotFaster,
    TargetDurable,
    ReadingDurable,
    NotTwice,
    Held,
    Verifies,
    Scaled,
    SameMotion,
    SameSpecimen,
    Reasoned,
    Unbroken,
    Ends,
}

impl Law {
    pub(super) const ALL: [Self; 14] = [
        Self::Released,
        Self::InsideLimits,
        Self::NotFaster,
        Self::TargetDurable,
        Self::ReadingDurable,
        Self::NotTwice,
        Self::Held,
        Self::Verifies,
        Self::Scaled,
        Self::SameMotion,
        Self::SameSpecimen,
        Self::Reasoned,
        Self::Unbroken,
        Self::Ends,
    ];

    pub(super) const fn text(self) -> &'static str {
        match self {
            Self::Released => "nothing moves without a release that named this motion",
            Self::InsideLimits => "no target is beyond the limits of its axis in force",
            Self::NotFaster => "no move is faster than the speed that was released",
            Self::TargetDurable => "a target of every axis is durable before it is sent",
            Self::ReadingDurable => "a reading is durable before the next target is logged",
            Self::NotTwice => "no target is sent twice unless the record says so",
            Self::Held => {
                "every axis of a rig that was stopped is at rest, or the record says that the hold is not confirmed"
            }
            Self::Verifies => "the run log is whole, and its replay is the run",
            Self::Scaled => "the rig moved and read what the tables state, at its scale",
            Self::SameMotion => "a run that went on has the results of one that was not disturbed",
            Self::SameSpecimen => {
                "a run goes on only on the rig, at the place and with the force that it was left with"
            }
            Self::Reasoned => "a refusal states its reason in words",
            Self::Unbroken => "psd does not panic",
            Self::Ends => "a session ends within an hour",
        }
    }
}

/// A law that was broken, and how.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Breach {
    pub(super) law: Law,
    pub(super) how: String,
}

impl Breach {
    /// What it has in common with others: its words, without numbers and entries.
    pub(super) fn kind(&self) -> String {
        let plain = self.how.split(['{', '"', '(']).next().unwrap_or_default();
        let words = plain.split_whitespace();
        let words = words.filter(|word| !word.contains(|letter: char| letter.is_ascii_digit()));
        words.collect::<Vec<_>>().join(" ")
    }
}

/// A motion that the operator released: the targets that it can have, in the coordinate of the plan, and the highest speed to each.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Released {
    /// \[m\], one per axis, and \[m/s\]. None: any target within the limits.
    targets: Vec<(Option<Vec<f64>>, f64)>,
    /// The same of the pre-test check of one axis, which counts from the place where the rig was read: within the settling band of zero.
    from_start: Vec<(f64, f64)>,
    /// \[m\]
    band: f64,
}

impl Released {
    /// The motion of a plan, as its release states it: each move at its own speed, or at that of the rig. The targets of a frame follow
    /// from its readings: a release states their limits.
    pub(super) fn of(plan: &Plan) -> Self {
        let Some(link) = plan.rig.link.as_real() else {
            return Self::default();
        };
        let number = |formula: &psd_plan::formula::Formula| match formula {
            psd_plan::formula::Formula::Constant(number) => *number,
            _ => f64::NAN,
        };
        let moves = plan
            .procedures
            .iter()
            .filter_map(|procedure| match &procedure.kind {
                psd_plan::ProcedureKind::Move(leg) => {
                    let speed = leg.speed.as_ref().map_or(link.own_speed, number);
                    Some((Some(vec![number(&leg.to)]), speed))
                }
                psd_plan::ProcedureKind::Inspect { .. } => None,
                _ => Some((None, link.own_speed)),
            });
        let probe = link.pretest_check.probe;
        Self {
            targets: moves.collect(),
            from_start: vec![(probe, link.own_speed), (0.0, link.own_speed)],
            band: plan.rig.settle.band,
        }
    }

    /// The same, and the target that a resumption sends again, if the plan does not name it.
    pub(super) fn and(mut self, decision: &ResumeDecision) -> Self {
        if let Some((target, speed)) = &decision.sends {
            let again = Some(target.clone());
            if !self.targets.iter().any(|(named, _)| *named == again) {
                self.targets.push((again, *speed));
            }
        }
        self
    }

    /// The highest speed of those that name this target, each axis to within its `near` \[m\]; None: none does.
    fn speed_to(&self, target: &[Target]) -> Option<f64> {
        let is_near = |named: f64, axis: &Target, near: f64| {
            // A sum of decimal numbers can be off by its last digit.
            (named - axis.to).abs() <= near * (1.0 + 1e-9)
        };
        let planned = self.targets.iter().filter(|(named, _)| {
            named.as_ref().is_none_or(|named| {
                let mut axes = target.iter();
                axes.all(|axis| is_near(named[axis.axis], axis, axis.near))
            })
        });
        let from_start = self.from_start.iter().filter(|(named, _)| {
            let mut axes = target.iter();
            axes.all(|axis| is_near(*named, axis, axis.near + self.band))
        });
        let planned = planned.map(|(_, speed)| *speed);
        let from_start = from_start.map(|(_, speed)| *speed);
        planned.chain(from_start).reduce(f64::max)
    }

    /// The highest speed \[m/s\].
    pub(super) fn fastest(&self) -> f64 {
        let planned = self.targets.iter().map(|(_, speed)| *speed);
        let from_start = self.from_start.iter().map(|(_, speed)| *speed);
        planned.chain(from_start).fold(0.0, f64::max)
    }
}

/// A target that an axis has received, in the coordinate of the plan.
#[derive(Clone, Copy, Debug)]
struct Target {
    axis: usize,
    /// \[m\], or \[N\] of an axial axis.
    to: f64,
    /// Distance within which it is another number.
    near: f64,
}

/// The rig before it receives something.
pub(super) struct Before {
    /// Commanded and true position of each axis, in its own coordinate \[m\].
    pub(super) positions: Vec<(f64, f64)>,
    /// Commanded force of each axis in its own coordinate \[N\]; None: it holds a displacement.
    pub(super) forces: Vec<Option<f64>>,
    /// It moved then, or within the time in which a position is read.
    pub(super) moving: bool,
}

/// Longest time between the reading of a position and its arrival as a target \[s\].
pub(super) const READ_WITHIN: f64 = 0.05;

/// Larger than any number whose words are swapped and whose second word was 0 \[m\].
const HARMLESS: f64 = 1e-30;

/// What a rig can be expected to obey, by its protocol.
#[derive(Clone, Copy, Debug)]
pub(super) struct Obeys {
    /// psd sets the speed of a move.
    pub(super) speed: bool,
    /// It is stopped by a stop command; otherwise by its present position as target.
    pub(super) stop: bool,
    /// Fraction by which a target can be rounded.
    pub(super) coarse: f64,
    /// The speed of a move follows from its travel and its time.
    pub(super) by_time: bool,
}

/// An axis, as the witness knows it.
#[derive(Clone, Debug)]
struct Axis {
    /// +1 or −1, and the zero of the plan in the coordinate of the axis \[m\].
    coordinate: (f64, f64),
    /// In the coordinate of the plan \[m\]; of an axial axis \[N\].
    limits: Interval,
    /// The highest rate of an axial axis \[N/s\].
    rate: f64,
    /// INTENT that belongs to its last move, and its moves beyond the first of one INTENT.
    last_intent: u64,
    repeated: u64,
    /// Of its last move \[m\].
    last_target: f64,
}

/// The witness of a life.
pub(super) struct Witness {
    obeys: Obeys,
    axes: Vec<Axis>,
    /// The rig's resolution and its settling band \[m\].
    resolution: f64,
    band: f64,
    pub(super) released: Option<Released>,
    moves: usize,
    violations: usize,
    /// psd was killed: what it had sent again is not in its record.
    killed: bool,
    /// A controller froze in the session before, and obeys in this one what that session sent.
    pub(super) obeys_late: bool,
    /// Moves after the last release.
    pub(super) moved: u64,
    /// Why the run must not have gone on, if anything moves now.
    pub(super) other_specimen: Option<String>,
    pub(super) breaches: Vec<Breach>,
    /// How often each law decided something.
    pub(super) decided: [u64; Law::ALL.len()],
}

impl Witness {
    /// `coordinates`: +1 or −1 and the zero of the plan for each axis, in its own coordinate \[m\].
    pub(super) fn new(
        obeys: Obeys,
        coordinates: Vec<(f64, f64)>,
        (resolution, band): (f64, f64),
    ) -> Self {
        let axis = |coordinate| Axis {
            coordinate,
            limits: Interval::ALL,
            rate: 0.0,
            last_intent: 0,
            repeated: 0,
            last_target: f64::NAN,
        };
        Self {
            obeys,
            axes: coordinates.into_iter().map(axis).collect(),
            resolution,
            band,
            released: None,
            moves: 0,
            violations: 0,
            killed: false,
            obeys_late: false,
            moved: 0,
            other_specimen: None,
            breaches: Vec::new(),
            decided: [0; Law::ALL.len()],
        }
    }

    /// The limits of this plan are in force.
    pub(super) fn limits_of(&mut self, plan: &Plan) {
        for (index, axis) in self.axes.iter_mut().enumerate() {
            let limits = plan.rig.limits_of(index, &plan.limits);
            let listed = plan.rig.listed_axes().get(index);
            axis.limits = match listed.and_then(|listed| listed.axial) {
                Some(axial) => {
                    axis.rate = axial.rate;
                    limits.force
                }
                None => limits.displacement,
            };
        }
    }

    pub(super) fn check(&mut self, law: Law, holds: bool, how: impl FnOnce() -> String) {
        self.decided[law as usize] += 1;
        if !holds {
            self.breaches.push(Breach { law, how: how() });
        }
    }

    /// A session begins, and nothing has moved. Nothing is released, unless the rig still `obeys_late` what was released before.
    pub(super) fn begin(&mut self, obeys_late: bool) {
        (self.moved, self.other_specimen, self.obeys_late) = (0, None, obeys_late);
        if !obeys_late {
            (self.released, self.killed) = (None, false);
        }
    }

    /// What someone else did to the rig is not psd's.
    pub(super) fn look_away(&mut self, rig: &EmulatedRig) {
        (self.moves, self.violations) = (rig.moves().len(), rig.violations().len());
    }

    /// Looks at what the rig has received since the last look.
    pub(super) fn look(&mut self, rig: &EmulatedRig, before: &Before, disk: &Disk) {
        let refused = rig.violations().len() > self.violations;
        let sent = self.moves..rig.moves().len();
        self.look_away(rig);
        if refused && sent.is_empty() {
            let target = rig.violations().last().copied();
            self.check(Law::InsideLimits, false, || {
                let target = target.unwrap_or(f64::NAN);
                format!("the rig refused {target:.6} m, in the coordinate of its axis")
            });
        }
        for sent in &rig.moves()[sent] {
            let axes = sent.actuators.iter().zip(&sent.targets);
            let targets: Vec<Target> = axes.map(|(axis, own)| self.target(*axis, *own)).collect();
            if self.moves_nothing(&targets, sent.speed, before) {
                continue;
            }
            // All axes arrive at the same time: the speed is that of the longest way.
            let ways = targets.iter().map(|target| {
                let own = self.own(*target);
                let (commanded, position) = before.positions[target.axis];
                ((own - commanded).abs(), (own - position).abs())
            });
            let (from_command, travel) =
                ways.fold(
                    (0.0, 0.0),
                    |longest: (f64, f64), way| {
                        if way.0 > longest.0 { way } else { longest }
                    },
                );
            // A ramp has a time: an actuator that lags behind its command has another travel in the same time.
            let speed = if self.obeys.by_time && from_command > 0.0 {
                sent.speed * travel / from_command
            } else {
                sent.speed
            };
            self.moves_to(&targets, speed, travel, disk.logged());
        }
        for axis in 0..self.axes.len() {
            let Some(control) = rig.force_control(axis) else {
                continue;
            };
            // A hold by its present force.
            let is_held = rig.axial_force(axis) == Some(control.target);
            if before.forces[axis] == Some(control.target) || is_held {
                continue;
            }
            let rate = self.axes[axis].rate;
            self.check(Law::NotFaster, control.rate <= rate, || {
                format!(
                    "the load grows by {} N/s, the plan has {rate} N/s",
                    control.rate
                )
            });
            let (sign, _) = self.axes[axis].coordinate;
            let target = Target {
                axis,
                to: sign * control.target,
                near: 1e-3,
            };
            self.moves_to(&[target], 0.0, 0.0, disk.logged());
        }
    }

    /// A target in the coordinate of the plan, from one in the coordinate of its axis \[m\].
    fn target(&self, axis: usize, own: f64) -> Target {
        let (sign, zero) = self.axes[axis].coordinate;
        // Before the word order of a drive is known, a target has only the bits of its first word.
        let coarse = self.obeys.coarse * own.abs();
        Target {
            axis,
            to: sign * (own - zero),
            near: self.resolution.max(1e-7) + coarse,
        }
    }

    /// In the coordinate of its axis \[m\].
    fn own(&self, target: Target) -> f64 {
        let (sign, zero) = self.axes[target.axis].coordinate;
        sign * target.to + zero
    }

    /// Whether these targets are a hold, or a command that moves nothing.
    fn moves_nothing(&self, targets: &[Target], speed: f64, before: &Before) -> bool {
        let is_hold = |target: &Target| {
            let (commanded, position) = before.positions[target.axis];
            // A hold by a target: a rig that moves has gone on since its position was read.
            let moving = before.moving || (commanded - position).abs() > self.resolution;
            let passed = if moving { READ_WITHIN * speed } else { 0.0 };
            let own = self.own(*target);
            let is_at = |position: f64| (own - position).abs() <= 3.0 * self.resolution + passed;
            is_at(commanded) || is_at(position)
        };
        // So near 0 is only the harmless target of a drive with the other word order.
        let is_harmless = |target: &Target| target.to != 0.0 && self.own(*target).abs() < HARMLESS;
        // A command that arrived twice waits in a controller with a queue, until the rig is there: it moves nothing.
        let is_late = |target: &Target| target.to == self.axes[target.axis].last_target;
        (!self.obeys.stop && targets.iter().all(is_hold))
            || targets.iter().all(is_harmless)
            || (self.released.is_none() && targets.iter().all(is_late))
    }

    fn moves_to(&mut self, targets: &[Target], speed: f64, travel: f64, logged: Option<Logged>) {
        self.moved += 1;
        let to: Vec<f64> = targets.iter().map(|target| target.to).collect();
        for target in targets {
            let Interval { low, high } = self.axes[target.axis].limits;
            let (to, near) = (target.to, target.near);
            self.check(
                Law::InsideLimits,
                low - near <= to && to <= high + near,
                || format!("the rig moves to {to:e}, the limits are {low} .. {high}"),
            );
        }
        let released = self.released.as_ref();
        let released = released.map(|released| released.speed_to(targets));
        let named = released.flatten();
        self.check(Law::Released, named.is_some(), || match released {
            None => format!("the rig moves before any release to {to:?} m"),
            Some(_) => format!("no release named that the rig moves to {to:?} m"),
        });
        // A ramp that is obeyed late keeps its time, but someone may have moved the rig meanwhile.
        let obeys_speed = self.obeys.speed && !(self.obeys_late && self.obeys.by_time);
        if let Some(named) = named.filter(|_| obeys_speed) {
            // A ramp has a time: its speed is as exact as the position from which its travel was computed.
            let slack = 1e-3
                + if self.obeys.by_time {
                    2.0 * self.band / travel
                } else {
                    0.0
                };
            self.check(Law::NotFaster, speed <= named * (1.0 + slack), || {
                format!("the rig moves at {speed} m/s to {to:?} m, released was {named} m/s")
            });
        }
        let number = logged.as_ref().map_or(0, |logged| logged.number);
        let axes = self.axes.len();
        let durable = logged.is_some_and(|logged| {
            let mut named = targets.iter();
            logged.durable
                && logged.targets.len() == axes
                && named
                    .all(|target| (logged.targets[target.axis] - target.to).abs() <= target.near)
        });
        self.check(Law::TargetDurable, durable, || {
            format!("the last durable INTENT does not name that the rig moves to {to:?} m")
        });
        for target in targets {
            let axis = &mut self.axes[target.axis];
            if number == axis.last_intent && !self.killed {
                axis.repeated += 1;
            }
            (axis.last_intent, axis.last_target) = (number, target.to);
        }
        if let Some(reason) = self.other_specimen.take() {
            self.check(Law::SameSpecimen, false, || reason);
        }
    }

    /// psd ended without its last words: its record states no more than `allowed` repeated targets.
    pub(super) fn ended_without_words(&mut self, allowed: u64) {
        self.killed = true;
        for axis in &mut self.axes {
            axis.repeated = axis.repeated.min(allowed);
        }
    }

    /// A session ended without a kill. `allowed` is the number of repeated targets that the record states.
    pub(super) fn session_ended(&mut self, record: &Record, at_rest: bool, allowed: u64) {
        let said = record
            .events
            .iter()
            .rev()
            .find_map(|event| match event.kind {
                EventKind::Held => Some(true),
                EventKind::NotHeld => Some(false),
                _ => None,
            });
        let stopped = !matches!(
            record.outcome,
            Outcome::Completed | Outcome::NotReleased { .. }
        );
        if stopped && self.moved > 0 {
            self.check(Law::Held, said.is_some(), || {
                format!("{:?}, and no word about the hold", record.outcome)
            });
        }
        if said != Some(false) {
            self.check(Law::Held, at_rest, || {
                format!("{:?}, and the rig still moves", record.outcome)
            });
        }
        for axis in 0..self.axes.len() {
            let repeated = self.axes[axis].repeated;
            self.check(Law::NotTwice, repeated <= allowed, || {
                format!("{repeated} targets were sent again, the record states {allowed}")
            });
        }
    }
}
