//! The drawing backend of plotters that writes SVG, which names its font and loads no file; every text is escaped. In: shapes in
//! hundredths of a reference pixel. Out: SVG.

use std::cell::RefCell;
use std::convert::Infallible;
use std::fmt::Write as _;
use std::rc::Rc;

use plotters::element::{Drawable, PointCollection};
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{FontStyle, FontTransform};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
};

use super::super::document::fonts::FIGURE_FAMILIES;
use super::chart::{Colour, LineStyle};

/// Units of a shape per reference pixel: the coordinates of plotters are integers.
pub(super) const UNITS: f64 = 100.0;

/// The line height of DejaVu Sans, ascent and descent, over its em: (1901 + 483)/2048, from its `hhea` table.
const LINE_OVER_EM: f64 = 2384.0 / 2048.0;

/// A sheet that plotters draws on; a clone is the same sheet.
#[derive(Clone)]
pub(super) struct Drawing {
    /// Reference pixels.
    width: u32,
    height: u32,
    shapes: Rc<RefCell<String>>,
}

impl Drawing {
    /// An empty sheet of `width × height` reference pixels.
    pub fn new(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            shapes: Rc::default(),
        }
    }

    /// What is drawn so far. The background is white in a browser and transparent in the PDF.
    pub fn svg(&self) -> String {
        let (width, height) = (self.width, self.height);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"{FIGURE_FAMILIES}\" fill=\"none\" stroke-linejoin=\"round\" style=\"background:#ffffff\">\n\
             {}</svg>\n",
            self.shapes.borrow()
        )
    }
}

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

/// A line of several segments. The styles of plotters have no dashes.
pub(super) struct Polyline {
    pub points: Vec<BackendCoord>,
    pub line: LineStyle,
    pub colour: Colour,
}

impl<'a> PointCollection<'a, BackendCoord> for &'a Polyline {
    type Point = &'a BackendCoord;
    type IntoIter = &'a [BackendCoord];

    fn point_iter(self) -> Self::IntoIter {
        &self.points
    }
}

impl Drawable<Drawing> for Polyline {
    fn draw<I: Iterator<Item = BackendCoord>>(
        &self,
        points: I,
        drawing: &mut Drawing,
        _: (u32, u32),
    ) -> Drawn {
        drawing.line(points, self.line, self.colour);
        Ok(())
    }
}

impl Drawing {
    fn add(&self, shape: &str) {
        let mut shapes = self.shapes.borrow_mut();
        shapes.push_str(shape);
        shapes.push('\n');
    }

    fn line(
        &self,
        points: impl IntoIterator<Item = BackendCoord>,
        line: LineStyle,
        colour: Colour,
    ) {
        let mut path = String::new();
        for (index, (x, y)) in points.into_iter().enumerate() {
            let start = if index == 0 { "M" } else { " L" };
            let _ = write!(path, "{start}{} {}", pixels(x), pixels(y));
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
}

/// The attributes of an area or of its outline.
fn ink<S: BackendStyle>(style: &S, fill: bool) -> String {
    let colour = hex(style.color().rgb);
    if fill {
        format!("fill=\"{colour}\"")
    } else {
        let width = number(f64::from(style.stroke_width()) / UNITS);
        format!("stroke=\"{colour}\" stroke-width=\"{width}\"")
    }
}

impl DrawingBackend for Drawing {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a hundred"
        )]
        let units = UNITS as u32;
        (self.width * units, self.height * units)
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, colour: BackendColor) -> Drawn {
        self.draw_rect((x, y), (x + 1, y + 1), &colour, true)
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Drawn {
        self.draw_path([from, to], style)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        points: I,
        style: &S,
    ) -> Drawn {
        let line = LineStyle {
            width: f64::from(style.stroke_width()) / UNITS,
            dash: &[],
        };
        self.line(points, line, style.color().rgb);
        Ok(())
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        (left, top): BackendCoord,
        (right, bottom): BackendCoord,
        style: &S,
        fill: bool,
    ) -> Drawn {
        self.add(&format!(
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {}/>",
            pixels(left),
            pixels(top),
            pixels(right - left),
            pixels(bottom - top),
            ink(style, fill)
        ));
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        (x, y): BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        self.add(&format!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>",
            pixels(x),
            pixels(y),
            number(f64::from(radius) / UNITS),
            ink(style, fill)
        ));
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn {
        let corners: Vec<String> = corners
            .into_iter()
            .map(|(x, y)| format!("{},{}", pixels(x), pixels(y)))
            .collect();
        self.add(&format!(
            "<polygon points=\"{}\" {}/>",
            corners.join(" "),
            ink(style, true)
        ));
        Ok(())
    }

    fn draw_text<T: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &T,
        (x, y): BackendCoord,
    ) -> Drawn {
        let upright = matches!(style.transform(), FontTransform::Rotate270);
        let size = style.size() / UNITS;
        // From the anchor down to the baseline. A text on its side is centred on its line, any other on its letters.
        let down = size
            * match style.anchor().v_pos {
                VPos::Top => 0.5,
                VPos::Center if upright => 0.097,
                VPos::Center => 0.267,
                VPos::Bottom => -0.306,
            };
        let (x, y) = (f64::from(x) / UNITS, f64::from(y) / UNITS);
        // For text read from bottom to top, down is to the right.
        let (x, y) = if upright {
            (x + down, y)
        } else {
            (x, y + down)
        };
        let text_anchor = match style.anchor().h_pos {
            HPos::Left => "start",
            HPos::Center => "middle",
            HPos::Right => "end",
        };
        let (x, y) = (number(x), number(y));
        let turn = if upright {
            format!(" transform=\"rotate(-90 {x} {y})\"")
        } else {
            String::new()
        };
        let weight = if matches!(style.style(), FontStyle::Bold) {
            " font-weight=\"bold\""
        } else {
            ""
        };
        self.add(&format!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\"{weight} text-anchor=\"{text_anchor}\" fill=\"{}\"{turn}>{}</text>",
            number(size / LINE_OVER_EM),
            hex(style.color().rgb),
            escaped(text)
        ));
        Ok(())
    }
}

/// Units in reference pixels.
fn pixels(units: i32) -> String {
    number(f64::from(units) / UNITS)
}

/// To a hundredth, without trailing zeros and without a negative zero.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
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

/// A text between tags: escaped, without control characters, and with code points for missing glyphs.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in psd_text::glyphs::shown(&crate::report::document::printable(text)).chars() {
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
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [1.0, 0.125, -0.001, 430.5].map(number),
            ["1", "0.12", "0", "430.5"]
        );
    }
}
