//! Charts of an impact on one storey of a frame: those of an impact for striker and contact, those of a frame for floors and
//! storeys, with the contact shaded in all that run over time. In: a history. Out: [`Chart`]s in SI with their captions.

use super::chart::{Chart, DASHED, Quantity, SOLID, Series, Style, palette};
use super::{impact, shake};
use crate::output::Run;
use crate::plan::{Figure, FigureKind};
use crate::quantity::Dimension;
use crate::record::StoreyImpactHistory;

/// None before the first step, and of what this procedure does not draw.
pub(super) fn chart(
    run: &Run<'_>,
    name: &str,
    history: &StoreyImpactHistory,
    figure: &Figure,
    kind: FigureKind,
) -> Option<(Chart, String)> {
    if history.floors.is_empty() {
        return None;
    }
    let limits = |result| impact::limits_on(run, figure.procedure, result);
    let chosen = if shake::is_chosen(&history.floors) { "; not every one is drawn" } else { "" };
    let struck = history.struck + 1;
    Some(match kind {
        FigureKind::Modes => (
            shake::modes(history.modes.as_ref()?),
            format!("{name}: shapes of the natural modes and their periods, floor by floor from the ground up."),
        ),
        FigureKind::Displacement => {
            let mut chart = shaded(history, shake::displacement(&history.floors));
            chart.series.push(striker(history));
            chart.references = limits("max_displacement");
            let caption = format!(
                "{name}: displacement of each floor, and of the striker on floor {struck} while it is near, against virtual \
                 time{chosen}."
            );
            (chart, caption)
        }
        FigureKind::Drift => (
            shaded(history, shake::drift(&history.floors, &limits("max_drift"))),
            format!("{name}: drift of each storey against virtual time{chosen}."),
        ),
        FigureKind::Hysteresis => (
            shake::hysteresis(&history.floors),
            format!(
                "{name}: measured storey shear against drift; the area of a loop is the energy that the storey took{chosen}."
            ),
        ),
        FigureKind::BaseShear => (
            shaded(history, shake::base_shear(&history.floors, &limits("max_base_shear"))),
            format!("{name}: base shear, the sum of the measured restoring forces, against virtual time."),
        ),
        FigureKind::Velocity => {
            let mut chart = impact::against_time(&history.blow, Quantity::of("Velocity", Dimension::VELOCITY));
            let floor = Style::line(palette::BLUE, 1.6, SOLID);
            let striker = Style::line(palette::VERMILION, 2.0, DASHED);
            chart.series = vec![
                impact::series(&history.blow, &format!("floor {struck}"), |step| step.velocity, floor),
                impact::series(&history.blow, "striker", |step| step.striker_velocity, striker),
            ];
            (chart, format!("{name}: velocity of the struck floor and of the striker against virtual time."))
        }
        FigureKind::StrikerVelocity => (
            impact::striker_velocity(&history.blow),
            format!("{name}: velocity of the striker against virtual time; each fall is a blow."),
        ),
        FigureKind::ContactForce => (
            impact::contact_force(&history.blow, &limits("max_contact_force")),
            format!("{name}: contact force, mean over each step, against virtual time."),
        ),
        FigureKind::Energy => (
            impact::energy(&history.blow, impact::taken_by_contact(run, figure.procedure)),
            format!(
                "{name}: where the energy of the striker went, all storeys together; the total of the parts stays level where \
                 the balance closes."
            ),
        ),
        FigureKind::Tracking => (shaded(history, shake::tracking(&history.floors)), super::followed(name, chosen)),
        _ => return None,
    })
}

/// Where the striker is, as long as it is near the floors.
fn striker(history: &StoreyImpactHistory) -> Series {
    let places = history.floors.iter().flat_map(|floors| floors.computed.iter().copied());
    impact::striker_near(&history.blow, places, Style::line(palette::BLACK, 1.4, DASHED))
}

/// The contact behind a chart over virtual time.
fn shaded(history: &StoreyImpactHistory, chart: Chart) -> Chart {
    let bands = impact::against_time(&history.blow, Quantity::time()).bands;
    Chart { bands, ..chart }
}
