//! The Cholesky factor of a symmetric band matrix, L D Lᵀ with ones on the diagonal of L: n·b² once, n·b per solution. In: a matrix. Out:
//! solutions, or the row that shows it is not positive definite.
//!
//! A tridiagonal matrix is eliminated from both ends towards the middle. This is the factor of the same matrix in a different order. Its
//! two chains of operations do not wait for one another, which halves the time of a solution.

use super::band::SymmetricBand;
use thiserror::Error;

/// The matrix has a direction without stiffness; it shows at `row`, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("not positive definite, as row {} shows", row + 1)]
pub struct NotPositiveDefinite {
    pub row: usize,
}

/// A factor for any number of solutions.
#[derive(Clone, Debug, PartialEq)]
pub enum BandFactor {
    Diagonal(Vec<f64>),
    Tridiagonal(TwoEnds),
    Band(Rows),
}

impl BandFactor {
    /// # Errors
    /// If the matrix is not positive definite.
    pub fn new(matrix: &SymmetricBand) -> Result<Self, NotPositiveDefinite> {
        let mut factor = match matrix.half_bandwidth() {
            0 => Self::Diagonal(Vec::new()),
            1 => Self::Tridiagonal(TwoEnds::default()),
            _ => Self::Band(Rows::default()),
        };
        factor.renew(matrix)?;
        Ok(factor)
    }

    /// The factor of a different matrix with the same band, in the same memory.
    ///
    /// # Errors
    /// If the matrix is not positive definite.
    pub fn renew(&mut self, matrix: &SymmetricBand) -> Result<(), NotPositiveDefinite> {
        match self {
            Self::Diagonal(pivots) => {
                pivots.clear();
                pivots.extend_from_slice(matrix.band(0));
                pivots
                    .iter()
                    .enumerate()
                    .try_for_each(|(row, pivot)| positive(row, *pivot, *pivot, 1))
            }
            Self::Tridiagonal(ends) => ends.renew(matrix.band(0), matrix.band(1)),
            Self::Band(rows) => rows.renew(matrix),
        }
    }

    /// x ← A⁻¹ x.
    pub fn solve_in_place(&self, x: &mut [f64]) {
        match self {
            Self::Diagonal(pivots) => divide(x, pivots),
            Self::Tridiagonal(ends) => ends.solve(x),
            Self::Band(rows) => rows.solve(x),
        }
    }
}

fn divide(x: &mut [f64], pivots: &[f64]) {
    for (x, pivot) in x.iter_mut().zip(pivots) {
        *x /= pivot;
    }
}

/// Rejects a pivot that is not larger than the rounding error of its row's own entry.
fn positive(row: usize, pivot: f64, entry: f64, order: usize) -> Result<(), NotPositiveDefinite> {
    #[expect(clippy::cast_precision_loss, reason = "no frame has 2^53 storeys")]
    let least = order as f64 * f64::EPSILON * entry;
    if pivot > least && pivot.is_finite() {
        Ok(())
    } else {
        Err(NotPositiveDefinite { row })
    }
}

/// A tridiagonal factor from both ends: rows `0..middle` from the top, the rows after `middle` from the bottom.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct TwoEnds {
    middle: usize,
    pivots: Vec<f64>,
    /// 1 over the pivots: a product takes a quarter of the time of a division.
    inverses: Vec<f64>,
    /// Between rows i and i + 1: the entry over the pivot of the one eliminated first.
    multipliers: Vec<f64>,
}

impl TwoEnds {
    fn renew(&mut self, diagonal: &[f64], beside: &[f64]) -> Result<(), NotPositiveDefinite> {
        let order = diagonal.len();
        let middle = order / 2;
        self.middle = middle;
        self.pivots.clear();
        self.pivots.extend_from_slice(diagonal);
        self.multipliers.resize(beside.len(), 0.0);
        let (pivots, multipliers) = (
            &mut self.pivots[..order],
            &mut self.multipliers[..order - 1],
        );
        for i in 0..middle {
            let low = order - 1 - i;
            positive(i, pivots[i], diagonal[i], order)?;
            multipliers[i] = beside[i] / pivots[i];
            pivots[i + 1] -= multipliers[i] * beside[i];
            if low > middle {
                positive(low, pivots[low], diagonal[low], order)?;
                multipliers[low - 1] = beside[low - 1] / pivots[low];
                pivots[low - 1] -= multipliers[low - 1] * beside[low - 1];
            }
        }
        positive(middle, pivots[middle], diagonal[middle], order)?;
        self.inverses.clear();
        self.inverses
            .extend(self.pivots.iter().map(|pivot| 1.0 / pivot));
        Ok(())
    }

    fn solve(&self, x: &mut [f64]) {
        let order = self.pivots.len();
        let (upper, rest) = x[..order].split_at_mut(self.middle);
        let Some((middle, lower)) = rest.split_first_mut() else {
            return;
        };
        let (down, up) = self.multipliers.split_at(self.middle);
        // With an even number of rows, one more is above the middle than below it: it goes first.
        let (mut above, mut below) = (0.0, 0.0);
        let (mut from_above, mut from_below) = (0.0, 0.0);
        let first = upper.len() - lower.len();
        for (x, multiplier) in upper[..first].iter_mut().zip(down) {
            above = *x;
            from_above = *multiplier;
        }
        let pairs = upper[first..]
            .iter_mut()
            .zip(&down[first..])
            .zip(lower.iter_mut().zip(up).rev());
        for ((upper, down), (lower, up)) in pairs {
            above = *upper - from_above * above;
            below = *lower - from_below * below;
            (*upper, *lower) = (above, below);
            (from_above, from_below) = (*down, *up);
        }
        *middle -= from_above * above + from_below * below;
        let (inverse_above, rest) = self.inverses.split_at(self.middle);
        let (inverse_middle, inverse_below) = (rest[0], &rest[1..]);
        *middle *= inverse_middle;
        (above, below) = (*middle, *middle);
        let uppers = upper[first..]
            .iter_mut()
            .zip(&down[first..])
            .zip(&inverse_above[first..])
            .rev();
        let lowers = lower.iter_mut().zip(up).zip(inverse_below);
        for (((upper, down), upper_inverse), ((lower, up), lower_inverse)) in uppers.zip(lowers) {
            above = *upper * upper_inverse - down * above;
            below = *lower * lower_inverse - up * below;
            (*upper, *lower) = (above, below);
        }
        for ((x, multiplier), inverse) in upper[..first].iter_mut().zip(down).zip(inverse_above) {
            *x = *x * inverse - multiplier * above;
        }
    }
}

/// A factor row by row.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Rows {
    half_bandwidth: usize,
    pivots: Vec<f64>,
    /// Row i contains columns i − b to i − 1; those before the first column are 0.
    lower: Vec<f64>,
}

impl Rows {
    fn renew(&mut self, matrix: &SymmetricBand) -> Result<(), NotPositiveDefinite> {
        let (order, width) = (matrix.order(), matrix.half_bandwidth());
        self.half_bandwidth = width;
        self.pivots.clear();
        self.pivots.resize(order, 0.0);
        self.lower.clear();
        self.lower.resize(order * width, 0.0);
        for i in 0..order {
            let first = i.saturating_sub(width);
            let (above, rest) = self.lower.split_at_mut(i * width);
            let row = &mut rest[..width];
            // Entry (i, j) is at j + width − i of its row: first l_ij d_j, divided when its column is complete.
            for j in first..i {
                let start = first.max(j.saturating_sub(width));
                let other = &above[j * width..(j + 1) * width];
                let mut sum = matrix.entry(i, j);
                for (left, right) in row[start + width - i..j + width - i]
                    .iter()
                    .zip(&other[start + width - j..])
                {
                    sum -= left * right;
                }
                row[j + width - i] = sum;
            }
            let mut pivot = matrix.entry(i, i);
            for j in first..i {
                let scaled = row[j + width - i];
                let entry = scaled / self.pivots[j];
                pivot -= scaled * entry;
                row[j + width - i] = entry;
            }
            positive(i, pivot, matrix.entry(i, i), order)?;
            self.pivots[i] = pivot;
        }
        Ok(())
    }

    fn solve(&self, x: &mut [f64]) {
        let width = self.half_bandwidth;
        let row = |i: usize| {
            let first = i.saturating_sub(width);
            (
                first,
                &self.lower[i * width + first + width - i..(i + 1) * width],
            )
        };
        for i in 0..self.pivots.len() {
            let (first, entries) = row(i);
            let mut sum = x[i];
            for (entry, x) in entries.iter().zip(&x[first..i]) {
                sum -= entry * x;
            }
            x[i] = sum;
        }
        divide(x, &self.pivots);
        for i in (0..self.pivots.len()).rev() {
            let (first, entries) = row(i);
            let from = x[i];
            for (entry, x) in entries.iter().zip(&mut x[first..i]) {
                *x -= entry * from;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Diagonally dominant, with different entries in the band.
    fn matrix(order: usize, width: usize) -> SymmetricBand {
        let mut matrix = SymmetricBand::zero(order, width);
        for i in 0..order {
            for j in i.saturating_sub(width)..=i {
                let (row, column) = (number(i), number(j));
                matrix.set(
                    i,
                    j,
                    if i == j {
                        4.0 + 4.0 * number(width) + row
                    } else {
                        (1.0 + row * 0.7 + column * 0.3).sin()
                    },
                );
            }
        }
        matrix
    }

    fn number(count: usize) -> f64 {
        f64::from(u32::try_from(count).expect("small"))
    }

    #[test]
    fn solutions_give_the_right_side_back() {
        for (order, width) in (1..12).flat_map(|order| (0..order).map(move |width| (order, width)))
        {
            let matrix = matrix(order, width);
            let exact: Vec<f64> = (0..order).map(|i| 1.0 + number(i).cos()).collect();
            let mut x = vec![0.0; order];
            matrix.mul_into(&exact, &mut x);
            BandFactor::new(&matrix)
                .expect("positive definite")
                .solve_in_place(&mut x);
            for (x, exact) in x.iter().zip(&exact) {
                assert!(
                    (x - exact).abs() < 1e-14,
                    "order {order}, half bandwidth {width}: {x} is not {exact}"
                );
            }
        }
    }

    /// A storey without stiffness below the first: the part above it is loose, and the two ends meet at it.
    #[test]
    fn a_loose_direction_is_found() {
        let loose =
            |stiffnesses: &[f64]| BandFactor::new(&crate::structure::storey_stiffness(stiffnesses));
        assert!(loose(&[1.0, 2.0, 3.0, 4.0]).is_ok());
        for free in 0..4 {
            let mut stiffnesses = [1.0, 2.0, 3.0, 4.0];
            stiffnesses[free] = 0.0;
            assert!(loose(&stiffnesses).is_err(), "storey {free}");
        }
        let mut wide = matrix(5, 3);
        wide.set(4, 4, -1.0);
        assert_eq!(BandFactor::new(&wide), Err(NotPositiveDefinite { row: 4 }));
        assert_eq!(
            BandFactor::new(&SymmetricBand::diagonal(&[1.0, 0.0])),
            Err(NotPositiveDefinite { row: 1 })
        );
        assert_eq!(
            BandFactor::new(&SymmetricBand::diagonal(&[f64::NAN])),
            Err(NotPositiveDefinite { row: 0 })
        );
    }
}
