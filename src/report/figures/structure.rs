//! The structure of a test of which a part is computed, or a specimen has a scale: floors with their masses and weights, storeys or
//! elements that are tested or computed, the axes of the rig. In: a frame. Out: SVG, and the drawing in words.

use plotters::style::text_anchor::{HPos, VPos};

use super::canvas::{self, Canvas, Point};
use super::chart::{Colour, LineStyle, palette};
use super::draw::{INK, lettering};
use crate::report::number;
use crate::report::wording::specimen::{DrawnStorey, drawn_storeys};
use psd_plan::{Frame, Storey};
use psd_text::units::Dimension;

const WIDTH: u32 = 720;
/// Of one storey, reference pixels: three lines of text beside it.
const STOREY: f64 = 58.0;
const TOP: f64 = 26.0;
/// The ground with its hatching.
const GROUND: f64 = 22.0;
/// The columns of a storey.
const COLUMNS: [f64; 2] = [212.0, 318.0];
/// The floors are wider than the columns.
const OVERHANG: f64 = 10.0;
const TEXT: f64 = 346.0;
/// Of one degree of freedom at least.
const LEVEL: f64 = 36.0;
/// The stiffness matrix and the elements side by side.
const LANES: [f64; 2] = [140.0, 330.0];
/// The end of an element.
const DOT: f64 = 4.0;
const SIZE: f64 = 12.5;
const LINE: f64 = 15.0;
const GREY: Colour = (110, 110, 110);

/// The drawing of a frame of storeys, or of a frame of matrices with elements.
pub(crate) fn svg(frame: &Frame) -> String {
    let storeys = drawn_storeys(frame);
    if frame.has_elements() {
        return elements(frame, &storeys);
    }
    #[expect(clippy::cast_precision_loss, reason = "a drawing has a few storeys")]
    let ground = TOP + STOREY * storeys.len() as f64;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a positive height in pixels"
    )]
    let height = (ground + GROUND) as u32;
    canvas::svg(WIDTH, height, |canvas| {
        ground_line(canvas, ground, [COLUMNS[0] - 40.0, COLUMNS[1] + OVERHANG]);
        let mut below = ground;
        for (storey, drawn) in frame.storeys.iter().zip(&storeys) {
            let floor = below - STOREY;
            columns(canvas, drawn, [floor, below]);
            beside(canvas, "storey", drawn, 0.5 * (floor + below));
            floor_at(canvas, storey, drawn, floor);
            below = floor;
        }
    })
}

/// A lane for the stiffness matrix and one for each element; a level for each degree of freedom.
fn elements(frame: &Frame, drawn: &[DrawnStorey]) -> String {
    let floors = frame.degrees_of_freedom();
    #[expect(clippy::cast_precision_loss, reason = "a drawing has a few lines")]
    let [levels, lines, lanes] = [floors, drawn.len(), drawn.len() + 1].map(|count| count as f64);
    let ground = TOP + (LEVEL * levels).max(STOREY * (lines + 1.0));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a positive height in pixels"
    )]
    let height = (ground + GROUND) as u32;
    let [left, right] = LANES;
    let level = |end: Option<usize>| {
        #[expect(clippy::cast_precision_loss, reason = "a drawing has a few levels")]
        let number = end.map_or(0.0, |end| (end + 1) as f64);
        ground - (ground - TOP) * number / levels
    };
    let lane = |number: usize| {
        #[expect(clippy::cast_precision_loss, reason = "a drawing has a few lanes")]
        let share = (number as f64 + 0.5) / lanes;
        left + share * (right - left)
    };
    canvas::svg(WIDTH, height, |canvas| {
        ground_line(canvas, ground, [left, right]);
        for floor in 0..floors {
            let y = level(Some(floor));
            canvas.polyline(&[(left, y), (right, y)], solid(1.6), GREY);
            let style = lettering(SIZE, HPos::Left, VPos::Center);
            canvas.text(
                &format!("degree of freedom {}", floor + 1),
                (6.0, y),
                &style,
            );
            let mass = number::stated(frame.mass[floor][floor], Dimension::MASS);
            canvas.text(&mass, (6.0, y + LINE), &style);
            canvas.disc((lane(0), y), DOT, GREY);
        }
        let base = if is_restrained(frame) { None } else { Some(0) };
        spring(
            canvas,
            lane(0),
            [level(base), level(floors.checked_sub(1))],
            false,
        );
        let mut style = lettering(SIZE, HPos::Left, VPos::Center);
        style.colour = GREY;
        let row = (ground - TOP) / (lines + 1.0);
        let mut y = TOP + 0.5 * row;
        canvas.text("K: stiffness matrix, computed", (TEXT, y), &style);
        named(canvas, "K", (lane(0), level(base)), false);
        for (element, drawn) in frame.elements.iter().zip(drawn) {
            y += row;
            let (x, ends) = (lane(drawn.number), element.ends.map(level));
            let is_tested = drawn.axis.is_some();
            spring(canvas, x, ends, is_tested);
            named(
                canvas,
                &drawn.number.to_string(),
                (x, ends[0].max(ends[1])),
                is_tested,
            );
            if let Some(axis) = drawn.axis {
                let x = x + 9.0;
                let middle = 0.5 * (ends[0] + ends[1]);
                arrow(canvas, [(x, ends[0]), (x, ends[1])], palette::VERMILION);
                let mut style = lettering(SIZE, HPos::Left, VPos::Center);
                style.colour = palette::VERMILION;
                canvas.text(&format!("axis {axis}"), (x + 4.0, middle), &style);
            }
            beside(canvas, "element", drawn, y);
        }
    })
}

/// Whether the stiffness of the files joins a degree of freedom to the ground: its row has a sum.
fn is_restrained(frame: &Frame) -> bool {
    frame.computed_stiffness.iter().any(|row| {
        let largest = row
            .iter()
            .fold(0.0, |most: f64, entry| most.max(entry.abs()));
        row.iter().sum::<f64>().abs() > 1e-9 * largest
    })
}

/// A line between two levels, with a dot at each: solid on the rig, dashed if computed.
fn spring(canvas: &Canvas, x: f64, [from, to]: [f64; 2], is_tested: bool) {
    let (line, colour) = of_part(is_tested);
    canvas.polyline(&[(x, from), (x, to)], line, colour);
    for y in [from, to] {
        canvas.disc((x, y), DOT, colour);
    }
}

/// The number of an element above its lower end.
fn named(canvas: &Canvas, name: &str, (x, low): Point, is_tested: bool) {
    let mut style = lettering(SIZE, HPos::Right, VPos::Bottom);
    style.colour = of_part(is_tested).1;
    canvas.text(name, (x - 6.0, low - 4.0), &style);
}

/// The drawing in words, from the ground up, or element by element.
pub(crate) fn description(frame: &Frame) -> String {
    let drawn = drawn_storeys(frame);
    let word = frame.word_for_a_member();
    let described = |drawn: &DrawnStorey| {
        let axis = drawn.axis.map(|axis| format!(", axis {axis}"));
        format!(
            "{word} {}: {}, {}{}",
            drawn.number,
            drawn.part,
            drawn.stiffness,
            axis.unwrap_or_default()
        )
    };
    if frame.has_elements() {
        let elements = drawn.iter().zip(&frame.elements).map(|(drawn, element)| {
            let [from, to] = element.ends.map(|end| end.map_or(0, |end| end + 1));
            format!("{}; from {from} to {to}", described(drawn))
        });
        let elements: Vec<String> = elements.collect();
        return format!(
            "Degrees of freedom 1 to {}, 0 is the ground. The stiffness matrix: computed. {}.",
            frame.degrees_of_freedom(),
            elements.join(". ")
        );
    }
    let storeys = drawn.iter().zip(&frame.storeys);
    let storeys = storeys.map(|(drawn, storey)| {
        format!(
            "{}; floor of {}",
            described(drawn),
            of_floor(storey).join(", ")
        )
    });
    let storeys: Vec<String> = storeys.collect();
    format!("From the ground up: {}.", storeys.join(". "))
}

/// Mass and weight of a floor.
fn of_floor(storey: &Storey) -> Vec<String> {
    let mut texts = vec![number::stated(storey.mass, Dimension::MASS)];
    if storey.gravity > 0.0 {
        let weight = number::stated(storey.gravity, Dimension::FORCE);
        texts.push(format!("weight {weight}"));
    }
    texts
}

const fn solid(width: f64) -> LineStyle {
    LineStyle { width, dash: &[] }
}

fn ground_line(canvas: &Canvas, y: f64, [left, right]: [f64; 2]) {
    canvas.polyline(&[(left, y), (right, y)], solid(2.5), INK);
    let mut x = left + 10.0;
    while x <= right {
        canvas.polyline(&[(x, y), (x - 8.0, y + 9.0)], solid(1.0), INK);
        x += 10.0;
    }
}

/// Solid on the rig, dashed if computed.
const fn of_part(is_tested: bool) -> (LineStyle, Colour) {
    if is_tested {
        (solid(4.0), palette::BLUE)
    } else {
        let dash = &[5.0, 4.0];
        (LineStyle { width: 1.6, dash }, GREY)
    }
}

fn columns(canvas: &Canvas, drawn: &DrawnStorey, [floor, below]: [f64; 2]) {
    let (line, colour) = of_part(drawn.axis.is_some());
    for x in COLUMNS {
        canvas.polyline(&[(x, floor), (x, below)], line, colour);
    }
}

/// The part and the stiffness of a storey or an element, in lines that fit.
fn beside(canvas: &Canvas, word: &str, drawn: &DrawnStorey, middle: f64) {
    let mut style = lettering(SIZE, HPos::Left, VPos::Center);
    style.colour = of_part(drawn.axis.is_some()).1;
    let room = f64::from(WIDTH) - TEXT - 4.0;
    let mut lines = vec![format!("{word} {}", drawn.number)];
    for text in drawn.part.split(", ").chain([drawn.stiffness.as_str()]) {
        let longer = lines.last().map(|line| format!("{line}, {text}"));
        match longer.filter(|line| style.width(line) <= room) {
            Some(longer) if text != drawn.stiffness => {
                lines.pop();
                lines.push(longer);
            }
            _ => lines.push(text.to_owned()),
        }
    }
    #[expect(clippy::cast_precision_loss, reason = "a few lines")]
    let mut y = middle - 0.5 * LINE * (lines.len() as f64 - 1.0);
    for line in lines {
        canvas.text(&line, (TEXT, y), &style);
        y += LINE;
    }
}

/// The floor with its mass, its weight and the actuator that moves it.
fn floor_at(canvas: &Canvas, storey: &Storey, drawn: &DrawnStorey, y: f64) {
    let [left, right] = [COLUMNS[0] - OVERHANG, COLUMNS[1] + OVERHANG];
    canvas.polyline(&[(left, y), (right, y)], solid(6.0), INK);
    let style = lettering(SIZE, HPos::Left, VPos::Center);
    let mut texts = of_floor(storey);
    texts[0] = format!("floor {}, {}", drawn.number, texts[0]);
    for (text, below) in texts.iter().zip([0.0, LINE]) {
        canvas.text(text, (6.0, y + below), &style);
    }
    if storey.gravity > 0.0 {
        let middle = 0.5 * (COLUMNS[0] + COLUMNS[1]);
        arrow(canvas, [(middle, y - 22.0), (middle, y - 4.0)], INK);
    }
    if let Some(axis) = drawn.axis {
        arrow(canvas, [(left - 52.0, y), (left, y)], palette::VERMILION);
        let mut style = lettering(SIZE, HPos::Center, VPos::Bottom);
        style.colour = palette::VERMILION;
        canvas.text(&format!("axis {axis}"), (left - 30.0, y - 5.0), &style);
    }
}

/// An arrow along an axis of the sheet.
fn arrow(canvas: &Canvas, [from, to]: [Point; 2], colour: Colour) {
    const HEAD: f64 = 8.0;
    let along = (to.0 - from.0).hypot(to.1 - from.1);
    let (x, y) = ((to.0 - from.0) / along, (to.1 - from.1) / along);
    let base = (to.0 - HEAD * x, to.1 - HEAD * y);
    canvas.polyline(&[from, base], solid(2.0), colour);
    let side = |sign: f64| (base.0 - sign * 4.0 * y, base.1 + sign * 4.0 * x);
    canvas.polygon(&[to, side(1.0), side(-1.0)], colour);
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_plan::{Behaviour, Element, Part, Scale};

    #[test]
    fn a_hybrid_test_is_drawn_with_its_parts_axes_scales_and_weights() {
        let scale = Scale {
            displacement: 0.5,
            force: 0.25,
            represents: 2.0,
        };
        let half = Part::Tested {
            apart: false,
            scale,
        };
        let storey = |part, gravity| Storey {
            part,
            gravity,
            height: Some(3.0),
            ..Storey::new(2000.0, 6e5, Behaviour::Elastic { stiffness: 6e5 })
        };
        let storeys = vec![storey(half, 5e3), storey(Part::Computed, 0.0)];
        let frame = Frame::of_storeys(storeys);
        assert_eq!(
            description(&frame).replace('\u{a0}', " "),
            "From the ground up: storey 1: tested at scale 0.5, one of 2 equal parts, on the strong floor, 600 kN/m; 150 kN/m on the rig, axis 1; floor of 2 t, weight 5 kN. storey 2: computed, 600 kN/m; floor of 2 t."
        );
        let drawn = svg(&frame).replace('\u{a0}', " ");
        for text in [
            "axis 1",
            "floor 2, 2 t",
            "weight 5 kN",
            "storey 2, computed",
            "150 kN/m on the rig",
        ] {
            assert!(drawn.contains(text), "{text}: {drawn}");
        }
        assert_eq!(drawn.matches("stroke-dasharray").count(), 2);
    }

    #[test]
    fn elements_are_drawn_beside_the_stiffness_matrix() {
        let element = |ends, part| Element {
            ends,
            stiffness: 4e5,
            stiffness_uncertainty: 0.0,
            behaviour: Behaviour::Elastic { stiffness: 4e5 },
            damping: 0.0,
            coulomb: 0.0,
            part,
        };
        let elements = vec![
            element([None, Some(1)], Part::Computed),
            element([Some(0), Some(1)], Part::TESTED),
        ];
        let drawn = |grounded: f64| {
            let mass = vec![vec![2000.0, 0.0], vec![0.0, 1500.0]];
            let stiffness = vec![vec![3e5 + grounded, -3e5], vec![-3e5, 3e5]];
            let frame = Frame::of_matrices(mass, stiffness).with_elements(elements.clone());
            let words = description(&frame).replace('\u{a0}', " ");
            (words, svg(&frame).replace('\u{a0}', " "))
        };
        let (words, picture) = drawn(1e5);
        assert_eq!(
            words,
            "Degrees of freedom 1 to 2, 0 is the ground. The stiffness matrix: computed. element 1: computed, 400 kN/m; from 0 to 2. \
             element 2: tested, on the strong floor, 400 kN/m, axis 1; from 1 to 2."
        );
        for text in [
            "axis 1",
            "degree of freedom 2",
            "1.5 t",
            "element 2, tested",
        ] {
            assert!(picture.contains(text), "{text}: {picture}");
        }
        // The matrix and the computed element.
        assert_eq!(picture.matches("stroke-dasharray").count(), 2);
        // A dot at each end of both elements, one for each degree of freedom of K, and those of its line.
        assert_eq!(picture.matches("<circle").count(), 8);
        assert_ne!(
            picture,
            drawn(0.0).1,
            "a free matrix does not reach the ground"
        );
    }
}
