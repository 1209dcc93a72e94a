//! The fragility curve of a data set. In: rows, stripe by stripe. Out: the stripes with their intervals, and the lognormal curve with its
//! band, or the reason why none fits. If runs have no result, there are two curves: the truth lies between them.

use std::collections::BTreeMap;

use serde::Serialize;

use super::ends;
use super::moments::number;
use crate::study::counts::Counts;
use crate::study::data_set::{Column, Event, Metadata, Stripes, StudyKind, StudyRow};
use psd_physics::study::Confidence;
use psd_physics::study::fragility::{Fit, NoFit, NoResult, Split, Stripe};
use psd_physics::study::probability::Outcomes;
use psd_text::units::display;

/// Points of a curve.
const POINTS: u64 = 121;
/// The curve begins at this fraction of the smallest intensity, and ends at this multiple of the largest.
const BEYOND: [f64; 2] = [0.5, 1.25];

/// The probability of an exceedance by the intensity.
#[derive(Clone, Debug, Serialize)]
pub struct FragilityAnswer {
    pub intensity: String,
    pub unit: String,
    /// The condition of an exceedance as the plan writes it.
    pub exceeds: String,
    pub stripes: Vec<StripeAnswer>,
    /// One curve if every run has a result. Otherwise two: runs without a result counted as not exceeding, then as exceeding.
    pub fits: Vec<FitAnswer>,
}

/// Runs at one intensity.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StripeAnswer {
    pub intensity: f64,
    pub exceeded: u64,
    pub not_exceeded: u64,
    pub no_result: u64,
    /// Fraction of exceedances, if no run without a result exceeds, and if all do.
    pub bounds: [f64; 2],
    /// Of Clopper and Pearson, over both bounds.
    pub interval: [f64; 2],
}

/// A fitted curve.
#[derive(Clone, Debug, Serialize)]
pub struct FitAnswer {
    /// How runs without a result count: `none` if there are none, `not_exceeded`, `exceeded`.
    pub no_result_as: &'static str,
    /// Why no curve fits; the rest is then missing.
    pub no_fit: Option<String>,
    /// θ, SI.
    pub median: Option<f64>,
    /// None: the runs do not show that the curve rises.
    pub median_interval: Option<[f64; 2]>,
    /// β
    pub dispersion: Option<f64>,
    pub dispersion_interval: Option<[f64; 2]>,
    /// Probability of a deviance as large as this one if the curve is lognormal; None with two stripes.
    pub goodness: Option<f64>,
    /// Some stripe has between 10 % and 90 % of exceedances. Without one the dispersion is a guess.
    pub has_middle: bool,
    /// The parts of the dispersion; None unless records and other inputs vary.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub split: Option<SplitAnswer>,
    pub curve: Vec<CurvePoint>,
}

/// The dispersion between ground-motion records, and by the other inputs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SplitAnswer {
    pub records: usize,
    pub record_to_record: f64,
    pub modelling: f64,
    /// Record-to-record part of β².
    pub share: f64,
    pub share_interval: [f64; 2],
}

impl SplitAnswer {
    fn of(split: Split) -> Self {
        Self {
            records: split.records,
            record_to_record: split.record_to_record,
            modelling: split.modelling,
            share: split.share,
            share_interval: ends(split.share_interval),
        }
    }
}

/// A point of a fitted curve with its band.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CurvePoint {
    pub intensity: f64,
    pub probability: f64,
    pub interval: [f64; 2],
    /// Beyond the smallest or the largest intensity of the study.
    pub is_extrapolated: bool,
}

/// Counts of every stripe.
pub struct StripeCounts {
    stripes: Vec<Counts>,
    /// Index of the number of the record among the inputs.
    record: Option<usize>,
    /// Those of each record, by its number.
    records: BTreeMap<u64, Vec<Counts>>,
}

impl StripeCounts {
    pub fn new(metadata: &Metadata) -> Self {
        let (count, record) = match &metadata.kind {
            StudyKind::Study(_) => (0, None),
            StudyKind::Fragility(stripes) => (stripes.values.len(), stripes.record),
        };
        Self {
            stripes: vec![Counts::new(metadata.requirements.len()); count],
            record,
            records: BTreeMap::new(),
        }
    }

    pub fn add(&mut self, row: &StudyRow) {
        let stripe = row.run.checked_rem(self.stripes.len() as u64);
        let Some(stripe) = stripe.and_then(|stripe| usize::try_from(stripe).ok()) else {
            return;
        };
        self.stripes[stripe].add(row);
        if let Some(number) = self.record.and_then(|at| row.inputs.get(at)) {
            let empty = vec![Counts::new(row.outcomes.len()); self.stripes.len()];
            let of_record = self.records.entry(number.to_bits()).or_insert(empty);
            of_record[stripe].add(row);
        }
    }
}

/// None of a study.
pub fn answer(
    metadata: &Metadata,
    counts: &StripeCounts,
    confidence: Confidence,
) -> Option<FragilityAnswer> {
    let StudyKind::Fragility(Stripes {
        intensity, values, ..
    }) = &metadata.kind
    else {
        return None;
    };
    let column = metadata.inputs.get(*intensity)?;
    let exceeds = metadata.requirements.first()?;
    let stripes_of = |counts: &[Counts]| -> Vec<Stripe> {
        let stripe = |(intensity, counts): (&f64, &Counts)| {
            // The first requirement of a fragility is its condition: met is exceeded.
            let outcomes = counts.of(0, Event::Holds);
            Stripe {
                intensity: *intensity,
                exceeded: outcomes.failed,
                not_exceeded: outcomes.passed,
                no_result: outcomes.no_result,
            }
        };
        values.iter().zip(counts).map(stripe).collect()
    };
    let stripes = stripes_of(&counts.stripes);
    let records: Vec<Vec<Stripe>> = counts.records.values().map(|it| stripes_of(it)).collect();
    // The intensity and the record alone: no run differs from another under the same record.
    let others = metadata.inputs.len() > 2;
    let treatments: &[(NoResult, &str)] = if stripes.iter().all(|stripe| stripe.no_result == 0) {
        &[(NoResult::AsNotExceeded, "none")]
    } else {
        &[
            (NoResult::AsNotExceeded, "not_exceeded"),
            (NoResult::AsExceeded, "exceeded"),
        ]
    };
    let fits = treatments
        .iter()
        .map(|(counted, name)| match Fit::new(&stripes, *counted) {
            Ok(fit) => FitAnswer {
                split: fit
                    .split(&records, *counted, confidence)
                    .filter(|_| others)
                    .map(SplitAnswer::of),
                ..fitted(&fit, name, &stripes, confidence)
            },
            Err(reason) => FitAnswer {
                no_result_as: name,
                no_fit: Some(no_fit(reason, column)),
                median: None,
                median_interval: None,
                dispersion: None,
                dispersion_interval: None,
                goodness: None,
                has_middle: false,
                split: None,
                curve: Vec::new(),
            },
        })
        .collect();
    Some(FragilityAnswer {
        intensity: column.name.clone(),
        unit: column.unit.clone(),
        exceeds: exceeds.text.clone(),
        stripes: stripes
            .iter()
            .filter_map(|stripe| of_stripe(stripe, confidence))
            .collect(),
        fits,
    })
}

/// None without runs.
fn of_stripe(stripe: &Stripe, confidence: Confidence) -> Option<StripeAnswer> {
    let outcomes = Outcomes {
        passed: stripe.not_exceeded,
        failed: stripe.exceeded,
        no_result: stripe.no_result,
    };
    Some(StripeAnswer {
        intensity: stripe.intensity,
        exceeded: stripe.exceeded,
        not_exceeded: stripe.not_exceeded,
        no_result: stripe.no_result,
        bounds: outcomes.estimates()?,
        interval: ends(outcomes.interval(confidence)),
    })
}

fn fitted(fit: &Fit, name: &'static str, stripes: &[Stripe], confidence: Confidence) -> FitAnswer {
    FitAnswer {
        no_result_as: name,
        no_fit: None,
        median: Some(fit.curve.median),
        median_interval: fit.median_interval(confidence).map(ends),
        dispersion: Some(fit.curve.dispersion),
        dispersion_interval: fit.dispersion_interval(confidence).map(ends),
        goodness: fit.goodness,
        has_middle: fit.has_middle,
        split: None,
        curve: curve(fit, stripes, confidence),
    }
}

/// Points of the curve at equal ratios of the intensity, and at both ends of the stripes.
fn curve(fit: &Fit, stripes: &[Stripe], confidence: Confidence) -> Vec<CurvePoint> {
    let (Some(first), Some(last)) = (stripes.first(), stripes.last()) else {
        return Vec::new();
    };
    let [least, largest] = [first.intensity, last.intensity];
    let [from, to] = [BEYOND[0] * least, BEYOND[1] * largest];
    let at = |index: u64| from * (to / from).powf(number(index) / number(POINTS - 1));
    let mut intensities: Vec<f64> = (0..POINTS).map(at).chain([least, largest]).collect();
    intensities.sort_by(f64::total_cmp);
    intensities
        .into_iter()
        .map(|intensity| CurvePoint {
            intensity,
            probability: fit.curve.probability(intensity),
            interval: ends(fit.band(intensity, confidence)),
            is_extrapolated: !(least..=largest).contains(&intensity),
        })
        .collect()
}

/// The reason, with its intensities in their unit.
fn no_fit(reason: NoFit, column: &Column) -> String {
    let printed = |intensity: f64| display::stated(intensity, column.dimension);
    match reason {
        NoFit::Intensity(intensity) => format!(
            "intensity {}: a fragility curve has intensities above 0",
            printed(intensity)
        ),
        NoFit::Step { below, above } => format!(
            "no run exceeds the limit up to {}, every run from {}: add intensities between them",
            printed(below),
            printed(above)
        ),
        NoFit::OneMixed {
            mixed,
            below,
            above,
        } => {
            let wanted = if above.is_finite() {
                format!("between {} and {}", printed(below), printed(above))
            } else {
                format!("above {}", printed(below))
            };
            let mixed = printed(mixed);
            format!("only one intensity ({mixed}) has both outcomes: add intensities {wanted}")
        }
        NoFit::OneIntensity | NoFit::NoneExceeds | NoFit::AllExceed | NoFit::NotRising => {
            reason.to_string()
        }
    }
}
