//! Rank correlation of inputs by a Gaussian copula. In: pairs of inputs with Spearman's ρ. Out: correlated standard normal numbers.
//!
//! Standard normal numbers with the correlation r = 2 sin(πρ/6) have the rank correlation ρ (K. Pearson, 1907), and so have all monotone
//! functions of them, whatever the distributions of the inputs. A matrix of correlations that do not go together has no Cholesky factor.

use std::f64::consts::{FRAC_PI_6, PI};

use thiserror::Error;

/// Least variance of an input that the inputs before it leave. Below it, the input is a function of them.
const LEAST_LEFT: f64 = 1e-10;

/// A rank correlation of two inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    pub inputs: [usize; 2],
    /// Spearman's ρ, between −1 and 1, both excluded.
    pub correlation: f64,
}

/// The reason why inputs cannot be correlated as stated.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum CorrelationError {
    #[error("a rank correlation lies between −1 and 1, both excluded, here {0}")]
    OutsideRange(f64),
    #[error("an input is correlated with itself")]
    WithItself(usize),
    #[error("there is no input {0}")]
    NoSuchInput(usize),
    #[error("the correlation of a pair is stated twice")]
    Twice([usize; 2]),
    /// This pair is the one that has to change least. With the others as stated, its rank correlation lies in this range, if any.
    #[error(
        "a rank correlation of {} contradicts the other correlations",
        pair.correlation
    )]
    Impossible { pair: Pair, range: Option<[f64; 2]> },
}

/// The Cholesky factor of the correlations.
#[derive(Clone, Debug, PartialEq)]
pub struct Correlation {
    /// Lower triangle, row by row.
    factor: Vec<Vec<f64>>,
}

impl Correlation {
    /// Of this many inputs; pairs that are not stated are independent.
    ///
    /// # Errors
    /// A pair is impossible, stated twice or contradicted by others.
    pub fn new(inputs: usize, pairs: &[Pair]) -> Result<Self, CorrelationError> {
        let mut matrix = identity(inputs);
        for pair in pairs {
            let [first, second] = pair.inputs;
            if pair.correlation.is_nan() || pair.correlation.abs() >= 1.0 {
                return Err(CorrelationError::OutsideRange(pair.correlation));
            }
            if let Some(missing) = pair.inputs.into_iter().find(|input| *input >= inputs) {
                return Err(CorrelationError::NoSuchInput(missing));
            }
            if first == second {
                return Err(CorrelationError::WithItself(first));
            }
            if matrix[first][second] != 0.0 {
                return Err(CorrelationError::Twice(pair.inputs));
            }
            let normal = 2.0 * (FRAC_PI_6 * pair.correlation).sin();
            matrix[first][second] = normal;
            matrix[second][first] = normal;
        }
        cholesky(&matrix)
            .map(|factor| Self { factor })
            .map_err(|row| contradiction(&matrix, pairs, row))
    }

    /// Correlated numbers from independent standard normal ones, in place.
    pub fn apply(&self, scores: &mut [f64]) {
        for (at, row) in self.factor.iter().enumerate().rev() {
            scores[at] = row.iter().zip(scores.iter()).map(|(l, z)| l * z).sum();
        }
    }
}

fn identity(count: usize) -> Vec<Vec<f64>> {
    let row = |at: usize| {
        (0..count)
            .map(|other| f64::from(u8::from(at == other)))
            .collect()
    };
    (0..count).map(row).collect()
}

/// The lower factor, or the first row that is a combination of those before it.
fn cholesky(matrix: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, usize> {
    let mut factor: Vec<Vec<f64>> = Vec::with_capacity(matrix.len());
    for (at, of_matrix) in matrix.iter().enumerate() {
        let mut row: Vec<f64> = Vec::with_capacity(at + 1);
        for (other, before) in factor.iter().enumerate() {
            let sum: f64 = row.iter().zip(before).map(|(a, b)| a * b).sum();
            row.push((of_matrix[other] - sum) / before[other]);
        }
        let left = of_matrix[at] - row.iter().map(|entry| entry * entry).sum::<f64>();
        if left < LEAST_LEFT {
            return Err(at);
        }
        row.push(left.sqrt());
        factor.push(row);
    }
    Ok(factor)
}

/// The pair of input `row` and an earlier one whose correlation has to change least for the first `row` + 1 inputs to go together.
fn contradiction(matrix: &[Vec<f64>], pairs: &[Pair], row: usize) -> CorrelationError {
    let of_row =
        |pair: &&Pair| pair.inputs.contains(&row) && pair.inputs.iter().all(|input| *input <= row);
    let mut least: Option<(f64, CorrelationError)> = None;
    for pair in pairs.iter().filter(of_row) {
        let other = pair.inputs[usize::from(pair.inputs[0] == row)];
        let range = possible(matrix, row, other);
        let missing = range.map_or(f64::INFINITY, |[low, high]| {
            (low - pair.correlation).max(pair.correlation - high)
        });
        if least.as_ref().is_none_or(|(most, _)| missing < *most) {
            let error = CorrelationError::Impossible { pair: *pair, range };
            least = Some((missing, error));
        }
    }
    least
        .expect("an input without correlations is independent")
        .1
}

/// The rank correlations that `row` may have with `other`, an earlier input, beside those with all other earlier ones.
fn possible(matrix: &[Vec<f64>], row: usize, other: usize) -> Option<[f64; 2]> {
    // The two inputs come last: what the others leave of their variances and of their covariance bounds their correlation.
    let order: Vec<usize> = (0..row).filter(|at| *at != other).chain([other]).collect();
    let reordered: Vec<Vec<f64>> = order
        .iter()
        .map(|at| order.iter().map(|to| matrix[*at][*to]).collect())
        .collect();
    let factor = cholesky(&reordered).ok()?;
    let last = order.len() - 1;
    let mut known: Vec<f64> = Vec::with_capacity(last);
    for at in 0..last {
        let sum: f64 = known.iter().zip(&factor[at]).map(|(a, b)| a * b).sum();
        known.push((matrix[row][order[at]] - sum) / factor[at][at]);
    }
    let left = 1.0 - known.iter().map(|entry| entry * entry).sum::<f64>();
    if left < LEAST_LEFT {
        return None;
    }
    let middle: f64 = known.iter().zip(&factor[last]).map(|(a, b)| a * b).sum();
    let half = left.sqrt() * factor[last][last];
    let rank = |normal: f64| 6.0 / PI * (0.5 * normal.clamp(-1.0, 1.0)).asin();
    Some([rank(middle - half), rank(middle + half)])
}

#[cfg(test)]
mod tests {
    use super::super::distribution::Tails;
    use super::super::sampling::philox::{Philox, Purpose};
    use super::super::sensitivity::spearman;
    use super::*;

    fn pair(first: usize, second: usize, correlation: f64) -> Pair {
        Pair {
            inputs: [first, second],
            correlation,
        }
    }

    /// Spearman's ρ of 20,000 draws of three inputs, within four standard errors 1/√n.
    #[test]
    fn draws_have_the_stated_rank_correlation() {
        let pairs = [pair(0, 1, 0.6), pair(2, 1, -0.5), pair(0, 2, -0.1)];
        let correlation = Correlation::new(3, &pairs).unwrap();
        let stream = Philox::new(1);
        let mut columns = vec![Vec::new(); 3];
        for run in 0..20_000 {
            let mut scores = [0, 1, 2]
                .map(|input| Tails::of_uniform(stream.uniform(Purpose::Value, run, input)).score());
            correlation.apply(&mut scores);
            for (column, score) in columns.iter_mut().zip(scores) {
                // Any monotone function leaves the ranks as they are.
                column.push(score.exp());
            }
        }
        for Pair {
            inputs: [first, second],
            correlation,
        } in pairs
        {
            let found = spearman::correlation(&columns[first], &columns[second]);
            assert!(
                (found - correlation).abs() < 4.0 / 20_000.0_f64.sqrt(),
                "{found}"
            );
        }
    }

    /// Three inputs of which two are nearly equal: with r₀₁ and r₁₂ given, r₀₂ = r₀₁r₁₂ ± √((1 − r₀₁²)(1 − r₁₂²)).
    #[test]
    fn a_contradiction_names_the_pair_and_what_it_may_be() {
        let pairs = [pair(0, 1, 0.95), pair(0, 2, 0.9), pair(1, 2, 0.1)];
        let normal = |rank: f64| 2.0 * (FRAC_PI_6 * rank).sin();
        let Err(CorrelationError::Impossible { pair: found, range }) = Correlation::new(3, &pairs)
        else {
            panic!("possible");
        };
        let [_, high] = range.unwrap();
        assert_eq!(found.inputs, [0, 2]);
        let (first, last) = (normal(0.95), normal(0.1));
        let most = first * last + ((1.0 - first * first) * (1.0 - last * last)).sqrt();
        assert!((normal(high) - most).abs() < 1e-12);
        // The matrix becomes possible at the named limit, and not before.
        let with = |second| Correlation::new(3, &[pairs[0], pair(0, 2, second), pairs[2]]);
        assert!(with(high - 1e-3).is_ok() && with(high + 1e-3).is_err());
    }

    #[test]
    fn impossible_pairs_are_refused() {
        use CorrelationError as E;
        let refused = |pairs: &[Pair]| Correlation::new(2, pairs).err();
        assert_eq!(refused(&[pair(0, 1, 1.0)]), Some(E::OutsideRange(1.0)));
        assert_eq!(refused(&[pair(1, 1, 0.5)]), Some(E::WithItself(1)));
        assert_eq!(refused(&[pair(0, 2, 0.5)]), Some(E::NoSuchInput(2)));
        assert_eq!(
            refused(&[pair(0, 1, 0.5), pair(1, 0, 0.5)]),
            Some(E::Twice([1, 0]))
        );
        assert_eq!(refused(&[pair(0, 1, 0.99)]), None);
    }
}
