//! The figures of a ground-motion test, with their captions, and the curve of a test on a chart of several. In: a history. Out: [`Chart`]s
//! in SI.

use crate::procedures::common::limit_lines::limits_on;
use crate::procedures::frame::charts::{one, over_time};
use crate::procedures::frame::{captions, charts};
use crate::procedures::stepping::energy::{EnergyCurve, nonzero_curves};
use crate::report::Run;
use crate::report::figures::chart::{Chart, Quantity, SOLID, SharedCurve, Style, palette};
use crate::report::figures::points::Points;
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
            captions::modes(name),
        ),
        FigureKind::Ground => (
            ground(history),
            format!("{name}: applied ground acceleration against simulated time."),
        ),
        FigureKind::Displacement => (
            charts::displacement(&history.steps),
            format!(
                "{name}: displacement of each {} relative to the ground against simulated time{}.",
                charts::entries_of(run.plan.tests_elements()),
                charts::chosen_floors(&history.steps)
            ),
        ),
        FigureKind::Drift => (
            charts::drift(&history.steps, &limits(schema::MAX_DRIFT)),
            captions::drifts(run, name, chosen),
        ),
        FigureKind::Hysteresis => (
            charts::hysteresis(&history.steps),
            captions::loops(run, name, chosen),
        ),
        FigureKind::BaseShear => (
            charts::base_shear(&history.steps, &limits(schema::MAX_BASE_SHEAR)),
            captions::base_shear(run, name),
        ),
        FigureKind::Energy => (
            energy(history),
            format!("{name}: input energy of the ground motion and its parts."),
        ),
        FigureKind::Tracking => (
            charts::tracking(&history.steps),
            captions::followed(run, name, chosen),
        ),
        _ => return None,
    })
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

fn ground(history: &ShakeHistory) -> Chart {
    let curve = one(
        &history.steps,
        "as applied",
        |step| step.ground_acceleration,
        Style::line(palette::BLUE, 1.4, SOLID),
    );
    let acceleration = Quantity::of("Acceleration of the ground", Dimension::ACCELERATION);
    over_time(acceleration, vec![curve])
}

/// The input, and the energies that it became.
fn energy(history: &ShakeHistory) -> Chart {
    let curves = [
        EnergyCurve::new(
            "input",
            |step: &ShakeStep| step.energies.input,
            Style::line(palette::BLACK, 1.6, SOLID),
        ),
        EnergyCurve::restoring(|step: &ShakeStep| step.energies.restoring),
        EnergyCurve::damping(|step: &ShakeStep| step.energies.damping),
        EnergyCurve::new(
            "kinetic",
            |step: &ShakeStep| step.energies.kinetic,
            Style::line(palette::SKY, 1.4, SOLID),
        ),
        EnergyCurve::weights(|step: &ShakeStep| step.energies.gravity),
    ];
    let curves = nonzero_curves(&history.steps.iter(), |step| step.floors.time, curves);
    over_time(Quantity::of("Energy", Dimension::ENERGY), curves)
}
