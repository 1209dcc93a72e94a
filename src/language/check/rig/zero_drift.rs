//! `zero_drift = within(…)` of a rig: the allowed zero drift in a run, and how the zero is read. In: the block of a rig. Out: a
//! [`DriftCheck`]. It reads nothing.

use super::{CheckedRig, context_of};
use crate::check::checker::Checker;
use crate::check::messages::rigs as message;
use psd_plan::schema::RigKind;
use psd_plan::schema::rig as schema;
use psd_plan::{DriftCheck, Link, ZeroAfter};
use psd_text::units::Dimension;

/// Number of standard deviations of one reading that the difference of two readings rarely exceeds by chance, in a long run.
const CHANCE: f64 = 5.0;

/// The zero-drift check of a rig: `Some(None)` if it has none, None if it has an error.
pub fn zero_drift(
    checker: &mut Checker,
    block: usize,
    kind: Option<RigKind>,
) -> Option<Option<DriftCheck>> {
    if checker.field(block, schema::ZERO_DRIFT.name).is_none() {
        return Some(None);
    }
    let context = context_of(checker, block, schema::ZERO_DRIFT.name)?;
    let chosen = checker.choice(block, schema::ZERO_DRIFT.name)?;
    let (force, over) = (
        checker.constant_argument(&chosen, schema::FORCE_DRIFT.name, context),
        checker.constant_argument(&chosen, schema::OVER.name, context),
    );
    let displacement = checker.optional_argument(&chosen, schema::DISPLACEMENT_DRIFT.name, context);
    let after = match chosen.span(schema::AFTER.name) {
        None => Some(ZeroAfter::Start),
        Some(at) => match checker
            .chosen_argument(&chosen, schema::AFTER.name)?
            .variant
            .name
        {
            "free" if kind == Some(RigKind::Virtual) => {
                checker.fail(message::no_operator_to_free_it(at))
            }
            "free" => Some(ZeroAfter::Free),
            "nowhere" => Some(ZeroAfter::Nowhere),
            _ => Some(ZeroAfter::Start),
        },
    };
    Some(Some(DriftCheck {
        force: force?,
        displacement: displacement?,
        over: over?,
        after: after?,
    }))
}

/// A tolerance that noise or resolution alone may exceed.
pub fn warn(checker: &mut Checker, rig: &CheckedRig) {
    let (Some(check), Some(block)) = (rig.plan.zero_drift, rig.block) else {
        return;
    };
    let Some((_, entry)) = checker.field(block, schema::ZERO_DRIFT.name) else {
        return;
    };
    let at = entry.value.span;
    let (noise, resolution) = match &rig.plan.link {
        Link::Virtual(link) => (link.noise, link.resolution),
        Link::Real(link) => (0..rig.plan.axes().unwrap_or(1))
            .map(|axis| link.readings_of(axis))
            .fold((0.0, 0.0), |(noise, resolution): (f64, f64), axis| {
                (noise.max(axis.noise), resolution.max(axis.resolution))
            }),
    };
    if check.force < CHANCE * noise {
        let diagnostic = message::drift_within_noise(
            schema::FORCE_DRIFT.name,
            check.force,
            message::ReadingScatter {
                name: schema::NOISE.name,
                size: noise,
                reach: CHANCE * noise,
            },
            Dimension::FORCE,
            at,
        );
        checker.diagnostics.push(diagnostic);
    }
    if let Some(displacement) = check
        .displacement
        .filter(|displacement| *displacement < resolution)
    {
        let scatter = message::ReadingScatter {
            name: schema::RESOLUTION.name,
            size: resolution,
            reach: resolution,
        };
        checker.diagnostics.push(message::drift_within_noise(
            schema::DISPLACEMENT_DRIFT.name,
            displacement,
            scatter,
            Dimension::LENGTH,
            at,
        ));
    }
}
