//! Curves of several runs on one chart, distinct by colour and dash. In: points in SI. Out: PNG bytes.

use std::borrow::Cow;

use super::chart::{
    Chart, Colour, DASH_DOT, DASHED, DOTTED, End, LONG, Marker, Quantity, SOLID, Series, Style,
    palette,
};
use super::{draw, raster};
use psd_text::units::Dimension;

/// The quantity of an axis.
#[derive(Clone, Debug)]
pub struct PlainAxis {
    pub name: String,
    pub dimension: Dimension,
}

/// One curve, SI.
#[derive(Clone, Debug)]
pub struct Curve {
    pub label: String,
    pub points: Vec<(f64, f64)>,
    /// Drawn as dots without a line.
    pub dots: bool,
    /// Number of the run from 0, which gives colour and dash. None for one of many, drawn pale.
    pub run: Option<usize>,
}

/// A chart of curves.
#[derive(Clone, Debug)]
pub struct Curves {
    pub x: PlainAxis,
    pub y: PlainAxis,
    pub curves: Vec<Curve>,
}

const STYLES: [(Colour, f64, &[f64]); 8] = [
    (palette::BLUE, 2.4, SOLID),
    (palette::VERMILION, 1.8, DASHED),
    (palette::GREEN, 1.8, DASH_DOT),
    (palette::PURPLE, 2.0, DOTTED),
    (palette::SKY, 1.8, LONG),
    (palette::BLACK, 1.4, DASHED),
    (palette::VERMILION, 1.4, SOLID),
    (palette::GREEN, 1.6, DOTTED),
];

impl Curves {
    /// Largest number of runs on one chart.
    pub const MOST_RUNS: usize = 6;

    /// Draws the curves, the last on top.
    ///
    /// # Errors
    /// The image cannot be encoded.
    pub fn png(&self) -> Result<Vec<u8>, String> {
        let axis = |axis: &PlainAxis, end: End| Quantity {
            name: Cow::Owned(axis.name.clone()),
            dimension: axis.dimension,
            end,
            from_zero: false,
            names: Vec::new(),
        };
        let x_end = if self.x.dimension == Dimension::TIME {
            End::Data
        } else {
            End::Margin
        };
        let series = |curve: &Curve| {
            let (colour, width, dash) = curve.run.map_or((palette::CLOUD, 1.0, SOLID), |run| {
                STYLES[run % STYLES.len()]
            });
            let style = match curve.run {
                Some(run) if curve.dots && run % 2 == 1 => Style::marker(colour, Marker::Ring(3.0)),
                _ if curve.dots => Style::marker(colour, Marker::Disc(2.0)),
                _ => Style::line(colour, width, dash),
            };
            Series {
                label: curve.label.clone(),
                points: curve.points.clone().into(),
                style,
            }
        };
        raster::png(&draw::svg(&Chart::of(
            axis(&self.x, x_end),
            axis(&self.y, End::Tick),
            self.curves.iter().map(series).collect(),
        )))
    }
}
