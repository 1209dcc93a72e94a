//! First-order sensitivity by ranks. In: the values of an input and of a result, from the runs of any study with independent inputs. Out:
//! the part of the result's variance that the input explains alone, Var E(Y|X)/Var Y, with its confidence interval.
//!
//! The runs are put in the order of the input. Neighbours then have nearly the same input, so the covariance of their results estimates
//! Var E(Y|X) (F. Gamboa, P. Gremaud, T. Klein, A. Lagnoux, *Global sensitivity analysis: a novel generation of mighty estimators based on
//! rank statistics*, Bernoulli 28 (2022) 2345–2374, after S. Chatterjee, J. Amer. Stat. Assoc. 116 (2021) 2009–2022):
//!
//! ```text
//! S = Σ yⱼ yⱼ₊₁ / Σ yⱼ²        yⱼ: result less its mean, in the order of the input
//! ```
//!
//! Its interval is that of the central limit theorem. With ψⱼ = (yⱼyⱼ₊₁ − S yⱼ²)/Var Y, the error of S is the mean of ψ. For given inputs,
//! only neighbouring ψ are dependent. E(ψⱼψⱼ₊₁) − E(ψⱼψⱼ₊₂) estimates their covariance, because the inputs of all three are nearly equal:
//!
//! ```text
//! n Var S = E(ψⱼ²) + 2 (E(ψⱼψⱼ₊₁) − E(ψⱼψⱼ₊₂))
//! ```

use super::{Index, Interval, order};
use crate::statistics::samples::mean;
use crate::study::{Confidence, number};

/// Fewest runs for an interval: below it the estimate of the variance is no better than a guess.
const FEWEST: usize = 50;

/// The index of one input. None with fewer than fifty runs, or if the result is constant or not finite.
///
/// # Panics
/// If there are not as many inputs as results.
#[must_use]
pub fn index(inputs: &[f64], results: &[f64], confidence: Confidence) -> Option<Index> {
    assert_eq!(inputs.len(), results.len(), "one result for each input");
    if results.len() < FEWEST {
        return None;
    }
    let middle = mean(results.iter().copied());
    let centred: Vec<f64> = order(inputs)
        .into_iter()
        .map(|run| results[run] - middle)
        .collect();
    let variance = mean(centred.iter().map(|y| y * y));
    if !(variance > 0.0 && variance.is_finite()) {
        return None;
    }
    let pairs = centred.windows(2);
    let value = mean(pairs.clone().map(|pair| pair[0] * pair[1])) / variance;
    let errors: Vec<f64> = pairs
        .map(|pair| {
            (pair[0] * pair[1] - value * 0.5 * (pair[0] * pair[0] + pair[1] * pair[1])) / variance
        })
        .collect();
    let lagged = |lag: usize| mean(errors.iter().zip(&errors[lag..]).map(|(a, b)| a * b));
    // The estimate of a variance may become negative where it is small; that of independent errors is then the better one.
    let one = lagged(0) + 2.0 * (lagged(1) - lagged(2));
    let variance_of_mean = one.max(0.1 * lagged(0)) / number(errors.len() as u64);
    let reach = confidence.normal_factor() * variance_of_mean.sqrt();
    let interval = Interval {
        low: value - reach,
        high: value + reach,
    };
    Some(Index { value, interval })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::super::sampling::{Design, Sampler};
    use super::*;

    /// Share of studies of `runs` runs whose 95 % intervals contain the true indices, input by input.
    fn coverage<const N: usize>(
        runs: u64,
        model: impl Fn([f64; N]) -> f64,
        truth: [f64; N],
    ) -> [f64; N] {
        const STUDIES: u64 = 500;
        let confidence = Confidence::new(0.95).unwrap();
        let mut covered = [0_u32; N];
        for seed in 0..STUDIES {
            let sampler = Sampler::new(Design::Random, seed, u32::try_from(N).unwrap()).unwrap();
            let point =
                |run| std::array::from_fn(|at| sampler.uniform(run, u32::try_from(at).unwrap()));
            let points: Vec<[f64; N]> = (0..runs).map(point).collect();
            let results: Vec<f64> = points.iter().map(|point| model(*point)).collect();
            for at in 0..N {
                let inputs: Vec<f64> = points.iter().map(|point| point[at]).collect();
                let index = index(&inputs, &results, confidence).unwrap();
                covered[at] += u32::from(index.interval.contains(truth[at]));
            }
        }
        covered.map(|count| f64::from(count) / number(STUDIES))
    }

    /// T. Ishigami, T. Homma (1990): Y = sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁ on (−π, π)³. In closed form, with a = 7 and b = 0.1,
    /// V = a²/8 + bπ⁴/5 + b²π⁸/18 + 1/2, V₁ = ½(1 + bπ⁴/5)², V₂ = a²/8, V₃ = 0.
    #[test]
    fn intervals_cover_the_indices_of_ishigami() {
        let model = |point: [f64; 3]| {
            let [x1, x2, x3] = point.map(|uniform| PI * (2.0 * uniform - 1.0));
            x1.sin() + 7.0 * x2.sin().powi(2) + 0.1 * x3.powi(4) * x1.sin()
        };
        let total = 49.0 / 8.0 + 0.1 * PI.powi(4) / 5.0 + 0.01 * PI.powi(8) / 18.0 + 0.5;
        let first = 0.5 * (1.0 + 0.1 * PI.powi(4) / 5.0).powi(2);
        let truth = [first / total, 49.0 / 8.0 / total, 0.0];
        let found = coverage(1000, model, truth);
        for share in found {
            assert!((0.92..=0.99).contains(&share), "{found:?}");
        }
    }

    /// A. Saltelli, I. M. Sobol' (1995): Y = Π (|4xᵢ − 2| + aᵢ)/(1 + aᵢ), Vᵢ = 1/(3(1 + aᵢ)²), V = Π (1 + Vᵢ) − 1.
    #[test]
    fn intervals_cover_the_indices_of_the_g_function() {
        const A: [f64; 4] = [0.0, 1.0, 4.5, 9.0];
        let model = |point: [f64; 4]| {
            let factor = |(x, a): (f64, f64)| ((4.0 * x - 2.0).abs() + a) / (1.0 + a);
            point.into_iter().zip(A).map(factor).product()
        };
        let parts = A.map(|a: f64| 1.0 / (3.0 * (1.0 + a).powi(2)));
        let total = parts.iter().map(|part| 1.0 + part).product::<f64>() - 1.0;
        let found = coverage(1000, model, parts.map(|part| part / total));
        for share in found {
            assert!((0.92..=0.99).contains(&share), "{found:?}");
        }
    }

    /// A result that is a function of the input has S = 1; the interval shrinks with the gaps between neighbours.
    #[test]
    fn an_input_that_determines_the_result_has_an_index_of_one() {
        let inputs: Vec<f64> = (0..500).map(|run| f64::from(run * 7 % 500)).collect();
        let results: Vec<f64> = inputs.iter().map(|x| x * x).collect();
        let index = index(&inputs, &results, Confidence::new(0.95).unwrap()).unwrap();
        assert!((index.value - 1.0).abs() < 0.02 && !index.may_be_zero());
    }

    #[test]
    fn a_constant_result_and_a_small_study_have_no_index() {
        let confidence = Confidence::new(0.95).unwrap();
        let inputs: Vec<f64> = (0..60).map(f64::from).collect();
        assert_eq!(index(&inputs, &[1.0; 60], confidence), None);
        assert_eq!(index(&inputs[..49], &inputs[..49], confidence), None);
    }
}
