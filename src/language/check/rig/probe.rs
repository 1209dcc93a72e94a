//! `probe(…)`: the pre-test check of a rig, or of one of its axes.

use crate::language::check::checker::{Checker, Context};
use crate::language::check::expressions::choice::Chosen;
use crate::plan::Gate;

/// `probe(…)`, of a rig or of one of its axes.
pub fn probe<'a>(checker: &mut Checker<'a>, chosen: &Chosen<'a>, context: Context) -> Option<Gate> {
    let probe = checker.constant_argument(chosen, "displacement", context);
    let stiffness = checker.interval_argument(chosen, "stiffness", context);
    let zero = checker.constant_argument(chosen, "zero", context);
    Some(Gate {
        zero: zero?,
        probe: probe?,
        stiffness: stiffness?,
    })
}
