//! The figures of a series of impacts: their list, captions and charts: the path and the motion of each, overlaid, and the response to
//! each against its energy. In: the history. Out: [`Chart`]s in SI with their captions.

use std::borrow::Cow;

use crate::procedures::common::limit_lines::conditions_on;
use crate::procedures::frame;
use crate::report::Run;
use crate::report::figures::chart::{
    Chart, Colour, DASHED, Marker, Quantity, SOLID, Series, Style, palette,
};
use crate::report::figures::points::Points;
use psd_plan::procedures::impact::block as schema;
use psd_plan::record::{EscalateHistory, FloorStep, ImpactStep, SeriesImpact};
use psd_plan::{Figure, FigureKind};
use psd_text::units::Dimension;
use psd_text::units::display::stated;

/// Figures of impacts on one degree of freedom, in the order of a report.
pub(crate) const FIGURES: &[FigureKind] = &[
    FigureKind::Escalate,
    FigureKind::ForceDisplacement,
    FigureKind::Displacement,
];

/// Figures of impacts on a storey.
pub(crate) const STOREY_FIGURES: &[FigureKind] = &[
    FigureKind::Escalate,
    FigureKind::Drift,
    FigureKind::Hysteresis,
    FigureKind::Displacement,
];

/// A figure and its caption; None if nothing was recorded for it, or for a figure of a different procedure.
pub(crate) fn chart(
    run: &Run<'_>,
    name: &str,
    history: &EscalateHistory,
    figure: &Figure,
) -> Option<(Chart, String)> {
    let kind = figure.kind;
    // The condition under which the series goes on.
    let limits = |result| conditions_on(run, figure.procedure, result);
    let struck = |impact: &SeriesImpact| !impact.history.steps.is_empty();
    if !history.impacts.iter().any(struck) {
        return None;
    }
    Some(match kind {
        FigureKind::ForceDisplacement => (
            force_displacement(history),
            format!(
                "{name}: restoring force against computed displacement for all impacts; lighter lines are earlier impacts."
            ),
        ),
        FigureKind::Displacement => (
            Chart {
                references: limits(schema::MAX_DISPLACEMENT),
                ..displacement(history)
            },
            match history.storeys().next() {
                None => format!(
                    "{name}: displacement against the simulated time of each impact; lighter lines are earlier impacts."
                ),
                Some(impact) => format!(
                    "{name}: displacement of floor {} against the simulated time of each impact; lighter lines are earlier impacts.",
                    impact.struck + 1
                ),
            },
        ),
        FigureKind::Escalate => (
            Chart {
                references: limits(schema::MAX_DISPLACEMENT),
                ..escalate(history)
            },
            match history.storeys().next() {
                None => format!(
                    "{name}: largest displacement of each impact, and the position after it, against its energy."
                ),
                Some(impact) => format!(
                    "{name}: largest displacement of floor {} in each impact, and its position after it, against its energy.",
                    impact.struck + 1
                ),
            },
        ),
        FigureKind::Drift => (
            Chart {
                references: limits(schema::MAX_DRIFT),
                ..drift(history)
            },
            format!(
                "{name}: largest drift of each storey in each impact, and the drift after it, against its energy."
            ),
        ),
        FigureKind::Hysteresis => {
            let steps: Vec<&FloorStep> = history
                .storeys()
                .flat_map(|impact| &impact.floors)
                .collect();
            let caption = format!(
                "{name}: {} against drift, impact after impact; straight lines connect successive impacts.",
                frame::captions::storey_shear(run)
            );
            (frame::charts::hysteresis(&steps), caption)
        }
        _ => return None,
    })
}

/// Restoring force against displacement, one curve per impact.
pub(crate) fn force_displacement(history: &EscalateHistory) -> Chart {
    over_each_other(
        history,
        Quantity {
            name: displaced(history),
            ..Quantity::along("", Dimension::LENGTH)
        },
        Quantity::of("Restoring force R", Dimension::FORCE),
        |step| (step.command, step.restoring_force),
    )
}

/// Displacement against the simulated time of each impact.
pub(crate) fn displacement(history: &EscalateHistory) -> Chart {
    let of = |step: &ImpactStep| (step.time, step.command);
    let displaced = Quantity {
        name: displaced(history),
        ..Quantity::of("", Dimension::LENGTH)
    };
    over_each_other(history, Quantity::time(), displaced, of)
}

/// Largest displacement, and the position after the impact, against its energy.
pub(crate) fn escalate(history: &EscalateHistory) -> Chart {
    let largest = |impact: &SeriesImpact| impact.number(schema::MAX_DISPLACEMENT.name);
    let peaks = history
        .impacts
        .iter()
        .filter_map(|impact| Some((impact.energy, largest(impact)?)))
        .collect();
    let rests = history
        .impacts
        .iter()
        .filter_map(|impact| Some((impact.energy, impact.rest_of_struck()?.0)))
        .collect();
    let failed = history
        .impacts
        .iter()
        .filter(|impact| impact.held == Some(false));
    let failed: Points = failed
        .filter_map(|impact| Some((impact.energy, largest(impact)?)))
        .collect();
    let mut series = vec![
        Series {
            label: "largest displacement".to_owned(),
            points: peaks,
            style: Style::line(palette::BLUE, 1.6, SOLID).marked(Marker::Disc(3.6)),
        },
        Series {
            label: "position after it".to_owned(),
            points: rests,
            style: Style::line(palette::GREEN, 1.4, DASHED).marked(Marker::Ring(4.0)),
        },
    ];
    if !failed.is_empty() {
        series.push(Series {
            label: "condition false".to_owned(),
            points: failed,
            style: Style::marker(palette::VERMILION, Marker::Ring(7.0)),
        });
    }
    Chart::of(
        Quantity::along("Energy of the impact", Dimension::ENERGY),
        Quantity {
            name: displaced(history),
            ..Quantity::of("", Dimension::LENGTH)
        },
        series,
    )
}

/// Largest drift of each storey, and the drift after the impact, against its energy.
pub(crate) fn drift(history: &EscalateHistory) -> Chart {
    let storeys = history
        .storeys()
        .next()
        .and_then(|impact| impact.floors.first())
        .map_or(0, |floors| floors.floors.computed.len());
    let largest = |impact: &SeriesImpact, storey: usize| {
        impact.list(schema::MAX_DRIFT.name)?.get(storey).copied()
    };
    let stayed =
        |impact: &SeriesImpact, storey: usize| impact.rest.as_ref()?.drift().get(storey).copied();
    let points = |of: &dyn Fn(&SeriesImpact, usize) -> Option<f64>, storey: usize| -> Points {
        history
            .impacts
            .iter()
            .filter_map(|impact| Some((impact.energy, of(impact, storey)?)))
            .collect()
    };
    let series = frame::charts::shown(storeys)
        .into_iter()
        .enumerate()
        .flat_map(|(curve, storey)| {
            let colour = frame::charts::style(curve, 1.6).colour;
            let peak = Style::line(colour, 1.6, SOLID).marked(Marker::Disc(3.2));
            let rest = Style::line(colour, 1.4, DASHED).marked(Marker::Ring(3.6));
            [
                Series {
                    label: format!("storey {}, largest", storey + 1),
                    points: points(&largest, storey),
                    style: peak,
                },
                Series {
                    label: format!("storey {}, after it", storey + 1),
                    points: points(&stayed, storey),
                    style: rest,
                },
            ]
        });
    Chart::of(
        Quantity::along("Energy of the impact", Dimension::ENERGY),
        Quantity::of("Drift", Dimension::LENGTH),
        series.collect(),
    )
}

/// The name of the displacement: that of the specimen, or of the struck floor.
fn displaced(history: &EscalateHistory) -> Cow<'static, str> {
    match history.storeys().next() {
        None => "Displacement X".into(),
        Some(impact) => format!("Displacement of floor {}", impact.struck + 1).into(),
    }
}

/// Largest number of labels of impacts: more of them hide the curves.
const MOST_LABELS: usize = 7;

/// One curve per impact, earlier ones lighter, the last one in a separate colour. Each is labelled with its energy; of many impacts, every
/// n-th one and the last.
fn over_each_other(
    history: &EscalateHistory,
    x: Quantity,
    y: Quantity,
    of: impl Fn(&ImpactStep) -> (f64, f64),
) -> Chart {
    let last = history.impacts.len().saturating_sub(1);
    let every = history.impacts.len().div_ceil(MOST_LABELS).max(1);
    // A label just before the last would overlap it.
    let labelled = |index: usize| {
        index == last || (index.is_multiple_of(every) && last - index >= every.div_ceil(2))
    };
    let series = history
        .impacts
        .iter()
        .enumerate()
        .map(|(index, impact)| Series {
            label: if labelled(index) {
                format!("impact {}, {}", index + 1, energy(impact))
            } else {
                String::new()
            },
            points: impact.history.steps.iter().map(|step| of(&step)).collect(),
            style: if index == last {
                Style::line(palette::VERMILION, 2.0, DASHED)
            } else {
                Style::line(shade(index, last), 1.5, SOLID)
            },
        });
    Chart::of(x, y, series.collect())
}

fn energy(impact: &SeriesImpact) -> String {
    stated(impact.energy, Dimension::ENERGY)
}

/// From light blue for the first impact to dark blue for the last but one.
fn shade(index: usize, last: usize) -> Colour {
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_IMPACTS")]
    let share = if last > 1 {
        index as f64 / (last - 1) as f64
    } else {
        1.0
    };
    let mix = |from: u8, to: u8| {
        let value = f64::from(from) + share * (f64::from(to) - f64::from(from));
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between two bytes"
        )]
        let byte = value.round() as u8;
        byte
    };
    // Paler than sky and darker than blue, so that neighbours can be distinguished.
    let (light, dark) = ((150, 206, 242), (0, 66, 120));
    (
        mix(light.0, dark.0),
        mix(light.1, dark.1),
        mix(light.2, dark.2),
    )
}
