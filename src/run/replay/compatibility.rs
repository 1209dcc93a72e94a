//! Differences of older versions. In: a plan, and a run log of it. Out: the plan as it was run by the version that wrote the run log. It
//! assesses nothing, and changes nothing that this version writes.

use std::borrow::Cow;

use super::entry::OperatorBody;
use super::logged_run::{LoggedRun, body};
use crate::plan::{Plan, ProcedureKind};
use crate::record::Event;
use crate::rig::journal::{EntryKind, Line};
use crate::run::zero_drift::READINGS;

/// The rules of this version, as stated in the header of a run log. 1: an `unload` may pass the unloaded position, and a `cycle` without
/// a number has ten targets in each quarter. 2: neither applies, but the targets of a `cycle` are equally spaced. 3: they are not equally
/// spaced. 4, 5 and 6: the wording of some events and questions differs.
pub const RULES: u32 = 6;

/// The first rules with the present wording of events and questions.
const PRESENT_WORDING: u32 = 6;

/// Targets between the middle and an amplitude if the plan gives no number, now and by rules 1.
const POINTS: u32 = 25;
const OLDER_POINTS: u32 = 10;

/// The plan as it was run by the version that wrote the run log.
pub(super) fn as_it_was_run<'a>(plan: &'a Plan, logged: &LoggedRun) -> Cow<'a, Plan> {
    let without_zeros = plan.rig.zero_drift.is_some() && serves_without_zeros(logged);
    if !without_zeros && logged.header.rules >= RULES {
        return Cow::Borrowed(plan);
    }
    let mut plan = plan.clone();
    // The first versions that served a rig with a zero-drift limit read no zeros before the first client. In their run logs the first
    // request follows the pre-test check. They are replayed in this form, without a zero drift.
    if without_zeros {
        plan.rig.zero_drift = None;
    }
    let first = logged.header.rules < 2;
    plan.unloads_at_once |= first;
    let stated = logged.texts.iter().any(|text| text.contains("points"));
    for procedure in &mut plan.procedures {
        if let ProcedureKind::Cycle(cycle) = &mut procedure.kind {
            cycle.evenly = logged.header.rules < 3;
            if first && cycle.points == POINTS && !stated {
                cycle.points = OLDER_POINTS;
            }
        }
    }
    Cow::Owned(plan)
}

/// Whether the run log has a client's first request, with fewer consecutive readings before it than a zero needs.
fn serves_without_zeros(logged: &LoggedRun) -> bool {
    let Some(first) = logged.lines.iter().position(is_request) else {
        return false;
    };
    let mut in_a_row = 0;
    for line in logged.lines.iter().take(first) {
        in_a_row = if line.kind == EntryKind::Sample {
            in_a_row + 1
        } else {
            0
        };
        if in_a_row >= READINGS {
            return false;
        }
    }
    true
}

fn is_request(line: &Line) -> bool {
    line.kind == EntryKind::Operator && matches!(body(line), Ok(OperatorBody::Asked { .. }))
}

/// Whether the events and questions of a run log have the wording of this version. Otherwise only their kind, time and position are
/// compared.
pub(super) const fn has_present_wording(logged: &LoggedRun) -> bool {
    logged.header.rules >= PRESENT_WORDING
}

/// Whether an event is the logged one.
pub(super) fn is_recorded(event: &Event, recorded: &Event, present_wording: bool) -> bool {
    if present_wording {
        return event == recorded;
    }
    Event {
        text: event.text.clone(),
        ..recorded.clone()
    } == *event
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::EventKind;

    #[test]
    fn the_text_of_an_event_counts_if_it_has_the_present_wording() {
        let event = |time: f64, text: &str| Event {
            time,
            procedure: None,
            step: None,
            kind: EventKind::Fault,
            text: text.to_owned(),
        };
        let now = event(
            1.5,
            "`damping` = \u{2212}0.33 N·s/m is invalid: it must be at least 0",
        );
        let older = event(
            1.5,
            "`damping` came out as -0.3284410318426494 in SI units, but must be at least 0",
        );
        assert!(is_recorded(&now, &now, true) && !is_recorded(&now, &older, true));
        assert!(is_recorded(&now, &older, false));
        let other_kind = Event {
            kind: EventKind::Hold,
            ..older.clone()
        };
        for other in [event(2.0, &older.text), other_kind] {
            assert!(!is_recorded(&now, &other, false), "{other:?}");
        }
    }
}
