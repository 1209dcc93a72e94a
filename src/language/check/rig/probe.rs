//! `probe(…)`: the pre-test check of a rig, or of one of its axes.

use crate::check::checker::{Checker, Context};
use crate::check::expressions::choice::Chosen;
use psd_plan::PretestCheck;
use psd_plan::schema::rig as schema;

/// `probe(…)`, of a rig or of one of its axes.
pub fn probe<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
) -> Option<PretestCheck> {
    let probe = checker.constant_argument(chosen, schema::PROBE.name, context);
    let stiffness = checker.interval_argument(chosen, schema::PROBED_STIFFNESS.name, context);
    let zero = checker.constant_argument(chosen, schema::ZERO_FORCE.name, context);
    Some(PretestCheck {
        zero: zero?,
        probe: probe?,
        stiffness: stiffness?,
    })
}
