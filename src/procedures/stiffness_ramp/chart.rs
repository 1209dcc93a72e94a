//! The list of figures of a stiffness ramp, and their content. In: a history. Out: [`Chart`]s in SI with their captions.

use super::figures;
use super::figures::relaxation_figures;
use crate::plan::FigureKind;
use crate::record::RampHistory;
use crate::report::figures::chart::Chart;

/// In the order of a report.
pub(crate) const FIGURES: &[FigureKind] = &[FigureKind::ForceDisplacement, FigureKind::Relaxation];

/// A figure and its caption; None if nothing was recorded for it, or if a ramp does not have this figure.
pub(crate) fn chart(
    name: &str,
    history: &RampHistory,
    kind: FigureKind,
) -> Option<(Chart, String)> {
    Some(match (kind, &history.reached) {
        (FigureKind::ForceDisplacement, _) if !history.steps.is_empty() => (
            figures::force_displacement(history),
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
