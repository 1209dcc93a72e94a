//! The figures as data: `figures.json`, schema `psd.figures/1`, SI. In: charts. Out: each curve with its points. A long curve is
//! thinned by position, not by its peaks, so that a small change of a number changes the data little. The images are drawn
//! from the same charts.

use serde::{Deserialize, Serialize};

use super::chart::{Band, Chart, Quantity, Series};
use psd_text::units::display::si_unit;

/// Name of the file in a folder of accepted results.
pub const FIGURE_DATA: &str = "figures.json";
const SCHEMA: &str = "psd.figures/1";

/// A curve of up to this many points is kept in full.
const WHOLE: usize = 200;
/// Segments of a longer curve.
const SEGMENTS: usize = 100;

/// The figures of a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Figures {
    pub schema: String,
    pub figures: Vec<FigureData>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FigureData {
    /// `hit_displacement`, the name of its image.
    pub figure: String,
    pub procedure: String,
    pub x: FigureAxis,
    pub y: FigureAxis,
    pub curves: Vec<FigureCurve>,
    /// Horizontal lines with their text.
    pub references: Vec<(String, f64)>,
    pub bands: Vec<FigureBand>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FigureAxis {
    pub name: String,
    /// SI
    pub unit: String,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FigureBand {
    pub label: String,
    pub intervals: Vec<(f64, f64)>,
}

/// A curve: its points, or the first point and the bounding box of each of its segments.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FigureCurve {
    pub label: String,
    /// Number of points drawn.
    pub count: usize,
    pub points: Vec<(f64, f64)>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub corners: Vec<[(f64, f64); 2]>,
    /// Drawn as dots without a line.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub dots: bool,
}

impl FigureCurve {
    /// The curve of these points.
    #[must_use]
    pub fn of(label: &str, points: &[(f64, f64)]) -> Self {
        let points: Vec<(f64, f64)> = points
            .iter()
            .copied()
            .filter(|(x, y)| x.is_finite() && y.is_finite())
            .collect();
        let (label, count) = (label.to_owned(), points.len());
        if count <= WHOLE {
            return Self {
                label,
                count,
                points,
                corners: Vec::new(),
                dots: false,
            };
        }
        let segments = || {
            (0..SEGMENTS)
                .map(|index| &points[index * count / SEGMENTS..(index + 1) * count / SEGMENTS])
        };
        let corner = |segment: &[(f64, f64)], pick: fn(f64, f64) -> f64| {
            segment.iter().skip(1).fold(segment[0], |corner, point| {
                (pick(corner.0, point.0), pick(corner.1, point.1))
            })
        };
        let corners = segments()
            .map(|segment| [corner(segment, f64::min), corner(segment, f64::max)])
            .collect();
        let firsts = segments()
            .map(|segment| segment[0])
            .chain(points.last().copied())
            .collect();
        Self {
            label,
            count,
            points: firsts,
            corners,
            dots: false,
        }
    }

    /// All kept points, to be compared with those of another curve.
    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.points
            .iter()
            .copied()
            .chain(self.corners.iter().flatten().copied())
    }

    /// A line that looks like the curve: through the first point of each segment, and to its lowest and highest value.
    #[must_use]
    pub fn line(&self) -> Vec<(f64, f64)> {
        if self.corners.is_empty() {
            return self.points.clone();
        }
        let mut line = Vec::new();
        for (index, [low, high]) in self.corners.iter().enumerate() {
            let (from, to) = (self.points[index], self.points[index + 1]);
            line.push(from);
            let middle = 0.5 * (from.0 + to.0);
            let (below, above) = (from.1.min(to.1), from.1.max(to.1));
            let visible = 0.02 * (high.1 - low.1).max(above - below);
            line.extend((low.1 < below - visible).then_some((middle, low.1)));
            line.extend((high.1 > above + visible).then_some((middle, high.1)));
        }
        line.extend(self.points.last());
        line
    }
}

impl Default for Figures {
    fn default() -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            figures: Vec::new(),
        }
    }
}

impl Figures {
    /// JSON with one line per curve, so that a changed curve is one changed line.
    #[must_use]
    pub fn to_json(&self) -> String {
        let json = |value: serde_json::Result<String>| value.expect("plain numbers and texts");
        let mut text = format!(
            "{{\n\"schema\": {},\n\"figures\": [",
            json(serde_json::to_string(&self.schema))
        );
        for (index, figure) in self.figures.iter().enumerate() {
            text.push_str(if index == 0 { "\n" } else { ",\n" });
            let head = FigureData {
                curves: Vec::new(),
                ..figure.clone()
            };
            let head = json(serde_json::to_string(&head));
            let curves: Vec<String> = figure
                .curves
                .iter()
                .map(|curve| json(serde_json::to_string(curve)))
                .collect();
            let list = if curves.is_empty() {
                "[]".to_owned()
            } else {
                format!("[\n{}\n]", curves.join(",\n"))
            };
            text.push_str(&head.replacen("\"curves\":[]", &format!("\"curves\":{list}"), 1));
        }
        text + "\n]\n}\n"
    }
}

/// The data of one chart.
pub(super) fn figure_data(figure: String, procedure: &str, chart: &Chart) -> FigureData {
    let axis = |quantity: &Quantity| FigureAxis {
        name: quantity.name.to_string(),
        unit: si_unit(quantity.dimension),
    };
    let curve = |series: &Series| FigureCurve {
        dots: series.style.line.is_none(),
        ..FigureCurve::of(&series.label, &series.points)
    };
    let band = |band: &Band| FigureBand {
        label: band.label.to_owned(),
        intervals: band.intervals.clone(),
    };
    FigureData {
        figure,
        procedure: procedure.to_owned(),
        x: axis(&chart.x),
        y: axis(&chart.y),
        curves: chart.series.iter().map(curve).collect(),
        references: chart
            .references
            .iter()
            .map(|reference| (reference.label.clone(), reference.y))
            .collect(),
        bands: chart.bands.iter().map(band).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_curve_is_kept_and_a_long_one_keeps_its_peaks_and_ends() {
        let points = |count: u32| {
            (0..count)
                .map(|i| (f64::from(i), if i == 123 { 9.0 } else { 0.0 }))
                .collect::<Vec<_>>()
        };
        let short = FigureCurve::of("a", &points(200));
        assert_eq!(
            (short.points.len(), short.corners.len(), short.line().len()),
            (200, 0, 200)
        );
        let long = FigureCurve::of("a", &points(100_003));
        assert_eq!(
            (long.count, long.points.len(), long.corners.len()),
            (100_003, 101, 100)
        );
        assert_eq!(long.points.last(), Some(&(100_002.0, 0.0)));
        assert_eq!(long.corners[0], [(0.0, 0.0), (999.0, 9.0)]);
        assert!(long.line().iter().any(|point| point.1 == 9.0));
    }

    #[test]
    fn the_file_reads_back() {
        let axis = || FigureAxis {
            name: "a \"curves\":[] b".to_owned(),
            unit: "m".to_owned(),
        };
        let figure = FigureData {
            figure: "hit".to_owned(),
            procedure: "hit".to_owned(),
            x: axis(),
            y: axis(),
            curves: vec![
                FigureCurve::of("one", &[(0.1, 1.0 / 3.0)]),
                FigureCurve::of("two", &[]),
            ],
            references: vec![("limit".to_owned(), 1.0)],
            bands: Vec::new(),
        };
        let figures = Figures {
            figures: vec![
                figure.clone(),
                FigureData {
                    curves: Vec::new(),
                    ..figure
                },
            ],
            ..Figures::default()
        };
        let back: Figures = serde_json::from_str(&figures.to_json()).unwrap();
        assert_eq!(back.to_json(), figures.to_json());
        assert_eq!(
            (
                back.figures[0].curves[0].points[0].1,
                back.figures[1].curves.len()
            ),
            (1.0 / 3.0, 0)
        );
    }
}
