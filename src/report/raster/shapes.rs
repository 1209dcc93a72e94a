//! The words of a drawing: point, colour, line. In: nothing. Out: types. It draws nothing.

/// A point in reference pixels (96 to the inch), y downward.
pub type Point = (f64, f64);

/// Red, green, blue.
pub type Colour = (u8, u8, u8);

/// A line.
#[derive(Clone, Copy)]
pub struct Line {
    /// Reference pixels.
    pub width: f64,
    /// Lengths drawn and left out, in turn, reference pixels; empty: solid.
    pub dash: &'static [f64],
}
