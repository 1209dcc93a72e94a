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

/// A figure of a frame alone, and its caption; None for a figure of a different procedure.
pub(super) fn chart(
    run: &Run<'_>,
    name: &str,
    history: &ImpactHistory,
    frame: &StruckFrame,
    figure: &Figure,
) -> Option<(Chart, String)> {
    let limits = |result: ResultKind| limits_on(run, figure.procedure, result);
    let chosen = frame::charts::chosen_members(&frame.floors);
    let struck = frame.struck + 1;
    Some(match figure.kind {
        FigureKind::Modes => (
            frame::charts::modes(frame.modes.as_ref()?),
            frame::captions::modes(name),
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
            frame::captions::base_shear(run, name),
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
