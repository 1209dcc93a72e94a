//! The figure of a damping sweep and its content. In: a history. Out: a [`Chart`] in SI with its caption.

use crate::procedures::stiffness_ramp;
use crate::report::figures::chart::Chart;
use psd_plan::FigureKind;
use psd_plan::record::DampingSweepHistory;

/// In the order of a report.
pub(crate) const FIGURES: &[FigureKind] = &[FigureKind::DampingFit];

/// A figure and its caption; None if nothing was recorded for it, or if a sweep does not have this figure.
pub(crate) fn chart(
    name: &str,
    history: &DampingSweepHistory,
    kind: FigureKind,
) -> Option<(Chart, String)> {
    Some(match kind {
        FigureKind::DampingFit if history.steps.iter().any(|step| step.steady) => (
            stiffness_ramp::figures::damping_fit(history),
            format!(
                "{name}: damping force along the motion against velocity: steady readings of both directions, half \
                 the difference of out and back at one position with its standard error, and the fitted line."
            ),
        ),
        _ => return None,
    })
}
