//! Symmetric band matrices for the masses, dampers and storeys of a frame. In: entries. Out: products. `factor` solves equations.

use thiserror::Error;

/// A symmetric matrix whose entries are 0 further than `half_bandwidth` from its diagonal: 0 for lumped masses, 1 for a
/// shear building, order − 1 for a full matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct SymmetricBand {
    order: usize,
    half_bandwidth: usize,
    /// Diagonal by diagonal, the main one first: the k-th contains (i + k, i) for i in `0..order − k`.
    entries: Vec<f64>,
}

/// Rows that are not a symmetric matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum RowsError {
    #[error("row {row} has {found} entries, not {order}")]
    NotSquare {
        row: usize,
        found: usize,
        order: usize,
    },
    #[error("entries ({row}, {column}) and ({column}, {row}) differ")]
    NotSymmetric { row: usize, column: usize },
}

impl SymmetricBand {
    /// All zero; a larger half bandwidth becomes `order − 1`.
    #[must_use]
    pub fn zero(order: usize, half_bandwidth: usize) -> Self {
        let half_bandwidth = half_bandwidth.min(order.saturating_sub(1));
        let count = (half_bandwidth + 1) * order - half_bandwidth * (half_bandwidth + 1) / 2;
        Self {
            order,
            half_bandwidth,
            entries: vec![0.0; count],
        }
    }

    /// These entries on the diagonal, and zeros elsewhere.
    #[must_use]
    pub fn diagonal(values: &[f64]) -> Self {
        Self {
            order: values.len(),
            half_bandwidth: 0,
            entries: values.to_vec(),
        }
    }

    /// The narrowest band that contains these rows; (i, j) and (j, i) must be the same number.
    ///
    /// # Errors
    /// If the rows are not square or not symmetric.
    pub fn from_dense(rows: &[Vec<f64>]) -> Result<Self, RowsError> {
        let order = rows.len();
        let mut half_bandwidth = 0;
        for (i, row) in rows.iter().enumerate() {
            if row.len() != order {
                return Err(RowsError::NotSquare {
                    row: i,
                    found: row.len(),
                    order,
                });
            }
        }
        for (i, row) in rows.iter().enumerate() {
            for (j, entry) in row.iter().enumerate().take(i) {
                if *entry != rows[j][i] {
                    return Err(RowsError::NotSymmetric { row: i, column: j });
                }
                if *entry != 0.0 {
                    half_bandwidth = half_bandwidth.max(i - j);
                }
            }
        }
        let mut band = Self::zero(order, half_bandwidth);
        for (i, row) in rows.iter().enumerate() {
            for (j, entry) in row
                .iter()
                .enumerate()
                .take(i + 1)
                .skip(i.saturating_sub(half_bandwidth))
            {
                band.set(i, j, *entry);
            }
        }
        Ok(band)
    }

    /// Number of rows and of columns.
    #[must_use]
    pub const fn order(&self) -> usize {
        self.order
    }

    /// Diagonals below the main one.
    #[must_use]
    pub const fn half_bandwidth(&self) -> usize {
        self.half_bandwidth
    }

    /// Index of the first entry of a diagonal.
    const fn start(&self, diagonal: usize) -> usize {
        diagonal * self.order - diagonal * diagonal.saturating_sub(1) / 2
    }

    /// The k-th diagonal below the main one: (i + k, i) for each i.
    #[must_use]
    pub fn band(&self, k: usize) -> &[f64] {
        &self.entries[self.start(k)..self.start(k) + self.order - k]
    }

    /// [`Self::band`] for writing; `k` is at most the half bandwidth.
    pub fn band_mut(&mut self, k: usize) -> &mut [f64] {
        let start = self.start(k);
        &mut self.entries[start..start + self.order - k]
    }

    /// (row, column), from 0; 0 outside the band.
    #[must_use]
    pub fn entry(&self, row: usize, column: usize) -> f64 {
        let k = row.abs_diff(column);
        if k > self.half_bandwidth {
            0.0
        } else {
            self.entries[self.start(k) + row.min(column)]
        }
    }

    /// Sets (row, column) and (column, row), which lie in the band.
    pub fn set(&mut self, row: usize, column: usize, value: f64) {
        let k = row.abs_diff(column);
        assert!(
            k <= self.half_bandwidth,
            "({row}, {column}) lies outside the band"
        );
        let index = self.start(k) + row.min(column);
        self.entries[index] = value;
    }

    /// Makes the band at least this wide, if it is narrower.
    pub(crate) fn include(&mut self, half_bandwidth: usize) {
        if half_bandwidth > self.half_bandwidth {
            self.widen(half_bandwidth);
        }
    }

    /// Makes the band at least this wide.
    fn widen(&mut self, half_bandwidth: usize) {
        let mut wide = Self::zero(self.order, half_bandwidth);
        wide.entries[..self.entries.len()].copy_from_slice(&self.entries);
        *self = wide;
    }

    /// Adds `factor` times the other matrix of the same order.
    pub fn add(&mut self, other: &Self, factor: f64) {
        assert_eq!(self.order, other.order, "matrices of one frame");
        self.include(other.half_bandwidth);
        for (entry, more) in self.entries.iter_mut().zip(&other.entries) {
            *entry += factor * more;
        }
    }

    /// Becomes a copy of the other, in its own memory if possible.
    pub fn copy_from(&mut self, other: &Self) {
        self.order = other.order;
        self.half_bandwidth = other.half_bandwidth;
        self.entries.clone_from(&other.entries);
    }

    /// Every entry times `factor`.
    pub fn scale(&mut self, factor: f64) {
        for entry in &mut self.entries {
            *entry *= factor;
        }
    }

    /// Whether every entry is exactly 0.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.entries.iter().all(|entry| *entry == 0.0)
    }

    /// y = A x.
    pub fn mul_into(&self, x: &[f64], y: &mut [f64]) {
        let order = self.order;
        let (x, y) = (&x[..order], &mut y[..order]);
        if self.half_bandwidth == 1 {
            return self.tridiagonal(x, y, |to, product| *to = product);
        }
        for ((to, entry), from) in y.iter_mut().zip(self.band(0)).zip(x) {
            *to = entry * from;
        }
        self.add_off_diagonals(x, y, 1.0);
    }

    /// y ← y + factor · A x.
    pub fn mul_add(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        let order = self.order;
        let (x, y) = (&x[..order], &mut y[..order]);
        if self.half_bandwidth == 1 {
            return self.tridiagonal(x, y, |to, product| *to += factor * product);
        }
        for ((to, entry), from) in y.iter_mut().zip(self.band(0)).zip(x) {
            *to += factor * (entry * from);
        }
        self.add_off_diagonals(x, y, factor);
    }

    fn add_off_diagonals(&self, x: &[f64], y: &mut [f64], factor: f64) {
        for k in 1..=self.half_bandwidth {
            let entries = self.band(k);
            for ((to, entry), from) in y.iter_mut().zip(entries).zip(&x[k..]) {
                *to += factor * (entry * from);
            }
            for ((to, entry), from) in y[k..].iter_mut().zip(entries).zip(x) {
                *to += factor * (entry * from);
            }
        }
    }

    /// Combines each entry of A x, A tridiagonal, with that of y in one pass.
    #[inline]
    fn tridiagonal(&self, x: &[f64], y: &mut [f64], take: impl Fn(&mut f64, f64)) {
        let (last, diagonal, beside) = (self.order - 1, self.band(0), self.band(1));
        take(&mut y[0], diagonal[0] * x[0] + beside[0] * x[1]);
        let inner = diagonal[1..]
            .iter()
            .zip(beside.windows(2))
            .zip(x.windows(3));
        for (to, ((entry, beside), x)) in y[1..].iter_mut().zip(inner) {
            take(to, beside[0] * x[0] + entry * x[1] + beside[1] * x[2]);
        }
        take(
            &mut y[last],
            beside[last - 1] * x[last - 1] + diagonal[last] * x[last],
        );
    }

    /// A ι, ι all ones.
    pub fn row_sums(&self, sums: &mut [f64]) {
        sums.copy_from_slice(self.band(0));
        for k in 1..=self.half_bandwidth {
            for (i, entry) in self.band(k).iter().enumerate() {
                sums[i] += entry;
                sums[i + k] += entry;
            }
        }
    }

    /// xᵀ A y.
    #[must_use]
    pub fn form(&self, x: &[f64], y: &[f64]) -> f64 {
        let mut sum = 0.0;
        for ((entry, left), right) in self.band(0).iter().zip(x).zip(y) {
            sum += entry * left * right;
        }
        for k in 1..=self.half_bandwidth {
            for (i, entry) in self.band(k).iter().enumerate() {
                sum += entry * (x[i] * y[i + k] + x[i + k] * y[i]);
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wide() -> Vec<Vec<f64>> {
        vec![
            vec![4.0, 1.0, 0.5, 0.0],
            vec![1.0, 5.0, 2.0, 0.25],
            vec![0.5, 2.0, 6.0, 3.0],
            vec![0.0, 0.25, 3.0, 7.0],
        ]
    }

    #[test]
    fn rows_come_back_entry_by_entry() {
        let rows = wide();
        let band = SymmetricBand::from_dense(&rows).expect("symmetric");
        assert_eq!((band.order(), band.half_bandwidth()), (4, 2));
        for (i, row) in rows.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                assert_eq!(band.entry(i, j), *entry);
            }
        }
    }

    #[test]
    fn an_asymmetric_matrix_is_refused_with_the_entry() {
        let mut rows = wide();
        rows[3][1] = 0.5;
        assert_eq!(
            SymmetricBand::from_dense(&rows),
            Err(RowsError::NotSymmetric { row: 3, column: 1 })
        );
        rows[2].pop();
        assert_eq!(
            SymmetricBand::from_dense(&rows),
            Err(RowsError::NotSquare {
                row: 2,
                found: 3,
                order: 4
            })
        );
    }

    #[test]
    fn products_are_those_of_the_full_matrix() {
        let rows = wide();
        let band = SymmetricBand::from_dense(&rows).expect("symmetric");
        let x = [1.0, -2.0, 3.0, 0.5];
        let expected: Vec<f64> = rows
            .iter()
            .map(|row| row.iter().zip(&x).map(|(a, x)| a * x).sum())
            .collect();
        let mut y = [0.0; 4];
        band.mul_into(&x, &mut y);
        assert_eq!(y.to_vec(), expected);
        band.mul_add(-1.0, &x, &mut y);
        assert_eq!(y, [0.0; 4]);
        let form: f64 = expected.iter().zip(&x).map(|(y, x)| y * x).sum();
        assert_eq!(band.form(&x, &x), form);
    }

    #[test]
    fn a_sum_is_as_wide_as_its_widest_part() {
        let mut sum = SymmetricBand::diagonal(&[1.0, 1.0, 1.0, 1.0]);
        sum.add(&SymmetricBand::from_dense(&wide()).expect("symmetric"), 2.0);
        assert_eq!(
            (sum.entry(0, 0), sum.entry(2, 0), sum.entry(3, 0)),
            (9.0, 1.0, 0.0)
        );
        sum.scale(0.5);
        assert_eq!(sum.entry(3, 2), 3.0);
    }
}
