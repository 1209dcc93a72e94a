//! The early end of a run: the final hold of the rig, its position, and whether it may be unloaded. In: the reason of the
//! end. Out: events. If the operator stopped the run, or may be at the specimen, nothing moves without the operator's
//! consent.

use super::session::{Session, signed};
use super::stop::Stop;
use super::{Extent, Inspection, Motion};
use psd_physics::tracking::trajectory::longest_travel;
use psd_plan::record::UNLOADING;
use psd_plan::record::{EventKind, Outcome};
use psd_plan::{Interval, Limits, Plan, RealLink, SafeState};
use psd_rig::{FinalHold, RigFault};
use psd_text::units::Dimension;
use psd_text::units::display::{plain, readable, stated};

impl Session<'_> {
    /// Holds the rig, and unloads it if unloading is its safe state and the operator is not at the rig. Also unloads it if the operator
    /// requests it. An axial load is taken off only if the operator requests it.
    pub(super) fn end_as_declared(&mut self, stop: &Stop, plan: &Plan) -> Outcome {
        let halted = self.end(stop);
        let Some(link) = plan.rig.link.as_real() else {
            return stop.outcome();
        };
        let held = halted.as_ref().is_none_or(FinalHold::is_held);
        let declared = link.safe_state == SafeState::Unload && stop.leaves_the_rig_sound();
        let is_loaded = self.guard.axial_loads().next().is_some();
        let alone = declared && !self.attended && !stop.is_a_persons() && !is_loaded;
        // A rig that the operator held during a move has since been read at rest: it may move again with the operator's consent.
        let sound = stop.leaves_the_rig_sound() || stop.is_a_persons();
        if held
            && sound
            && self.extend_limits(link, halted.as_ref())
            && (alone || self.may_unload(plan, halted.as_ref()))
        {
            self.unload();
        }
        stop.outcome()
    }

    /// Records why the run ends here, and the position at which the rig holds.
    pub(crate) fn end(&mut self, stop: &Stop) -> Option<FinalHold> {
        let halted = self.guard.halt();
        self.event(stop.event_kind(), stop.to_string());
        self.report_final_hold(halted.as_ref());
        self.leave();
        halted
    }

    /// Reports the axial loads that a run leaves on a real specimen.
    pub(crate) fn report_axial_loads(&mut self) {
        if self.guard.datum().is_none() {
            return;
        }
        let loads: Vec<(usize, f64)> = self.guard.axial_loads().collect();
        for (storey, force) in loads {
            let text = format!(
                "the axial load of storey {} was not taken off: its target is {}",
                storey + 1,
                stated(force, Dimension::FORCE)
            );
            self.event(EventKind::Note, text);
        }
    }

    /// Reports the position at which the rig holds, or that the hold is not confirmed.
    fn report_final_hold(&mut self, halted: Option<&FinalHold>) {
        if let Some(halted) = halted {
            let kind = if halted.is_held() {
                EventKind::Held
            } else {
                EventKind::NotHeld
            };
            self.event(kind, halted.to_string());
        }
    }

    /// Whether the operator requests unloading.
    fn may_unload(&mut self, plan: &Plan, halted: Option<&FinalHold>) -> bool {
        let shown = |positions: &[f64]| {
            positions
                .iter()
                .map(|position| readable(*position, Dimension::LENGTH))
                .collect::<Vec<_>>()
                .join(", ")
        };
        let found = halted.and_then(|halted| halted.found.as_ref());
        let at = shown(found.map_or_else(
            || self.guard.commanded(),
            |(positions, _)| positions.as_slice(),
        ));
        let home = shown(&self.home);
        let motion = self.unloading(plan, halted);
        let speed = self.guard.own_speed();
        let speed = speed.map_or_else(String::new, |speed| {
            format!(" at {}", plain(speed, Dimension::VELOCITY, 4))
        });
        let question = format!(
            "unload? The rig is HELD at {at}. If confirmed, it MOVES to {home}{speed}, its start position{}",
            self.takes_off()
        );
        loop {
            match self.observer.may_unload(&question, &motion) {
                None => return false,
                Some(Inspection::GoOn { note, by }) => {
                    let note = note.map_or_else(String::new, |note| format!(": {note}"));
                    self.event(
                        EventKind::Inspection,
                        format!("{question}: yes{note}{}", signed(by.as_deref())),
                    );
                    return true;
                }
                Some(Inspection::Stop { reason, by }) => {
                    self.event(
                        EventKind::Inspection,
                        format!("{question}: {reason}{}", signed(by.as_deref())),
                    );
                    return false;
                }
                Some(Inspection::Wait) => {
                    if let Err(stop) = self.breathe() {
                        let halted = self.guard.halt();
                        self.event(stop.event_kind(), stop.to_string());
                        self.report_final_hold(halted.as_ref());
                        return false;
                    }
                }
            }
        }
    }

    /// What happens to the axial loads at the start position, as the end of a sentence.
    fn takes_off(&self) -> String {
        let loads = self.guard.axial_loads().map(|(storey, force)| {
            format!(
                "; there AXIAL of storey {} takes off its {}",
                storey + 1,
                stated(force, Dimension::FORCE)
            )
        });
        loads.collect()
    }

    /// The motion that removes the load.
    fn unloading(&self, plan: &Plan, halted: Option<&FinalHold>) -> Motion {
        let found = halted.and_then(|halted| halted.found.as_ref());
        let from = found.map_or_else(
            || self.guard.commanded(),
            |(positions, _)| positions.as_slice(),
        );
        let over = |values: &mut dyn Iterator<Item = f64>| {
            over_all(values.map(|value| Interval {
                low: value,
                high: value,
            }))
        };
        let longest = longest_travel(from, &self.home);
        let speed = self.guard.own_speed();
        let expected = Extent {
            travel: over(&mut from.iter().chain(&self.home).copied()),
            force: found.and_then(|(_, force)| over(&mut force.iter().copied().chain([0.0]))),
            speed,
            duration: speed.map(|speed| Motion::duration(plan, longest, speed)),
        };
        let does = format!("it MOVES back to its start position{}", self.takes_off());
        let motion = Motion::of(plan, self.identity(), does);
        let of_axes = self.guard.limits_of_axes();
        let limits = Limits {
            displacement: over_all(of_axes.iter().map(|limits| limits.displacement))
                .unwrap_or(plan.limits.displacement),
            force: over_all(of_axes.iter().map(|limits| limits.force)).unwrap_or(plan.limits.force),
            ..motion.limits
        };
        Motion {
            expected,
            limits,
            ..motion
        }
    }

    /// Extends the limits to where the rig holds, so that none is exceeded while the operator decides and while the rig unloads. False:
    /// the rig cannot be reached.
    fn extend_limits(&mut self, link: &RealLink, halted: Option<&FinalHold>) -> bool {
        let Some(found) = halted.and_then(|halted| halted.found.as_ref()) else {
            return true;
        };
        let extended = self
            .guard
            .extend_limits(found, |axis| link.readings_of(axis));
        let is_extended = extended.is_ok();
        if !is_extended {
            self.end_unloading(extended);
        }
        is_extended
    }

    /// Unloads after a stop; a fault is an additional event. The axial load goes last, while the other axes hold.
    fn unload(&mut self) {
        self.event(EventKind::Hold, UNLOADING.to_owned());
        let home = self.home.clone();
        let mut unloaded = self.go_to_all(&home, None).and_then(|()| self.guard.read());
        if unloaded.is_ok() && self.guard.axial_loads().next().is_some() {
            let taken_off = self.guard.load_axially(None, 0.0);
            unloaded = taken_off.and_then(|()| self.guard.read());
        }
        self.end_unloading(unloaded.map(drop));
    }

    /// Holds again, and reports the position. A fault is an event before it.
    fn end_unloading(&mut self, unloaded: Result<(), RigFault>) {
        if let Err(fault) = unloaded {
            let stop = Stop::from(fault);
            self.event(stop.event_kind(), format!("not unloaded: {stop}"));
        }
        let halted = self.guard.halt();
        self.report_final_hold(halted.as_ref());
    }
}

/// The smallest interval that contains all of these.
fn over_all(intervals: impl Iterator<Item = Interval>) -> Option<Interval> {
    intervals.reduce(|a, b| Interval {
        low: a.low.min(b.low),
        high: a.high.max(b.high),
    })
}
