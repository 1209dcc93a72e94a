//! Chart of a relaxation: what each hold had still to lose, against the time it was held. In: the holds and their fit. Out: a
//! [`Chart`] in SI.

use super::super::number;
use super::chart::{Chart, Colour, Marker, Quantity, SOLID, Series, Style, palette};
use crate::mechanics::relaxation::RelaxationFit;
use crate::quantity::Dimension;
use crate::record::RampHistory;

/// Holds drawn, at most: the last, which loses most, and others evenly before it.
const DRAWN: usize = 4;
const COLOURS: [Colour; DRAWN] = [palette::SKY, palette::GREEN, palette::PURPLE, palette::BLUE];
/// Points of a curve.
const POINTS: u32 = 120;

/// R − R∞ of some holds and the exponential of each.
pub(super) fn left(history: &RampHistory, fit: &RelaxationFit) -> Chart {
    let count = history.holds.len();
    let drawn = count.min(DRAWN);
    let chosen: Vec<usize> = (1..=drawn).map(|part| (part * count).div_ceil(drawn) - 1).collect();
    let tau = number::with_uncertainty(fit.time_constant.0, Some(fit.time_constant.1), Dimension::TIME);
    let mut series = Vec::new();
    for (order, index) in chosen.iter().enumerate() {
        let seconds = history.holds[*index].readings.last().map_or(0.0, |(time, _)| *time);
        let at = |part: u32| seconds * (f64::from(part) / f64::from(POINTS)).powi(2);
        let curve = |time: f64| (time, fit.holds[*index][1] * (-time / fit.time_constant.0).exp());
        series.push(Series {
            label: if order == 0 { format!("fit, τ = {tau}") } else { String::new() },
            points: (0..=POINTS).map(|part| curve(at(part))).collect(),
            style: Style::line(palette::VERMILION, 1.6, SOLID),
        });
    }
    for (order, index) in chosen.iter().enumerate() {
        let hold = &history.holds[*index];
        let place = number::text(hold.displacement, Dimension::LENGTH);
        series.push(Series {
            label: format!("held at {place}"),
            points: hold.readings.iter().map(|(time, force)| (*time, force - fit.holds[*index][0])).collect(),
            style: Style::marker(COLOURS[DRAWN - drawn + order], Marker::Disc(3.4)),
        });
    }
    Chart {
        x: Quantity::along("Time held", Dimension::TIME),
        y: Quantity::of("Force still to relax", Dimension::FORCE),
        bands: Vec::new(),
        series,
        references: Vec::new(),
    }
}
