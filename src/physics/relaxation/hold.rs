//! Readings of a specimen at rest, from which relaxation is identified. In: moves and readings of a rig. Out: [`Hold`]s. It knows no
//! model.

/// A dwell: a specimen held at one displacement, and its readings.
#[derive(Clone, Debug, PartialEq)]
pub struct Hold {
    /// Number of the step it belongs to.
    pub step: u64,
    /// \[m\]
    pub displacement: f64,
    /// From the last reading before to the begin of the move here \[s\].
    pub waited_for: f64,
    /// Duration of the move, at constant velocity \[s\].
    pub moved_for: f64,
    /// From the end of the move to the first reading \[s\]: time at rest while the rig settled.
    pub settled_for: f64,
    /// Time since the first reading \[s\] and force \[N\].
    pub readings: Vec<(f64, f64)>,
}

impl Hold {
    /// Time of the last reading after the first \[s\].
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.readings.last().map_or(0.0, |(time, _)| *time)
    }

    /// Σ (R − R̄)² of its readings about their mean \[N²\]: the squares that a constant force leaves.
    #[must_use]
    pub fn squares_about_mean(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
        let count = self.readings.len().max(1) as f64;
        let mean = self.readings.iter().map(|(_, force)| force).sum::<f64>() / count;
        self.readings
            .iter()
            .map(|(_, force)| (force - mean).powi(2))
            .sum()
    }
}

/// Times of all readings \[s\] and the largest force \[N\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub count: usize,
    /// The shortest time after a first reading \[s\].
    pub shortest: f64,
    /// \[s\]
    pub longest: f64,
    /// In absolute value \[N\].
    pub largest_force: f64,
}

impl Extent {
    pub fn new(holds: &[Hold]) -> Self {
        let readings = || holds.iter().flat_map(|hold| &hold.readings);
        let times = || readings().map(|(time, _)| *time);
        Self {
            count: readings().count(),
            shortest: times()
                .filter(|time| *time > 0.0)
                .fold(f64::INFINITY, f64::min),
            longest: times().fold(0.0, f64::max),
            largest_force: readings().fold(0.0, |most: f64, (_, force)| most.max(force.abs())),
        }
    }

    /// The times between which a relaxation time can be identified \[s\]: from a fifth of the shortest to 30 of the longest.
    pub fn resolvable(&self) -> (f64, f64) {
        (0.2 * self.shortest, 30.0 * self.longest)
    }
}

/// `count` times from `low` to `high`, in geometric progression.
pub(super) fn geometric(low: f64, high: f64, count: u32) -> impl Iterator<Item = f64> {
    (0..count).map(move |index| low * (high / low).powf(f64::from(index) / f64::from(count - 1)))
}

/// The reason why there is no fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unrelaxed {
    /// Fewer readings than parameters.
    TooFew,
    /// Constant forces describe the readings as well (BIC).
    Steady,
    /// The relaxation is faster than the readings, or slower than the holds.
    OutOfReach,
}
