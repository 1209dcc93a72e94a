//! The binomial distribution for up to billions of runs. In: failures, runs, a probability. Out: probabilities of so many failures.
//!
//! Single terms by the saddle-point expansion (C. Loader, *Fast and accurate computation of binomial probabilities*, Bell Labs, 2000), which
//! has no large terms that cancel. Tails by the continued fraction of the incomplete beta function (Abramowitz and Stegun 1964, 26.5.8),
//! evaluated after W. J. Lentz.

use std::f64::consts::PI;

use crate::study::number;

/// The continued fraction converges in some √n terms.
const MOST_TERMS: u32 = 10_000_000;
/// Replaces a zero in Lentz's method.
const TINY: f64 = 1e-300;

/// Probability of exactly `count` of `runs`.
pub fn exactly(count: u64, runs: u64, probability: f64) -> f64 {
    if count > runs {
        return 0.0;
    }
    if count == 0 {
        return (number(runs) * (-probability).ln_1p()).exp();
    }
    if count == runs {
        return probability.powf(number(runs));
    }
    let [n, k] = [runs, count].map(number);
    let exponent = stirling_error(runs)
        - stirling_error(count)
        - stirling_error(runs - count)
        - deviance(k, n * probability)
        - deviance(n - k, n * (1.0 - probability));
    (exponent + 0.5 * (n / (2.0 * PI * k * (n - k))).ln()).exp()
}

/// Probability of `count` of `runs` or more.
pub fn at_least(count: u64, runs: u64, probability: f64) -> f64 {
    if count == 0 {
        return 1.0;
    }
    if count > runs {
        return 0.0;
    }
    // The fraction converges on this side of the mean only.
    if probability < number(count + 1) / number(runs + 2) {
        upper_tail(count, runs, probability)
    } else {
        1.0 - upper_tail(runs - count + 1, runs, 1.0 - probability)
    }
}

/// Probability of `count` of `runs` or fewer.
pub fn at_most(count: u64, runs: u64, probability: f64) -> f64 {
    if count >= runs {
        return 1.0;
    }
    if probability < number(count + 2) / number(runs + 2) {
        1.0 - upper_tail(count + 1, runs, probability)
    } else {
        upper_tail(runs - count, runs, 1.0 - probability)
    }
}

/// Iₚ(k, n − k + 1), for p below (k + 1)/(n + 2).
fn upper_tail(count: u64, runs: u64, probability: f64) -> f64 {
    if probability <= 0.0 {
        return 0.0;
    }
    let front = exactly(count, runs, probability) * (1.0 - probability);
    let [a, b] = [count, runs - count + 1].map(number);
    let safe = |value: f64| if value.abs() < TINY { TINY } else { value };
    let mut c = 1.0;
    let mut d = 1.0 / safe(1.0 - (a + b) * probability / (a + 1.0));
    let mut fraction = d;
    for term in 1..MOST_TERMS {
        let m = f64::from(term);
        let even = m * (b - m) * probability / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        d = 1.0 / safe(1.0 + even * d);
        c = safe(1.0 + even / c);
        fraction *= c * d;
        let odd = -(a + m) * (a + b + m) * probability / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 / safe(1.0 + odd * d);
        c = safe(1.0 + odd / c);
        fraction *= c * d;
        if (c * d - 1.0).abs() < f64::EPSILON {
            break;
        }
    }
    front * fraction
}

/// ln n! − (n + ½) ln n + n − ½ ln 2π.
fn stirling_error(count: u64) -> f64 {
    let n = number(count);
    if count < 16 {
        let factorial: f64 = (1..=count).map(number).product();
        return factorial.ln() - (n + 0.5) * n.ln() + n - 0.5 * (2.0 * PI).ln();
    }
    let square = n * n;
    (1.0 / 12.0 - (1.0 / 360.0 - (1.0 / 1260.0 - 1.0 / 1680.0 / square) / square) / square) / n
}

/// x ln(x/m) + m − x, without cancellation where x is near m.
fn deviance(x: f64, mean: f64) -> f64 {
    if (x - mean).abs() >= 0.1 * (x + mean) {
        return x * (x / mean).ln() + mean - x;
    }
    let ratio = (x - mean) / (x + mean);
    let square = ratio * ratio;
    let mut power = 2.0 * x * ratio;
    let mut sum = (x - mean) * ratio;
    for term in 1..1000 {
        power *= square;
        let next = sum + power / f64::from(2 * term + 1);
        if next == sum {
            break;
        }
        sum = next;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of terms C(n, k) pᵏ(1 − p)ⁿ⁻ᵏ in the order of their size.
    #[test]
    fn tails_are_sums_of_terms() {
        for (runs, probability) in [(1, 0.3_f64), (10, 0.5), (40, 0.02), (60, 0.97)] {
            let mut terms = Vec::new();
            let mut choose = 1.0;
            for count in 0..=runs {
                let [n, k] = [runs, count].map(number);
                let term = choose * probability.powf(k) * (1.0 - probability).powf(n - k);
                assert!((exactly(count, runs, probability) / term - 1.0).abs() < 1e-12);
                terms.push(term);
                choose *= (n - k) / (k + 1.0);
            }
            for count in 0..=runs {
                let at = usize::try_from(count).unwrap();
                let above: f64 = terms[at..].iter().rev().sum();
                let below: f64 = terms[..=at].iter().sum();
                assert!((at_least(count, runs, probability) - above).abs() < 1e-12);
                assert!((at_most(count, runs, probability) - below).abs() < 1e-12);
            }
        }
    }

    /// A billion runs: the normal approximation with a correction of continuity is good to 1e-5 there; half below the median.
    #[test]
    fn a_billion_runs_are_counted() {
        let runs = 1_000_000_000;
        let sd = (1e9_f64 * 0.25).sqrt();
        let found = at_least(500_031_623, runs, 0.5);
        let normal = super::super::super::distribution::normal::below(-(31_622.5) / sd);
        assert!(
            (found / normal - 1.0).abs() < 1e-5,
            "{found} is not {normal}"
        );
        assert!((at_most(3, runs, 1e-9) - 8.0 / 3.0 * (-1.0_f64).exp()).abs() < 1e-8);
    }
}
