//! The figures of a series of impacts, with their captions. In: a history. Out: [`Chart`]s in SI.

use super::figures;
use crate::plan::FigureKind;
use crate::procedures::base_excitation;
use crate::record::{EscalateHistory, FloorStep, SeriesImpact};
use crate::report::figures::chart::Chart;

/// Figures of impacts on one degree of freedom, in the order of a report.
pub(crate) const FIGURES: &[FigureKind] = &[
    FigureKind::ImpactSeries,
    FigureKind::ForceDisplacement,
    FigureKind::Displacement,
];

/// Figures of impacts on a storey.
pub(crate) const STOREY_FIGURES: &[FigureKind] = &[
    FigureKind::ImpactSeries,
    FigureKind::Drift,
    FigureKind::Hysteresis,
    FigureKind::Displacement,
];

/// A figure and its caption; None if nothing was recorded for it, or for a figure of a different procedure.
pub(crate) fn chart(
    name: &str,
    history: &EscalateHistory,
    kind: FigureKind,
) -> Option<(Chart, String)> {
    let struck = |impact: &SeriesImpact| !impact.impact().steps.is_empty();
    if !history.impacts.iter().any(struck) {
        return None;
    }
    Some(match kind {
        FigureKind::ForceDisplacement => (
            figures::force_displacement(history),
            format!(
                "{name}: restoring force against computed displacement for all impacts; lighter lines are earlier impacts."
            ),
        ),
        FigureKind::Displacement => (
            figures::displacement(history),
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
        FigureKind::ImpactSeries => (
            figures::impact_series(history),
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
            figures::drift(history),
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
                "{name}: measured storey shear against drift, impact after impact; straight lines connect successive impacts."
            );
            (base_excitation::figures::hysteresis(&steps), caption)
        }
        _ => return None,
    })
}
