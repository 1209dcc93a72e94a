//! Charts of an impact on one storey of a frame: those of an impact for striker and contact, those of a frame for floors and
//! storeys, with the contact shaded in all that run over time. In: a history. Out: [`Chart`]s in SI with their captions.

use super::charts;
use crate::procedures::common::limit_lines::limits_on;
use crate::procedures::frame;
use crate::procedures::frame::charts::entries_of;
use crate::report::Run;
use crate::report::figures::chart::{Chart, DASHED, Quantity, SOLID, Series, Style, palette};
use psd_plan::procedures::impact::block as schema;
use psd_plan::record::{Floors, ImpactHistory, StruckFrame};
use psd_plan::schema::ResultKind;
use psd_plan::{Figure, FigureKind};
use psd_text::units::Dimension;

/// A figure and its caption; None before the first step, or for a figure of a different procedure.
pub(crate) fn chart(
    run: &Run<'_>,
    name: &str,
    history: &ImpactHistory,
    frame: &StruckFrame,
    figure: &Figure,
) -> Option<(Chart, String)> {
    if frame.floors.is_empty() {
        return None;
    }
    let limits = |result: ResultKind| limits_on(run, figure.procedure, result);
    let chosen = frame::charts::chosen_members(&frame.floors);
    let struck = frame.struck + 1;
    Some(match figure.kind {
        FigureKind::Modes => (
            frame::charts::modes(frame.modes.as_ref()?),
            format!("{name}: natural mode shapes and periods, floor by floor from the ground up."),
        ),
        FigureKind::Displacement => {
            let mut chart = shaded(history, frame::charts::displacement(&frame.floors));
            chart.series.push(striker(history, frame));
            chart.references = limits(schema::MAX_DISPLACEMENT);
            let floor = entries_of(frame.floors.first().is_some_and(Floors::has_elements));
            let caption = format!(
                "{name}: displacement of each {floor}, and of the striker while near {floor} {struck}, against simulated time{}.",
                frame::charts::chosen_floors(&frame.floors)
            );
            (chart, caption)
        }
        FigureKind::Drift => (
            shaded(
                history,
                frame::charts::drift(&frame.floors, &limits(schema::MAX_DRIFT)),
            ),
            frame::captions::drifts(run, name, chosen),
        ),
        FigureKind::Hysteresis => (
            frame::charts::hysteresis(&frame.floors),
            frame::captions::loops(run, name, chosen),
        ),
        FigureKind::BaseShear => (
            shaded(
                history,
                frame::charts::base_shear(&frame.floors, &limits(schema::MAX_BASE_SHEAR)),
            ),
            format!(
                "{name}: base shear, the sum of the {}, against simulated time.",
                frame::captions::restoring_forces(run)
            ),
        ),
        FigureKind::Velocity => {
            let mut chart =
                charts::against_time(history, Quantity::of("Velocity", Dimension::VELOCITY));
            let floor = Style::line(palette::BLUE, 1.6, SOLID);
            let striker = Style::line(palette::VERMILION, 2.0, DASHED);
            chart.series = vec![
                charts::series(
                    history,
                    &format!("floor {struck}"),
                    |step| step.velocity,
                    floor,
                ),
                charts::series(history, "striker", |step| step.striker_velocity, striker),
            ];
            (
                chart,
                format!(
                    "{name}: velocity of the struck floor and of the striker against simulated time."
                ),
            )
        }
        FigureKind::StrikerVelocity => (
            charts::striker_velocity(history),
            format!(
                "{name}: velocity of the striker against simulated time; each drop is a contact."
            ),
        ),
        FigureKind::ContactForce => (
            charts::contact_force(history, &limits(schema::MAX_CONTACT_FORCE)),
            format!("{name}: contact force, mean over each step, against simulated time."),
        ),
        FigureKind::Energy => (
            charts::energy(history, charts::energy_of_contact(run, figure.procedure)),
            format!(
                "{name}: parts of the striker's energy, all storeys together; their total is the energy put in, if the balance closes."
            ),
        ),
        FigureKind::Tracking => (
            shaded(history, frame::charts::tracking(&frame.floors)),
            frame::captions::followed(run, name, chosen),
        ),
        _ => return None,
    })
}

/// The position of the striker, as long as it is near the floors.
fn striker(history: &ImpactHistory, frame: &StruckFrame) -> Series {
    let positions = frame
        .floors
        .iter()
        .flat_map(|floors| floors.floors.computed.iter().copied());
    charts::striker_near(history, positions, Style::line(palette::BLACK, 1.4, DASHED))
}

/// The contact as shading of a chart over simulated time.
fn shaded(history: &ImpactHistory, chart: Chart) -> Chart {
    let bands = charts::against_time(history, Quantity::time()).bands;
    Chart { bands, ..chart }
}
