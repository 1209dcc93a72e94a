//! A Latin hypercube without a table: a keyed permutation gives the stratum of every run. In: the number of runs, a key, a run. Out: the
//! stratum. It needs no memory that grows, so a study of a billion runs can be divided among machines.
//!
//! The permutation is the swap-or-not shuffle (V. T. Hoang, B. Morris, P. Rogaway, *An enciphering scheme based on a card shuffle*, CRYPTO
//! (2012) 1–13). In each round the numbers x and K − x modulo n are a pair, and a random bit of the pair says whether they are exchanged. It
//! works for any n.

use super::mixing::mixed;
use crate::study::number;

/// Each round halves the distance from a random permutation.
const ROUNDS: usize = 64;

/// A random permutation of 0, 1, … n − 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Permutation {
    count: u64,
    rounds: Vec<Round>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Round {
    /// The sum of a pair, modulo n.
    sum: u64,
    /// Key of the random bits.
    key: u64,
}

impl Permutation {
    /// Of `count` numbers, at least one and at most 2⁶².
    #[must_use]
    pub fn new(count: u64, key: u64) -> Self {
        let round = |at: usize| Round {
            sum: scaled(mixed(key, 2 * at as u64), count),
            key: mixed(key, 2 * at as u64 + 1),
        };
        Self {
            count,
            rounds: (0..ROUNDS).map(round).collect(),
        }
    }

    /// The number at this position.
    ///
    /// # Panics
    /// If there is no such position.
    #[must_use]
    pub fn at(&self, run: u64) -> u64 {
        assert!(run < self.count, "position {run} of {}", self.count);
        self.rounds.iter().fold(run, |number, round| {
            let partner = if number <= round.sum {
                round.sum - number
            } else {
                round.sum + self.count - number
            };
            let exchanged = mixed(round.key, number.max(partner)) >> 63 == 1;
            if exchanged { partner } else { number }
        })
    }

    /// The point of this run: `inside` its stratum, between 0 and 1.
    #[must_use]
    pub fn point(&self, run: u64, inside: f64) -> f64 {
        let point = (number(self.at(run)) + inside) / number(self.count);
        // Rounding may reach 1 in the last stratum.
        point.min(1.0 - f64::EPSILON / 2.0)
    }
}

/// A number below `count` from 64 random bits: the upper half of their product.
fn scaled(bits: u64, count: u64) -> u64 {
    ((u128::from(bits) * u128::from(count)) >> 64) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_is_used_once() {
        for count in [1, 2, 3, 4, 5, 16, 17, 1000, 4096, 10_000] {
            let permutation = Permutation::new(count, 99);
            let mut used = vec![false; usize::try_from(count).unwrap()];
            for run in 0..count {
                let number = usize::try_from(permutation.at(run)).unwrap();
                assert!(!used[number], "{number} of {count} twice");
                used[number] = true;
            }
        }
    }

    /// All 120 permutations of five numbers, over 24,000 keys: χ² with 119 degrees of freedom is below 180 with probability 0.9998.
    #[test]
    fn every_permutation_is_as_likely() {
        let mut counts = [0_u32; 120];
        for key in 0..24_000 {
            let permutation = Permutation::new(5, mixed(1, key));
            let mut left: Vec<u64> = (0..5).collect();
            let mut index = 0;
            for run in 0..5 {
                let at = left
                    .iter()
                    .position(|number| *number == permutation.at(run))
                    .unwrap();
                index = index * left.len() + at;
                left.remove(at);
            }
            counts[index] += 1;
        }
        let squares: f64 = counts
            .iter()
            .map(|count| (f64::from(*count) - 200.0).powi(2) / 200.0)
            .sum();
        assert!((70.0..180.0).contains(&squares), "{squares}");
    }

    /// A sum of inputs: the points of a Latin hypercube leave no scatter of its mean but that within the strata.
    #[test]
    fn a_sum_has_no_scatter_between_strata() {
        let count = 100;
        let permutation = Permutation::new(count, 3);
        let mean: f64 = (0..count)
            .map(|run| permutation.point(run, 0.5))
            .sum::<f64>()
            / 100.0;
        assert!((mean - 0.5).abs() < 1e-14);
        assert!(permutation.point(0, 1.0 - f64::EPSILON / 2.0) < 1.0);
    }
}
