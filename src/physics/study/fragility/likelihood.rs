//! The likelihood of a fragility curve. In: counts of exceedances at some intensities, and the coefficients of the curve. Out: the
//! log-likelihood and its derivatives, and its maximum over one or both coefficients.
//!
//! With η = α₀ + α₁ t, where t is the logarithm of the intensity, a run exceeds with the probability Φ(η). The log-likelihood is concave in
//! both coefficients, so Newton's method with halved steps finds its only maximum.

use crate::study::distribution::normal;
use crate::study::number;

/// Largest number of Newton steps.
const MOST_STEPS: u32 = 100;
/// Below this, Φ is replaced by its asymptote.
const FAR: f64 = -30.0;

/// Runs at one intensity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Count {
    /// ln of the intensity, from any origin.
    pub at: f64,
    pub exceeded: u64,
    pub not_exceeded: u64,
}

/// A point of the likelihood along one direction: value, slope, curvature.
#[derive(Clone, Copy, Debug, Default)]
struct Local {
    value: f64,
    slope: [f64; 2],
    /// Second derivatives, negated: 00, 01, 11.
    information: [f64; 3],
}

fn local(counts: &[Count], coefficients: [f64; 2]) -> Local {
    let mut sum = Local::default();
    for count in counts {
        let score = coefficients[0] + coefficients[1] * count.at;
        for (runs, sign) in [(count.exceeded, 1.0), (count.not_exceeded, -1.0)] {
            if runs == 0 {
                continue;
            }
            let (log, hazard) = log_and_hazard(sign * score);
            let weight = number(runs);
            let slope = weight * sign * hazard;
            let curvature = weight * hazard * (hazard + sign * score);
            sum.value += weight * log;
            sum.slope[0] += slope;
            sum.slope[1] += slope * count.at;
            sum.information[0] += curvature;
            sum.information[1] += curvature * count.at;
            sum.information[2] += curvature * count.at * count.at;
        }
    }
    sum
}

/// ln Φ(z) and φ(z)/Φ(z). Far below zero, Φ(z) → φ(z)/(−z + 1/−z).
fn log_and_hazard(score: f64) -> (f64, f64) {
    if score > FAR {
        let below = normal::below(score);
        return (below.ln(), normal::density(score) / below);
    }
    let hazard = -score - 1.0 / score;
    let log_density = -0.5 * score * score - 0.5 * (2.0 * std::f64::consts::PI).ln();
    (log_density - hazard.ln(), hazard)
}

/// The log-likelihood of these coefficients.
pub fn log_likelihood(counts: &[Count], coefficients: [f64; 2]) -> f64 {
    local(counts, coefficients).value
}

/// The coefficients of the largest likelihood, from a start. None if it has no maximum.
pub fn maximum(counts: &[Count], start: [f64; 2]) -> Option<[f64; 2]> {
    let mut at = start;
    for _ in 0..MOST_STEPS {
        let Local {
            value,
            slope,
            information: [i00, i01, i11],
        } = local(counts, at);
        let determinant = i00 * i11 - i01 * i01;
        let step = [
            (i11 * slope[0] - i01 * slope[1]) / determinant,
            (i00 * slope[1] - i01 * slope[0]) / determinant,
        ];
        if !step.iter().all(|part| part.is_finite()) {
            return None;
        }
        if step
            .iter()
            .zip(at)
            .all(|(part, at)| part.abs() < 1e-10 * (1.0 + at.abs()))
        {
            return Some(at);
        }
        at = halved(counts, at, step, value)?;
    }
    None
}

/// The largest log-likelihood on the line `through` + s `along`, and its position s, from a start.
pub fn maximum_on_line(
    counts: &[Count],
    through: [f64; 2],
    along: [f64; 2],
    start: f64,
) -> (f64, f64) {
    let point = |s: f64| [through[0] + s * along[0], through[1] + s * along[1]];
    let mut s = start;
    for _ in 0..MOST_STEPS {
        let Local {
            value,
            slope,
            information: [i00, i01, i11],
        } = local(counts, point(s));
        let rise = slope[0] * along[0] + slope[1] * along[1];
        let curvature =
            i00 * along[0] * along[0] + 2.0 * i01 * along[0] * along[1] + i11 * along[1] * along[1];
        let mut step = rise / curvature;
        if !step.is_finite() || step.abs() < 1e-9 * (1.0 + s.abs()) {
            return (value, s);
        }
        let mut next = log_likelihood(counts, point(s + step));
        while (next.is_nan() || next < value) && step.abs() > 1e-9 * (1.0 + s.abs()) {
            step *= 0.5;
            next = log_likelihood(counts, point(s + step));
        }
        s += step;
    }
    (log_likelihood(counts, point(s)), s)
}

/// After a step that is halved until the likelihood does not fall.
fn halved(counts: &[Count], at: [f64; 2], step: [f64; 2], value: f64) -> Option<[f64; 2]> {
    let mut fraction = 1.0;
    for _ in 0..50 {
        let next = [at[0] + fraction * step[0], at[1] + fraction * step[1]];
        let found = log_likelihood(counts, next);
        // Rounding alone may lower it beside the maximum.
        if found >= value - 1e-12 * value.abs() {
            return Some(next);
        }
        fraction *= 0.5;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_asymptote_meets_the_function() {
        let [(log, hazard), (far_log, far_hazard)] = [FAR + 1e-9, FAR].map(log_and_hazard);
        assert!((log - far_log).abs() < 2e-5 && (hazard - far_hazard).abs() < 1e-3);
        assert!(log_and_hazard(-1e8).0.is_finite());
    }

    /// Two intensities and two coefficients: the curve passes through both shares, Φ⁻¹(0.2) and Φ⁻¹(0.6).
    #[test]
    fn two_shares_are_met_exactly() {
        let count = |at, exceeded| Count {
            at,
            exceeded,
            not_exceeded: 10 - exceeded,
        };
        let counts = [count(-1.0, 2), count(1.0, 6)];
        let [constant, slope] = maximum(&counts, [0.0, 0.0]).unwrap();
        assert!((constant - slope - normal::quantile(0.2)).abs() < 1e-9);
        assert!((constant + slope - normal::quantile(0.6)).abs() < 1e-9);
        let (value, s) = maximum_on_line(&counts, [0.0, slope], [1.0, 0.0], -3.0);
        assert!((s - constant).abs() < 1e-8);
        assert!((value - log_likelihood(&counts, [constant, slope])).abs() < 1e-12);
    }
}
