//! Spearman's rank correlation of an input with a result. In: their values. Out: ρ with its interval. It holds for correlated inputs too.

use super::{Index, Interval, order};
use crate::statistics::samples::mean;
use crate::study::{Confidence, number};

/// Fewest runs for an interval.
const FEWEST: usize = 10;

/// ρ, the correlation of the ranks; equal values share the mean of their ranks. NaN if one of the two is constant.
#[must_use]
pub fn correlation(inputs: &[f64], results: &[f64]) -> f64 {
    let [first, second] = [inputs, results].map(|values| {
        let ranks = ranks(values);
        let middle = mean(ranks.iter().copied());
        ranks
            .into_iter()
            .map(|rank| rank - middle)
            .collect::<Vec<f64>>()
    });
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    product(&first, &second) / (product(&first, &first) * product(&second, &second)).sqrt()
}

/// ρ with the interval of Fisher's z = artanh ρ, whose variance is (1 + ½ρ²)/(n − 3) (D. G. Bonett, T. A. Wright, Psychometrika 65 (2000)
/// 23–28). None with fewer than ten runs, or if input or result are constant.
#[must_use]
pub fn index(inputs: &[f64], results: &[f64], confidence: Confidence) -> Option<Index> {
    let value = correlation(inputs, results);
    if inputs.len() < FEWEST || value.is_nan() {
        return None;
    }
    // Equal ranks throughout give ±1, where z is infinite: the nearest number below gives an interval that ends there.
    let bounded = value.clamp(-1.0 + f64::EPSILON, 1.0 - f64::EPSILON);
    let variance = (1.0 + 0.5 * bounded * bounded) / (number(inputs.len() as u64) - 3.0);
    let reach = confidence.normal_factor() * variance.sqrt();
    let interval = Interval {
        low: (bounded.atanh() - reach).tanh(),
        high: (bounded.atanh() + reach).tanh(),
    };
    Some(Index { value, interval })
}

/// From 1 on.
fn ranks(values: &[f64]) -> Vec<f64> {
    let order = order(values);
    let mut ranks = vec![0.0; values.len()];
    let mut from = 0;
    while from < order.len() {
        let equal = order[from..]
            .iter()
            .take_while(|index| values[**index] == values[order[from]])
            .count()
            .max(1);
        // The mean of the ranks from + 1 … from + equal.
        let rank = number(from as u64) + 0.5 * (number(equal as u64) + 1.0);
        for index in &order[from..from + equal] {
            ranks[*index] = rank;
        }
        from += equal;
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::super::super::distribution::Tails;
    use super::super::super::sampling::philox::{Philox, Purpose};
    use super::*;

    /// With d the differences of the ranks, ρ = 1 − 6Σd²/(n(n² − 1)): here Σd² = 2 of five. With equal values: 1, 2.5, 2.5, 4.
    #[test]
    fn it_is_the_closed_form() {
        let found = correlation(&[1.0, 2.0, 3.0, 4.0, 5.0], &[10.0, 20.0, 40.0, 30.0, 50.0]);
        assert!((found - (1.0 - 12.0 / 120.0)).abs() < 1e-14);
        assert_eq!(ranks(&[3.0, 5.0, 5.0, 9.0]), [1.0, 2.5, 2.5, 4.0]);
        assert!(correlation(&[1.0, 2.0], &[3.0, 3.0]).is_nan());
        assert!((correlation(&[1.0, 2.0, 3.0], &[3.0, 2.0, 1.0]) + 1.0).abs() < 1e-14);
    }

    /// Normal numbers with correlation r have ρ = (6/π) asin(r/2). Of 1000 studies of 100 runs, at least 94 % of the 95 % intervals
    /// contain it: three standard errors of that share are 2 %.
    #[test]
    fn intervals_cover_the_truth() {
        let confidence = Confidence::new(0.95).unwrap();
        for r in [0.0, 0.5, 0.9_f64] {
            let truth = 6.0 / std::f64::consts::PI * (0.5 * r).asin();
            let mut covered = 0;
            for study in 0..1000 {
                let stream = Philox::new(study);
                let score = |run, input| {
                    Tails::of_uniform(stream.uniform(Purpose::Value, run, input)).score()
                };
                let inputs: Vec<f64> = (0..100).map(|run| score(run, 0)).collect();
                let results: Vec<f64> = (0..100)
                    .map(|run| r * score(run, 0) + (1.0 - r * r).sqrt() * score(run, 1))
                    .collect();
                let index = index(&inputs, &results, confidence).unwrap();
                covered += u32::from(index.interval.contains(truth));
            }
            assert!((930..=975).contains(&covered), "{covered} for {r}");
        }
    }
}
