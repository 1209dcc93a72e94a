//! Charts of a relaxation: the remaining force of each dwell, or the force lost by one law and by the other, against the time of the
//! dwell. In: the dwells and their fit. Out: a [`Chart`] in SI.

use crate::report::figures::chart::{
    Chart, Colour, DASHED, Marker, Quantity, SOLID, Series, Style, palette,
};
use crate::report::number;
use psd_physics::relaxation::law::RelaxationLaw;
use psd_physics::relaxation::time_constant::RelaxationFit;
use psd_plan::record::{Hold, LawFit, StiffnessRampHistory, SuperpositionFit};
use psd_text::units::Dimension;

/// Largest number of dwells drawn: the last, which loses most, and others evenly spaced before it.
const DRAWN: usize = 4;
const COLOURS: [Colour; DRAWN] = [palette::SKY, palette::GREEN, palette::PURPLE, palette::BLUE];
/// Points of a curve.
const POINTS: u32 = 120;

/// The last dwell and others evenly spaced before it.
fn drawn_of(count: usize) -> Vec<usize> {
    let drawn = count.min(DRAWN);
    (1..=drawn)
        .map(|part| (part * count).div_ceil(drawn) - 1)
        .collect()
}

/// The force that some dwells have lost since their first reading, and the laws: the better one as a full line, the other dashed.
pub(crate) fn lost(holds: &[Hold], fit: &SuperpositionFit) -> Chart {
    let mut series = Vec::new();
    let best = fit.best();
    let mut chosen = drawn_of(best.reached.len());
    // The fastest dwell loses most: there the curves differ most.
    if !chosen.contains(&best.worst) {
        chosen[0] = best.worst;
    }
    let first = |hold: usize| best.force(hold, 0.0).unwrap_or(0.0);
    for (law, colour, width, dash) in fit
        .fits
        .iter()
        .zip([
            (palette::VERMILION, 1.6, SOLID),
            (palette::BLACK, 1.2, DASHED),
        ])
        .map(|(law, (c, w, d))| (law, c, w, d))
    {
        for (order, index) in chosen.iter().enumerate() {
            let seconds = holds[*index].readings.last().map_or(0.0, |(time, _)| *time);
            let at = |part: u32| seconds * (f64::from(part) / f64::from(POINTS)).powi(2);
            let curve = |time: f64| (time, first(*index) - law.force(*index, time).unwrap_or(0.0));
            series.push(Series {
                label: if order == 0 {
                    law_words(law)
                } else {
                    String::new()
                },
                points: (0..=POINTS).map(|part| curve(at(part))).collect(),
                style: Style::line(colour, width, dash),
            });
        }
    }
    for (order, index) in chosen.iter().enumerate() {
        let displacement = number::text(holds[*index].displacement, Dimension::LENGTH);
        series.push(Series {
            label: format!("dwell at {displacement}"),
            points: holds[*index]
                .readings
                .iter()
                .map(|(time, force)| (*time, first(*index) - force))
                .collect(),
            style: Style::marker(COLOURS[DRAWN - chosen.len() + order], Marker::Disc(3.4)),
        });
    }
    Chart::of(
        Quantity::along("Dwell time", Dimension::TIME),
        Quantity::of("Force lost", Dimension::FORCE),
        series,
    )
}

fn law_words(fit: &LawFit) -> String {
    let time = number::with_uncertainty(fit.time.0, Some(fit.time.1), Dimension::TIME);
    match fit.law {
        RelaxationLaw::Exponential => format!("1 − e^(−t/τ), τ = {time}"),
        RelaxationLaw::Logarithmic => format!("ln(1 + t/t₀), t₀ = {time}"),
    }
}

/// R − R∞ of some dwells and the exponential of each.
pub(crate) fn left(history: &StiffnessRampHistory, fit: &RelaxationFit) -> Chart {
    let chosen = drawn_of(history.holds.len());
    let tau = number::with_uncertainty(
        fit.time_constant.0,
        Some(fit.time_constant.1),
        Dimension::TIME,
    );
    let mut series = Vec::new();
    for (order, index) in chosen.iter().enumerate() {
        let seconds = history.holds[*index]
            .readings
            .last()
            .map_or(0.0, |(time, _)| *time);
        let at = |part: u32| seconds * (f64::from(part) / f64::from(POINTS)).powi(2);
        let curve = |time: f64| {
            (
                time,
                fit.holds[*index][1] * (-time / fit.time_constant.0).exp(),
            )
        };
        series.push(Series {
            label: if order == 0 {
                format!("fit, τ = {tau}")
            } else {
                String::new()
            },
            points: (0..=POINTS).map(|part| curve(at(part))).collect(),
            style: Style::line(palette::VERMILION, 1.6, SOLID),
        });
    }
    for (order, index) in chosen.iter().enumerate() {
        let hold = &history.holds[*index];
        let displacement = number::text(hold.displacement, Dimension::LENGTH);
        series.push(Series {
            label: format!("dwell at {displacement}"),
            points: hold
                .readings
                .iter()
                .map(|(time, force)| (*time, force - fit.holds[*index][0]))
                .collect(),
            style: Style::marker(COLOURS[DRAWN - chosen.len() + order], Marker::Disc(3.4)),
        });
    }
    Chart::of(
        Quantity::along("Dwell time", Dimension::TIME),
        Quantity::of("Remaining relaxation", Dimension::FORCE),
        series,
    )
}
