//! Count, mean, scatter and range of numbers, one after the other. In: numbers. Out: their moments, which do not lose digits however many
//! there are (B. P. Welford, Technometrics 4 (1962) 419–420).

/// Moments so far.
#[derive(Clone, Copy, Debug)]
pub struct Moments {
    pub count: u64,
    pub mean: f64,
    /// Sum of the squared distances from the mean.
    squares: f64,
    pub least: f64,
    pub largest: f64,
}

impl Default for Moments {
    fn default() -> Self {
        Self {
            count: 0,
            mean: 0.0,
            squares: 0.0,
            least: f64::INFINITY,
            largest: f64::NEG_INFINITY,
        }
    }
}

impl Moments {
    pub fn add(&mut self, value: f64) {
        self.count += 1;
        let distance = value - self.mean;
        self.mean += distance / number(self.count);
        self.squares += distance * (value - self.mean);
        self.least = self.least.min(value);
        self.largest = self.largest.max(value);
    }

    /// Standard deviation of the sample. None with fewer than two numbers.
    pub fn standard_deviation(&self) -> Option<f64> {
        (self.count > 1).then(|| (self.squares / number(self.count - 1)).sqrt())
    }
}

/// A count as a number.
#[expect(
    clippy::cast_precision_loss,
    reason = "a study has far fewer runs than 2^53"
)]
pub const fn number(count: u64) -> f64 {
    count as f64
}
