//! The list of figures of a `cycle`, and their content. In: a history. Out: [`Chart`]s in SI with their captions.

use super::figures;
use crate::plan::FigureKind;
use crate::record::CycleHistory;
use crate::report::figures::chart::Chart;

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
            figures::loops(history),
            format!(
                "{name}: restoring force against displacement; the area of a loop is the energy of its cycle."
            ),
        ),
        FigureKind::Backbone => (
            figures::backbone(history),
            format!(
                "{name}: backbone, the force at the ends of the cycles, amplitude by amplitude."
            ),
        ),
        FigureKind::CycleEnergy => (
            figures::energy(history),
            format!("{name}: energy of each cycle, and cumulative energy."),
        ),
        FigureKind::StiffnessDegradation => (
            figures::stiffness(history),
            format!("{name}: secant stiffness of each cycle."),
        ),
        _ => return None,
    })
}
