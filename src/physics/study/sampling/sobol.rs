//! Sobol' sequences with Owen's scramble. In: the index of a point, a dimension, a key. Out: the coordinate. Every point is made without
//! those before it.
//!
//! In base two, the coordinate of point i is the sum modulo 2 of the direction numbers of the bits of i (I. M. Sobol', USSR Comput. Math.
//! Math. Phys. 7 (1967) 86–112), with the numbers of `direction_numbers`. A scramble flips each bit of a coordinate by a random bit
//! of its own for every value of the bits above it (A. B. Owen, *Randomly permuted (t,m,s)-nets and (t,s)-sequences*, Lect. Notes Stat. 106
//! (1995) 299–317). Here that bit is a hash of the bits above, so the tree of random bits needs no memory.

use super::DesignError;
use super::direction_numbers::ROWS;
use super::mixing::mixed;
use super::unit_interval;

/// Inputs for which there are direction numbers.
pub const MOST_INPUTS: usize = ROWS.len() + 1;

/// Bits of a coordinate, as many as [`unit_interval`] uses.
const BITS: usize = 52;
/// Bits that are flipped one by one. The bits below them are flipped together: they matter for more than 2³² points only.
const OWN: u32 = 32;

/// The direction numbers of the dimensions in use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SobolSequence {
    /// Highest bit first, in the upper bits of a word.
    directions: Vec<[u64; BITS]>,
}

impl SobolSequence {
    /// In this many dimensions.
    ///
    /// # Errors
    /// More than [`MOST_INPUTS`].
    pub fn new(dimensions: usize) -> Result<Self, DesignError> {
        if dimensions > MOST_INPUTS {
            return Err(DesignError::TooManyInputs { inputs: dimensions });
        }
        let directions = (0..dimensions).map(direction_numbers).collect();
        Ok(Self { directions })
    }

    /// The bits of a coordinate, in the upper bits of a word: point `index`, from 0.
    fn bits(&self, mut index: u64, dimension: usize) -> u64 {
        let directions = &self.directions[dimension];
        let mut bits = 0;
        while index != 0 {
            bits ^= directions[index.trailing_zeros() as usize];
            index &= index - 1;
        }
        bits
    }

    /// A coordinate of point `index`, under the scramble of this key: between 0 and 1, both excluded.
    ///
    /// # Panics
    /// If there is no such dimension, or from 2⁵² points.
    #[must_use]
    pub fn scrambled(&self, index: u64, dimension: usize, key: u64) -> f64 {
        unit_interval(scramble(self.bits(index, dimension), key))
    }
}

/// Bit j depends on bits 0 … j only, and flips by a random bit for each value of bits 0 … j − 1.
fn scramble(bits: u64, key: u64) -> u64 {
    let mut flips = 0;
    for depth in 0..OWN {
        // The bits above, with a one before them: every node of the tree has its own number.
        let node = 1 << depth | bits.checked_shr(64 - depth).unwrap_or(0);
        flips |= mixed(key, node) >> 63 << (63 - depth);
    }
    let node = 1 << OWN | bits >> (64 - OWN);
    bits ^ flips ^ mixed(key, node) >> OWN
}

/// Of one dimension, by the recurrence of its polynomial (P. Bratley, B. L. Fox, ACM Trans. Math. Softw. 14 (1988) 88–100).
fn direction_numbers(dimension: usize) -> [u64; BITS] {
    let mut numbers = [0; BITS];
    let Some(row) = dimension.checked_sub(1).map(|index| ROWS[index]) else {
        // The first dimension is van der Corput's sequence.
        return std::array::from_fn(|bit| 1 << (63 - bit));
    };
    let degree = row.first.len();
    for bit in 0..BITS {
        numbers[bit] = if bit < degree {
            row.first[bit] << (63 - bit)
        } else {
            let last = numbers[bit - degree];
            (1..degree)
                .filter(|back| row.coefficients >> (degree - 1 - back) & 1 == 1)
                .fold(last ^ last >> degree, |sum, back| sum ^ numbers[bit - back])
        };
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(sequence: &SobolSequence, index: u64, dimension: usize) -> f64 {
        unit_interval(sequence.bits(index, dimension)) - f64::EPSILON / 2.0
    }

    /// The first ten points in three dimensions, which Joe and Kuo publish with their program. They are in the order of Gray's code.
    #[test]
    fn first_points_are_the_published_ones() {
        let published = [
            [0.0, 0.0, 0.0],
            [0.5, 0.5, 0.5],
            [0.75, 0.25, 0.25],
            [0.25, 0.75, 0.75],
            [0.375, 0.375, 0.625],
            [0.875, 0.875, 0.125],
            [0.625, 0.125, 0.875],
            [0.125, 0.625, 0.375],
            [0.1875, 0.3125, 0.9375],
            [0.6875, 0.8125, 0.4375],
        ];
        let sequence = SobolSequence::new(3).unwrap();
        for (index, point) in (0_u64..).zip(published) {
            let found = [0, 1, 2].map(|dimension| plain(&sequence, index ^ index >> 1, dimension));
            assert_eq!(found, point);
        }
    }

    /// Property A of Sobol': the first bits of the first d direction numbers of d dimensions are linearly independent over GF(2), so
    /// that 2ᵈ points have one in each half of every dimension. Joe and Kuo's numbers have it (2008, sec. 2). A wrong number breaks it
    /// in half of the cases.
    #[test]
    fn first_bits_are_independent_in_every_number_of_dimensions() {
        let sequence = SobolSequence::new(MOST_INPUTS).unwrap();
        for dimensions in 1..=BITS {
            let mut rows: Vec<u64> = sequence.directions[..dimensions]
                .iter()
                .map(|numbers| {
                    (0..dimensions).fold(0, |row, bit| row | (numbers[bit] >> 63) << bit)
                })
                .collect();
            for column in 0..dimensions {
                let pivot = (column..dimensions).find(|at| rows[*at] >> column & 1 == 1);
                rows.swap(column, pivot.expect("a pivot"));
                for at in column + 1..dimensions {
                    if rows[at] >> column & 1 == 1 {
                        rows[at] ^= rows[column];
                    }
                }
            }
        }
    }

    /// A scramble keeps the net: 2ᵐ points have one in each of 2ᵐ intervals of every dimension, and in each of 2ᵐ boxes of the first two.
    #[test]
    fn scrambled_points_are_still_a_net() {
        let sequence = SobolSequence::new(MOST_INPUTS).unwrap();
        let count = 256_u64;
        for key in 0..20 {
            for dimension in 0..MOST_INPUTS {
                let mut used = [false; 256];
                for index in 0..count {
                    let bits = scramble(sequence.bits(index, dimension), mixed(key, 1));
                    assert!(!std::mem::replace(
                        &mut used[usize::try_from(bits >> 56).unwrap()],
                        true
                    ));
                }
            }
            for split in 0..=8 {
                let mut used = [false; 256];
                for index in 0..count {
                    let [first, second] = [0, 1].map(|dimension| {
                        scramble(
                            sequence.bits(index, dimension),
                            mixed(key, dimension as u64),
                        )
                    });
                    let cell = u128::from(first >> 32) >> (32 - split) << (8 - split)
                        | u128::from(second >> 32) >> (24 + split);
                    let cell = usize::try_from(cell).unwrap();
                    assert!(!std::mem::replace(&mut used[cell], true), "{split}");
                }
            }
        }
    }

    /// Over keys, a scrambled point is uniform (χ² of 64 intervals, 63 degrees of freedom: below 115 with probability 0.9999), and two
    /// points that share no bit are independent.
    #[test]
    fn a_scrambled_point_is_uniform_over_keys() {
        let sequence = SobolSequence::new(2).unwrap();
        let mut counts = [0_u32; 64];
        let mut products = 0.0;
        for key in 0..6400 {
            let [first, second] =
                [0, 1].map(|index| sequence.scrambled(index, 1, mixed(11, key)) - 0.5);
            counts
                [usize::try_from(scramble(sequence.bits(5, 1), mixed(11, key)) >> 58).unwrap()] +=
                1;
            // They lie in opposite halves, and independently inside them.
            assert!(first * second < 0.0);
            products += (first.abs() - 0.25) * (second.abs() - 0.25);
        }
        let squares: f64 = counts
            .iter()
            .map(|count| (f64::from(*count) - 100.0).powi(2) / 100.0)
            .sum();
        assert!((30.0..115.0).contains(&squares), "{squares}");
        // The variance of |u − ½| is 1/48.
        assert!((products / 6400.0).abs() < 4.0 / 48.0 / 80.0, "{products}");
    }

    /// Owen (1997): the variance of a smooth integral falls as n⁻³, that of random points as n⁻¹. From 64 to 1024 points of the product of
    /// two inputs the standard deviation falls by 16^1.5 = 64, within a factor of two.
    #[test]
    fn the_scatter_of_a_smooth_integral_falls_faster_than_that_of_random_points() {
        let sequence = SobolSequence::new(2).unwrap();
        let scatter = |count: u32| {
            let squares: f64 = (0..200)
                .map(|key| {
                    let keys = [mixed(5, 2 * key), mixed(5, 2 * key + 1)];
                    let sum: f64 = (0..u64::from(count))
                        .map(|index| {
                            sequence.scrambled(index, 0, keys[0])
                                * sequence.scrambled(index, 1, keys[1])
                        })
                        .sum();
                    (sum / f64::from(count) - 0.25).powi(2)
                })
                .sum();
            (squares / 200.0).sqrt()
        };
        let ratio = scatter(64) / scatter(1024);
        assert!((32.0..128.0).contains(&ratio), "{ratio}");
    }
}
