//! What an older version did otherwise. In: a plan, a record of it. Out: the plan as the version that wrote the record ran it. It
//! judges nothing, and changes nothing of what this version writes.

use std::borrow::Cow;

use super::entry::OperatorBody;
use super::played::{Played, body};
use crate::plan::{Plan, ProcedureKind};
use crate::record::journal::{EntryKind, Line};
use crate::run::zero::READINGS;

/// The rules that this version computes a run by, as its records say in their header. 1: an `unload` may pass the place without load, and a
/// `cycle` has ten targets a quarter unless it says another number. 2: neither.
pub const RULES: u32 = 2;

/// Targets between the middle and an amplitude where the plan gave no number, now and by the rules of 1.
const POINTS: u32 = 25;
const OLDER_POINTS: u32 = 10;

/// The plan as the version ran it that wrote the record.
pub(super) fn as_it_was_run<'a>(plan: &'a Plan, played: &Played) -> Cow<'a, Plan> {
    let without_zeros = plan.rig.drift.is_some() && serves_without_zeros(played);
    if !without_zeros && played.header.rules >= RULES {
        return Cow::Borrowed(plan);
    }
    let mut plan = plan.clone();
    // The first versions that served a rig which says how far its zeros may drift read none before the first client: their records go from
    // the gate to the first request, and are played back so, with a drift that nobody looked at.
    if without_zeros {
        plan.rig.drift = None;
    }
    if played.header.rules < RULES {
        plan.unloads_at_once = true;
        let said = played.texts.iter().any(|text| text.contains("points"));
        for procedure in &mut plan.procedures {
            if let ProcedureKind::Cycle(cycle) = &mut procedure.kind
                && cycle.points == POINTS
                && !said
            {
                cycle.points = OLDER_POINTS;
            }
        }
    }
    Cow::Owned(plan)
}

/// Whether a client's first request is on record, and before it nowhere as many readings in a row as make a zero.
fn serves_without_zeros(played: &Played) -> bool {
    let Some(first) = played.lines.iter().position(is_request) else { return false };
    let mut in_a_row = 0;
    for line in played.lines.iter().take(first) {
        in_a_row = if line.kind == EntryKind::Sample { in_a_row + 1 } else { 0 };
        if in_a_row >= READINGS {
            return false;
        }
    }
    true
}

fn is_request(line: &Line) -> bool {
    line.kind == EntryKind::Operator && matches!(body(line), Ok(OperatorBody::Asked { .. }))
}
