//! The largest force behind many noisy readings. In: readings and their noise. Out: the largest force. It knows no rig.
//!
//! If a curve is flat, the largest of many readings contains the largest error: for sixty readings with a standard deviation σ it is 2.3σ
//! too large. The readings themselves show this bias (Cook & Stefanski, *Simulation-extrapolation estimation in parametric measurement
//! error models*, J. Amer. Stat. Assoc. 89 (1994) 1314–1328). Noise of √(1 + λ)σ adds c√(1 + λ)σ to the largest of readings of one force.
//! The same noise once more (λ = 1) adds (√2 − 1)cσ, and no noise at all (λ = −1) removes cσ. A single outstanding reading keeps its
//! size. The result scatters as one reading does.

use std::f64::consts::SQRT_2;

use statrs::function::erf::erfc;

/// Readings this many standard deviations below the largest have no effect.
const FAR: f64 = 9.0;
/// With the noise once more, the largest reading lies between this many standard deviations below the largest and above it.
const BELOW: f64 = 6.0;
const ABOVE: f64 = 8.0;
/// Intervals of that range: for a smooth function the trapezoidal rule with a tenth of its width is exact to all significant digits.
const PARTS: u32 = 140;

/// Collects readings one by one.
#[derive(Clone, Debug)]
pub struct NoisyLargest {
    /// Standard deviation of a reading.
    noise: f64,
    /// Readings that may have an effect.
    readings: Vec<f64>,
    largest: Option<f64>,
}

impl NoisyLargest {
    /// `noise`: standard deviation of a reading, 0 without noise.
    #[must_use]
    pub const fn new(noise: f64) -> Self {
        Self {
            noise,
            readings: Vec::new(),
            largest: None,
        }
    }

    /// One for each of these standard deviations.
    #[must_use]
    pub fn of_each(noise: &[f64]) -> Vec<Self> {
        noise.iter().map(|noise| Self::new(*noise)).collect()
    }

    /// As [`Self::new`], with these readings.
    #[must_use]
    pub fn of(noise: f64, readings: impl Iterator<Item = f64>) -> Self {
        let mut all = Self::new(noise);
        readings.for_each(|reading| all.push(reading));
        all
    }

    pub fn push(&mut self, reading: f64) {
        let largest = self.largest.map_or(reading, |largest| largest.max(reading));
        if self.noise > 0.0 {
            if self.largest.is_none_or(|before| largest > before) {
                self.readings
                    .retain(|known| *known > largest - FAR * self.noise);
            }
            if reading > largest - FAR * self.noise {
                self.readings.push(reading);
            }
        }
        self.largest = Some(largest);
    }

    /// The largest reading minus the bias from noise; None without readings.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        let largest = self.largest?;
        Some(if self.noise > 0.0 {
            largest - self.added(largest) / (SQRT_2 - 1.0)
        } else {
            largest
        })
    }

    /// The mean increase of the largest reading with the same noise once more: ∫ 1 − ∏ Φ((t − Rᵢ)/σ) dt.
    fn added(&self, largest: f64) -> f64 {
        let step = (BELOW + ABOVE) / f64::from(PARTS);
        let above: f64 = (0..PARTS)
            .map(|part| {
                // The weight is one at the lower end and zero at the upper end.
                let at = -BELOW + step * (f64::from(part) + 0.5);
                let below = |reading: &f64| {
                    (0.5 * erfc(-(at + (largest - reading) / self.noise) / SQRT_2)).ln()
                };
                1.0 - self.readings.iter().map(below).sum::<f64>().exp()
            })
            .sum();
        self.noise * (step * above - BELOW)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::testing::normal;

    /// Mean error and standard deviation, over σ, of the result for a curve, and the mean error of the largest reading.
    fn of_many(curve: &[f64], noise: f64) -> ([f64; 2], f64) {
        const RUNS: u32 = 400;
        let truth = curve.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut state = 5;
        let (mut sum, mut squares, mut raw) = (0.0, 0.0, 0.0);
        for _ in 0..RUNS {
            let read: Vec<f64> = curve
                .iter()
                .map(|force| force + noise * normal(&mut state))
                .collect();
            let error = (NoisyLargest::of(noise, read.iter().copied())
                .value()
                .unwrap()
                - truth)
                / noise;
            sum += error;
            squares += error * error;
            raw += (read.iter().copied().fold(f64::NEG_INFINITY, f64::max) - truth) / noise;
        }
        let count = f64::from(RUNS);
        (
            [
                sum / count,
                (squares / count - (sum / count).powi(2)).sqrt(),
            ],
            raw / count,
        )
    }

    /// Flat, rising to its end, rising slowly, round, of two readings. The result has a bias below 0.6σ while the largest reading is up
    /// to 2.7σ too large, and it has the scatter of one reading.
    #[test]
    fn it_is_right_on_the_average_whatever_the_curve() {
        let line = |from: f64, to: f64, count: u32| {
            (0..count)
                .map(move |index| from + (to - from) * f64::from(index) / f64::from(count - 1))
                .collect::<Vec<f64>>()
        };
        let round: Vec<f64> = (-30..30)
            .map(|index: i32| 420.0 - 0.05 * f64::from(index).powi(2))
            .collect();
        for (curve, raw) in [
            (vec![420.0; 60], 2.3),
            (vec![420.0; 200], 2.7),
            (line(0.0, 420.0, 60), 0.0),
            (line(410.0, 420.0, 50), 1.5),
            (round, 1.5),
            (vec![0.0, 420.0, 420.0], 0.5),
        ] {
            let ([mean, scatter], of_largest) = of_many(&curve, 4.0);
            assert!(
                (of_largest - raw).abs() < 0.35,
                "{of_largest} of {} readings",
                curve.len()
            );
            assert!(
                mean.abs() < 0.6 && (0.8..1.3).contains(&scatter),
                "{mean} ± {scatter} of {} readings",
                curve.len()
            );
        }
    }

    #[test]
    fn without_noise_and_with_one_dominant_term_it_is_the_largest() {
        let readings = || [1.0, 7.0, 3.0].into_iter();
        assert_eq!(NoisyLargest::of(0.0, readings()).value(), Some(7.0));
        assert!((NoisyLargest::of(0.1, readings()).value().unwrap() - 7.0).abs() < 1e-9);
        assert_eq!(NoisyLargest::new(1.0).value(), None);
    }

    /// Φ((t − R₁)/σ)Φ((t − R₂)/σ): the mean of the larger of two with σ is R + σ/√π.
    #[test]
    fn noise_once_more_adds_what_it_adds_by_hand() {
        let two = NoisyLargest::of(4.0, [420.0, 420.0].into_iter());
        assert!(
            (two.added(420.0) - 4.0 / std::f64::consts::PI.sqrt()).abs() < 1e-9,
            "{}",
            two.added(420.0)
        );
    }
}
