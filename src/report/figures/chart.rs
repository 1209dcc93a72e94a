//! The content of a chart: series, bands and reference lines in SI, and the style of each. Styles differ in colour and in dash
//! or marker, so that a grey print can be read.

use std::borrow::Cow;

use super::points::Points;
use crate::report::number;
use crate::report::wording::figures as wording;
use psd_text::units::Dimension;

/// A chart of two quantities.
pub(crate) struct Chart {
    pub x: Quantity,
    pub y: Quantity,
    pub bands: Vec<Band>,
    pub series: Vec<Series>,
    pub references: Vec<Reference>,
}

impl Chart {
    /// These curves alone.
    pub const fn of(x: Quantity, y: Quantity, series: Vec<Series>) -> Self {
        Self {
            x,
            y,
            bands: Vec::new(),
            series,
            references: Vec::new(),
        }
    }

    /// The axes and the range of each curve in words, for a reader who cannot see the chart.
    pub fn description(&self) -> String {
        let range = |series: &Series| {
            let ends = series
                .points
                .iter()
                .map(|(_, y)| *y)
                .filter(|y| y.is_finite())
                .fold(None, |ends: Option<(f64, f64)>, y| {
                    Some(ends.map_or((y, y), |(low, high)| (low.min(y), high.max(y))))
                });
            let (low, high) = ends?;
            let [low, high] = [low, high].map(|y| number::text(y, self.y.dimension));
            Some(wording::curve(&series.label, low, high))
        };
        let curves = self.series.iter().filter_map(range);
        wording::axes(&self.y.name, &self.x.name) + &curves.collect::<String>()
    }
}

/// The quantity of an axis.
pub(crate) struct Quantity {
    pub name: Cow<'static, str>,
    pub dimension: Dimension,
    pub end: End,
    /// Whether zero must be on the axis.
    pub from_zero: bool,
    /// Names instead of numbers: the first one is at 1, the lowest. Empty: an axis of numbers.
    pub names: Vec<String>,
}

/// The end of an axis.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    /// At the end of the data, for a time.
    Data,
    /// Slightly beyond the data, so that no marker is on the frame.
    Margin,
    /// At a whole tick beyond the data.
    Tick,
    /// As `Margin`, for a count: every tick is a whole number.
    Whole,
}

impl Quantity {
    pub const fn time() -> Self {
        Self {
            name: Cow::Borrowed("Simulated time"),
            dimension: Dimension::TIME,
            end: End::Data,
            from_zero: false,
            names: Vec::new(),
        }
    }

    /// A quantity along y.
    pub const fn of(name: &'static str, dimension: Dimension) -> Self {
        Self {
            name: Cow::Borrowed(name),
            dimension,
            end: End::Tick,
            from_zero: true,
            names: Vec::new(),
        }
    }

    /// A quantity along x.
    pub const fn along(name: &'static str, dimension: Dimension) -> Self {
        Self {
            name: Cow::Borrowed(name),
            dimension,
            end: End::Margin,
            from_zero: true,
            names: Vec::new(),
        }
    }
}

/// The curve of one procedure on a chart of several, with the axes of that chart.
pub(crate) struct SharedCurve {
    pub x: Quantity,
    pub y: Quantity,
    /// The content of the chart, for its caption.
    pub caption: &'static str,
    pub points: Points,
}

/// A named set of points, SI.
pub(crate) struct Series {
    pub label: String,
    pub points: Points,
    pub style: Style,
}

/// Shaded intervals of x with one name.
pub(crate) struct Band {
    pub label: &'static str,
    pub intervals: Vec<(f64, f64)>,
    pub colour: Colour,
}

/// A horizontal line across the plot with its text.
#[derive(Clone)]
pub(crate) struct Reference {
    pub label: String,
    pub y: f64,
}

pub(crate) type Colour = (u8, u8, u8);

/// The colours of Okabe and Ito, distinct for every common kind of colour vision.
pub(crate) mod palette {
    use crate::report::figures::chart::Colour;

    pub const BLACK: Colour = (0, 0, 0);
    pub const BLUE: Colour = (0, 114, 178);
    pub const VERMILION: Colour = (213, 94, 0);
    pub const GREEN: Colour = (0, 158, 115);
    pub const PURPLE: Colour = (204, 121, 167);
    pub const SKY: Colour = (86, 180, 233);
    pub const CONTACT: Colour = (226, 232, 238);
    pub const LIMIT: Colour = (250, 226, 196);
    pub const CLOUD: Colour = (176, 190, 200);
    pub const FILL: Colour = (206, 222, 236);
}

/// The look of a series.
#[derive(Clone, Copy)]
pub(crate) struct Style {
    pub colour: Colour,
    /// None: markers only.
    pub line: Option<LineStyle>,
    pub marker: Option<Marker>,
    /// The points are the corners of an area of this colour.
    pub fill: bool,
}

#[derive(Clone, Copy)]
pub(crate) struct LineStyle {
    /// Reference pixels (96 to the inch).
    pub width: f64,
    /// Lengths drawn and left out, in turn, reference pixels; empty: solid.
    pub dash: &'static [f64],
}

#[derive(Clone, Copy)]
pub(crate) enum Marker {
    Disc(f64),
    Ring(f64),
}

impl Style {
    pub const fn line(colour: Colour, width: f64, dash: &'static [f64]) -> Self {
        Self {
            colour,
            line: Some(LineStyle { width, dash }),
            marker: None,
            fill: false,
        }
    }

    pub const fn marker(colour: Colour, marker: Marker) -> Self {
        Self {
            colour,
            line: None,
            marker: Some(marker),
            fill: false,
        }
    }

    /// The same with a marker at each point.
    pub const fn marked(self, marker: Marker) -> Self {
        Self {
            marker: Some(marker),
            ..self
        }
    }

    /// An area without an outline.
    pub const fn area(colour: Colour) -> Self {
        Self {
            colour,
            line: None,
            marker: None,
            fill: true,
        }
    }
}

pub(crate) const SOLID: &[f64] = &[];
pub(crate) const DASHED: &[f64] = &[9.0, 4.0];
pub(super) const SPARSE: &[f64] = &[6.0, 9.0];
pub(crate) const DOTTED: &[f64] = &[2.0, 3.0];
pub(crate) const DASH_DOT: &[f64] = &[10.0, 3.5, 2.0, 3.5];
pub(crate) const LONG: &[f64] = &[16.0, 4.0];
