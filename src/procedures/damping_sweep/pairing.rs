//! Pairs of readings of a stroke at the same position, out and back. In: the steps of both passes. Out: pairs, and the measured velocity.
//! It moves nothing.

use super::sweep::Stroke;
use crate::physics::identification::damping_strokes::OutAndBack;
use crate::physics::identification::fit_line;
use crate::record::{LineFit, SweepStep};

/// A stroke with its pairs of readings.
pub(super) type Paired<'a> = (&'a Stroke, Vec<OutAndBack>);

/// Pairs of readings at the same position by their times: the last reading of a pass is where the next one starts, and has no partner.
pub(super) fn paired_by_time(out: &[SweepStep], back: &[SweepStep]) -> Vec<OutAndBack> {
    let steady = out
        .iter()
        .zip(back.iter().rev().skip(1))
        .filter(|(out, back)| out.steady && back.steady);
    let pair = |(out, back): (&SweepStep, &SweepStep)| OutAndBack {
        velocity: out.velocity,
        displacement: 0.5 * (out.displacement + back.displacement),
        half_apart: 0.5 * (out.displacement - back.displacement),
        half_difference: 0.5 * (out.restoring_force - back.restoring_force),
        mean: 0.5 * (out.restoring_force + back.restoring_force),
    };
    steady.map(pair).collect()
}

/// Pairs at the positions of the pass with fewer readings; the force of the other pass is interpolated there.
pub(super) fn paired_by_position(out: &[SweepStep], back: &[SweepStep]) -> Vec<OutAndBack> {
    let steady = |pass: &[SweepStep]| {
        let mut pass: Vec<SweepStep> = pass.iter().filter(|step| step.steady).copied().collect();
        pass.sort_by(|one, other| one.displacement.total_cmp(&other.displacement));
        pass
    };
    let (out, back) = (steady(out), steady(back));
    let (sparse, dense) = if out.len() <= back.len() {
        (out, back)
    } else {
        (back, out)
    };
    let pair = |step: &SweepStep| {
        let other = interpolated(&dense, step.displacement)?;
        Some(OutAndBack {
            velocity: step.velocity,
            displacement: step.displacement,
            half_apart: 0.0,
            half_difference: 0.5 * (step.restoring_force - other),
            mean: 0.5 * (step.restoring_force + other),
        })
    };
    sparse.iter().filter_map(pair).collect()
}

/// Force \[N\] at `position` \[m\], interpolated between two readings; they are sorted by position.
fn interpolated(steps: &[SweepStep], position: f64) -> Option<f64> {
    let after = steps
        .iter()
        .position(|step| step.displacement >= position)?;
    let above = steps[after];
    if above.displacement == position {
        return Some(above.restoring_force);
    }
    let below = steps[after.checked_sub(1)?];
    let fraction = (position - below.displacement) / (above.displacement - below.displacement);
    Some(below.restoring_force + fraction * (above.restoring_force - below.restoring_force))
}

/// The line of measured position over time on the steady part: its slope is the velocity \[m/s\].
pub(super) fn velocity_of(pass: &[SweepStep]) -> Option<LineFit> {
    let steady = pass.iter().filter(|step| step.steady);
    let (times, positions): (Vec<f64>, Vec<f64>) = steady
        .map(|step| (step.wall_time, step.displacement))
        .unzip();
    fit_line(&times, &positions)
}
