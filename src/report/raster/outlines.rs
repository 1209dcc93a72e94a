//! The drawing backend of plotters whose shapes are outlines. In: shapes in fractions of a pixel. Out: filled outlines in pixels, in their order.
//! It fills nothing.

use std::convert::Infallible;

use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
    FontStyle,
};
use tiny_skia::{Color, LineJoin, Path, PathBuilder, Rect, Stroke, Transform};

use super::letters::{Fonts, text_outline};

/// Units of a shape per pixel, in each direction: the coordinates of plotters are integers.
pub(crate) const UNITS: u32 = 4;

/// An area of one colour.
pub(crate) struct Area {
    pub outline: Path,
    pub colour: Color,
}

/// A sheet that plotters draws on.
pub(crate) struct Outlines<'a> {
    /// In pixels.
    pub width: u32,
    pub height: u32,
    pub fonts: &'a Fonts,
    pub areas: &'a mut Vec<Area>,
}

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

#[expect(
    clippy::cast_precision_loss,
    reason = "a sheet has some thousand units"
)]
const fn unit(value: i32) -> f32 {
    value as f32
}

/// A path through some points; none if there are fewer than two.
fn path(points: impl IntoIterator<Item = BackendCoord>, closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (x, y) in points {
        if path.is_empty() {
            path.move_to(unit(x), unit(y));
        } else {
            path.line_to(unit(x), unit(y));
        }
    }
    if closed {
        path.close();
    }
    path.finish()
}

impl Outlines<'_> {
    /// Adds the area inside a path, which `placed` moves within the sheet.
    fn fill(&mut self, path: Option<Path>, colour: BackendColor, placed: Transform) {
        let pixel = 1.0 / unit(UNITS.cast_signed());
        let outline = path.and_then(|path| path.transform(placed.post_scale(pixel, pixel)));
        let (red, green, blue) = colour.rgb;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 0 and 1"
        )]
        let alpha = (colour.alpha * 255.0).round() as u8;
        self.areas.extend(outline.map(|outline| Area {
            outline,
            colour: Color::from_rgba8(red, green, blue, alpha),
        }));
    }

    /// Adds a filled path, or a line along it.
    fn draw<S: BackendStyle>(&mut self, path: Option<Path>, style: &S, fill: bool) {
        let area = if fill {
            path
        } else {
            let stroke = Stroke {
                width: unit(style.stroke_width().cast_signed()),
                line_join: LineJoin::Round,
                ..Stroke::default()
            };
            path.and_then(|path| path.stroke(&stroke, 1.0))
        };
        self.fill(area, style.color(), Transform::identity());
    }
}

impl DrawingBackend for Outlines<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        (self.width * UNITS, self.height * UNITS)
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, colour: BackendColor) -> Drawn {
        let square = Rect::from_xywh(unit(x), unit(y), 1.0, 1.0).map(PathBuilder::from_rect);
        self.fill(square, colour, Transform::identity());
        Ok(())
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
        self.draw(path(points, false), style, false);
        Ok(())
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let corners = [from, (to.0, from.1), to, (from.0, to.1)];
        self.draw(path(corners, true), style, fill);
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        (x, y): BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let circle = PathBuilder::from_circle(unit(x), unit(y), unit(radius.cast_signed()));
        self.draw(circle, style, fill);
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn {
        self.draw(path(corners, true), style, true);
        Ok(())
    }

    /// The letters as outlines, at the place that plotters defines: its text has its baseline half a size below the top of its box.
    fn draw_text<T: BackendTextStyle>(&mut self, text: &str, style: &T, at: BackendCoord) -> Drawn {
        let ((left, top), (right, bottom)) = style
            .layout_box(text)
            .map_err(|error| DrawingErrorKind::FontError(Box::new(error)))?;
        let (width, height) = (right - left, bottom - top);
        let dx = match style.anchor().h_pos {
            HPos::Left => 0,
            HPos::Center => -width / 2,
            HPos::Right => -width,
        };
        let dy = match style.anchor().v_pos {
            VPos::Top => 0,
            VPos::Center => -height / 2,
            VPos::Bottom => -height,
        };
        let bold = matches!(style.style(), FontStyle::Bold);
        #[expect(clippy::cast_possible_truncation, reason = "some units")]
        let size = style.size() as f32;
        let outline = text_outline(self.fonts.of(bold), size, text);
        // Where one unit to the right and one unit down of a text point to.
        let turned = |x, y| {
            let (x, y) = style.transform().transform(x, y);
            (unit(x), unit(y))
        };
        let ((right_x, right_y), (down_x, down_y)) = (turned(1, 0), turned(0, 1));
        let placed = Transform::from_translate(unit(dx), unit(dy) + 0.5 * size).post_concat(
            Transform::from_row(right_x, right_y, down_x, down_y, unit(at.0), unit(at.1)),
        );
        self.fill(outline, style.color(), placed);
        Ok(())
    }
}
