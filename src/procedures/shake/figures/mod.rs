//! The figures of a ground-motion test, with their captions, and the curve of a test on a chart of several. In: a history. Out: [`Chart`]s
//! in SI.

pub(crate) mod charts;

use crate::procedures::common::limit_lines::limits_on;
use crate::report::Run;
use crate::report::figures::chart::{Chart, Quantity, SharedCurve};
use crate::report::figures::points::Points;
use crate::report::wording::specimen::{measured, weights};
use psd_plan::procedures::shake::block as schema;
use psd_plan::record::{Floors, ShakeHistory, ShakeStep};
use psd_plan::schema::ResultKind;
use psd_plan::{Figure, FigureKind};
use psd_text::units::Dimension;

/// Figures of a ground-motion test, in the order of a report.
pub(crate) const FIGURES: &[FigureKind] = &[
    FigureKind::Modes,
    FigureKind::Ground,
    FigureKind::Displacement,
    FigureKind::Drift,
    FigureKind::Hysteresis,
    FigureKind::BaseShear,
    FigureKind::Energy,
    FigureKind::Tracking,
];

/// Figures that several ground-motion tests share: one curve for each.
pub(crate) const SHARED: &[FigureKind] = &[
    FigureKind::Displacement,
    FigureKind::Drift,
    FigureKind::Hysteresis,
    FigureKind::BaseShear,
];

/// A figure of a ground-motion test and its caption; None before the first step, or for a figure of a different procedure.
pub(crate) fn chart(
    run: &Run<'_>,
    name: &str,
    history: &ShakeHistory,
    figure: &Figure,
) -> Option<(Chart, String)> {
    if history.steps.is_empty() {
        return None;
    }
    let limits = |result: ResultKind| charts::of_size(limits_on(run, figure.procedure, result));
    let chosen = charts::chosen_members(&history.steps);
    Some(match figure.kind {
        FigureKind::Modes => (
            charts::modes(history.modes.as_ref()?),
            format!("{name}: natural mode shapes and periods, floor by floor from the ground up."),
        ),
        FigureKind::Ground => (
            charts::ground(history),
            format!("{name}: applied ground acceleration against simulated time."),
        ),
        FigureKind::Displacement => (
            charts::displacement(&history.steps),
            format!(
                "{name}: displacement of each {} relative to the ground against simulated time{}.",
                charts::entries_of(has_elements(run)),
                charts::chosen_floors(&history.steps)
            ),
        ),
        FigureKind::Drift => (
            charts::drift(&history.steps, &limits(schema::MAX_DRIFT)),
            drifts(run, name, chosen),
        ),
        FigureKind::Hysteresis => (charts::hysteresis(&history.steps), loops(run, name, chosen)),
        FigureKind::BaseShear => (
            charts::base_shear(&history.steps, &limits(schema::MAX_BASE_SHEAR)),
            format!(
                "{name}: base shear, the sum of the {}, against simulated time.",
                restoring_forces(run)
            ),
        ),
        FigureKind::Energy => (
            charts::energy(history),
            format!("{name}: input energy of the ground motion and its parts."),
        ),
        FigureKind::Tracking => (
            charts::tracking(&history.steps),
            followed(run, name, chosen),
        ),
        _ => return None,
    })
}

/// The caption of the drifts.
pub(crate) fn drifts(run: &Run<'_>, name: &str, chosen: &str) -> String {
    let drift = if has_elements(run) {
        "deformation of each element"
    } else {
        "drift of each storey"
    };
    format!("{name}: {drift} against simulated time{chosen}.")
}

/// Whether the rig tests a frame of matrices with elements.
fn has_elements(run: &Run<'_>) -> bool {
    let frame = run.plan.frame_on_the_rig();
    frame.is_some_and(|frame| !frame.elements.is_empty())
}

/// The caption of the loops.
pub(crate) fn loops(run: &Run<'_>, name: &str, chosen: &str) -> String {
    if has_elements(run) {
        let force = measured("force of each element", run.plan.frame_on_the_rig());
        return format!(
            "{name}: {force} against its deformation; the area of a loop is the energy absorbed by the element{chosen}."
        );
    }
    format!(
        "{name}: {} against drift; the area of a loop is the energy absorbed by the storey{chosen}.",
        storey_shear(run)
    )
}

/// The storey shear of a caption, with what of it was measured.
pub(crate) fn storey_shear(run: &Run<'_>) -> String {
    measured("storey shear", run.plan.frame_on_the_rig())
}

/// The same of the restoring forces.
pub(crate) fn restoring_forces(run: &Run<'_>) -> String {
    let frame = run.plan.frame_on_the_rig();
    let sum = measured("restoring forces", frame);
    match frame.and_then(weights) {
        None => sum,
        Some(_) => format!("{sum} net of P-Δ"),
    }
}

/// The caption of the tracking of a frame.
pub(crate) fn followed(run: &Run<'_>, name: &str, chosen: &str) -> String {
    let of = if has_elements(run) {
        "element"
    } else {
        "floor"
    };
    format!(
        "{name}: tracking error of each {of}'s actuator{chosen}, and the tracking indicator of all of them over the \
         largest command; a falling indicator shows that lag adds energy to the test."
    )
}

/// The curve of this history on a chart of several; None for a figure that is not shared.
pub(crate) fn shared(kind: FigureKind, history: &ShakeHistory) -> Option<SharedCurve> {
    let points = points(kind, history)?;
    let elements = history.steps.first().is_some_and(Floors::has_elements);
    let over_time = |name, dimension| (Quantity::time(), Quantity::of(name, dimension));
    let (length, force) = (Dimension::LENGTH, Dimension::FORCE);
    let ((x, y), caption) = match kind {
        FigureKind::Displacement if elements => (
            over_time("Displacement of the last degree of freedom", length),
            "displacement of the last degree of freedom against simulated time",
        ),
        FigureKind::Drift if elements => (
            over_time("Deformation of element 1", length),
            "deformation of element 1 against simulated time",
        ),
        FigureKind::Hysteresis if elements => (
            (
                Quantity::along("Deformation of element 1", length),
                Quantity::of("Force of element 1", force),
            ),
            "force of element 1 against its deformation",
        ),
        FigureKind::Displacement => (
            over_time("Displacement of the top floor", length),
            "displacement of the top floor against simulated time",
        ),
        FigureKind::Drift => (
            over_time("Drift of the lowest storey", length),
            "drift of the lowest storey against simulated time",
        ),
        FigureKind::Hysteresis => (
            (
                Quantity::along("Drift of the lowest storey", length),
                Quantity::of("Base shear", force),
            ),
            "measured shear of the lowest storey against its drift",
        ),
        FigureKind::BaseShear => (
            over_time("Base shear", force),
            "base shear, the sum of the measured restoring forces, against simulated time",
        ),
        _ => return None,
    };
    Some(SharedCurve {
        x,
        y,
        caption,
        points,
    })
}

fn points(kind: FigureKind, ShakeHistory { steps, .. }: &ShakeHistory) -> Option<Points> {
    let lowest = |values: Vec<f64>| values.first().copied().unwrap_or(0.0);
    let gross = |step: &ShakeStep| {
        if step.has_elements() {
            return lowest(step.shear());
        }
        step.floors.restoring_force.iter().sum()
    };
    Some(match kind {
        FigureKind::Displacement => steps
            .iter()
            .map(|step| {
                (
                    step.floors.time,
                    step.floors.computed.last().copied().unwrap_or(0.0),
                )
            })
            .collect(),
        FigureKind::Drift => steps
            .iter()
            .map(|step| (step.floors.time, lowest(step.drift())))
            .collect(),
        FigureKind::Hysteresis => steps
            .iter()
            .map(|step| (lowest(step.drift()), gross(step)))
            .collect(),
        FigureKind::BaseShear => steps
            .iter()
            .map(|step| (step.floors.time, step.base_shear()))
            .collect(),
        _ => return None,
    })
}
