//! The distribution of every result. In: rows. Out: mean, standard deviation, quantiles with intervals, histogram, cumulative curve,
//! sensitivities. Which interval holds depends on the sampling: of ranks for independent runs, of replicates for a Sobol' study, none for a
//! Latin hypercube.

use serde::Serialize;

use super::kept::Kept;
use super::moments::{Moments, number};
use super::sensitivity::{self, Sensitivity};
use super::{Ends, ends};
use crate::study::data_set::{Metadata, StudyRow};
use psd_physics::study::quantile::{Quantile, quantile};
use psd_physics::study::{Confidence, mean};
use psd_plan::study::Sampling;

/// Quantiles of a result.
const QUANTILES: [f64; 3] = [0.05, 0.5, 0.95];
/// Points of a cumulative curve, at most.
const POINTS: usize = 501;
/// Bars of a histogram, at least and at most.
const BARS: [f64; 2] = [5.0, 60.0];

/// A result over all runs.
#[derive(Clone, Debug, Serialize)]
pub struct ResultAnswer {
    pub name: String,
    pub unit: String,
    /// Runs in which it exists.
    pub runs: u64,
    pub no_result: u64,
    /// Of the runs in which it exists.
    pub mean: Option<f64>,
    /// None: the sampling gives no interval.
    pub mean_interval: Option<[f64; 2]>,
    pub standard_deviation: Option<f64>,
    pub least: Option<f64>,
    pub largest: Option<f64>,
    pub quantiles: Vec<QuantileAnswer>,
    pub histogram: Option<Histogram>,
    /// Values with the fraction of the kept runs that are not above them.
    pub cumulative: Vec<[f64; 2]>,
    /// One for each input, in the order of the inputs.
    pub sensitivities: Vec<Sensitivity>,
}

/// A quantile of a result.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct QuantileAnswer {
    pub probability: f64,
    /// If runs without a result were all below, and if they were all above.
    pub estimates: Ends,
    /// None: the study is too small, or the sampling gives no interval.
    pub interval: Ends,
}

/// Counts of values between equally spaced edges.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Histogram {
    pub low: f64,
    /// Width of a bar.
    pub width: f64,
    pub counts: Vec<u64>,
}

/// Moments of every result, replicate by replicate.
pub struct Distributions {
    /// `of[result][replicate]`
    of: Vec<Vec<Moments>>,
    whole: Vec<Moments>,
    lost: Vec<u64>,
    replicates: u64,
}

impl Distributions {
    pub fn new(metadata: &Metadata) -> Self {
        let replicates = u64::from(metadata.replicates.max(1));
        let results = metadata.results.len();
        Self {
            of: vec![vec![Moments::default(); metadata.replicates.max(1) as usize]; results],
            whole: vec![Moments::default(); results],
            lost: vec![0; results],
            replicates,
        }
    }

    pub fn add(&mut self, row: &StudyRow) {
        let replicate = usize::try_from(row.run % self.replicates).unwrap_or(0);
        for (index, value) in row.results.iter().enumerate() {
            if let Some(value) = value {
                self.of[index][replicate].add(*value);
                self.whole[index].add(*value);
            } else {
                self.lost[index] += 1;
            }
        }
    }

    pub fn answers(
        &self,
        metadata: &Metadata,
        kept: &Kept,
        confidence: Confidence,
    ) -> Vec<ResultAnswer> {
        let columns = metadata.results.iter().enumerate();
        columns
            .map(|(index, column)| {
                let moments = self.whole[index];
                let exists = moments.count > 0;
                let (sorted, lost) = kept.sorted(index, 0, 1);
                let quantiles = QUANTILES.map(|probability| {
                    let found = match metadata.sampling {
                        Sampling::Sobol => self.of_replicates(index, kept, probability, confidence),
                        _ => quantile(&sorted, lost, probability, confidence),
                    };
                    QuantileAnswer {
                        probability,
                        estimates: found.estimates,
                        interval: match metadata.sampling {
                            Sampling::LatinHypercube | Sampling::Subset => [None; 2],
                            Sampling::Random | Sampling::Sobol => found.interval,
                        },
                    }
                });
                ResultAnswer {
                    name: column.name.clone(),
                    unit: column.unit.clone(),
                    runs: moments.count,
                    no_result: self.lost[index],
                    mean: exists.then_some(moments.mean),
                    mean_interval: self.mean_interval(index, metadata.sampling, confidence),
                    standard_deviation: moments.standard_deviation(),
                    least: exists.then_some(moments.least),
                    largest: exists.then_some(moments.largest),
                    quantiles: quantiles.to_vec(),
                    histogram: histogram(&sorted),
                    cumulative: cumulative(&sorted, lost),
                    sensitivities: sensitivity::answers(metadata, kept, index, confidence),
                }
            })
            .collect()
    }

    /// Student's interval of the mean: of independent runs, or of the means of the replicates.
    fn mean_interval(
        &self,
        index: usize,
        sampling: Sampling,
        confidence: Confidence,
    ) -> Option<[f64; 2]> {
        match sampling {
            Sampling::LatinHypercube | Sampling::Subset => None,
            Sampling::Random => {
                let moments = self.whole[index];
                let sd = moments.standard_deviation()?;
                let reach = mean::factor(number(moments.count - 1), confidence) * sd
                    / number(moments.count).sqrt();
                Some([moments.mean - reach, moments.mean + reach])
            }
            Sampling::Sobol => {
                let replicates = self.of[index].iter().filter(|moments| moments.count > 0);
                let means: Vec<f64> = replicates.map(|moments| moments.mean).collect();
                mean::mean_of(&means, confidence).map(|mean| ends(mean.interval))
            }
        }
    }

    /// The mean of the quantiles of the replicates, with their scatter as interval.
    fn of_replicates(
        &self,
        index: usize,
        kept: &Kept,
        probability: f64,
        confidence: Confidence,
    ) -> Quantile {
        let count = usize::try_from(self.replicates).unwrap_or(1);
        let each: Vec<Ends> = (0..count)
            .map(|replicate| {
                let (sorted, lost) = kept.sorted(index, replicate, count);
                quantile(&sorted, lost, probability, confidence).estimates
            })
            .collect();
        // A quantile beyond all results of one replicate has no mean.
        let side = |side: usize| {
            let values: Option<Vec<f64>> = each.iter().map(|ends| ends[side]).collect();
            values.and_then(|values| mean::mean_of(&values, confidence))
        };
        let [low, high] = [0, 1].map(side);
        Quantile {
            estimates: [low.map(|mean| mean.value), high.map(|mean| mean.value)],
            interval: [
                low.map(|mean| mean.interval.low),
                high.map(|mean| mean.interval.high),
            ],
        }
    }
}

/// Bars after D. Freedman and P. Diaconis (Z. Wahrscheinlichkeitstheorie 57 (1981) 453–476): 2 × interquartile range / n^⅓ wide. None
/// without values; one bar if all are equal.
fn histogram(sorted: &[f64]) -> Option<Histogram> {
    let (low, high) = (*sorted.first()?, *sorted.last()?);
    if low == high {
        return Some(Histogram {
            low,
            width: 0.0,
            counts: vec![sorted.len() as u64],
        });
    }
    let quartile = |quarter: usize| sorted[(quarter * (sorted.len() - 1)) / 4];
    let ideal = 2.0 * (quartile(3) - quartile(1)) / number(sorted.len() as u64).cbrt();
    let bars = if ideal > 0.0 {
        ((high - low) / ideal).ceil().clamp(BARS[0], BARS[1])
    } else {
        BARS[1]
    };
    let width = (high - low) / bars;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and the number of bars, at most 60"
    )]
    let bar = |value: f64| ((value - low) / width) as usize;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped just before"
    )]
    let mut counts = vec![0; bars as usize];
    for value in sorted {
        let last = counts.len() - 1;
        counts[bar(*value).min(last)] += 1;
    }
    Some(Histogram { low, width, counts })
}

/// The empirical cumulative curve, thinned to a few hundred points by rank. Runs without a result count in the denominator.
fn cumulative(sorted: &[f64], lost: u64) -> Vec<[f64; 2]> {
    let all = number(sorted.len() as u64 + lost);
    let step = sorted.len().div_ceil(POINTS - 1).max(1);
    let mut ranks: Vec<usize> = (0..sorted.len()).step_by(step).collect();
    if ranks.last().is_some_and(|last| last + 1 != sorted.len()) {
        ranks.push(sorted.len() - 1);
    }
    ranks
        .into_iter()
        .map(|rank| [sorted[rank], number(rank as u64 + 1) / all])
        .collect()
}
