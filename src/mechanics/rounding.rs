//! What rounding to a quantum makes of sums of readings. In: where the readings lie, their weights in each sum, the quantum. Out: the
//! covariance of the sums. It knows no fit and no rig.
//!
//! A reading that is rounded is off by e = q·s(y), s the sawtooth from −½ to ½ of the true value y in quanta. Where the zero of the grid
//! lies is not known, and over all its places the errors of two readings have the covariance q²·B₂({yᵢ − yⱼ})/2, B₂(t) = t² − t + 1/6: the
//! same for readings of one quantum's distance as for one and the same reading, q²/12, and as good as none for readings that lie anyhow. So
//! a fine grid makes independent errors, and a coarse one nearly one error for all. By Fourier, B₂({t})/2 = Σ cos(2πkt)/(2π²k²), and a sum
//! with weights wᵢ has the variance q² Σₖ |Σᵢ wᵢ e^(2πi·k·yᵢ)|²/(2π²k²). Noise of σ quanta ahead of the rounding leaves e^(−(2πkσ)²) of
//! what two readings share: of the k-th harmonic of either reading the characteristic function of a normal error, e^(−(2πkσ)²/2).

use std::f64::consts::TAU;

/// Harmonics that are summed; what the others add, 7 % of all, counts as independent from reading to reading.
const HARMONICS: u8 = 8;

/// How finely it is looked for what the readings leave open.
const TRIED: i8 = 8;

/// Readings that are rounded.
#[derive(Clone, Debug)]
pub struct Rounded {
    /// Where each lies before it is rounded, in quanta.
    pub places: Vec<f64>,
    /// What the readings leave open of that: by any part of each of these, up to its whole to either side, they may all lie elsewhere.
    pub open: Vec<Vec<f64>>,
    /// Standard deviation of one reading before it is rounded, in quanta.
    pub noise: f64,
    /// Each is the mean of so many.
    pub samples: u32,
}

impl Rounded {
    /// Covariance of two weighted sums of the readings, in quanta². Of all that is left open the place counts that makes most of the
    /// first sum.
    #[must_use]
    pub fn covariance(&self, first: &[f64], second: &[f64]) -> [[f64; 2]; 2] {
        let at = |moved: &[f64], by: f64| self.at([first, second], moved, by);
        let mut worst = at(&[], 0.0);
        for moved in &self.open {
            for tried in -TRIED..=TRIED {
                let found = at(moved, f64::from(tried) / f64::from(TRIED));
                if found[0][0] > worst[0][0] {
                    worst = found;
                }
            }
        }
        worst
    }

    /// Variance of one weighted sum, in quanta².
    #[must_use]
    pub fn variance(&self, weights: &[f64]) -> f64 {
        self.covariance(weights, weights)[0][0]
    }

    fn at(&self, weights: [&[f64]; 2], moved: &[f64], by: f64) -> [[f64; 2]; 2] {
        let samples = f64::from(self.samples.max(1));
        let products = |a: usize, b: usize| weights[a].iter().zip(weights[b]).map(|(a, b)| a * b).sum::<f64>();
        let alone = [[products(0, 0), products(0, 1)], [products(1, 0), products(1, 1)]];
        let mut found = [[0.0; 2]; 2];
        let mut left = 1.0 / 12.0;
        for harmonic in (1..=HARMONICS).map(f64::from) {
            let size = 2.0 / (TAU * harmonic).powi(2);
            left -= size;
            let shared = (-(TAU * harmonic * self.noise).powi(2)).exp();
            let sums = self.sums(weights, harmonic, moved, by);
            for (a, row) in found.iter_mut().enumerate() {
                for (b, cell) in row.iter_mut().enumerate() {
                    let together = sums[a][0] * sums[b][0] + sums[a][1] * sums[b][1];
                    let one = alone[a][b];
                    *cell += size * (shared * (together - one) + one * (shared + (1.0 - shared) / samples));
                }
            }
        }
        for (a, row) in found.iter_mut().enumerate() {
            for (b, cell) in row.iter_mut().enumerate() {
                *cell += left * alone[a][b] / samples;
            }
        }
        found
    }

    /// Real and imaginary part of Σ wᵢ e^(2πi·k·yᵢ) of both sums.
    fn sums(&self, weights: [&[f64]; 2], harmonic: f64, moved: &[f64], by: f64) -> [[f64; 2]; 2] {
        let mut sums = [[0.0; 2]; 2];
        for (index, place) in self.places.iter().enumerate() {
            let place = place + by * moved.get(index).copied().unwrap_or(0.0);
            let (sin, cos) = (TAU * harmonic * place).sin_cos();
            for (sum, weights) in sums.iter_mut().zip(weights) {
                sum[0] += weights[index] * cos;
                sum[1] += weights[index] * sin;
            }
        }
        sums
    }
}

/// Weights of the values in slope and intercept of the line of least squares through them.
#[must_use]
pub fn line_weights(x: &[f64]) -> [Vec<f64>; 2] {
    #[expect(clippy::cast_precision_loss, reason = "far fewer points than 2^53")]
    let count = x.len() as f64;
    let mean = x.iter().sum::<f64>() / count;
    let squares: f64 = x.iter().map(|x| (x - mean).powi(2)).sum();
    let slope: Vec<f64> = x.iter().map(|x| (x - mean) / squares).collect();
    let intercept = slope.iter().map(|weight| 1.0 / count - mean * weight).collect();
    [slope, intercept]
}

/// How far each lies along the way of all of them, from 0 to 1.
#[must_use]
pub fn along(x: &[f64]) -> Vec<f64> {
    let (low, high) = x.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
    x.iter().map(|x| if high > low { (x - low) / (high - low) } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::identification::fit_line;
    use crate::mechanics::testing::{normal, uniform};

    fn even(count: u32) -> Vec<f64> {
        (1..=count).map(|point| f64::from(point) / f64::from(count)).collect()
    }

    fn slopes(x: &[f64], rise: f64, noise: f64, samples: u32, state: &mut u64) -> f64 {
        let zero = uniform(state);
        let mut read = |x: f64| (0..samples).map(|_| (zero + rise * x + noise * normal(state)).round()).sum::<f64>();
        let y: Vec<f64> = x.iter().map(|x| read(*x) / f64::from(samples)).collect();
        fit_line(x, &y).unwrap().slope - rise
    }

    /// Replays with the zero of the grid anywhere scatter as the closed form says, whether the grid is fine against the steps, or
    /// coarse, or in step with them, with noise ahead of it or without.
    #[test]
    fn it_is_the_scatter_of_replays_with_the_grid_anywhere() {
        const REPLAYS: u32 = 3000;
        let mut state = 7;
        for (count, rise, noise, samples) in [
            (3, 1.3, 0.0, 1),
            (5, 0.4, 0.0, 1),
            (5, 17.3, 0.0, 1),
            (12, 3.0, 0.0, 1),
            (12, 0.7, 0.1, 1),
            (12, 5.4, 0.3, 4),
            (40, 121.7, 0.0, 1),
            (40, 2.2, 0.05, 9),
        ] {
            let x = even(count);
            let rounded = Rounded { places: x.iter().map(|x| rise * x).collect(), open: Vec::new(), noise, samples };
            let [weights, _] = line_weights(&x);
            let noisy = noise * noise / f64::from(samples) * weights.iter().map(|weight| weight * weight).sum::<f64>();
            let foretold = (rounded.variance(&weights) + noisy).sqrt();
            let squares: f64 = (0..REPLAYS).map(|_| slopes(&x, rise, noise, samples, &mut state).powi(2)).sum();
            let found = (squares / f64::from(REPLAYS)).sqrt();
            // 3000 replays tell it to 1.3 %, of bounded errors better.
            assert!((found / foretold - 1.0).abs() < 0.06, "{count} points over {rise} quanta: {found}, told {foretold}");
        }
    }

    /// By hand: in step with the grid all readings are off alike, so that no slope is; anyhow they are off by 1/√12 each.
    #[test]
    fn in_step_with_the_grid_all_are_off_alike_and_anyhow_each_by_itself() {
        let x = even(10);
        let [slope, intercept] = line_weights(&x);
        let of =
            |rise: f64, noise: f64| Rounded { places: x.iter().map(|x| rise * x).collect(), open: Vec::new(), noise, samples: 1 };
        let alone: f64 = slope.iter().map(|weight| weight * weight).sum::<f64>() / 12.0;
        // But for the harmonics that are not summed.
        assert!(of(20.0, 0.0).variance(&slope) < 0.075 * alone);
        // The intercept is off by as much as they are all.
        assert!((12.0 * of(20.0, 0.0).variance(&intercept) - 1.0).abs() < 0.075);
        assert!((of(20.0, f64::INFINITY).variance(&slope) / alone - 1.0).abs() < 1e-12);
        let many = Rounded { samples: 16, ..of(20.0, f64::INFINITY) };
        assert!((many.variance(&slope) / alone - 1.0 / 16.0).abs() < 1e-12);
    }

    /// Two readings on a grid that is left open, one at either end of the way: each is off by 1/√12 or both alike; at most the slope has
    /// the error of a difference that is known to ½ at best, where one of them is on the verge of the next quantum.
    #[test]
    fn what_the_readings_leave_open_is_taken_at_its_worst() {
        let x = [0.0, 1.0];
        let [slope, intercept] = line_weights(&x);
        let open = Rounded { places: vec![0.0, 20.0], open: vec![along(&x)], noise: 0.0, samples: 1 };
        // Of a difference of n + ½ quanta: n or n + 1 are read, ½ off either way.
        assert!((open.variance(&slope).sqrt() - 0.5).abs() < 0.02, "{}", open.variance(&slope).sqrt());
        let [[_, shared], [_, of_intercept]] = open.covariance(&slope, &intercept);
        assert!((of_intercept - 1.0 / 12.0).abs() < 1e-9 && shared < 0.0);
    }
}
