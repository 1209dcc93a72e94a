//! Figures by their content: the curves, the text of the legend, the limits, the shaded times. Numbers in the text of a legend are
//! results, and are compared there.

use super::finding::{Change, Finding, FindingPart, RowRef};
use super::tolerance::{Rule, Tolerances};
use super::{Truth, number};
use crate::report::{FigureCurve, FigureData};
use psd_text::units::{Dimension, unit};

pub(super) fn compare(
    accepted: &Truth,
    now: &Truth,
    tolerances: &Tolerances,
    found: &mut Vec<Finding>,
) {
    let (was, is) = match (accepted.figures(), now.figures()) {
        (Some(was), Some(is)) => (was.figures, is.figures),
        (None, None) => return,
        (None, Some(_)) => {
            return found.push(Finding::new(
                FindingPart::Figure,
                super::FIGURES,
                Change::New,
            ));
        }
        (Some(_), None) => {
            return found.push(Finding::new(
                FindingPart::Figure,
                super::FIGURES,
                Change::Missing,
            ));
        }
    };
    for old in &was {
        match is.iter().find(|new| new.figure == old.figure) {
            Some(new) => figure(old, new, tolerances, found),
            None => found.push(Finding::new(
                FindingPart::Figure,
                format!("figure {}", old.figure),
                Change::Missing,
            )),
        }
    }
    for new in is
        .iter()
        .filter(|new| !was.iter().any(|old| old.figure == new.figure))
    {
        found.push(Finding::new(
            FindingPart::Figure,
            format!("figure {}", new.figure),
            Change::New,
        ));
    }
}

/// A tolerance rule for each axis.
#[derive(Clone, Copy)]
struct Axis {
    dimension: Dimension,
    rule: Rule,
    scale: f64,
}

fn figure(was: &FigureData, is: &FigureData, tolerances: &Tolerances, found: &mut Vec<Finding>) {
    let mut note = |what: &str, change: Option<Change>| {
        found.extend(change.map(|change| {
            Finding::new(
                FindingPart::Figure,
                format!("figure {}{what}", was.figure),
                change,
            )
        }));
    };
    for (axis, old, new) in [("x", &was.x, &is.x), ("y", &was.y, &is.y)] {
        note(
            &format!(", {axis} axis"),
            words(
                &format!("{} {}", old.name, old.unit),
                &format!("{} {}", new.name, new.unit),
            ),
        );
    }
    let axis = |unit: &str, pick: fn(&(f64, f64)) -> f64| {
        let dimension = unit::parse(unit).map_or(Dimension::NUMBER, |unit| unit.dimension);
        let points = was
            .curves
            .iter()
            .chain(&is.curves)
            .flat_map(FigureCurve::points);
        Axis {
            dimension,
            rule: tolerances.axis(&was.procedure, dimension),
            scale: number::scale(points.map(|point| pick(&point))),
        }
    };
    let (x, y) = (
        axis(&was.x.unit, |point| point.0),
        axis(&was.y.unit, |point| point.1),
    );
    note(
        "",
        Change::length("curves", was.curves.len(), is.curves.len()),
    );
    for (old, new) in was.curves.iter().zip(&is.curves) {
        let name = if old.label.is_empty() {
            String::new()
        } else {
            format!(", {}", old.label)
        };
        note(&format!("{name}: words"), words(&old.label, &new.label));
        if old.count == new.count {
            for (along, change) in [
                ("x", curve(old, new, x, |point| point.0)),
                ("y", curve(old, new, y, |point| point.1)),
            ] {
                note(&format!("{name}: {along}"), change);
            }
        } else {
            note(&name, Change::length("points", old.count, new.count));
        }
    }
    lines(&was.references, &is.references, y, &mut note);
    for (old, new) in was.bands.iter().zip(&is.bands) {
        let name = format!(", {}", old.label);
        note(&format!("{name}: words"), words(&old.label, &new.label));
        let ends = |intervals: &[(f64, f64)]| {
            intervals
                .iter()
                .flat_map(|(from, to)| [*from, *to])
                .collect::<Vec<_>>()
        };
        let change = Change::length("intervals", old.intervals.len(), new.intervals.len())
            .or_else(|| row(&ends(&old.intervals), &ends(&new.intervals), x));
        note(&name, change);
    }
}

fn lines(
    was: &[(String, f64)],
    is: &[(String, f64)],
    y: Axis,
    note: &mut impl FnMut(&str, Option<Change>),
) {
    if let Some(change) = Change::length("limits", was.len(), is.len()) {
        return note("", Some(change));
    }
    for ((old_label, old), (new_label, new)) in was.iter().zip(is) {
        note(", limit: words", words(old_label, new_label));
        let scale = y.scale.max(old.abs());
        note(
            ", limit",
            number::single(Some(*old), Some(*new), y.dimension, y.rule, scale),
        );
    }
}

/// The rule of a curve, along one axis.
fn curve(
    was: &FigureCurve,
    is: &FigureCurve,
    axis: Axis,
    pick: fn(&(f64, f64)) -> f64,
) -> Option<Change> {
    let of = |curve: &FigureCurve| {
        curve
            .points()
            .map(|point| pick(&point))
            .collect::<Vec<f64>>()
    };
    row(&of(was), &of(is), axis)
}

fn row(was: &[f64], is: &[f64], axis: Axis) -> Option<Change> {
    let pairs: Vec<_> = was
        .iter()
        .zip(is)
        .map(|(was, is)| (Some(*was), Some(*is)))
        .collect();
    let at = |row| RowRef {
        row,
        step: None,
        time: None,
    };
    Change::length("points", was.len(), is.len())
        .or_else(|| number::many(&pairs, axis.dimension, axis.rule, axis.scale, at))
}

/// The text without its numbers.
fn words(was: &str, is: &str) -> Option<Change> {
    let bare = |text: &str| {
        let is_digit = |c: char| {
            c.is_ascii_digit() || matches!(c, '.' | '−' | '⁻' | '⁰' | '¹' | '²' | '³' | '⁴'..='⁹')
        };
        text.split(is_digit)
            .filter(|part| !part.is_empty())
            .collect::<Vec<_>>()
            .join("#")
    };
    (bare(was) != bare(is)).then(|| Change::Text {
        was: was.to_owned(),
        is: is.to_owned(),
        first: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{FigureAxis, Figures};

    fn figures(points: &[(f64, f64)], label: &str) -> Truth {
        let axis = |name: &str, unit: &str| FigureAxis {
            name: name.to_owned(),
            unit: unit.to_owned(),
        };
        let data = FigureData {
            figure: "hit_force".to_owned(),
            procedure: "hit".to_owned(),
            x: axis("time", "s"),
            y: axis("force", "N"),
            curves: vec![FigureCurve::of(label, points)],
            references: vec![("limit".to_owned(), 5.0)],
            bands: Vec::new(),
        };
        let text = Figures {
            figures: vec![data],
            ..Figures::default()
        }
        .to_json();
        Truth::of([(super::super::FIGURES.to_owned(), text)])
    }

    fn findings(was: &Truth, is: &Truth) -> Vec<String> {
        let mut found = Vec::new();
        compare(was, is, &Tolerances::default(), &mut found);
        found.into_iter().map(|finding| finding.name).collect()
    }

    #[test]
    fn a_curve_moves_beyond_its_tolerance_and_not_within_it() {
        let line = |peak: f64| {
            (0..1000)
                .map(|i| (f64::from(i), if i == 777 { peak } else { 1.0 }))
                .collect::<Vec<_>>()
        };
        let was = figures(&line(10.0), "force, K = 3.1 kN/m");
        assert_eq!(
            findings(&was, &figures(&line(10.0 + 9e-9), "force, K = 3.2 kN/m")),
            Vec::<String>::new()
        );
        // The peak is not a point that regular thinning of a curve would keep.
        assert_eq!(
            findings(&was, &figures(&line(10.0 + 11e-9), "force, K = 3.1 kN/m")),
            ["figure hit_force, force, K = 3.1 kN/m: y"]
        );
        assert_eq!(
            findings(&was, &figures(&line(10.0), "power, K = 3.1 kN/m")),
            ["figure hit_force, force, K = 3.1 kN/m: words"]
        );
        assert_eq!(
            findings(&was, &figures(&line(10.0)[1..], "force, K = 3.1 kN/m")),
            ["figure hit_force, force, K = 3.1 kN/m"]
        );
        assert_eq!(findings(&was, &Truth::default()), ["figures.json"]);
    }
}
