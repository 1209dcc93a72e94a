//! The answers of a study, computed from its data set alone. In: the rows, in one pass. Out: [`Answers`], plain data with intervals,
//! the same for the same file. It draws nothing and prints nothing.
//!
//! Counts, probabilities, means and standard deviations are of all runs. Quantiles, histograms and cumulative curves are of the first
//! [`KEPT`] runs, sensitivities of the first [`RANKED`]: the beginning of a study is a study, so their intervals hold; they are only
//! wider. Memory is that of the kept runs, however many rows follow.

mod distribution;
mod fragility;
mod kept;
mod looks;
mod moments;
mod probability;
mod reasons;
mod sensitivity;
mod studied;
mod subset;
#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;
mod worst;

use serde::Serialize;

use crate::study::data_set::{DataSetFault, Metadata, Reader, Stopping, StudyKind, StudyRow};
use distribution::Distributions;
use kept::Kept;
use looks::CountsWithLooks;
use psd_physics::study::{Confidence, Interval};
use psd_plan::study::Sampling;
use worst::WorstRuns;

pub use distribution::{Histogram, QuantileAnswer, ResultAnswer};
pub use fragility::{CurvePoint, FitAnswer, FragilityAnswer, SplitAnswer, StripeAnswer};
pub use kept::Kept as KeptRuns;
pub use probability::{Probability, RequirementAnswer};
pub use reasons::ReasonCount;
pub use sensitivity::{IndexAnswer, Sensitivity};
pub use studied::{LookAnswer, StudiedAnswer};
pub use subset::{LevelAnswer, SubsetAnswer};
pub use worst::{WorstRun, setting};

/// Runs whose values are kept: quantiles, histograms and cumulative curves.
pub const KEPT: usize = 1 << 18;
/// Runs that are ranked for sensitivities.
pub const RANKED: usize = 1 << 16;

/// Lower and upper end; None: this side has no bound.
pub type Ends = [Option<f64>; 2];

/// What a study found. Every value is in the SI unit of its column.
#[derive(Clone, Debug, Serialize)]
pub struct Answers {
    pub runs: u64,
    /// Largest number of runs of the study.
    pub at_most: u64,
    /// All runs that the study asks for are there.
    pub complete: bool,
    /// Level of confidence of every interval, except of looks.
    pub confidence: f64,
    /// In the order of the plan.
    pub requirements: Vec<RequirementAnswer>,
    /// Requirements on probabilities of this study.
    pub studied: Vec<StudiedAnswer>,
    /// Looks of the stopping rule, in their order; none if the number of runs is fixed.
    pub looks: Vec<LookAnswer>,
    /// None of a fragility, whose results depend on the intensity, and of a subset simulation, whose runs are near the limit.
    pub results: Vec<ResultAnswer>,
    /// Why runs have no result, the commonest reason first.
    pub reasons: Vec<ReasonCount>,
    pub fragility: Option<FragilityAnswer>,
    /// Of a complete subset simulation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub subset: Option<SubsetAnswer>,
    /// The first runs, for figures.
    #[serde(skip)]
    pub kept: Kept,
}

impl Answers {
    /// Reads the whole data set once.
    ///
    /// # Errors
    /// It is damaged, or does not begin with run 0.
    pub fn of(reader: &Reader) -> Result<Self, DataSetFault> {
        let metadata = reader.metadata();
        let fault = |reason: String| DataSetFault::new(reader.path(), reason);
        if metadata.first != 0 {
            return Err(fault(format!(
                "contains runs {} to {} only; merge the parts of the study first: `psd study merge`",
                metadata.first,
                metadata.end.saturating_sub(1)
            )));
        }
        let confidence =
            Confidence::new(metadata.confidence).map_err(|error| fault(error.to_string()))?;
        let mut pass = Pass::new(metadata, confidence);
        for block in reader.blocks() {
            let block = block?;
            block.rows().for_each(|row| pass.add(metadata, &row));
        }
        Ok(pass.finish(metadata, confidence))
    }
}

/// What one pass collects.
struct Pass {
    counts: CountsWithLooks,
    distributions: Distributions,
    kept: Kept,
    worst: WorstRuns,
    reasons: reasons::Reasons,
    stripes: fragility::StripeCounts,
}

impl Pass {
    fn new(metadata: &Metadata, confidence: Confidence) -> Self {
        Self {
            counts: CountsWithLooks::new(metadata, confidence),
            distributions: Distributions::new(metadata),
            kept: Kept::new(metadata),
            worst: WorstRuns::new(metadata),
            reasons: reasons::Reasons::default(),
            stripes: fragility::StripeCounts::new(metadata),
        }
    }

    fn add(&mut self, metadata: &Metadata, row: &StudyRow) {
        self.counts.add(row);
        self.distributions.add(row);
        self.kept.add(row);
        self.worst.add(metadata, row);
        self.reasons.add(row);
        self.stripes.add(row);
    }

    fn finish(self, metadata: &Metadata, confidence: Confidence) -> Answers {
        let subset = subset::answer(&self.counts, confidence);
        let of_probabilities = self.counts.confidence(confidence);
        let studied = studied::answers(metadata, &self.counts, subset.as_ref(), confidence);
        // The runs of stripes and of levels are not a sample of the results.
        let results = if is_a_sample(&metadata.kind) {
            self.distributions.answers(metadata, &self.kept, confidence)
        } else {
            Vec::new()
        };
        Answers {
            runs: self.counts.counts().runs,
            at_most: metadata.at_most,
            complete: studied.complete,
            confidence: metadata.confidence,
            requirements: probability::answers(
                metadata,
                self.counts.counts(),
                self.worst,
                of_probabilities,
            ),
            studied: studied.answers,
            looks: studied.looks,
            results,
            reasons: self.reasons.answers(),
            subset,
            fragility: fragility::answer(metadata, &self.stripes, confidence),
            kept: self.kept,
        }
    }
}

/// An interval as two ends.
const fn ends(interval: Interval) -> [f64; 2] {
    [interval.low, interval.high]
}

/// Whether the runs are drawn from the inputs as they scatter.
const fn is_a_sample(kind: &StudyKind) -> bool {
    matches!(
        kind,
        StudyKind::Study(Stopping::Fixed | Stopping::Decided | Stopping::HalfWidth(_))
    )
}

/// Whether runs are independent of each other, as exact intervals require.
const fn is_independent(sampling: Sampling) -> bool {
    matches!(sampling, Sampling::Random)
}
