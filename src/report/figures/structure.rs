//! The structure of a test of which a part is computed, or a specimen has a scale: floors with their masses and weights, storeys that are
//! tested or computed, the axes of the rig. In: a frame. Out: SVG, and the drawing in words.

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
const SIZE: f64 = 12.5;
const LINE: f64 = 15.0;
const GREY: Colour = (110, 110, 110);

/// The drawing of a frame of storeys.
pub(crate) fn svg(frame: &Frame) -> String {
    let storeys = drawn_storeys(frame);
    #[expect(clippy::cast_precision_loss, reason = "a drawing has a few storeys")]
    let ground = TOP + STOREY * storeys.len() as f64;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a positive height in pixels"
    )]
    let height = (ground + GROUND) as u32;
    canvas::svg(WIDTH, height, |canvas| {
        ground_line(canvas, ground);
        let mut below = ground;
        for (storey, drawn) in frame.storeys.iter().zip(&storeys) {
            let floor = below - STOREY;
            columns(canvas, drawn, [floor, below]);
            beside(canvas, drawn, 0.5 * (floor + below));
            floor_at(canvas, storey, drawn, floor);
            below = floor;
        }
    })
}

/// The drawing in words, from the ground up.
pub(crate) fn description(frame: &Frame) -> String {
    let storeys = drawn_storeys(frame).into_iter().zip(&frame.storeys);
    let storeys: Vec<String> = storeys
        .map(|(drawn, storey)| {
            let axis = drawn.axis.map(|axis| format!(", axis {axis}"));
            format!(
                "storey {}: {}, {}{}; floor of {}",
                drawn.number,
                drawn.part,
                drawn.stiffness,
                axis.unwrap_or_default(),
                of_floor(storey).join(", ")
            )
        })
        .collect();
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

fn ground_line(canvas: &Canvas, y: f64) {
    let [left, right] = [COLUMNS[0] - 40.0, COLUMNS[1] + OVERHANG];
    canvas.polyline(&[(left, y), (right, y)], solid(2.5), INK);
    let mut x = left + 10.0;
    while x <= right {
        canvas.polyline(&[(x, y), (x - 8.0, y + 9.0)], solid(1.0), INK);
        x += 10.0;
    }
}

/// Solid on the rig, dashed if computed.
fn columns(canvas: &Canvas, drawn: &DrawnStorey, [floor, below]: [f64; 2]) {
    let (line, colour) = if drawn.axis.is_some() {
        (solid(4.0), palette::BLUE)
    } else {
        let dash = &[5.0, 4.0];
        (LineStyle { width: 1.6, dash }, GREY)
    };
    for x in COLUMNS {
        canvas.polyline(&[(x, floor), (x, below)], line, colour);
    }
}

/// The part and the stiffness of a storey, in lines that fit.
fn beside(canvas: &Canvas, drawn: &DrawnStorey, middle: f64) {
    let colour = if drawn.axis.is_some() {
        palette::BLUE
    } else {
        GREY
    };
    let mut style = lettering(SIZE, HPos::Left, VPos::Center);
    style.colour = colour;
    let room = f64::from(WIDTH) - TEXT - 4.0;
    let mut lines = vec![format!("storey {}", drawn.number)];
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
    use psd_plan::{Behaviour, Part, Scale};

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
}
