//! The figures of a stiffness ramp: their list, captions and charts, and the line of a damping sweep. In: steps and fits. Out: [`Chart`]s in
//! SI with their captions.

pub(crate) mod relaxation_figures;

use crate::report::figures::chart::{
    Chart, DASHED, Marker, Quantity, SOLID, Series, Style, palette,
};
use crate::report::figures::points::Points;
use crate::report::number;
use psd_plan::FigureKind;
use psd_plan::record::{
    DampingSweepHistory, MultilinearFit, RampStep, StiffnessRampHistory, SweepStep,
};
use psd_text::units::Dimension;

/// In the order of a report.
pub(crate) const FIGURES: &[FigureKind] = &[FigureKind::ForceDisplacement, FigureKind::Relaxation];

/// A figure and its caption; None if nothing was recorded for it, or if a ramp does not have this figure.
pub(crate) fn chart(
    name: &str,
    history: &StiffnessRampHistory,
    kind: FigureKind,
) -> Option<(Chart, String)> {
    Some(match (kind, &history.reached) {
        (FigureKind::ForceDisplacement, _) if !history.steps.is_empty() => (
            force_displacement(history),
            format!(
                "{name}: measured restoring force against displacement, with the least-squares fit."
            ),
        ),
        (FigureKind::Relaxation, Some(fit)) => (
            relaxation_figures::lost(&history.holds, fit),
            format!(
                "{name}: force lost in the pauses, with the relaxation laws, against dwell time."
            ),
        ),
        (FigureKind::Relaxation, None) => (
            relaxation_figures::left(history, history.relaxation.as_ref()?),
            format!(
                "{name}: remaining relaxation, measured minus fitted final force, against dwell time."
            ),
        ),
        _ => return None,
    })
}

/// Measured points, with the unloading branch separate, and the line K·X + intercept.
pub(crate) fn force_displacement(history: &StiffnessRampHistory) -> Chart {
    let points = |wanted: bool| -> Points {
        history
            .steps
            .iter()
            .filter(|step| step.returning == wanted)
            .map(point)
            .collect()
    };
    let mut series = Vec::new();
    if let Some(fit) = history.fit {
        let stiffness =
            number::with_uncertainty(fit.slope, Some(fit.slope_error), Dimension::STIFFNESS);
        series.push(Series {
            label: format!("fit, K = {stiffness}"),
            points: ends(history.steps.iter().map(|step| step.displacement))
                .map(|x| (x, fit.intercept + fit.slope * x))
                .into_iter()
                .collect(),
            style: Style::line(palette::VERMILION, 1.8, SOLID),
        });
    }
    if let Some(fit) = history.bilinear {
        let stiffness = number::with_uncertainty(
            fit.stiffness,
            Some(fit.stiffness_error),
            Dimension::STIFFNESS,
        );
        let force = number::with_uncertainty(
            fit.yield_force,
            Some(fit.yield_force_error),
            Dimension::FORCE,
        );
        let [low, high] = ends(
            history
                .steps
                .iter()
                .filter(|step| !step.returning)
                .map(|step| step.displacement),
        );
        series.push(Series {
            label: format!("fit, K = {stiffness}, Fy = {force}"),
            points: [low, fit.yield_displacement, high]
                .map(|x| (x, fit.force(x)))
                .into_iter()
                .collect(),
            style: Style::line(palette::VERMILION, 1.8, SOLID),
        });
    }
    if let Some(fit) = &history.multilinear {
        series.push(curve(fit, history));
    }
    let back = points(true);
    if !back.is_empty() {
        series.push(Series {
            label: "return path".to_owned(),
            points: back,
            style: RETURN,
        });
    }
    series.push(Series {
        label: "measured".to_owned(),
        points: points(false),
        style: MEASURED,
    });
    Chart::of(
        Quantity::along("Displacement X", Dimension::LENGTH),
        Quantity::of("Restoring force R", Dimension::FORCE),
        series,
    )
}

/// The segments of the curve, between the ends of the readings and through the breakpoints.
fn curve(fit: &MultilinearFit, history: &StiffnessRampHistory) -> Series {
    let [low, high] = ends(
        history
            .steps
            .iter()
            .filter(|step| !step.returning)
            .map(|step| step.displacement),
    );
    let mut displacements: Vec<f64> = fit
        .breakpoints
        .iter()
        .map(|(displacement, _)| *displacement)
        .chain([low, high])
        .collect();
    displacements.sort_by(f64::total_cmp);
    let stiffness = number::with_uncertainty(
        fit.stiffnesses[0].0,
        Some(fit.stiffnesses[0].1),
        Dimension::STIFFNESS,
    );
    let label = match fit.breakpoints.len() {
        0 => format!("fit, no breakpoint, K = {stiffness}"),
        1 => format!("fit, 1 breakpoint, initial K = {stiffness}"),
        count => format!("fit, {count} breakpoints, initial K = {stiffness}"),
    };
    Series {
        label,
        points: displacements
            .into_iter()
            .map(|x| (x, fit.force(x)))
            .collect(),
        style: Style::line(palette::VERMILION, 1.8, SOLID).marked(Marker::Ring(5.0)),
    }
}

const MEASURED: Style = Style::marker(palette::BLUE, Marker::Disc(4.0));
const RETURN: Style = Style::line(palette::GREEN, 1.2, DASHED).marked(Marker::Ring(4.5));
/// Largest number of readings drawn for a sweep: more points show nothing more.
const CLOUD_POINTS: usize = 3000;

/// Steady readings in a light tone, the fitted means with their standard error at each velocity, and `F_d = c·v + F_c`. The readings of
/// both directions are drawn on one side, each with the sign of its motion.
pub(crate) fn damping_fit(history: &DampingSweepHistory) -> Chart {
    let steady: Vec<&SweepStep> = history.steps.iter().filter(|step| step.steady).collect();
    let every = steady.len().div_ceil(CLOUD_POINTS).max(1);
    let cloud = steady
        .iter()
        .step_by(every)
        .map(|step| along(step.velocity, step.damping_force))
        .collect();
    let mut series = vec![Series {
        label: "steady readings".to_owned(),
        points: cloud,
        style: Style::marker(palette::CLOUD, Marker::Disc(1.8)),
    }];
    let commanded = steady.iter().map(|step| step.velocity.abs());
    let means = means(&history.pairs, commanded);
    if let Some(fit) = history.fit {
        let c = number::with_uncertainty(fit.slope, Some(fit.slope_error), Dimension::DAMPING);
        let friction =
            number::with_uncertainty(fit.intercept, Some(fit.intercept_error), Dimension::FORCE);
        let fastest = means.iter().map(|mean| mean.velocity).fold(0.0, f64::max);
        series.push(Series {
            label: format!("fit, c = {c}, Fc = {friction}"),
            points: [0.0, fastest]
                .map(|velocity| (velocity, fit.intercept + fit.slope * velocity))
                .into_iter()
                .collect(),
            style: Style::line(palette::VERMILION, 1.8, SOLID),
        });
    }
    series.extend(means.iter().map(|mean| {
        Series {
            label: String::new(),
            points: [
                mean.force - mean.standard_error,
                mean.force + mean.standard_error,
            ]
            .map(|force| (mean.velocity, force))
            .into_iter()
            .collect(),
            style: Style::line(palette::BLACK, 1.6, SOLID),
        }
    }));
    series.push(Series {
        label: "half the difference of out and back, mean ± standard error".to_owned(),
        points: means
            .iter()
            .map(|mean| (mean.velocity, mean.force))
            .collect(),
        style: Style::marker(palette::BLUE, Marker::Disc(3.2)),
    });
    Chart::of(
        Quantity::along("Velocity", Dimension::VELOCITY),
        Quantity::of("Damping force", Dimension::FORCE),
        series,
    )
}

/// Absolute value of the velocity \[m/s\], and the force with the sign of the motion \[N\].
fn along(velocity: f64, force: f64) -> (f64, f64) {
    (velocity.abs(), force * velocity.signum())
}

/// The mean of the pairs of one commanded velocity.
struct Mean {
    /// Mean, which a lagging actuator keeps below the commanded one \[m/s\].
    velocity: f64,
    /// \[N\]
    force: f64,
    /// Standard error of the mean \[N\]; 0 for one pair.
    standard_error: f64,
}

/// One mean per commanded velocity, in order. A pair belongs to the nearest one.
fn means(pairs: &[(f64, f64)], commanded: impl Iterator<Item = f64>) -> Vec<Mean> {
    let mut speeds: Vec<f64> = commanded.collect();
    speeds.sort_by(f64::total_cmp);
    speeds.dedup();
    let mut groups = vec![Vec::new(); speeds.len()];
    for (velocity, force) in pairs {
        let (speed, force) = along(*velocity, *force);
        let above = speeds.partition_point(|commanded| *commanded < speed);
        let nearest = (above.saturating_sub(1)..speeds.len().min(above + 1)).min_by(|a, b| {
            (speeds[*a] - speed)
                .abs()
                .total_cmp(&(speeds[*b] - speed).abs())
        });
        if let Some(nearest) = nearest {
            groups[nearest].push((speed, force));
        }
    }
    let mean = |group: &Vec<(f64, f64)>| {
        #[expect(clippy::cast_precision_loss, reason = "far below 2^52 readings")]
        let count = group.len() as f64;
        let velocity = group.iter().map(|(velocity, _)| velocity).sum::<f64>() / count;
        let force = group.iter().map(|(_, force)| force).sum::<f64>() / count;
        let spread: f64 = group.iter().map(|(_, other)| (other - force).powi(2)).sum();
        let standard_error = if count > 1.0 {
            (spread / (count - 1.0) / count).sqrt()
        } else {
            0.0
        };
        Mean {
            velocity,
            force,
            standard_error,
        }
    };
    let read = groups.iter().filter(|group| !group.is_empty());
    read.map(mean).collect()
}

fn point(step: &RampStep) -> (f64, f64) {
    (step.displacement, step.restoring_force)
}

/// Smallest and largest.
fn ends(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    [low, high]
}

#[cfg(test)]
mod tests {
    use super::means;

    #[test]
    fn the_bar_of_a_velocity_is_the_standard_error_of_its_mean() {
        // 1, 2, 3: standard deviation 1, of the mean 1/√3. The return pass has its own sign. A lagging actuator is slower.
        let pairs = [(0.1, 1.0), (0.02, 5.0), (-0.098, -2.0), (0.099, 3.0)];
        let means = means(&pairs, [0.02, 0.1, 0.1].into_iter());
        assert_eq!(
            (means.len(), means[0].force, means[0].standard_error),
            (2, 5.0, 0.0)
        );
        assert!(
            (means[1].velocity - 0.099).abs() < 1e-12
                && (means[1].force - 2.0).abs() < 1e-12
                && (means[1].standard_error - 3_f64.sqrt().recip()).abs() < 1e-12
        );
    }
}
