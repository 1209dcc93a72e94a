//! The figures of an impact with their captions, and its curve on a chart of several impacts. In: a history. Out: [`Chart`]s in SI.

pub(crate) mod charts;
pub(crate) mod storey;

use crate::procedures::common::limit_lines::limits_on;
use crate::procedures::impact::contact;
use crate::report::Run;
use crate::report::figures::chart::{Chart, Quantity, SharedCurve};
use crate::report::figures::points::Points;
use psd_plan::procedures::impact::block as schema;
use psd_plan::record::ImpactHistory;
use psd_plan::{Figure, FigureKind, Impact};
use psd_text::units::Dimension;

/// Figures of an impact on one degree of freedom, in the order of a report.
pub(crate) const FIGURES: &[FigureKind] = &[
    FigureKind::Displacement,
    FigureKind::Velocity,
    FigureKind::StrikerVelocity,
    FigureKind::ContactForce,
    FigureKind::ForceDisplacement,
    FigureKind::Energy,
    FigureKind::Tracking,
];

/// Figures of an impact on a storey.
pub(crate) const STOREY_FIGURES: &[FigureKind] = &[
    FigureKind::Modes,
    FigureKind::Displacement,
    FigureKind::Drift,
    FigureKind::Hysteresis,
    FigureKind::BaseShear,
    FigureKind::Velocity,
    FigureKind::StrikerVelocity,
    FigureKind::ContactForce,
    FigureKind::Energy,
    FigureKind::Tracking,
];

/// Figures that several impacts on one degree of freedom share: one curve of each.
pub(crate) const SHARED: &[FigureKind] = &[
    FigureKind::Displacement,
    FigureKind::Velocity,
    FigureKind::StrikerVelocity,
    FigureKind::ContactForce,
    FigureKind::ForceDisplacement,
];

/// A figure of an impact and its caption; None before the first step, or for a figure of a different procedure.
pub(crate) fn chart(
    run: &Run<'_>,
    impact: &Impact,
    name: &str,
    history: &ImpactHistory,
    figure: &Figure,
) -> Option<(Chart, String)> {
    let of_frame = history.frame.as_ref();
    if of_frame.map_or(history.steps.is_empty(), |frame| frame.floors.is_empty()) {
        return None;
    }
    Some(match (figure.kind, of_frame) {
        (FigureKind::StrikerVelocity, _) => (
            charts::striker_velocity(history),
            format!(
                "{name}: velocity of the striker against simulated time; each drop is a contact."
            ),
        ),
        (FigureKind::ContactForce, _) => (
            charts::contact_force(
                history,
                &limits_on(run, figure.procedure, schema::MAX_CONTACT_FORCE),
            ),
            format!("{name}: contact force, mean over each step, against simulated time."),
        ),
        (FigureKind::Energy, _) => {
            let together = of_frame.map_or("", |_| ", all storeys together");
            (
                charts::energy(history, contact::energy(&impact.contact)),
                format!(
                    "{name}: parts of the striker's energy{together}; their total is the energy put in, if the balance closes."
                ),
            )
        }
        (_, Some(frame)) => return storey::chart(run, name, history, frame, figure),
        (_, None) => return of_point(run, name, history, figure),
    })
}

/// A figure of one degree of freedom alone.
fn of_point(
    run: &Run<'_>,
    name: &str,
    history: &ImpactHistory,
    figure: &Figure,
) -> Option<(Chart, String)> {
    Some(match figure.kind {
        FigureKind::Displacement => (
            charts::displacement(
                history,
                &limits_on(run, figure.procedure, schema::MAX_DISPLACEMENT),
            ),
            format!(
                "{name}: displacement of the structure and of the striker against simulated time."
            ),
        ),
        FigureKind::Velocity => (
            charts::velocity(history),
            format!("{name}: velocity of the structure and of the striker against simulated time."),
        ),
        FigureKind::ForceDisplacement => (
            charts::force_displacement(history),
            format!(
                "{name}: restoring force against computed displacement; the area below is the absorbed energy."
            ),
        ),
        FigureKind::Tracking => (
            charts::tracking(history),
            if history
                .steps
                .iter()
                .all(|step| step.displacement == step.command)
            {
                format!("{name}: tracking error of the actuator: zero.")
            } else {
                format!(
                    "{name}: tracking error of the actuator, and the tracking indicator over the largest command; a \
                     falling indicator shows that lag adds energy to the test."
                )
            },
        ),
        _ => return None,
    })
}

/// The curve of this history on a chart of several; None for a figure that is not shared.
pub(crate) fn shared(kind: FigureKind, history: &ImpactHistory) -> Option<SharedCurve> {
    if history.frame.is_some() {
        return None;
    }
    let points = points(kind, history)?;
    let over_time = |name, dimension| (Quantity::time(), Quantity::of(name, dimension));
    let (length, force, velocity) = (Dimension::LENGTH, Dimension::FORCE, Dimension::VELOCITY);
    let ((x, y), caption) = match kind {
        FigureKind::Displacement => (
            over_time("Displacement X", length),
            "displacement of the structure against simulated time",
        ),
        FigureKind::Velocity => (
            over_time("Velocity of the structure", velocity),
            "velocity of the structure against simulated time",
        ),
        FigureKind::StrikerVelocity => (
            over_time("Striker velocity", velocity),
            "velocity of the striker against simulated time",
        ),
        FigureKind::ContactForce => (
            over_time("Contact force", force),
            "contact force, mean over each step, against simulated time",
        ),
        FigureKind::ForceDisplacement => (
            (
                Quantity::along("Displacement X", length),
                Quantity::of("Restoring force R", force),
            ),
            "measured restoring force against displacement",
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

fn points(kind: FigureKind, ImpactHistory { steps, .. }: &ImpactHistory) -> Option<Points> {
    Some(match kind {
        FigureKind::Displacement => steps
            .iter()
            .map(|step| (step.time, step.computed))
            .collect(),
        FigureKind::Velocity => steps
            .iter()
            .map(|step| (step.time, step.velocity))
            .collect(),
        FigureKind::StrikerVelocity => steps
            .iter()
            .map(|step| (step.time, step.striker_velocity))
            .collect(),
        FigureKind::ContactForce => steps
            .pairs()
            .flat_map(|(before, step)| {
                [
                    (before.time, step.contact_force),
                    (step.time, step.contact_force),
                ]
            })
            .collect(),
        FigureKind::ForceDisplacement => steps
            .iter()
            .map(|step| (step.command, step.restoring_force))
            .collect(),
        _ => return None,
    })
}
