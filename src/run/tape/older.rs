//! What an older version did otherwise. In: a plan, a record of it. Out: the plan as the version that wrote the record ran it. It
//! judges nothing, and changes nothing of what this version writes.

use std::borrow::Cow;

use super::entry::OperatorBody;
use super::played::{Played, body};
use crate::plan::Plan;
use crate::record::journal::{EntryKind, Line};
use crate::run::zero::READINGS;

/// A rig that says how far its zeros may drift has them read before the first client that drives it. The first versions that served a
/// rig read none: their records go from the gate to the first request, and are played back so, with a drift that nobody looked at.
pub(super) fn as_it_was_run<'a>(plan: &'a Plan, played: &Played) -> Cow<'a, Plan> {
    if plan.rig.drift.is_none() || !serves_without_zeros(played) {
        return Cow::Borrowed(plan);
    }
    let mut plan = plan.clone();
    plan.rig.drift = None;
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
