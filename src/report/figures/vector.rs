//! The vector canvas. In: shapes in reference pixels. Out: SVG, which names its font and loads no file; every text is escaped.
//! Coordinates are rounded to a hundredth of a pixel.

use std::cell::RefCell;
use std::fmt::Write as _;

use plotters::style::text_anchor::{HPos, VPos};

use super::super::document::fonts::FIGURE_FAMILIES;
use super::canvas::{Canvas, Lettering, Point};
use super::chart::{Colour, Line};

/// The line height of DejaVu Sans, ascent and descent, over its em: (1901 + 483)/2048, from its `hhea` table.
const LINE_OVER_EM: f64 = 2384.0 / 2048.0;

struct Drawing {
    shapes: RefCell<String>,
}

/// Draws on `width × height` reference pixels. The background is white in a browser and transparent in the PDF.
pub(super) fn svg(width: u32, height: u32, paint: impl FnOnce(&dyn Canvas)) -> String {
    let drawing = Drawing {
        shapes: RefCell::new(String::new()),
    };
    paint(&drawing);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"{FIGURE_FAMILIES}\" fill=\"none\" stroke-linejoin=\"round\" style=\"background:#ffffff\">\n\
         {}</svg>\n",
        drawing.shapes.into_inner()
    )
}

impl Drawing {
    fn add(&self, shape: &str) {
        let mut shapes = self.shapes.borrow_mut();
        shapes.push_str(shape);
        shapes.push('\n');
    }
}

impl Canvas for Drawing {
    fn rectangle(&self, from: Point, to: Point, colour: Colour) {
        let (left, top) = (from.0.min(to.0), from.1.min(to.1));
        let (width, height) = ((to.0 - from.0).abs(), (to.1 - from.1).abs());
        self.add(&format!(
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>",
            number(left),
            number(top),
            number(width),
            number(height),
            hex(colour)
        ));
    }

    fn disc(&self, centre: Point, radius: f64, colour: Colour) {
        self.add(&format!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\"/>",
            number(centre.0),
            number(centre.1),
            number(radius),
            hex(colour)
        ));
    }

    fn polygon(&self, corners: &[Point], colour: Colour) {
        let corners: Vec<String> = corners
            .iter()
            .map(|(x, y)| format!("{},{}", number(*x), number(*y)))
            .collect();
        self.add(&format!(
            "<polygon points=\"{}\" fill=\"{}\"/>",
            corners.join(" "),
            hex(colour)
        ));
    }

    fn polyline(&self, points: &[Point], line: Line, colour: Colour) {
        let mut path = String::new();
        for (index, (x, y)) in points.iter().enumerate() {
            let _ = write!(
                path,
                "{}{} {}",
                if index == 0 { "M" } else { " L" },
                number(*x),
                number(*y)
            );
        }
        let dash: Vec<String> = line.dash.iter().map(|length| number(*length)).collect();
        let dash = if dash.is_empty() {
            String::new()
        } else {
            format!(" stroke-dasharray=\"{}\"", dash.join(" "))
        };
        let (stroke, width) = (hex(colour), number(line.width));
        self.add(&format!(
            "<path d=\"{path}\" stroke=\"{stroke}\" stroke-width=\"{width}\"{dash}/>"
        ));
    }

    fn text(&self, text: &str, anchor: Point, style: &Lettering) {
        // From the anchor down to the baseline, as on the raster.
        let down = style.size
            * match style.anchor.vertical {
                VPos::Top => 0.5,
                VPos::Center if style.upright => 0.097,
                VPos::Center => 0.267,
                VPos::Bottom => -0.306,
            };
        // For text read from bottom to top, down is to the right.
        let (x, y) = if style.upright {
            (anchor.0 + down, anchor.1)
        } else {
            (anchor.0, anchor.1 + down)
        };
        let text_anchor = match style.anchor.horizontal {
            HPos::Left => "start",
            HPos::Center => "middle",
            HPos::Right => "end",
        };
        let (x, y) = (number(x), number(y));
        let turn = if style.upright {
            format!(" transform=\"rotate(-90 {x} {y})\"")
        } else {
            String::new()
        };
        let weight = if style.bold {
            " font-weight=\"bold\""
        } else {
            ""
        };
        self.add(&format!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\"{weight} text-anchor=\"{text_anchor}\" fill=\"{}\"{turn}>{}</text>",
            number(style.size / LINE_OVER_EM),
            hex(style.colour),
            escaped(text)
        ));
    }
}

/// To a hundredth, without trailing zeros and without a negative zero.
fn number(value: f64) -> String {
    let text = format!("{:.2}", value.clamp(-1e5, 1e5));
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

fn hex((red, green, blue): Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// A text between tags: escaped, without control characters, and with code points for missing glyphs as on the raster.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in crate::text::glyphs::shown(&crate::report::document::printable(text)).chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::super::canvas::Anchor;
    use super::*;

    #[test]
    fn a_label_is_never_markup() {
        let anchor = Anchor {
            horizontal: HPos::Left,
            vertical: VPos::Top,
        };
        let style = Lettering {
            size: 13.0,
            bold: false,
            colour: (0, 0, 0),
            anchor,
            upright: false,
        };
        let drawn = svg(10, 10, |canvas| {
            canvas.text("</text><script>&\u{1b}", (1.0, 2.0), &style);
        });
        assert!(
            drawn.contains(">&lt;/text&gt;&lt;script&gt;&amp;\u{fffd}</text>"),
            "{drawn}"
        );
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [1.0, 0.125, -0.001, 430.5].map(number),
            ["1", "0.12", "0", "430.5"]
        );
    }
}
