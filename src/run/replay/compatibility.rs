//! Differences of older versions. In: a plan, and a run log of it. Out: the plan as it was run by the version that wrote the run log. It
//! assesses nothing, and changes nothing that this version writes.

use std::borrow::Cow;

use super::entry::OperatorBody;
use super::logged_run::{LoggedRun, body};
use crate::plan::{Plan, ProcedureKind};
use crate::record::Event;
use crate::record::journal::{EntryKind, Line};
use crate::rig::RigFault;
use crate::run::session::STOPPED_ON_REQUEST;
use crate::run::zero_drift::READINGS;

/// The computation rules of this version, as stated in the header of a run log. 1: an `unload` may pass the unloaded position, and a
/// `cycle` without a number has ten targets in each quarter. 2: neither applies, but the targets of a `cycle` are equally spaced. 3: they
/// are not equally spaced.
pub const RULES: u32 = 3;

/// Targets between the middle and an amplitude if the plan gives no number, now and by rules 1.
const POINTS: u32 = 25;
const OLDER_POINTS: u32 = 10;

/// The plan as it was run by the version that wrote the run log.
pub(super) fn as_it_was_run<'a>(plan: &'a Plan, logged: &LoggedRun) -> Cow<'a, Plan> {
    let without_zeros = plan.rig.drift.is_some() && serves_without_zeros(logged);
    if !without_zeros && logged.header.rules >= RULES {
        return Cow::Borrowed(plan);
    }
    let mut plan = plan.clone();
    // The first versions that served a rig with a zero-drift limit read no zeros before the first client. In their run logs the first
    // request follows the pre-test check. They are replayed in this form, without a zero drift.
    if without_zeros {
        plan.rig.drift = None;
    }
    let first = logged.header.rules < 2;
    plan.unloads_at_once |= first;
    let said = logged.texts.iter().any(|text| text.contains("points"));
    for procedure in &mut plan.procedures {
        if let ProcedureKind::Cycle(cycle) = &mut procedure.kind {
            cycle.evenly = logged.header.rules < 3;
            if first && cycle.points == POINTS && !said {
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

/// Whether an event is the logged one. Older versions stated an unusable input in SI units, as a number without a unit, and
/// logged a request to hold during a question to the operator as a hold during a motion.
pub(super) fn is_recorded(event: &Event, recorded: &Event) -> bool {
    const CAME_OUT: &str = " came out as ";
    let stopped_while_asked =
        event.text == STOPPED_ON_REQUEST && recorded.text == RigFault::Interrupted.to_string();
    let field = |event: &Event| {
        event
            .text
            .split_once(CAME_OUT)
            .map(|(field, _)| field.to_owned())
    };
    let older = field(recorded).is_some() && recorded.text.contains(" in SI units, but must be ");
    let same_otherwise = || {
        Event {
            text: event.text.clone(),
            ..recorded.clone()
        } == *event
    };
    let same_text = recorded.text == event.text
        || stopped_while_asked
        || older && field(recorded) == field(event);
    same_text && same_otherwise()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::EventKind;

    #[test]
    fn a_hold_requested_while_a_person_was_asked_is_the_stop_on_record() {
        let hold = |text: &str| Event {
            time: 1.5,
            procedure: None,
            step: None,
            kind: EventKind::Hold,
            text: text.to_owned(),
        };
        let (now, older) = (
            hold("stopped on request"),
            hold("held on request in the middle of a step"),
        );
        assert!(is_recorded(&now, &older) && !is_recorded(&older, &now));
        assert!(!is_recorded(&now, &hold("declined by the operator")));
    }

    #[test]
    fn an_input_that_was_told_in_si_units_is_the_one_on_record() {
        let told = |text: &str| Event {
            time: 1.5,
            procedure: None,
            step: None,
            kind: EventKind::Fault,
            text: text.to_owned(),
        };
        let now = told("`damping` came out as \u{2212}0.33 N·s/m, but must be at least 0");
        let older =
            told("`damping` came out as -0.3284410318426494 in SI units, but must be at least 0");
        assert!(is_recorded(&now, &now) && is_recorded(&now, &older));
        for other in [
            told("`stiffness` came out as -0.3284410318426494 in SI units, but must be at least 0"),
            told("`damping` came out as \u{2212}0.34 N·s/m, but must be at least 0"),
            Event {
                time: 2.0,
                ..older.clone()
            },
        ] {
            assert!(!is_recorded(&now, &other), "{}", other.text);
        }
    }
}
