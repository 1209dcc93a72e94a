//! The figures of several runs on common axes: a sheet for each curve that at least two of them have. Up to six runs have different
//! colours and dashes. More runs are drawn pale, with their mean if they have the same points on the first axis.

use super::{Side, Spread};
use crate::report::{Curve, Curves, FigureAxis, FigureCurve, PlainAxis};
use psd_text::units::{Dimension, unit};

/// One sheet.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// For example `hit_displacement_1`.
    pub name: String,
    pub caption: String,
    pub curves: Curves,
}

/// Every sheet, in the order of the first run's figures.
#[must_use]
pub fn sheets(sides: &[Side]) -> Vec<Sheet> {
    let mut found = Vec::new();
    let mut known: Vec<&str> = Vec::new();
    for figure in sides.iter().flat_map(|side| &side.figures.figures) {
        if known.contains(&figure.figure.as_str()) {
            continue;
        }
        known.push(&figure.figure);
        // A curve of two points is a fit, and one of a single point is an error bar: both are in the results.
        let drawn = figure
            .curves
            .iter()
            .enumerate()
            .filter(|(_, curve)| curve.count > 2);
        for (index, curve) in drawn {
            let of = |side: &Side| {
                let same = side
                    .figures
                    .figures
                    .iter()
                    .find(|other| other.figure == figure.figure)?;
                same.curves
                    .get(index)
                    .filter(|other| other.count > 2)
                    .cloned()
            };
            let drawn: Vec<(usize, FigureCurve)> = sides
                .iter()
                .enumerate()
                .filter_map(|(run, side)| Some((run, of(side)?)))
                .collect();
            if drawn.len() < 2 {
                continue;
            }
            let caption = format!(
                "{}: {}",
                figure.figure.replacen('_', ", ", 1).replace('_', " "),
                curve.label
            );
            let curves = Curves {
                x: axis(&figure.x),
                y: axis(&figure.y),
                curves: curves(sides, &drawn),
            };
            found.push(Sheet {
                name: format!("{}_{}", figure.figure, index + 1),
                caption,
                curves,
            });
        }
    }
    found
}

fn axis(axis: &FigureAxis) -> PlainAxis {
    let dimension = unit::parse(&axis.unit).map_or(Dimension::NUMBER, |unit| unit.dimension);
    PlainAxis {
        name: axis.name.clone(),
        dimension,
    }
}

fn curves(sides: &[Side], drawn: &[(usize, FigureCurve)]) -> Vec<Curve> {
    if sides.len() <= Curves::MOST_RUNS {
        let one = |(run, curve): &(usize, FigureCurve)| Curve {
            label: format!("{} {}", run + 1, sides[*run].name),
            points: curve.line(),
            dots: curve.dots,
            run: Some(*run),
        };
        return drawn.iter().map(one).collect();
    }
    let label = |index: usize| {
        if index == 0 {
            format!("each of {} runs", drawn.len())
        } else {
            String::new()
        }
    };
    let each = drawn.iter().enumerate().map(|(index, (_, curve))| Curve {
        label: label(index),
        points: curve.line(),
        dots: curve.dots,
        run: None,
    });
    each.chain(mean(drawn)).collect()
}

/// The mean of curves that have the same points on the first axis.
fn mean(drawn: &[(usize, FigureCurve)]) -> Option<Curve> {
    let (_, first) = drawn.first()?;
    let same = drawn.iter().all(|(_, curve)| {
        curve.count == first.count
            && curve
                .points
                .iter()
                .zip(&first.points)
                .all(|(a, b)| (a.0 - b.0).abs() <= 1e-9 * b.0.abs())
    });
    let at = |index: usize| {
        let heights: Vec<f64> = drawn
            .iter()
            .filter_map(|(_, curve)| Some(curve.points.get(index)?.1))
            .collect();
        Some((first.points[index].0, Spread::of_values(&heights)?.mean))
    };
    let points = (0..first.points.len())
        .map(at)
        .collect::<Option<Vec<_>>>()?;
    same.then(|| Curve {
        label: "mean".to_owned(),
        points,
        dots: false,
        run: Some(0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{FigureData, Figures};

    fn side(height: f64) -> Side {
        let axis = |name: &str, unit: &str| FigureAxis {
            name: name.to_owned(),
            unit: unit.to_owned(),
        };
        let figure = FigureData {
            figure: "hit_force".to_owned(),
            procedure: "hit".to_owned(),
            x: axis("time", "s"),
            y: axis("force", "N"),
            curves: vec![
                FigureCurve::of("force", &[(0.0, 0.0), (1.0, height), (2.0, 0.0)]),
                FigureCurve::of("fit", &[(0.0, 0.0), (2.0, 0.0)]),
            ],
            references: Vec::new(),
            bands: Vec::new(),
        };
        let figures = Figures {
            figures: vec![figure],
            ..Figures::default()
        };
        Side {
            name: format!("run {height}"),
            summary: serde_json::Value::Null,
            figures,
            plan: None,
        }
    }

    #[test]
    fn few_runs_are_listed_separately_and_many_have_a_mean() {
        let few = sheets(&[side(1.0), side(2.0)]);
        assert_eq!(
            (few.len(), few[0].name.as_str(), few[0].curves.curves.len()),
            (1, "hit_force_1", 2)
        );
        assert_eq!(few[0].curves.curves[1].run, Some(1));
        let many: Vec<Side> = (1..=8_u8).map(|height| side(f64::from(height))).collect();
        let sheet = &sheets(&many)[0].curves;
        assert_eq!(
            (sheet.curves.len(), sheet.curves[0].label.as_str()),
            (9, "each of 8 runs")
        );
        assert_eq!(sheet.curves[8].points[1], (1.0, 4.5));
        assert!(sheet.png().is_ok());
    }
}
