//! The dispersion of a fragility curve divided: between ground-motion records, and between structures under one record. In: exceedances
//! of each record at each intensity, and the fitted curve. Out: the record-to-record share of β², with its interval.
//!
//! The capacity of a structure under record r is lognormal around a median of that record, and these medians are lognormal themselves:
//!
//! ```text
//! P(exceeded | x, r) = Φ((ln(x/θ) − βᵣ u)/βₘ)        u ~ N(0, 1) of the record, βᵣ² + βₘ² = β²
//! ```
//!
//! With the share s = βᵣ²/β², the likelihood of a record is the mean of that of its runs over u. Its maximum over θ and β at each share is the
//! profile likelihood, which has the estimate and the interval of the share.

use std::cell::Cell;

use super::likelihood::{Count, log_likelihood};
use super::{Fit, NoResult, Stripe};
use crate::study::{Confidence, Interval, number};

/// Fewest records that show how they differ.
const FEWEST: usize = 3;
/// Largest share: with all of it between the records, a record exceeds always or never.
const MOST: f64 = 0.999;
/// Half of the range of u: beyond it a normal number is never found.
const REACH: f64 = 6.0;
/// Newton steps of a maximum over θ and β.
const STEPS: u32 = 12;
/// Bisections of an end, and sections of the search of the maximum.
const SECTIONS: u32 = 12;

/// The parts of a dispersion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split {
    pub records: usize,
    /// βᵣ²/β²
    pub share: f64,
    pub share_interval: Interval,
    /// βᵣ
    pub record_to_record: f64,
    /// βₘ: by the other inputs.
    pub modelling: f64,
}

impl Fit {
    /// The parts of its dispersion. `records`: the stripes of each record. None with fewer than three records.
    #[must_use]
    pub fn split(
        &self,
        records: &[Vec<Stripe>],
        counted: NoResult,
        confidence: Confidence,
    ) -> Option<Split> {
        let of_record = |stripes: &Vec<Stripe>| -> Vec<Count> {
            let stripes = stripes.iter().map(|stripe| stripe.with(counted));
            stripes
                .filter(|stripe| stripe.runs() > 0)
                .map(|stripe| Count {
                    at: stripe.intensity.ln() - self.origin,
                    exceeded: stripe.exceeded,
                    not_exceeded: stripe.not_exceeded,
                })
                .collect()
        };
        let records: Vec<Vec<Count>> = records.iter().map(of_record).collect();
        let records: Vec<Vec<Count>> = records.into_iter().filter(|it| !it.is_empty()).collect();
        if records.len() < FEWEST {
            return None;
        }
        let start = [
            self.curve.median.ln() - self.origin,
            self.curve.dispersion.ln(),
        ];
        // Each maximum begins at the last one: near shares have near maxima.
        let start = Cell::new(start);
        let profile = |share: f64| {
            let (most, at) = maximum(&records, share, start.get());
            start.set(at);
            most
        };
        let (share, most) = largest(&profile);
        let least = most - 0.5 * confidence.normal_factor().powi(2);
        let end = |beyond: f64| {
            if profile(beyond) >= least {
                return beyond;
            }
            let (mut inside, mut outside) = (share, beyond);
            for _ in 0..SECTIONS {
                let middle = 0.5 * (inside + outside);
                if profile(middle) >= least {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            outside
        };
        Some(Split {
            records: records.len(),
            share,
            share_interval: Interval {
                low: end(0.0),
                // The likelihood of the largest share stands for that of 1.
                high: Some(end(MOST)).filter(|high| *high < MOST).unwrap_or(1.0),
            },
            record_to_record: share.sqrt() * self.curve.dispersion,
            modelling: (1.0 - share).sqrt() * self.curve.dispersion,
        })
    }
}

/// The share of the largest profile likelihood, by golden sections, and that likelihood.
fn largest(profile: &impl Fn(f64) -> f64) -> (f64, f64) {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = (0.0, MOST);
    let at = |low: f64, high: f64, part: f64| low + part * (high - low);
    let mut inner = [at(low, high, 1.0 - golden), at(low, high, golden)];
    let mut found = inner.map(profile);
    for _ in 0..SECTIONS {
        if found[0] >= found[1] {
            high = inner[1];
            inner = [at(low, high, 1.0 - golden), inner[0]];
            found = [profile(inner[0]), found[0]];
        } else {
            low = inner[0];
            inner = [inner[1], at(low, high, golden)];
            found = [found[1], profile(inner[1])];
        }
    }
    let middle = 0.5 * (low + high);
    let (none, inside) = (profile(0.0), profile(middle));
    if none >= inside {
        (0.0, none)
    } else {
        (middle, inside)
    }
}

/// The largest log-likelihood over ln θ and ln β at a share, and its position, by Newton's method with differences.
fn maximum(records: &[Vec<Count>], share: f64, start: [f64; 2]) -> (f64, [f64; 2]) {
    let value = |at: [f64; 2]| likelihood(records, share, at);
    let h = 1e-3;
    let mut at = start;
    let mut best = value(at);
    for _ in 0..STEPS {
        let moved = |first: f64, second: f64| value([at[0] + first * h, at[1] + second * h]);
        let [right, left, up, down] =
            [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)].map(|(a, b)| moved(a, b));
        let slope = [(right - left) / (2.0 * h), (up - down) / (2.0 * h)];
        let i00 = -(right - 2.0 * best + left) / (h * h);
        let i11 = -(up - 2.0 * best + down) / (h * h);
        let i01 = -(moved(1.0, 1.0) - right - up + best) / (h * h);
        let determinant = i00 * i11 - i01 * i01;
        let mut step = if i00 > 0.0 && determinant > 0.0 {
            [
                (i11 * slope[0] - i01 * slope[1]) / determinant,
                (i00 * slope[1] - i01 * slope[0]) / determinant,
            ]
        } else {
            slope.map(|slope| 0.1 * slope.signum())
        };
        let next = |step: [f64; 2]| value([at[0] + step[0], at[1] + step[1]]);
        let mut found = next(step);
        while (found.is_nan() || found < best) && step[0].hypot(step[1]) > 1e-6 {
            step = step.map(|part| 0.5 * part);
            found = next(step);
        }
        if found.is_nan() || found < best {
            break;
        }
        let rise = found - best;
        at = [at[0] + step[0], at[1] + step[1]];
        best = found;
        if rise < 1e-3 {
            break;
        }
    }
    (best, at)
}

/// The log-likelihood of all records; `at`: ln θ and ln β.
fn likelihood(records: &[Vec<Count>], share: f64, at: [f64; 2]) -> f64 {
    let dispersion = at[1].exp();
    let between = share.sqrt() * dispersion;
    let within = (1.0 - share).sqrt() * dispersion;
    let of_record = |counts: &Vec<Count>| {
        let runs: u64 = counts.iter().map(|it| it.exceeded + it.not_exceeded).sum();
        let ratio = between / within;
        // The narrowest that the likelihood of a record can be in u, which a step resolves.
        let width = 1.0 / (1.0 + ratio * ratio * number(runs)).sqrt();
        let step = width;
        let (mut sum, mut most) = (0.0_f64, f64::NEG_INFINITY);
        let mut u = -REACH;
        while u <= REACH {
            let coefficients = [-(at[0] + between * u) / within, 1.0 / within];
            let log = log_likelihood(counts, coefficients) - 0.5 * u * u;
            // The sum of exponentials, scaled by the largest so far.
            if log > most {
                sum = sum * (most - log).exp() + 1.0;
                most = log;
            } else {
                sum += (log - most).exp();
            }
            u += step;
        }
        most + (sum * step).ln() - 0.5 * (2.0 * std::f64::consts::PI).ln()
    };
    records.iter().map(of_record).sum()
}

#[cfg(test)]
mod tests {
    use super::super::super::distribution::normal;
    use super::super::super::sampling::philox::{Philox, Purpose};
    use super::*;

    const MEDIAN: f64 = 0.8;

    /// Runs of 30 records at six intensities, four at each, with these dispersions.
    fn study(seed: u64, between: f64, within: f64) -> Vec<Vec<Stripe>> {
        let stream = Philox::new(seed);
        let score = |run, input| normal::quantile(stream.uniform(Purpose::Value, run, input));
        (0..30)
            .map(|record| {
                let own = MEDIAN * (between * score(record, 1000)).exp();
                let stripe = |at: u32| {
                    let intensity = 0.3 + 0.2 * f64::from(at);
                    let exceeds =
                        |run: &u32| own * (within * score(record, 10 * at + run)).exp() < intensity;
                    let exceeded = (0..4).filter(exceeds).count() as u64;
                    Stripe {
                        intensity,
                        exceeded,
                        not_exceeded: 4 - exceeded,
                        no_result: 0,
                    }
                };
                (0..6).map(stripe).collect()
            })
            .collect()
    }

    /// The curve of all records together.
    fn fit(records: &[Vec<Stripe>]) -> Fit {
        let together = (0..6).map(|at| {
            let sum = |of: fn(&Stripe) -> u64| records.iter().map(|it| of(&it[at])).sum();
            Stripe {
                exceeded: sum(|stripe| stripe.exceeded),
                not_exceeded: sum(|stripe| stripe.not_exceeded),
                ..records[0][at]
            }
        });
        let together: Vec<Stripe> = together.collect();
        Fit::new(&together, NoResult::AsExceeded).unwrap()
    }

    fn split(records: &[Vec<Stripe>]) -> Split {
        let confidence = Confidence::new(0.95).unwrap();
        fit(records)
            .split(records, NoResult::AsExceeded, confidence)
            .unwrap()
    }

    /// Of 12 studies with βᵣ = 0.3 and βₘ = 0.2, a share of 9/13, the 95 % intervals contain it in ten or more (two standard errors), and the
    /// mean of the estimates is within 0.08 of it.
    #[test]
    fn the_parts_of_a_known_dispersion_are_recovered() {
        let truth = 9.0 / 13.0;
        let splits: Vec<Split> = (0..12).map(|seed| split(&study(seed, 0.3, 0.2))).collect();
        let covers = |split: &&Split| split.share_interval.contains(truth);
        let covered = splits.iter().filter(covers).count();
        assert!(covered >= 10, "{covered} of 12");
        let mean = splits.iter().map(|split| split.share).sum::<f64>() / 12.0;
        assert!((mean - truth).abs() < 0.08, "{mean}");
        let parts = splits[0].record_to_record.hypot(splits[0].modelling);
        assert!((splits[0].record_to_record / parts - splits[0].share.sqrt()).abs() < 1e-12);
    }

    /// Records that do not differ, and structures that do not: the interval reaches the end of the shares.
    #[test]
    fn the_whole_dispersion_may_be_of_one_kind() {
        let alike = split(&study(3, 0.0, 0.3));
        assert!(
            alike.share < 0.15 && alike.share_interval.low == 0.0,
            "{alike:?}"
        );
        let fixed = split(&study(4, 0.3, 0.0));
        assert!(
            fixed.share > 0.97 && fixed.share_interval.high == 1.0,
            "{fixed:?}"
        );
    }

    #[test]
    fn two_records_show_no_share() {
        let records = study(1, 0.3, 0.2);
        let confidence = Confidence::new(0.95).unwrap();
        let split = fit(&records).split(&records[..2], NoResult::AsExceeded, confidence);
        assert_eq!(split, None);
    }
}
