//! Accepted and new results on one chart: the figure curves that differ, and columns of tables that are in no such figure. In: both
//! results and the differences. Out: images. If a difference is too small to see, it is drawn as a separate curve.

use psd_plan::schema::columns;
use std::collections::BTreeSet;

use crate::exit::Failure;
use psd::golden::{Change, Finding, FindingPart, Table, Truth, column_dimension};
use psd::report::{Curve, Curves, FigureCurve, OutputError, OutputFile, PlainAxis};
use psd_text::units::{Dimension, unit};

/// Largest number of columns drawn: those with the largest difference over their tolerance.
const COLUMNS: usize = 6;
/// Largest number of curves drawn for one figure.
const CURVES: usize = 3;

/// All images.
pub fn all(was: &Truth, is: &Truth, found: &[Finding]) -> Result<Vec<OutputFile>, Failure> {
    let mut files = Vec::new();
    for (name, curves) in figures(was, is).into_iter().chain(columns(was, is, found)) {
        let bytes = curves.png().map_err(|reason| OutputError::Figure {
            figure: "overlay",
            procedure: name.clone(),
            reason,
        })?;
        files.push(OutputFile {
            path: format!("{name}.png"),
            bytes,
        });
    }
    Ok(files)
}

/// The curves of each figure that differ.
fn figures(was: &Truth, is: &Truth) -> Vec<(String, Curves)> {
    let (Some(was), Some(is)) = (was.figures(), is.figures()) else {
        return Vec::new();
    };
    let axis = |name: &str, token: &str| PlainAxis {
        name: name.to_owned(),
        dimension: unit::parse(token).map_or(Dimension::NUMBER, |unit| unit.dimension),
    };
    let mut sheets = Vec::new();
    for old in &was.figures {
        let Some(new) = is.figures.iter().find(|new| new.figure == old.figure) else {
            continue;
        };
        let moved = |(old, new): &(&FigureCurve, &FigureCurve)| {
            old.count != new.count || !old.points().eq(new.points())
        };
        let moved: Vec<_> = old
            .curves
            .iter()
            .zip(&new.curves)
            .filter(moved)
            .take(CURVES)
            .collect();
        let mut curves = Vec::new();
        for (index, (old, new)) in moved.into_iter().enumerate() {
            let label = |which: &str, curve: &FigureCurve| {
                if curve.label.is_empty() {
                    which.to_owned()
                } else {
                    format!("{which}: {}", curve.label)
                }
            };
            curves.push(Curve {
                label: label("this run", new),
                points: new.line(),
                dots: new.dots,
                run: Some(2 * index),
            });
            curves.push(Curve {
                label: label("accepted", old),
                points: old.line(),
                dots: new.dots,
                run: Some(2 * index + 1),
            });
        }
        if !curves.is_empty() {
            sheets.push((
                old.figure.clone(),
                Curves {
                    x: axis(&old.x.name, &old.x.unit),
                    y: axis(&old.y.name, &old.y.unit),
                    curves,
                },
            ));
        }
    }
    sheets
}

/// The columns with the largest differences, over time if there is a time column.
fn columns(was: &Truth, is: &Truth, found: &[Finding]) -> Vec<(String, Curves)> {
    let mut moved: Vec<(&str, f64)> = found
        .iter()
        .filter_map(|finding| match &finding.change {
            Change::Moved(moved) if finding.part == FindingPart::Table => {
                let by = moved.by().map_or(f64::INFINITY, f64::abs);
                Some((
                    finding.name.as_str(),
                    by / moved.scale.max(f64::MIN_POSITIVE),
                ))
            }
            _ => None,
        })
        .collect();
    moved.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut drawn = BTreeSet::new();
    let mut sheets = Vec::new();
    for (name, share) in moved.into_iter().take(COLUMNS) {
        let Some((table, column)) = name.split_once('.') else {
            continue;
        };
        let of = |truth: &Truth| {
            truth
                .tables()
                .find(|(known, _)| *known == table)
                .and_then(|(_, table)| line(&table, column))
        };
        let (Some((x, old)), Some((_, new))) = (of(was), of(is)) else {
            continue;
        };
        if !drawn.insert(name) {
            continue;
        }
        let y = PlainAxis {
            name: column.to_owned(),
            dimension: column_dimension(column),
        };
        if share < SEEN {
            let points = old
                .iter()
                .zip(&new)
                .map(|(old, new)| (new.0, new.1 - old.1))
                .collect();
            let label = "this run minus accepted".to_owned();
            let y = PlainAxis {
                name: format!("Difference of {column}"),
                ..y.clone()
            };
            let curves = vec![Curve {
                label,
                points,
                dots: false,
                run: Some(0),
            }];
            sheets.push((
                format!("{table}_{column}_difference"),
                Curves {
                    x: x.clone(),
                    y,
                    curves,
                },
            ));
        }
        let curves = vec![
            Curve {
                label: "this run".to_owned(),
                points: new,
                dots: false,
                run: Some(0),
            },
            Curve {
                label: "accepted".to_owned(),
                points: old,
                dots: false,
                run: Some(1),
            },
        ];
        sheets.push((format!("{table}_{column}"), Curves { x, y, curves }));
    }
    sheets
}

/// The fraction of the largest value of a column that is hardly visible, about two pixels.
const SEEN: f64 = 0.01;

/// A column over the time of the test, of the rig, or over its rows.
fn line(table: &Table, column: &str) -> Option<(PlainAxis, Vec<(f64, f64)>)> {
    let ys = table.numbers(column)?;
    let mut along = [columns::TIME, columns::WALL_TIME, columns::STEP]
        .map(|column| column.name)
        .into_iter()
        .filter(|name| *name != column);
    let (name, xs) = along.find_map(|name| Some((name, table.numbers(name)?)))?;
    let points = xs
        .into_iter()
        .zip(ys)
        .filter_map(|(x, y)| Some((x?, y?)))
        .collect();
    let shown = match name {
        _ if name == columns::TIME.name => "Simulated time",
        _ if name == columns::WALL_TIME.name => "Rig time",
        _ => "Step",
    };
    Some((
        PlainAxis {
            name: shown.to_owned(),
            dimension: column_dimension(name),
        },
        points,
    ))
}
