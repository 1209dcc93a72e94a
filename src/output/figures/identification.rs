//! Charts of the identification procedures: a stiffness ramp's line and a damping sweep's. In: their steps and fits.
//! Out: [`Chart`]s in SI.

use super::super::number;
use super::chart::{Chart, DASHED, Marker, Quantity, SOLID, Series, Style, palette};
use crate::quantity::Dimension;
use crate::record::{LineFit, RampHistory, RampStep, SweepHistory, SweepStep};

/// Measured points, the way back apart, and the line K·X + intercept.
pub(super) fn force_displacement(history: &RampHistory) -> Chart {
    let points =
        |wanted: bool| -> Vec<(f64, f64)> { history.steps.iter().filter(|step| step.returning == wanted).map(point).collect() };
    let mut series = Vec::new();
    if let Some(fit) = history.fit {
        let stiffness = number::with_uncertainty(fit.slope, Some(fit.slope_error), Dimension::STIFFNESS);
        series.push(Series {
            label: format!("fit, K = {stiffness}"),
            points: ends(history.steps.iter().map(|step| step.displacement)).map(|x| (x, fit.intercept + fit.slope * x)).to_vec(),
            style: Style::line(palette::VERMILION, 1.8, SOLID),
        });
    }
    let back = points(true);
    if !back.is_empty() {
        series.push(Series { label: "way back".to_owned(), points: back, style: RETURN });
    }
    series.push(Series { label: "measured".to_owned(), points: points(false), style: MEASURED });
    Chart {
        x: Quantity::along("Displacement X", Dimension::LENGTH),
        y: Quantity::of("Restoring force R", Dimension::FORCE),
        bands: Vec::new(),
        series,
        references: Vec::new(),
    }
}

const MEASURED: Style = Style::marker(palette::BLUE, Marker::Disc(4.0));
const RETURN: Style = Style { marker: Some(Marker::Ring(4.5)), ..Style::line(palette::GREEN, 1.2, DASHED) };
/// Readings drawn of a sweep, at most: a cloud says no more with more.
const CLOUD_POINTS: usize = 3000;

/// Steady readings, the mean at each velocity, and `F_d = c·v + F_c·sign v`.
pub(super) fn damping_fit(history: &SweepHistory) -> Chart {
    let steady: Vec<&SweepStep> = history.steps.iter().filter(|step| step.steady).collect();
    let every = steady.len().div_ceil(CLOUD_POINTS).max(1);
    let cloud = steady.iter().step_by(every).map(|step| (step.velocity, step.damping_force)).collect();
    let means = means(&steady);
    let mut series = vec![Series {
        label: "steady readings".to_owned(),
        points: cloud,
        style: Style::marker(palette::CLOUD, Marker::Disc(1.8)),
    }];
    if let Some(fit) = history.fit {
        let c = number::with_uncertainty(fit.slope, Some(fit.slope_error), Dimension::DAMPING);
        let friction = number::with_uncertainty(fit.intercept, Some(fit.intercept_error), Dimension::FORCE);
        let [low, high] = ends(means.iter().map(|mean| mean.0));
        for (index, side) in [(low.max(0.0), high.max(0.0)), (low.min(0.0), high.min(0.0))].into_iter().enumerate() {
            let from = if index == 0 { (0.0, side.1) } else { (side.0, 0.0) };
            if from.0 == from.1 {
                continue;
            }
            // One name for both halves: the Coulomb part changes sign with the velocity.
            let label = if series.len() == 1 { format!("fit, c = {c}, Fc = {friction}") } else { String::new() };
            let sign = if index == 0 { 1.0 } else { -1.0 };
            series.push(Series {
                label,
                points: vec![(from.0, line(fit, from.0, sign)), (from.1, line(fit, from.1, sign))],
                style: Style::line(palette::VERMILION, 1.8, SOLID),
            });
        }
    }
    series.push(Series { label: "mean".to_owned(), points: means, style: MEASURED });
    Chart {
        x: Quantity::along("Velocity", Dimension::VELOCITY),
        y: Quantity::of("Damping force", Dimension::FORCE),
        bands: Vec::new(),
        series,
        references: Vec::new(),
    }
}

fn line(fit: LineFit, velocity: f64, sign: f64) -> f64 {
    fit.slope * velocity + fit.intercept * sign
}

/// Mean damping force at each commanded velocity, in order of velocity.
fn means(steady: &[&SweepStep]) -> Vec<(f64, f64)> {
    let mut sorted: Vec<(f64, f64)> = steady.iter().map(|step| (step.velocity, step.damping_force)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    sorted
        .chunk_by(|a, b| a.0 == b.0)
        .map(|group| {
            #[expect(clippy::cast_precision_loss, reason = "far below 2^52 readings")]
            let count = group.len() as f64;
            (group[0].0, group.iter().map(|(_, force)| force).sum::<f64>() / count)
        })
        .collect()
}

fn point(step: &RampStep) -> (f64, f64) {
    (step.displacement, step.restoring_force)
}

/// Smallest and largest.
fn ends(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    [low, high]
}
