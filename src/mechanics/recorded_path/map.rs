//! Where a curve lies when its beginning has moved. In: how places and forces of the record were shifted or stretched. Out:
//! the place of the record that a place stands for, and the force there.

/// Places of the record ξ lie at `stretch`·ξ + `shift` (m), its forces r are `growth`·r + `rise` (N).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Map {
    stretch: f64,
    shift: f64,
    growth: f64,
    rise: f64,
}

impl Map {
    pub const NONE: Self = Self { stretch: 1.0, shift: 0.0, growth: 1.0, rise: 0.0 };

    /// Moved as it is.
    pub const fn shifted(shift: f64, rise: f64) -> Self {
        Self { shift, rise, ..Self::NONE }
    }

    /// Stretched about a point, m and N, so that another comes to where it is wanted; None where that is no stretch.
    pub fn about(point: [f64; 2], from: [f64; 2], to: [f64; 2]) -> Option<Self> {
        let factor = |axis: usize| (to[axis] - point[axis]) / (from[axis] - point[axis]);
        let (stretch, growth) = (factor(0), factor(1));
        let possible = |factor: f64| factor.is_finite() && factor > 0.0;
        (possible(stretch) && possible(growth)).then(|| Self {
            stretch,
            shift: point[0] * (1.0 - stretch),
            growth,
            rise: point[1] * (1.0 - growth),
        })
    }

    /// This one, done to what another one has done.
    pub fn after(self, first: Self) -> Self {
        Self {
            stretch: self.stretch * first.stretch,
            shift: self.stretch * first.shift + self.shift,
            growth: self.growth * first.growth,
            rise: self.growth * first.rise + self.rise,
        }
    }

    /// Where a place of the record lies, m.
    pub fn place(self, recorded: f64) -> f64 {
        self.stretch * recorded + self.shift
    }

    /// The place of the record, m.
    pub fn back(self, place: f64) -> f64 {
        (place - self.shift) / self.stretch
    }

    /// N
    pub fn force(self, recorded: f64) -> f64 {
        self.growth * recorded + self.rise
    }
}
