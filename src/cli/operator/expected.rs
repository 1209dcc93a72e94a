//! The expected demand of a run on its rig, for the operator who permits the motion: displacement, force, speed, duration. In: a plan.
//! Out: the extent of a dry run on an ideal copy of the specimen, and its steps. It moves nothing.

use super::pace::Part;
use crate::commands::explain_plan::dry_rig::{Reach, Watched, whole};
use psd::procedures::most_steps;
use psd::run::Extent;
use psd_plan::{Interval, Plan};
use psd_rig::RigFault;
use psd_rig::real::RealRig;
use psd_text::units::Dimension;
use psd_text::units::display::plain;

/// The expected run of a plan.
#[derive(Clone, Debug, Default)]
pub struct Expected {
    pub extent: Extent,
    pub steps: u64,
    /// One for each procedure.
    pub procedures: Vec<Reach>,
}

impl Expected {
    /// The share of each procedure: its rig time.
    pub fn parts(&self) -> Vec<Part> {
        let parts = self.procedures.iter().map(|reach| Part {
            share: reach.ended - reach.started,
            steps: reach.steps,
        });
        parts.collect()
    }
}

/// The share of each procedure without a dry run: its steps. Empty if a number is not known.
pub fn parts_by_steps(plan: &Plan) -> Vec<Part> {
    let parts = plan.procedures.iter().map(|procedure| {
        let steps = most_steps(&procedure.kind, plan)?;
        #[expect(clippy::cast_precision_loss, reason = "a share of steps")]
        let share = steps as f64;
        Some(Part { share, steps })
    });
    parts.collect::<Option<_>>().unwrap_or_default()
}

/// The expected run of the whole plan; unknown if only the real rig has the specimen.
pub fn expectation(plan: &Plan) -> Expected {
    if plan.unknown_specimen().is_some() {
        return Expected::default();
    }
    let ideal = plan.on_an_ideal_rig();
    let (_, reaches) = Watched::run(&ideal, plan.rig.link.as_real().map(|link| link.own_speed));
    Expected {
        extent: over(&reaches),
        steps: reaches.iter().map(|reach| reach.steps).sum(),
        procedures: reaches,
    }
}

/// Whether the rig itself allows the expected travel and the pre-test check. With several axes, only a travel that no axis allows is
/// refused.
///
/// # Errors
/// It does not; nothing has moved.
pub fn within_reach(plan: &Plan, expected: Extent, rig: &RealRig) -> Result<(), RigFault> {
    let (Some(link), Some(ranges)) = (plan.rig.link.as_real(), rig.reported_range()) else {
        return Ok(());
    };
    let probes = (0..ranges.len()).map(|axis| link.pretest_check_of(axis).probe);
    let travels = probes.map(|probe| Interval {
        low: probe.min(0.0),
        high: probe.max(0.0),
    });
    let both = |one: Interval, other: Interval| Interval {
        low: one.low.min(other.low),
        high: one.high.max(other.high),
    };
    let (Some(travel), Some(allowed)) = (
        travels.chain(expected.travel).reduce(both),
        ranges.into_iter().reduce(both),
    ) else {
        return Ok(());
    };
    if allowed.contains(travel.low) && allowed.contains(travel.high) {
        return Ok(());
    }
    let span = |Interval { low, high }| {
        let [low, high] = [low, high].map(|end| plain(end, Dimension::LENGTH, 6));
        format!("{low} .. {high}")
    };
    Err(RigFault::Device(format!(
        "the run would move over {}, but from the plan's zero the rig itself allows {}: begin at another position, or choose smaller \
         displacements. Nothing moved",
        span(travel),
        span(allowed)
    )))
}

/// The remaining extent after `done` steps.
pub fn rest(extent: Extent, steps: u64, done: u64) -> Extent {
    #[expect(clippy::cast_precision_loss, reason = "a share of steps")]
    let share = if steps > 0 {
        1.0 - (done.min(steps) as f64) / (steps as f64)
    } else {
        1.0
    };
    Extent {
        duration: extent.duration.map(|duration| share * duration),
        ..extent
    }
}

fn over(reaches: &[Reach]) -> Extent {
    let moved = || reaches.iter().filter(|reach| reach.moved);
    let widest = |pick: fn(&Reach) -> Interval| {
        let spans = moved().map(pick).filter(|span| span.low <= span.high);
        spans.reduce(|a, b| Interval {
            low: a.low.min(b.low),
            high: a.high.max(b.high),
        })
    };
    Extent {
        travel: widest(|reach| whole(&reach.displacement)),
        force: widest(|reach| whole(&reach.force)),
        speed: moved().map(|reach| reach.speed).reduce(f64::max),
        duration: reaches.last().map(|reach| reach.ended),
    }
}
