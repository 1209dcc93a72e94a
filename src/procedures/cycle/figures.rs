//! The figures of a `cycle`: their list, captions and charts: loops, backbone, energy and stiffness cycle by cycle. In: the history. Out:
//! [`Chart`]s in SI with their captions.

use crate::report::figures::chart::{
    Chart, DASHED, LONG, Marker, Quantity, SOLID, Series, Style, palette,
};
use crate::report::figures::points::Points;
use psd_plan::FigureKind;
use psd_plan::record::{CycleHistory, MultilinearFit, WholeCycle};
use psd_text::units::Dimension;

/// In the order of a report.
pub(crate) const FIGURES: &[FigureKind] = &[
    FigureKind::ForceDisplacement,
    FigureKind::Backbone,
    FigureKind::CycleEnergy,
    FigureKind::StiffnessDegradation,
];

/// A figure and its caption; None if nothing was recorded for it, or if a `cycle` does not have this figure.
pub(crate) fn chart(
    name: &str,
    history: &CycleHistory,
    kind: FigureKind,
) -> Option<(Chart, String)> {
    if history.cycles.is_empty() {
        return None;
    }
    Some(match kind {
        FigureKind::ForceDisplacement => (
            loops(history),
            format!(
                "{name}: restoring force against displacement; the area of a loop is the energy of its cycle."
            ),
        ),
        FigureKind::Backbone => (
            backbone(history),
            format!(
                "{name}: backbone, the force at the ends of the cycles, amplitude by amplitude."
            ),
        ),
        FigureKind::CycleEnergy => (
            energy(history),
            format!("{name}: energy of each cycle, and cumulative energy."),
        ),
        FigureKind::StiffnessDegradation => (
            stiffness(history),
            format!("{name}: secant stiffness of each cycle."),
        ),
        _ => return None,
    })
}

/// Every loop, the last one on top.
pub(crate) fn loops(history: &CycleHistory) -> Chart {
    let point = |step: &psd_plan::record::CycleStep| (step.displacement, step.restoring_force);
    let last = history.cycles.last().map_or(u64::MAX, |cycle| cycle.cycle);
    let all = history.steps.iter().map(point).collect();
    // Its own readings, and the one at which it begins.
    let before = history.steps.iter().rposition(|step| step.cycle < last);
    let of_last = before.map_or_else(Points::default, |from| {
        history.steps[from..].iter().map(point).collect()
    });
    let mut series = vec![Series {
        label: match history.cycles.len() {
            1 => "1 cycle".to_owned(),
            count => format!("{count} cycles"),
        },
        points: all,
        style: Style::line(palette::BLUE, 1.3, SOLID),
    }];
    if history.cycles.len() > 1 {
        series.push(Series {
            label: "the last".to_owned(),
            points: of_last,
            style: Style::line(palette::VERMILION, 2.0, SOLID),
        });
    }
    Chart::of(
        Quantity::along("Displacement X", Dimension::LENGTH),
        Quantity::of("Restoring force R", Dimension::FORCE),
        series,
    )
}

/// The ends of the first cycle at each amplitude, and of the last one if there are more.
pub(crate) fn backbone(history: &CycleHistory) -> Chart {
    let mut first: Vec<&WholeCycle> = history
        .cycles
        .iter()
        .filter(|cycle| cycle.repeat == 1)
        .collect();
    let mut last: Vec<&WholeCycle> = history
        .cycles
        .chunk_by(|a, b| b.repeat > a.repeat)
        .filter_map(|level| level.last())
        .collect();
    let repeated = last.iter().any(|cycle| cycle.repeat > 1);
    let envelope = |cycles: &mut Vec<&WholeCycle>| {
        let mut points: Vec<(f64, f64)> =
            cycles.iter().flat_map(|cycle| cycle.found.ends).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Points::from(points)
    };
    let mut series = vec![Series {
        label: "first cycle of each amplitude".to_owned(),
        points: envelope(&mut first),
        // A fitted curve is drawn as the line through them.
        style: match history.backbone {
            Some(_) => Style::marker(palette::BLUE, Marker::Disc(3.6)),
            None => Style::line(palette::BLUE, 1.8, SOLID).marked(Marker::Disc(3.6)),
        },
    }];
    if repeated {
        series.push(Series {
            label: "last cycle of each amplitude".to_owned(),
            points: envelope(&mut last),
            style: Style::line(palette::VERMILION, 1.4, DASHED).marked(Marker::Ring(4.2)),
        });
    }
    if let Some(fit) = &history.backbone {
        series.extend(sides(fit, history));
    }
    Chart::of(
        Quantity::along("Displacement X", Dimension::LENGTH),
        Quantity::of("Restoring force R", Dimension::FORCE),
        series,
    )
}

/// The curve on each side that the cycles reached; one name for both.
fn sides(fit: &MultilinearFit, history: &CycleHistory) -> Vec<Series> {
    let middle = history.middle();
    let reach = history
        .backbone_points()
        .iter()
        .map(|(x, _)| *x)
        .fold(0.0, f64::max);
    let displacements: Vec<f64> = [0.0]
        .into_iter()
        .chain(
            fit.breakpoints
                .iter()
                .map(|(displacement, _)| *displacement),
        )
        .chain([reach])
        .collect();
    let went = |direction: f64| {
        history
            .cycles
            .iter()
            .flat_map(|cycle| cycle.found.ends)
            .any(|(x, _)| direction * (x - middle) > 0.5 * reach)
    };
    let mut label = format!("fit of {} segments", fit.stiffnesses.len());
    let side = |direction: f64| Series {
        label: std::mem::take(&mut label),
        points: displacements
            .iter()
            .map(|x| (middle + direction * x, direction * fit.force(*x)))
            .collect(),
        style: Style::line(palette::GREEN, 1.6, LONG),
    };
    [1.0, -1.0]
        .into_iter()
        .filter(|direction| went(*direction))
        .map(side)
        .collect()
}

/// The energy dissipated by each cycle, and the sum so far.
pub(crate) fn energy(history: &CycleHistory) -> Chart {
    let mut sum = 0.0;
    let cumulated = history
        .cycles
        .iter()
        .map(|cycle| {
            sum += cycle.found.energy;
            (number(cycle), sum)
        })
        .collect();
    let each = history
        .cycles
        .iter()
        .map(|cycle| (number(cycle), cycle.found.energy))
        .collect();
    let series = vec![
        Series {
            label: "cumulative".to_owned(),
            points: cumulated,
            style: Style::line(palette::SKY, 1.8, DASHED),
        },
        Series {
            label: "each cycle".to_owned(),
            points: each,
            style: Style::line(palette::BLUE, 1.4, SOLID).marked(Marker::Disc(3.6)),
        },
    ];
    Chart::of(
        Quantity::along("Cycle", Dimension::NUMBER),
        Quantity::of("Energy", Dimension::ENERGY),
        series,
    )
}

/// Secant stiffness cycle by cycle.
pub(crate) fn stiffness(history: &CycleHistory) -> Chart {
    let points = history
        .cycles
        .iter()
        .filter_map(|cycle| Some((number(cycle), cycle.found.stiffness?)))
        .collect();
    let style = Style::line(palette::BLUE, 1.4, SOLID).marked(Marker::Disc(3.6));
    let series = vec![Series {
        label: "secant stiffness".to_owned(),
        points,
        style,
    }];
    Chart::of(
        Quantity::along("Cycle", Dimension::NUMBER),
        Quantity::of("Secant stiffness", Dimension::STIFFNESS),
        series,
    )
}

#[expect(clippy::cast_precision_loss, reason = "far fewer cycles than 2^53")]
fn number(cycle: &WholeCycle) -> f64 {
    cycle.cycle as f64
}
