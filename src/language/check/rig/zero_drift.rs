//! `zero_drift = within(…)` of a rig: the allowed zero drift in a run, and how the zero is read. In: the block of a rig. Out: a
//! [`DriftCheck`]. It reads nothing.

use crate::check::checker::Checker;
use crate::check::wording::shown;
use crate::codes::{E652, W709};
use psd_plan::schema::{RigKind, rig as schema};
use psd_plan::{DriftCheck, Link, ZeroAfter};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;
use psd_text::units::Dimension;

use super::{CheckedRig, context_of};

/// Number of standard deviations of one reading that the difference of two readings rarely exceeds by chance, in a long run.
const CHANCE: f64 = 5.0;

#[derive(Violation)]
#[violation(
    E652,
    "the specimen of a virtual rig cannot be taken off its load cell"
)]
#[help("write `after: start`: the rig returns to its start position and reads the zero there")]
struct NoOperatorToFreeIt {
    #[label("requires an operator")]
    at: Span,
}

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
            "free" if kind == Some(RigKind::Virtual) => checker.fail(NoOperatorToFreeIt { at }),
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

/// A source of random changes of a reading.
#[derive(Clone, Copy)]
struct ReadingScatter {
    name: &'static str,
    /// In SI units.
    size: f64,
    /// The largest change that it may cause, in SI units.
    reach: f64,
}

#[derive(Violation)]
#[violation(
    W709,
    "{what} drift tolerance {allowed} is within the scatter of the readings",
    allowed = shown(allowed, dimension)
)]
#[help(
    "write at least {reach}, or reduce the {name}",
    name = scatter.name,
    reach = shown(scatter.reach, dimension)
)]
struct DriftWithinNoise<'a> {
    what: &'a str,
    allowed: f64,
    scatter: ReadingScatter,
    dimension: Dimension,
    #[label(
        "{name} of one reading: {size}",
        name = scatter.name,
        size = shown(scatter.size, dimension)
    )]
    at: Span,
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
        Link::Real(link) => (0..link.lateral_axes())
            .map(|axis| link.readings_of(axis))
            .fold((0.0, 0.0), |(noise, resolution): (f64, f64), axis| {
                (noise.max(axis.noise), resolution.max(axis.resolution))
            }),
    };
    if check.force < CHANCE * noise {
        let diagnostic = DriftWithinNoise {
            what: schema::FORCE_DRIFT.name,
            allowed: check.force,
            scatter: ReadingScatter {
                name: schema::NOISE.name,
                size: noise,
                reach: CHANCE * noise,
            },
            dimension: Dimension::FORCE,
            at,
        }
        .diagnostic();
        checker.diagnostics.push(diagnostic);
    }
    if let Some(displacement) = check
        .displacement
        .filter(|displacement| *displacement < resolution)
    {
        let scatter = ReadingScatter {
            name: schema::RESOLUTION.name,
            size: resolution,
            reach: resolution,
        };
        checker.report(DriftWithinNoise {
            what: schema::DISPLACEMENT_DRIFT.name,
            allowed: displacement,
            scatter,
            dimension: Dimension::LENGTH,
            at,
        });
    }
}
