//! The early end of a run: the final hold of the rig, its position, and whether it may be unloaded. In: the reason of the
//! end. Out: events. If the operator stopped the run, or may be at the specimen, nothing moves without the operator's
//! consent.

use super::session::{Session, signed};
use super::stop::Stop;
use super::{Extent, Inspection, Motion, UNLOADING};
use crate::plan::{Interval, Plan, SafeState};
use crate::record::{EventKind, Outcome};
use crate::rig::FinalHold;
use crate::units::Dimension;
use crate::units::display::{plain, readable};

impl Session<'_> {
    /// Holds the rig, and unloads it if unloading is its safe state and the operator is not at the rig. Also unloads it if the operator
    /// requests it.
    pub(super) fn end_as_declared(&mut self, stop: &Stop, plan: &Plan) -> Outcome {
        let halted = self.end(stop);
        let Some(link) = plan.rig.link.as_real() else {
            return stop.outcome();
        };
        let held = halted.as_ref().is_none_or(FinalHold::is_held);
        let declared = link.safe_state == SafeState::Unload && stop.leaves_the_rig_sound();
        let alone = declared && !self.attended && !stop.is_a_persons();
        // A rig that the operator held during a move has since been read at rest: it may move again with the operator's consent.
        let sound = stop.leaves_the_rig_sound() || stop.is_a_persons();
        if held && sound && (alone || self.may_unload(plan, halted.as_ref())) {
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
            "unload? The rig is HELD at {at}. If confirmed, it MOVES to {home}{speed}, its start position"
        );
        loop {
            match self.observer.may_unload(&question, &motion) {
                None => return false,
                Some(Inspection::GoOn { note, by }) => {
                    // Older versions did not ask.
                    if by.is_some() {
                        let note = note.map_or_else(String::new, |note| format!(": {note}"));
                        self.event(
                            EventKind::Inspection,
                            format!("{question}: yes{note}{}", signed(by.as_deref())),
                        );
                    }
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

    /// The motion that removes the load.
    fn unloading(&self, plan: &Plan, halted: Option<&FinalHold>) -> Motion {
        let found = halted.and_then(|halted| halted.found.as_ref());
        let from = found.map_or_else(
            || self.guard.commanded(),
            |(positions, _)| positions.as_slice(),
        );
        let over = |values: &mut dyn Iterator<Item = f64>| {
            values
                .map(|value| Interval {
                    low: value,
                    high: value,
                })
                .reduce(|a, b| Interval {
                    low: a.low.min(b.low),
                    high: a.high.max(b.high),
                })
        };
        let longest = from
            .iter()
            .zip(&self.home)
            .map(|(from, to)| (to - from).abs())
            .fold(0.0, f64::max);
        let speed = self.guard.own_speed();
        let expected = Extent {
            travel: over(&mut from.iter().chain(&self.home).copied()),
            force: found.and_then(|(_, force)| over(&mut force.iter().copied().chain([0.0]))),
            speed,
            duration: speed.map(|speed| Motion::duration(plan, longest, speed)),
        };
        let does = "it MOVES back to its start position".to_owned();
        Motion {
            expected,
            ..Motion::of(plan, self.identity(), does)
        }
    }

    /// Unloads after a stop, inside the same limits; a fault is an additional event.
    fn unload(&mut self) {
        self.event(EventKind::Hold, UNLOADING.to_owned());
        let home = self.home.clone();
        let unloaded = self
            .go_to_all(&home, None)
            .and_then(|()| Ok(self.guard.read()?));
        if let Err(stop) = unloaded {
            self.event(stop.event_kind(), format!("not unloaded: {stop}"));
        }
        let halted = self.guard.halt();
        self.report_final_hold(halted.as_ref());
    }
}
