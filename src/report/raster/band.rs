//! A sheet, drawn in bands from top to bottom. In: the rows of one band, shapes in subpixels of the whole sheet. Out: those rows of the shapes.
//! It rounds nothing, so that the bands together are the sheet.

use plotters::prelude::{BitMapBackend, DrawingBackend};
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, DrawingErrorKind};

/// Some rows of a sheet.
pub(crate) struct Band<'a> {
    pub rows: BitMapBackend<'a>,
    /// The first of these rows.
    pub top: i32,
    /// Subpixels of the whole sheet.
    pub sheet: (u32, u32),
}

type Error<'a> = <BitMapBackend<'a> as DrawingBackend>::ErrorType;

impl Band<'_> {
    const fn moved(&self, point: BackendCoord) -> BackendCoord {
        (point.0, point.1 - self.top)
    }
}

impl<'a> DrawingBackend for Band<'a> {
    type ErrorType = Error<'a>;

    fn get_size(&self) -> (u32, u32) {
        self.sheet
    }

    fn ensure_prepared(&mut self) -> Result<(), DrawingErrorKind<Error<'a>>> {
        self.rows.ensure_prepared()
    }

    fn present(&mut self) -> Result<(), DrawingErrorKind<Error<'a>>> {
        self.rows.present()
    }

    fn draw_pixel(
        &mut self,
        point: BackendCoord,
        colour: BackendColor,
    ) -> Result<(), DrawingErrorKind<Error<'a>>> {
        self.rows.draw_pixel(self.moved(point), colour)
    }

    /// Circles and polygons consist of vertical and horizontal lines.
    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Result<(), DrawingErrorKind<Error<'a>>> {
        let (from, to) = (self.moved(from), self.moved(to));
        self.rows.draw_line(from, to, style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
        fill: bool,
    ) -> Result<(), DrawingErrorKind<Error<'a>>> {
        let (from, to) = (self.moved(from), self.moved(to));
        self.rows.draw_rect(from, to, style, fill)
    }
}
