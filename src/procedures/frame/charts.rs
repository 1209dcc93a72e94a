//! Charts of floors, storeys and elements. In: the steps of a frame, its modes. Out: [`Chart`]s in SI. Colour and dash distinguish floors
//! and storeys, the lowest first.

use crate::report::figures::chart::{
    Chart, Colour, DASH_DOT, DASHED, DOTTED, End, LONG, Marker, Quantity, Reference, SOLID, Series,
    Style, palette,
};
use crate::report::figures::points::{PointCollector, Points};
use psd_physics::statistics::samples::peak;
use psd_plan::record::{Floors, Modes};
use psd_text::units::Dimension;

/// More curves than this cannot be distinguished in one picture.
const MOST_CURVES: usize = 6;

const COLOURS: [Colour; MOST_CURVES] = [
    palette::BLUE,
    palette::VERMILION,
    palette::GREEN,
    palette::PURPLE,
    palette::SKY,
    palette::BLACK,
];
const DASHES: [&[f64]; MOST_CURVES] = [SOLID, DASHED, LONG, DASH_DOT, SOLID, DOTTED];

/// Displacement of each floor relative to the ground.
pub(crate) fn displacement<S: Floors>(steps: &[S]) -> Chart {
    each_floor(
        steps,
        Quantity::of("Displacement", Dimension::LENGTH),
        entries_of(has_elements(steps)),
        |step| step.computed().to_vec(),
    )
}

/// Drift of each storey, or deformation of each element.
pub(crate) fn drift<S: Floors>(steps: &[S], limits: &[Reference]) -> Chart {
    let (of, [name, _]) = of_members(has_elements(steps));
    let mut chart = each_floor(steps, Quantity::of(name, Dimension::LENGTH), of, S::drift);
    chart.references = limits.to_vec();
    chart
}

/// Storey shear against storey drift, or force of each element against its deformation: the area of a loop is the absorbed energy.
pub(crate) fn hysteresis<S: Floors>(steps: &[S]) -> Chart {
    loops(steps, has_elements(steps), |step| {
        step.drift().into_iter().zip(step.shear()).collect()
    })
}

/// The loop of each storey or element.
pub(crate) fn loops<S: Floors>(
    steps: &[S],
    is_of_elements: bool,
    read: impl Fn(&S) -> Vec<(f64, f64)>,
) -> Chart {
    let (of, [along, force]) = of_members(is_of_elements);
    let curves = each(steps, read).into_iter().enumerate();
    let curves = curves.map(|(curve, (member, points))| Series {
        label: format!("{of} {}", member + 1),
        points,
        style: retraced(curve),
    });
    Chart::of(
        Quantity::along(along, Dimension::LENGTH),
        Quantity::of(force, Dimension::FORCE),
        curves.collect(),
    )
}

/// The name of the entries of a list of displacements: of a frame of matrices with elements, they are no floors.
pub(crate) const fn entries_of(has_elements: bool) -> &'static str {
    if has_elements {
        "degree of freedom"
    } else {
        "floor"
    }
}

/// A storey, or an element of a frame of matrices.
pub(crate) const fn members_of(has_elements: bool) -> &'static str {
    if has_elements { "element" } else { "storey" }
}

/// A storey or an element, and the names of its drift or deformation and of its force.
const fn of_members(is_of_elements: bool) -> (&'static str, [&'static str; 2]) {
    let names = if is_of_elements {
        ["Deformation", "Force"]
    } else {
        ["Drift", "Storey shear"]
    };
    (members_of(is_of_elements), names)
}

/// Whether the steps are those of a frame of matrices with elements.
fn has_elements<S: Floors>(steps: &[S]) -> bool {
    steps.first().is_some_and(S::has_elements)
}

pub(crate) fn base_shear<S: Floors>(steps: &[S], limits: &[Reference]) -> Chart {
    let style = Style::line(palette::BLUE, 1.6, SOLID);
    let curve = one(steps, "base shear", S::base_shear, style);
    Chart {
        references: limits.to_vec(),
        ..over_time(Quantity::of("Base shear", Dimension::FORCE), vec![curve])
    }
}

/// The tracking error of each floor, and the tracking indicator of all as a length: divided by the largest command.
pub(crate) fn tracking<S: Floors>(steps: &[S]) -> Chart {
    let missed = |step: &S| {
        if step.has_elements() {
            let elements = step.elements().iter();
            return elements
                .map(|read| read.deformation - read.target)
                .collect();
        }
        step.measured()
            .iter()
            .zip(step.command())
            .map(|(measured, command)| measured - command)
            .collect()
    };
    let mut chart = each_floor(
        steps,
        Quantity::of("Tracking error", Dimension::LENGTH),
        if has_elements(steps) {
            "element"
        } else {
            "floor"
        },
        missed,
    );
    // Mostly rounding and noise, alternating at every step: dashes would not be visible.
    for (curve, series) in chart.series.iter_mut().enumerate() {
        series.style = Style::line(COLOURS[curve % MOST_CURVES], 0.7, SOLID);
    }
    let largest = peak(steps.iter().flat_map(S::command));
    if largest > 0.0 {
        let all = |step: &S| {
            step.tracking()
                .iter()
                .map(|axis| axis.indicator)
                .sum::<f64>()
        };
        let points = steps
            .iter()
            .map(|step| (step.time(), all(step) / largest))
            .collect();
        let label = "tracking indicator / largest command".to_owned();
        chart.series.push(Series {
            label,
            points,
            style: Style::line(palette::BLACK, 2.2, DOTTED),
        });
    }
    chart
}

/// Shapes of the first modes, floor by floor from the ground up; the largest entry of each is 1.
pub(crate) fn modes(modes: &Modes) -> Chart {
    let shapes = modes
        .shapes
        .iter()
        .zip(&modes.periods)
        .take(MOST_CURVES)
        .enumerate();
    let series = shapes.map(|(mode, (shape, period))| Series {
        label: format!(
            "mode {}, {}",
            mode + 1,
            crate::report::number::text(*period, Dimension::TIME)
        ),
        points: std::iter::once((0.0, 0.0))
            .chain(shape.iter().copied().zip((1..).map(f64::from)))
            .collect(),
        style: style(mode, 1.6).marked(Marker::Disc(3.2)),
    });
    Chart::of(
        Quantity::along("Shape, largest entry 1", Dimension::NUMBER),
        Quantity {
            end: End::Whole,
            ..Quantity::of("Floor", Dimension::NUMBER)
        },
        series.collect(),
    )
}

/// Bounds on a peak absolute value are drawn on both sides; the label is at the first.
pub(crate) fn of_size(limits: Vec<Reference>) -> Vec<Reference> {
    let both = |limit: Reference| {
        let other = (limit.y != 0.0).then(|| Reference {
            label: String::new(),
            y: -limit.y,
        });
        std::iter::once(limit).chain(other)
    };
    limits.into_iter().flat_map(both).collect()
}

/// For the caption of a chart of floors: whether not every floor is drawn.
pub(crate) fn chosen_floors<S: Floors>(steps: &[S]) -> &'static str {
    chosen(steps.first().map_or(0, |step| step.computed().len()))
}

/// The same of a chart of storeys or elements.
pub(crate) fn chosen_members<S: Floors>(steps: &[S]) -> &'static str {
    chosen(steps.first().map_or(0, |step| step.drift().len()))
}

const fn chosen(curves: usize) -> &'static str {
    if curves > MOST_CURVES {
        "; not all are drawn"
    } else {
        ""
    }
}

/// The floors that are drawn: all, or as many as can be distinguished, evenly from the lowest to the highest.
pub(crate) fn shown(floors: usize) -> Vec<usize> {
    if floors <= MOST_CURVES {
        return (0..floors).collect();
    }
    (0..MOST_CURVES)
        .map(|curve| curve * (floors - 1) / (MOST_CURVES - 1))
        .collect()
}

fn each_floor<S: Floors>(steps: &[S], y: Quantity, what: &str, read: fn(&S) -> Vec<f64>) -> Chart {
    let curves = each(steps, |step| {
        read(step)
            .into_iter()
            .map(|value| (step.time(), value))
            .collect()
    });
    let curves = curves
        .into_iter()
        .enumerate()
        .map(|(curve, (floor, points))| Series {
            label: format!("{what} {}", floor + 1),
            points,
            style: style(curve, 1.6),
        });
    over_time(y, curves.collect())
}

/// The curves of the floors that are drawn, each with its floor; `read` gives a point of every floor or element.
fn each<S: Floors>(steps: &[S], read: impl Fn(&S) -> Vec<(f64, f64)>) -> Vec<(usize, Points)> {
    let count = steps.first().map_or(0, |step| read(step).len());
    let mut curves: Vec<(usize, PointCollector)> = shown(count)
        .into_iter()
        .map(|floor| (floor, PointCollector::default()))
        .collect();
    for step in steps {
        let points = read(step);
        for (floor, curve) in &mut curves {
            curve.push(points[*floor]);
        }
    }
    curves
        .into_iter()
        .map(|(floor, curve)| (floor, curve.points()))
        .collect()
}

pub(crate) fn style(curve: usize, width: f64) -> Style {
    Style::line(
        COLOURS[curve % MOST_CURVES],
        width,
        DASHES[curve % MOST_CURVES],
    )
}

/// A path that is travelled again fills its own dashes: the width distinguishes storeys, the thinner on top.
fn retraced(curve: usize) -> Style {
    const WIDTHS: [f64; MOST_CURVES] = [3.6, 2.0, 1.4, 1.0, 0.8, 0.6];
    Style::line(
        COLOURS[curve % MOST_CURVES],
        WIDTHS[curve % MOST_CURVES],
        SOLID,
    )
}

pub(crate) fn over_time(y: Quantity, series: Vec<Series>) -> Chart {
    Chart::of(Quantity::time(), y, series)
}

pub(crate) fn one<S: Floors>(
    steps: &[S],
    label: &str,
    read: fn(&S) -> f64,
    style: Style,
) -> Series {
    Series {
        label: label.to_owned(),
        points: steps.iter().map(|step| (step.time(), read(step))).collect(),
        style,
    }
}

#[cfg(test)]
mod tests {
    use super::shown;

    #[test]
    fn of_many_floors_the_lowest_and_the_highest_are_always_drawn() {
        assert_eq!(shown(2), [0, 1]);
        assert_eq!(shown(6), [0, 1, 2, 3, 4, 5]);
        assert_eq!(shown(64), [0, 12, 25, 37, 50, 63]);
    }
}
