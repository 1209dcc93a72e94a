//! Motion of a real rig. In: a proposed move. Out: the rig settled at its target, or the reason why not. Every wait is
//! bounded, observes stop requests, and keeps the heartbeat of the devices alive.

use super::poll::Point;
use super::settle::{Disturbed, Settling, SettlingReading};
use super::{Axis, DeviceRole, ProposedMove, RealRig};
use crate::controllers::SLICE;
use crate::safety::failpoint::{Guarding, on};
use crate::{LimitedQuantity, Reading, RigFault, named_axis, who};
use psd_plan::{Interval, Settle};
use psd_text::units::{Dimension, display};

/// Largest deviation of an axis from its path before it is held: a number of settling bands, and a fraction of the longest
/// travel. The overshoot of a servo is smaller, and so is the motion that a moving neighbour causes.
const BESIDE_BANDS: f64 = 2.0;
const BESIDE_TRAVEL: f64 = 0.25;
/// Number of standard deviations of the noise that two readings of the same force cannot differ by chance.
const LEAP: f64 = 6.0;

impl RealRig {
    /// Sends the proposed move and waits until the rig has settled.
    pub(super) fn carry_out(&mut self) -> Result<(), RigFault> {
        let began = self.clock.now();
        let farthest = self
            .proposed
            .as_ref()
            .map(|proposed| self.farthest(proposed));
        let (targets, seconds) = self.set_off()?;
        let there = self.settle_at(&targets, self.clock.now() + seconds)?;
        self.settled = Some(targets);
        // The time on the line counts as part of the motion: it was not slower than this.
        self.seen_speed = farthest
            .map(|farthest| farthest / (there - began))
            .filter(|speed| speed.is_finite());
        Ok(())
    }

    /// Waits until every axis has settled, all in one sampling: an axis that another one disturbs begins its dwell again.
    /// `arrival` (\[s\], by the clock) is the expected arrival of the axis with the longest travel. Gives the time when all
    /// were seen to be settled \[s\].
    pub(super) fn settle_at(&mut self, targets: &[f64], arrival: f64) -> Result<f64, RigFault> {
        let mut settling = self.settling(targets);
        let mut rested = None;
        loop {
            let point = self.poll()?;
            let now = self.clock.now();
            self.seen_positions.push((now, point.displacement[0]));
            self.watch(&point)?;
            let controlled = self.controlled(&point);
            let astray = first_astray(&settling, &controlled);
            // A device that cannot report whether it moves, or reports rest before it has begun, is given the duration of
            // the travel.
            let there = point.moving == Some(false) && astray.is_none();
            let rests = there || point.moving != Some(true) && now >= arrival;
            if rests {
                rested.get_or_insert(now);
            }
            let steady = rests && !point.unsettled;
            if !on(Guarding::Settling) && rests {
                return Ok(now);
            }
            let readings = settling.iter_mut().zip(controlled.iter().zip(&point.force));
            let met: Vec<bool> = readings
                .map(|(axis, (x, force))| {
                    axis.add_reading(&SettlingReading {
                        time: now,
                        controlled: *x,
                        force: *force,
                        steady,
                    })
                })
                .collect();
            let Some(unmet) = met.iter().position(|met| !met) else {
                self.rested = settling.iter().map(Settling::rested).collect();
                return Ok(rested.unwrap_or(now));
            };
            if now - rested.unwrap_or(arrival) > self.settle.timeout {
                return match (rested, astray) {
                    (Some(_), Some(axis)) if on(Guarding::Following) => {
                        Err(self.following(axis, &point, targets))
                    }
                    (Some(rested), Some(_)) => Ok(rested),
                    (Some(_), None) => Err(self.unsettled(Some(unmet))),
                    (None, axis) => Err(self.unsettled(axis)),
                };
            }
            self.wait_until(now + self.period())?;
        }
    }

    /// Waits until the time `until` (\[s\], by the clock), and polls often enough for the heartbeat of the devices.
    pub(super) fn stay_until(&mut self, until: f64) -> Result<(), RigFault> {
        // Counted from the last answer of the rig: otherwise many short waits would be one long silence.
        while self.last_contact + self.link.watchdog / 4.0 < until {
            self.wait_until(self.last_contact + self.link.watchdog / 4.0)?;
            let point = self.poll()?;
            self.watch(&point)?;
        }
        self.wait_until(until)
    }

    /// Compares a reading during the motion with the limits, because the settled reading would be too late. A single reading may be a
    /// spike.
    pub(super) fn watch(&mut self, point: &Point) -> Result<(), RigFault> {
        let count = self.axes.len();
        let mut found = None;
        for (index, axis) in self.axes.iter_mut().enumerate() {
            let displacement = (
                LimitedQuantity::MeasuredDisplacement,
                axis.limits.displacement,
                point.displacement[index],
            );
            let force = (
                LimitedQuantity::Force,
                axis.limits.force,
                point.force[index],
            );
            let breach = [displacement, force]
                .into_iter()
                .find(|(_, limit, value)| !limit.contains(*value));
            let again = std::mem::replace(&mut axis.outside, breach.is_some());
            found = found.or(breach.filter(|_| again && on(Guarding::ReadingLimits)).map(
                |(quantity, limit, value)| RigFault::LimitBreached {
                    quantity,
                    value,
                    low: limit.low,
                    high: limit.high,
                    axis: named_axis(index, count),
                },
            ));
        }
        let Some(fault) = found else {
            return self.check_path_deviation(point);
        };
        self.broken = Some(point.clone().into_reading());
        Err(fault)
    }

    /// An axis that deviates from its path is held before it arrives at another position. The device may have received a wrong target, or
    /// lost a limit. A single reading may be a spike.
    fn check_path_deviation(&mut self, point: &Point) -> Result<(), RigFault> {
        let count = self.axes.len();
        for (index, axis) in self.axes.iter_mut().enumerate() {
            let at = axis.controlled(point.displacement[index], point.force[index]);
            let Some(range) = axis.allowed_range.filter(|range| !range.contains(at)) else {
                axis.off = false;
                continue;
            };
            if std::mem::replace(&mut axis.off, true) && on(Guarding::PathDeviation) {
                if axis.axial.is_some() {
                    self.broken = Some(point.clone().into_reading());
                    return Err(RigFault::LimitBreached {
                        quantity: LimitedQuantity::Force,
                        value: at,
                        low: range.low,
                        high: range.high,
                        axis: named_axis(index, count),
                    });
                }
                let shown = |position| display::plain(position, Dimension::LENGTH, 6);
                let (who, at, low, high) = (
                    who(named_axis(index, count)),
                    shown(at),
                    shown(range.low),
                    shown(range.high),
                );
                return Err(RigFault::Device(format!(
                    "{who} deviated from the commanded path: it is at {at}, outside {low} .. {high}"
                )));
            }
        }
        Ok(())
    }

    /// Waits without asking anything.
    pub(super) fn wait_until(&mut self, until: f64) -> Result<(), RigFault> {
        loop {
            if self.stop_request.hold_requested() {
                return Err(RigFault::Interrupted);
            }
            let left = until - self.clock.now();
            // A microsecond is negligible, and the rounding of a clock in nanoseconds is smaller.
            if left.is_nan() || left <= 1e-6 {
                return Ok(());
            }
            self.clock.sleep(left.min(SLICE));
        }
    }

    /// The longest travel of a move \[m\].
    fn farthest(&self, proposed: &ProposedMove) -> f64 {
        let ends = proposed.targets.iter().zip(&proposed.from);
        let lateral = self
            .axes
            .iter()
            .zip(ends)
            .filter(|(axis, _)| axis.axial.is_none());
        lateral
            .map(|(_, (to, from))| (to - from).abs())
            .fold(0.0, f64::max)
    }

    /// Sends the proposed move. Gives its targets and the duration of the longest travel, or change of a force \[s\].
    pub(super) fn set_off(&mut self) -> Result<(Vec<f64>, f64), RigFault> {
        let nothing = || RigFault::Device("nothing was proposed to execute".to_owned());
        let proposed = self.proposed.take().ok_or_else(nothing)?;
        let farthest = self.farthest(&proposed);
        let ProposedMove {
            going,
            targets,
            from,
        } = proposed;
        self.moved = true;
        self.actuator
            .start(&going)
            .map_err(|fault| self.device_fault(DeviceRole::Actuator, &fault))?;
        (self.deaf, self.settled, self.broken) = (false, None, None);
        self.seen_positions = vec![(self.clock.now(), from[0])];
        for axis in &mut self.axes {
            (axis.outside, axis.span) = (false, 0.0);
            axis.validator.begin_force_control();
        }
        self.look_up()?;
        let mut seconds = farthest / going.speed;
        let of_travel = BESIDE_BANDS * self.settle.band + BESIDE_TRAVEL * farthest;
        for (axis, (to, from)) in self.axes.iter_mut().zip(targets.iter().zip(&from)) {
            let mut beside = of_travel;
            if let Some(axial) = axis.axial {
                beside = axial.tolerance;
                seconds = seconds.max((to - from).abs() / axial.rate);
            }
            let range = Interval {
                low: to.min(*from) - beside,
                high: to.max(*from) + beside,
            };
            (axis.allowed_range, axis.off) = (Some(range), false);
        }
        Ok((targets, seconds))
    }

    /// Whether a reading at the settled position shows that the rig is not settled.
    pub(super) fn disturbed(&self, point: &Point, targets: &[f64]) -> Option<Disturbed> {
        let astray = first_astray(&self.settling(targets), &self.controlled(point));
        (astray.is_some() || point.moving == Some(true) || point.unsettled)
            .then_some(Disturbed { astray })
    }

    /// Whether the force of a reading does not follow from the dwell before it: its distance from the median of that dwell
    /// is more than noise and the force rate that settling allows. Most readings of one median may have lost a digit on the
    /// line.
    pub(super) fn force_jumps(&self, reading: &Reading) -> bool {
        let (now, rate) = (self.clock.now(), self.settle.force_rate);
        let force_jumps = |axis: &Axis, rested: Option<(f64, f64)>, force: f64| {
            rested.is_some_and(|(began, before)| {
                let allowed = LEAP * axis.rules.noise + rate * (now - began);
                axis.axial.is_none()
                    && axis.rules.noise > 0.0
                    && rate > 0.0
                    && (force - before).abs() > allowed
            })
        };
        let read = self.rested.iter().zip(&reading.force);
        on(Guarding::ForceJump)
            && self
                .axes
                .iter()
                .zip(read)
                .any(|(axis, (rested, force))| force_jumps(axis, *rested, *force))
    }

    /// The rig reports that it has arrived, and the axis with this index is at a different position.
    pub(super) fn following(&self, index: usize, point: &Point, targets: &[f64]) -> RigFault {
        let axis = named_axis(index, self.axes.len());
        if let Some(axial) = self.axes[index].axial {
            return RigFault::LimitBreached {
                quantity: LimitedQuantity::ForceError,
                value: point.force[index] - targets[index],
                low: -axial.tolerance,
                high: axial.tolerance,
                axis,
            };
        }
        let error = (point.displacement[index] - targets[index]).abs();
        RigFault::Following {
            error,
            band: self.settle.band,
            axis,
        }
    }

    /// The settling of each axis at its target: of its displacement within the band, or of its force within its tolerance.
    pub(super) fn settling(&self, targets: &[f64]) -> Vec<Settling> {
        let of = |(axis, target): (&Axis, &f64)| {
            let settle = axis.axial.map_or(self.settle, |axial| Settle {
                band: axial.tolerance,
                force_rate: 0.0,
                ..self.settle
            });
            Settling::new(settle, *target)
        };
        self.axes.iter().zip(targets).map(of).collect()
    }

    /// The fault for a rig that did not settle in time. The axis with this index is the first of those that delayed settling, if that is
    /// known.
    pub(super) fn unsettled(&self, index: Option<usize>) -> RigFault {
        let axis = index.and_then(|index| named_axis(index, self.axes.len()));
        RigFault::NotSettled {
            timeout: self.settle.timeout,
            axis,
        }
    }
}

/// The first axis that is not at its target. `controlled`: displacements \[m\], or forces in force control \[N\].
pub(super) fn first_astray(settling: &[Settling], controlled: &[f64]) -> Option<usize> {
    settling
        .iter()
        .zip(controlled)
        .position(|(axis, controlled)| !axis.in_position(*controlled))
}
