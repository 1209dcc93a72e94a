//! `drift = within(…)` of a rig: how far its zeros may drift in a run, and how they are read. In: the block of a rig. Out: a
//! [`DriftCheck`]. It reads nothing.

use super::{CheckedRig, place_of};
use crate::language::check::checker::Checker;
use crate::language::check::messages::rigs as fault;
use crate::plan::{DriftCheck, Link, ZeroAfter};
use crate::schema::RigKind;
use crate::units::Dimension;

/// Standard deviations of one reading within which chance alone may bring the difference of two, in a long run.
const CHANCE: f64 = 5.0;

/// What a rig says of its zeros: `Some(None)` where it says nothing, None where that is faulty.
#[expect(
    clippy::option_option,
    reason = "left out and faulty are different things here"
)]
pub fn drift(
    checker: &mut Checker,
    block: usize,
    kind: Option<RigKind>,
) -> Option<Option<DriftCheck>> {
    if checker.given(block, "drift").is_none() {
        return Some(None);
    }
    let place = place_of(checker, block, "drift")?;
    let chosen = checker.choice(block, "drift")?;
    let (force, over) = (
        checker.constant_argument(&chosen, "force", place),
        checker.constant_argument(&chosen, "over", place),
    );
    let displacement = checker.optional_argument(&chosen, "displacement", place);
    let after = match chosen.span("after") {
        None => Some(ZeroAfter::Start),
        Some(at) => match checker.chosen_argument(&chosen, "after")?.variant.name {
            "free" if kind == Some(RigKind::Virtual) => checker.fail(fault::nobody_to_free_it(at)),
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

/// A tolerance within which noise or quanta alone may bring a reading.
pub fn warn(checker: &mut Checker, rig: &CheckedRig) {
    let (Some(check), Some(block)) = (rig.plan.drift, rig.block) else {
        return;
    };
    let Some((_, entry)) = checker.given(block, "drift") else {
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
        let fault = fault::drift_within_noise(
            "force",
            check.force,
            ("noise", noise, CHANCE * noise),
            Dimension::FORCE,
            at,
        );
        checker.faults.push(fault);
    }
    if let Some(displacement) = check
        .displacement
        .filter(|displacement| *displacement < resolution)
    {
        let of = ("resolution", resolution, resolution);
        checker.faults.push(fault::drift_within_noise(
            "displacement",
            displacement,
            of,
            Dimension::LENGTH,
            at,
        ));
    }
}
