//! Several procedures of one kind on one chart, one curve each, on the same axes. In: their records, the figure. Out: a
//! [`Chart`] in SI and what it shows in words. Bounds of requirements stand on the figures of the procedure they bound. Of a
//! frame the top floor stands for its displacement and the lowest storey, which carries all the others, for its drift and shear.

use super::chart::{Chart, Colour, DASH_DOT, DOTTED, LONG, Quantity, SOLID, SPARSE, Series, Style, palette};
use super::points::Points;
use crate::plan::{FigureKind, MOST_TOGETHER};
use crate::quantity::Dimension;
use crate::record::{Floors, History, ImpactHistory, ProcedureRecord, ShakeHistory, ShakeStep};

/// Those that may lie on each other are told apart all the same: a narrow line of gaps on a broad one shows both.
const STYLES: [(Colour, f64, &[f64]); MOST_TOGETHER] = [
    (palette::BLUE, 2.0, SOLID),
    (palette::VERMILION, 2.6, SOLID),
    (palette::BLACK, 1.3, SPARSE),
    (palette::GREEN, 1.8, LONG),
    (palette::PURPLE, 1.6, DASH_DOT),
    (palette::SKY, 1.8, DOTTED),
];

const LOOP: f64 = 1.2;

/// What one chart of several procedures shows of each.
struct Shown {
    x: Quantity,
    y: Quantity,
    words: &'static str,
}

/// The chart, and its words; None where no procedure has steps, or none has this figure.
pub(super) fn chart(kind: FigureKind, procedures: &[&ProcedureRecord]) -> Option<(Chart, String)> {
    let first = procedures.iter().find_map(|procedure| shown(kind, &procedure.history))?;
    // A loop that runs many times needs a fine line.
    let loops = matches!(kind, FigureKind::ForceDisplacement | FigureKind::Hysteresis);
    let curves = procedures.iter().zip(STYLES).filter_map(|(procedure, (colour, width, dash))| {
        let width = if loops { LOOP } else { width };
        let points = points(kind, &procedure.history).filter(|points| !points.is_empty())?;
        Some(Series { label: procedure.name.clone(), points, style: Style::line(colour, width, dash) })
    });
    let series: Vec<Series> = curves.collect();
    if series.is_empty() {
        return None;
    }
    let names: Vec<&str> = series.iter().map(|series| series.label.as_str()).collect();
    let names = match names.split_last() {
        Some((last, before)) if !before.is_empty() => format!("{} and {last}", before.join(", ")),
        _ => names.concat(),
    };
    let caption = format!("{names} on one chart: {}.", first.words);
    Some((Chart { x: first.x, y: first.y, bands: Vec::new(), series, references: Vec::new() }, caption))
}

fn shown(kind: FigureKind, history: &History) -> Option<Shown> {
    let over_time = |name, dimension, words| Shown { x: Quantity::time(), y: Quantity::of(name, dimension), words };
    let (length, force, velocity) = (Dimension::LENGTH, Dimension::FORCE, Dimension::VELOCITY);
    Some(match (history, kind) {
        (History::Impact(_), FigureKind::Displacement) => {
            over_time("Displacement X", length, "displacement of the structure against virtual time")
        }
        (History::Impact(_), FigureKind::Velocity) => {
            over_time("Velocity of the structure", velocity, "velocity of the structure against virtual time")
        }
        (History::Impact(_), FigureKind::StrikerVelocity) => {
            over_time("Striker velocity", velocity, "velocity of the striker against virtual time")
        }
        (History::Impact(_), FigureKind::ContactForce) => {
            over_time("Contact force", force, "contact force, mean over each step, against virtual time")
        }
        (History::Impact(_), FigureKind::ForceDisplacement) => Shown {
            x: Quantity::along("Displacement X", length),
            y: Quantity::of("Restoring force R", force),
            words: "measured restoring force against displacement",
        },
        (History::Shake(_), FigureKind::Displacement) => {
            over_time("Displacement of the top floor", length, "displacement of the top floor against virtual time")
        }
        (History::Shake(_), FigureKind::Drift) => {
            over_time("Drift of the lowest storey", length, "drift of the lowest storey against virtual time")
        }
        (History::Shake(_), FigureKind::Hysteresis) => Shown {
            x: Quantity::along("Drift of the lowest storey", length),
            y: Quantity::of("Base shear", force),
            words: "measured shear of the lowest storey against its drift",
        },
        (History::Shake(_), FigureKind::BaseShear) => {
            over_time("Base shear", force, "base shear, the sum of the measured restoring forces, against virtual time")
        }
        _ => return None,
    })
}

/// One procedure's curve.
fn points(kind: FigureKind, history: &History) -> Option<Points> {
    match history {
        History::Impact(history) => impact(kind, history),
        History::Shake(history) => shake(kind, history),
        _ => None,
    }
}

fn impact(kind: FigureKind, ImpactHistory { steps, .. }: &ImpactHistory) -> Option<Points> {
    Some(match kind {
        FigureKind::Displacement => steps.iter().map(|step| (step.time, step.computed)).collect(),
        FigureKind::Velocity => steps.iter().map(|step| (step.time, step.velocity)).collect(),
        FigureKind::StrikerVelocity => steps.iter().map(|step| (step.time, step.striker_velocity)).collect(),
        FigureKind::ContactForce => steps
            .windows(2)
            .flat_map(|pair| [(pair[0].time, pair[1].contact_force), (pair[1].time, pair[1].contact_force)])
            .collect(),
        FigureKind::ForceDisplacement => steps.iter().map(|step| (step.command, step.restoring_force)).collect(),
        _ => return None,
    })
}

fn shake(kind: FigureKind, ShakeHistory { steps, .. }: &ShakeHistory) -> Option<Points> {
    let lowest = |values: Vec<f64>| values.first().copied().unwrap_or(0.0);
    let base_shear = |step: &ShakeStep| step.restoring_force.iter().sum();
    Some(match kind {
        FigureKind::Displacement => steps.iter().map(|step| (step.time, step.computed.last().copied().unwrap_or(0.0))).collect(),
        FigureKind::Drift => steps.iter().map(|step| (step.time, lowest(step.drift()))).collect(),
        FigureKind::Hysteresis => steps.iter().map(|step| (lowest(step.drift()), base_shear(step))).collect(),
        FigureKind::BaseShear => steps.iter().map(|step| (step.time, base_shear(step))).collect(),
        _ => return None,
    })
}
