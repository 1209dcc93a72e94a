//! Pairs of readings of a stroke at the same position, out and back. In: the steps of both passes. Out: pairs, and the measured velocity.
//! It moves nothing.

use super::sweep::Stroke;
use psd_physics::identification::damping_strokes::OutAndBack;
use psd_physics::identification::fit_line;
use psd_plan::record::{LineFit, SweepStep};

/// A stroke with its pairs of readings.
pub(super) type Paired<'a> = (&'a Stroke, Vec<OutAndBack>);

/// Pairs of readings at the same position by their times: the last reading of a pass is where the next one starts, and has no partner.
/// An actuator with a `lag` \[s\] still approaches the commanded velocity v on the steady part. After the time t of a pass it moves at
/// v·(1 − e^(−t/lag)) if it began at rest, and at v·(1 − (2 − e^(−T/lag))·e^(−t/lag)) after the pass of T in the other direction.
pub(super) fn paired_by_time(
    out: &[SweepStep],
    back: &[SweepStep],
    seconds: f64,
    lag: f64,
) -> Vec<OutAndBack> {
    let reversal = 2.0 - faded(seconds, lag);
    #[expect(clippy::cast_precision_loss, reason = "far fewer samples than 2^53")]
    let time = |index: usize| seconds * (index + 1) as f64 / out.len() as f64;
    let last = out.len().saturating_sub(2);
    let steady = out
        .iter()
        .zip(back.iter().rev().skip(1))
        .enumerate()
        .filter(|(_, (out, back))| out.steady && back.steady);
    let pair = |(index, (out, back)): (usize, (&SweepStep, &SweepStep))| {
        let velocity = out.velocity * (1.0 - faded(time(index), lag));
        let returning = back.velocity * (1.0 - reversal * faded(time(last - index), lag));
        OutAndBack {
            velocity: 0.5 * (velocity - returning),
            unmatched_velocity: 0.5 * (velocity + returning),
            displacement: 0.5 * (out.displacement + back.displacement),
            half_apart: 0.5 * (out.displacement - back.displacement),
            half_difference: 0.5 * (out.restoring_force - back.restoring_force),
            mean: 0.5 * (out.restoring_force + back.restoring_force),
        }
    };
    steady.map(pair).collect()
}

/// What a first-order lag \[s\] leaves of a change of velocity after so many seconds.
fn faded(seconds: f64, lag: f64) -> f64 {
    if lag > 0.0 {
        (-seconds / lag).exp()
    } else {
        0.0
    }
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
            unmatched_velocity: 0.0,
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
