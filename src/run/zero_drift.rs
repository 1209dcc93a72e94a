//! The zero readings of a rig before the first procedure and after the last. In: the limits of their drift, and how to unload. Out: a
//! [`Drift`] of the record, reported as notes. It assesses no requirement.

use super::session::Session;
use super::stop::Stop;
use psd_physics::identification::fit_line;
use psd_physics::statistics::samples::mean;
use psd_plan::record::{AxisDrift, Drift, EventKind, Zero};
use psd_plan::{DriftCheck, ZeroAfter};
use psd_rig::{Held, Reading, named_axis};
use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// Number of readings of a zero.
pub(crate) const READINGS: u32 = 10;

/// The instruction to the operator before the zero of a free cell is read.
const TAKE_OFF: &str =
    "remove the specimen from the load cell: its zero is read, and nothing moves";

/// With the specimen unloaded: reads the zeros, and has the following dwells evaluated.
pub(crate) fn before(check: DriftCheck, session: &mut Session<'_>) -> Result<Drift, Stop> {
    let axes = zeros(check.over, session)?
        .into_iter()
        .map(|before| AxisDrift {
            before,
            after: None,
        })
        .collect();
    session.guard.watch_holds(check.over);
    let drift = Drift {
        check,
        axes,
        held: Held::default(),
    };
    let texts = drift.axes.iter().map(|axis| describe(&axis.before));
    session.event(
        EventKind::Note,
        format!("zero before the test: {}", listed(texts)),
    );
    Ok(drift)
}

/// Reads the zeros again. If they are read with the specimen mounted, the rig returns to the position of the first zero readings: `home`
/// \[m\].
pub(crate) fn after(
    drift: &mut Drift,
    home: &[f64],
    session: &mut Session<'_>,
) -> Result<(), Stop> {
    match drift.check.after {
        ZeroAfter::Start => session.go_to_all(home, None)?,
        ZeroAfter::Free => session.inspect(TAKE_OFF)?,
        ZeroAfter::Nowhere => return Ok(()),
    }
    for (axis, zero) in drift.axes.iter_mut().zip(zeros(drift.check.over, session)?) {
        axis.after = Some(zero);
    }
    let changes = drift
        .axes
        .iter()
        .filter_map(|axis| axis.after.as_ref().zip(axis.change()));
    let texts = changes.map(|(zero, (by, _))| {
        format!(
            "{}, {} from the zero before",
            describe(zero),
            readable(by, Dimension::FORCE)
        )
    });
    session.event(
        EventKind::Note,
        format!("zero after the test: {}", listed(texts)),
    );
    Ok(())
}

/// `2 mN, drift 0.1 mN/s`
fn describe(zero: &Zero) -> String {
    let slope = readable(zero.force_slope, Dimension::FORCE);
    format!(
        "{} at rest, drift {slope}/s",
        readable(zero.force, Dimension::FORCE)
    )
}

/// Joins the values of several axes, each with its number.
fn listed(texts: impl Iterator<Item = String>) -> String {
    let texts: Vec<String> = texts.collect();
    let axes = texts.len();
    let named = |(index, texts): (usize, &String)| {
        named_axis(index, axes).map_or(texts.clone(), |axis| format!("axis {axis}: {texts}"))
    };
    texts
        .iter()
        .enumerate()
        .map(named)
        .collect::<Vec<_>>()
        .join("; ")
}

/// Readings over several seconds, at the present position.
fn zeros(over: f64, session: &mut Session<'_>) -> Result<Vec<Zero>, Stop> {
    let mut readings = vec![session.guard.read()?];
    for _ in 1..READINGS {
        session.guard.pause(over / f64::from(READINGS - 1))?;
        readings.push(session.guard.read()?);
    }
    let targets = session.guard.commanded().to_vec();
    Ok(targets
        .iter()
        .enumerate()
        .map(|(axis, target)| zero_of(axis, *target, &readings))
        .collect())
}

fn zero_of(axis: usize, target: f64, readings: &[Reading]) -> Zero {
    let time = readings.last().map_or(0.0, |reading| reading.time);
    let times: Vec<f64> = readings.iter().map(|reading| reading.time).collect();
    let forces: Vec<f64> = readings.iter().map(|reading| reading.force[axis]).collect();
    let positions: Vec<f64> = readings
        .iter()
        .map(|reading| reading.displacement[axis] - target)
        .collect();
    let slope = |values: &[f64]| fit_line(&times, values).map_or(0.0, |fit| fit.slope);
    let mean = |values: &[f64]| mean(values.iter().copied());
    Zero {
        time,
        force: mean(&forces),
        displacement: mean(&positions),
        force_slope: slope(&forces),
        displacement_slope: slope(&positions),
    }
}
