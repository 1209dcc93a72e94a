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
    SameSpecimen,
    Reasoned,
    Unbroken,
    Ends,
}

impl Law {
    pub(super) const ALL: [Self; 12] = [
        Self::Released,
        Self::InsideLimits,
        Self::NotFaster,
        Self::TargetDurable,
        Self::ReadingDurable,
        Self::NotTwice,
        Self::Held,
        Self::Verifies,
        Self::SameSpecimen,
        Self::Reasoned,
        Self::Unbroken,
        Self::Ends,
    ];

    pub(super) const fn text(self) -> &'static str {
        match self {
            Self::Released => "nothing moves without a release that named this motion",
            Self::InsideLimits => "no target is beyond the limits in force",
            Self::NotFaster => "no move is faster than the speed that was released",
            Self::TargetDurable => "a target is durable before it is sent",
            Self::ReadingDurable => "a reading is durable before the next target is logged",
            Self::NotTwice => "no target is sent twice unless the record says so",
            Self::Held => {
                "a rig that was stopped is at rest, or the record says that the hold is not confirmed"
            }
            Self::Verifies => "the run log is whole, and its replay is the run",
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
    /// \[m\] and \[m/s\]
    pub(super) targets: Vec<(f64, f64)>,
    /// The same of the pre-test check, which counts from the place where the rig was read: within the settling band of zero.
    from_start: Vec<(f64, f64)>,
    /// \[m\]
    band: f64,
}

impl Released {
    /// The motion of a plan, as its release states it: each move at its own speed, or at that of the rig.
    pub(super) fn of(plan: &Plan) -> Self {
        let Some(link) = plan.rig.link.as_real() else {
            return Self::default();
        };
        let moves = plan
            .procedures
            .iter()
            .filter_map(|procedure| match &procedure.kind {
                psd_plan::ProcedureKind::Move(leg) => {
                    let number = |formula: &psd_plan::formula::Formula| match formula {
                        psd_plan::formula::Formula::Constant(number) => *number,
                        _ => f64::NAN,
                    };
                    let speed = leg.speed.as_ref().map_or(link.own_speed, number);
                    Some((number(&leg.to), speed))
                }
                _ => None,
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
        if let Some((target, speed)) = &decision.sends
            && !self.targets.iter().any(|(named, _)| *named == target[0])
        {
            self.targets.push((target[0], *speed));
        }
        self
    }

    /// The highest speed of those that name this target to within `near` \[m\]; None: none does.
    fn speed_to(&self, target: f64, near: f64) -> Option<f64> {
        let named = |targets: &[(f64, f64)], near: f64| {
            // A sum of decimal numbers can be off by its last digit.
            let near = near * (1.0 + 1e-9);
            let named = targets
                .iter()
                .filter(|(named, _)| (named - target).abs() <= near);
            named.map(|(_, speed)| *speed).reduce(f64::max)
        };
        let from_start = named(&self.from_start, near + self.band);
        let planned = named(&self.targets, near);
        planned.into_iter().chain(from_start).reduce(f64::max)
    }

    /// The highest speed \[m/s\].
    pub(super) fn fastest(&self) -> f64 {
        let all = self.targets.iter().chain(&self.from_start);
        all.map(|(_, speed)| *speed).fold(0.0, f64::max)
    }
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

/// The witness of a life.
pub(super) struct Witness {
    pub(super) obeys: Obeys,
    /// +1 or −1, and the zero of the plan in the coordinate of the rig \[m\].
    pub(super) coordinate: (f64, f64),
    /// In the coordinate of the plan \[m\].
    pub(super) limits: Interval,
    /// The rig's resolution and its settling band \[m\].
    pub(super) resolution: f64,
    pub(super) band: f64,
    pub(super) released: Option<Released>,
    moves: usize,
    violations: usize,
    /// INTENT that belongs to the last move, and the moves beyond the first of one INTENT.
    last_intent: u64,
    /// Of the last move \[m\].
    last_target: f64,
    pub(super) repeated: u64,
    /// psd was killed: what it had sent again is not in its record.
    pub(super) killed: bool,
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
    pub(super) fn new(
        obeys: Obeys,
        coordinate: (f64, f64),
        limits: Interval,
        (resolution, band): (f64, f64),
    ) -> Self {
        Self {
            obeys,
            coordinate,
            limits,
            resolution,
            band,
            released: None,
            moves: 0,
            violations: 0,
            last_intent: 0,
            last_target: f64::NAN,
            repeated: 0,
            killed: false,
            obeys_late: false,
            moved: 0,
            other_specimen: None,
            breaches: Vec::new(),
            decided: [0; Law::ALL.len()],
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

    /// Looks at what the rig has received since the last look. `positions` are its commanded and its true position before \[m\]; `moving`:
    /// it moved then, or within the time in which a position is read.
    pub(super) fn look(
        &mut self,
        rig: &EmulatedRig,
        (positions, moving): ([f64; 2], bool),
        disk: &Disk,
    ) {
        let refused = rig.violations().len() > self.violations;
        let (sign, zero) = self.coordinate;
        let sent: Vec<(f64, f64)> = rig.moves()[self.moves..]
            .iter()
            .map(|sent| (sign * (sent.targets[0] - zero), sent.speed))
            .collect();
        let refused_target = rig.violations().last().map(|target| sign * (target - zero));
        self.look_away(rig);
        if refused && sent.is_empty() {
            self.check(Law::InsideLimits, false, || {
                format!(
                    "the rig refused {:.6} m",
                    refused_target.unwrap_or(f64::NAN)
                )
            });
        }
        for (target, speed) in sent {
            // A hold by a target: a rig that moves has gone on since its position was read.
            let moving = moving || (positions[0] - positions[1]).abs() > self.resolution;
            let passed = if moving { READ_WITHIN * speed } else { 0.0 };
            let is_hold = |position: f64| {
                (target - sign * (position - zero)).abs() <= 3.0 * self.resolution + passed
            };
            if !self.obeys.stop && positions.into_iter().any(is_hold) {
                continue;
            }
            // So near 0 is only the harmless target of a drive with the other word order.
            if target != 0.0 && (sign * target + zero).abs() < HARMLESS {
                continue;
            }
            // A command that arrived twice waits in a controller with a queue, until the rig is there: it moves nothing.
            if target == self.last_target && self.released.is_none() {
                continue;
            }
            let travels = positions.map(|position| (target - sign * (position - zero)).abs());
            // A ramp has a time: an actuator that lags behind its command has another travel in the same time.
            let speed = if self.obeys.by_time && travels[0] > 0.0 {
                speed * travels[1] / travels[0]
            } else {
                speed
            };
            self.moves_to(target, speed, travels[1], disk.logged());
        }
    }

    fn moves_to(&mut self, target: f64, speed: f64, travel: f64, logged: Option<Logged>) {
        self.moved += 1;
        let (sign, zero) = self.coordinate;
        // Before the word order of a drive is known, a target has only the bits of its first word.
        let coarse = self.obeys.coarse * (sign * target + zero).abs();
        let near = self.resolution.max(1e-7) + coarse;
        let Interval { low, high } = self.limits;
        self.check(
            Law::InsideLimits,
            low - near <= target && target <= high + near,
            || format!("the rig moves to {target:e} m, the limits are {low} .. {high} m"),
        );
        let released = self.released.as_ref();
        let released = released.map(|released| released.speed_to(target, near));
        let named = released.flatten();
        self.check(Law::Released, named.is_some(), || match released {
            None => format!("the rig moves to {target:e} m before any release"),
            Some(_) => format!("the rig moves to {target:e} m, which no release named"),
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
                format!("the rig moves to {target} m at {speed} m/s, released was {named} m/s")
            });
        }
        let number = logged.as_ref().map_or(0, |logged| logged.number);
        let durable = logged.is_some_and(|logged| {
            logged.durable
                && logged
                    .targets
                    .first()
                    .is_some_and(|logged| (logged - target).abs() <= near)
        });
        self.check(Law::TargetDurable, durable, || {
            format!("the rig moves to {target:e} m, which is not the last durable INTENT")
        });
        if number == self.last_intent && !self.killed {
            self.repeated += 1;
        }
        (self.last_intent, self.last_target) = (number, target);
        if let Some(reason) = self.other_specimen.take() {
            self.check(Law::SameSpecimen, false, || reason);
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
        let repeated = self.repeated;
        self.check(Law::NotTwice, repeated <= allowed, || {
            format!("{repeated} targets were sent again, the record states {allowed}")
        });
    }
}
