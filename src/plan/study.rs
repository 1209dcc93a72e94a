//! Studies: many runs of the plan with scattered inputs. In: nothing. Out: the checked parameters of `study` and `fragility` blocks, and
//! the requirements on their probabilities. A run of the plan itself does not read them.

use serde::{Deserialize, Serialize};

use super::formula::{Formula, ResultReference};
use super::{Comparison, Condition};
use psd_physics::study::Confidence;
use psd_physics::study::correlation::Pair;
use psd_physics::study::inputs::Source;
use psd_physics::study::subset_simulation::SubsetSimulation;
use psd_text::units::Dimension;

/// Most runs of a study.
pub const MOST_RUNS: u64 = 10_000_000_000;
/// Runs of a study that does not state their number.
pub const USUAL_RUNS: u64 = 10_000;
/// Seed of a study that does not state one.
pub const USUAL_SEED: u64 = 1;
/// Largest seed: a whole number of a plan is exact up to 2⁵³.
pub const MOST_SEED: u64 = 1 << 53;
/// Scrambled replicates of a Sobol' study: the scatter of their means gives an interval.
pub const REPLICATES: u32 = 16;

/// What the studies of a plan vary, and how.
#[derive(Clone, Debug)]
pub struct Variation {
    /// The varied values, in the order of the columns of the data set.
    pub inputs: Vec<Input>,
    /// One distribution for one input, one table of rows for one or several inputs; their values in this order are those of `inputs`.
    pub sources: Vec<Source>,
    /// Rank correlations of sources.
    pub correlations: Vec<Pair>,
    pub sampling: Sampling,
    pub seed: u64,
    /// Inputs whose distribution follows from a simulated run of the plan, beside those above.
    pub measured: Vec<Measured>,
}

/// An input that is a result of the plan, with the uncertainty that a run of the plan gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Index among the inputs.
    pub input: usize,
    /// Index among the sources.
    pub source: usize,
    pub result: ResultReference,
}

/// A value of the plan that differs from run to run.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// As in `--set`: `impact_speed`, or `beam.mass`.
    pub name: String,
    pub dimension: Dimension,
    /// Its distribution as the plan writes it.
    pub text: String,
    /// The value of the plan without the study, SI.
    pub nominal: f64,
    /// Whether it is the number of a ground-motion record.
    pub is_record: bool,
}

/// A number that is kept for every run.
#[derive(Clone, Debug, PartialEq)]
pub struct Collected {
    /// As the plan writes it: `hit.max_displacement`, `max(quake.max_drift)`.
    pub text: String,
    pub value: Formula,
    pub dimension: Dimension,
}

/// How the points of a study are chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampling {
    #[default]
    Random,
    LatinHypercube,
    Sobol,
    /// Subset simulation: each level begins where the last one was worst.
    Subset,
}

impl Sampling {
    /// The keyword of the language.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::LatinHypercube => "latin_hypercube",
            Self::Sobol => "sobol",
            Self::Subset => "subset",
        }
    }
}

/// When a study ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Runs {
    Fixed(u64),
    /// Once every requirement on a probability of this study is decided, after `at_most` runs at the latest.
    Decided {
        confidence: Confidence,
        at_most: u64,
    },
    /// Once half of the interval of every probability is at most this wide, after `at_most` runs at the latest.
    HalfWidth {
        half_width: f64,
        confidence: Confidence,
        at_most: u64,
    },
    /// Once every replicate of a subset simulation has reached the rare event.
    Rare(RareEvent),
}

/// A rare event and the subset simulation that finds it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RareEvent {
    /// Runs of a level.
    pub points: u32,
    pub replicates: u32,
    /// Number of standard normal numbers behind the inputs.
    pub numbers: u32,
    /// The requirement of the plan that fails.
    pub requirement: usize,
    /// It fails where its result is too small.
    pub falls: bool,
}

impl RareEvent {
    /// The simulation with a seed.
    #[must_use]
    pub const fn simulation(self, seed: u64) -> SubsetSimulation {
        SubsetSimulation {
            inputs: self.numbers,
            points: self.points as usize,
            replicates: self.replicates,
            seed,
        }
    }
}

impl Runs {
    /// The largest number of runs.
    #[must_use]
    pub const fn at_most(self) -> u64 {
        match self {
            Self::Fixed(runs)
            | Self::Decided { at_most: runs, .. }
            | Self::HalfWidth { at_most: runs, .. } => runs,
            Self::Rare(rare) => rare.simulation(0).at_most(),
        }
    }
}

/// A `study` block.
#[derive(Clone, Debug)]
pub struct Study {
    pub name: String,
    pub variation: Variation,
    pub runs: Runs,
    /// Confidence of its intervals.
    pub confidence: Confidence,
    /// Numbers that are kept for every run, beside those that a requirement reads.
    pub collect: Vec<Collected>,
}

/// A `fragility` block: the probability of an exceedance by the intensity.
#[derive(Clone, Debug)]
pub struct Fragility {
    pub name: String,
    /// The input that is stepped; its `text` is empty.
    pub intensity: Input,
    /// Its values, SI, rising, above 0.
    pub stripes: Vec<f64>,
    /// What counts as an exceedance: the condition holds.
    pub exceeds: Condition,
    /// The other inputs, if any; without one, every run at an intensity is the same.
    pub variation: Option<Variation>,
    /// Runs at each intensity.
    pub runs: u64,
    pub confidence: Confidence,
}

/// What a probability is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StudyEvent {
    /// This requirement of the plan is not met.
    Fails { requirement: usize },
    /// This requirement of the plan is met.
    Holds { requirement: usize },
}

/// `require "label" scatter.probability(fails: "stays in travel") < 2 %`: decided by the study, not by a run.
#[derive(Clone, Debug)]
pub struct StudyRequirement {
    pub label: String,
    /// The condition as the plan writes it.
    pub text: String,
    /// Index into the studies of the plan.
    pub study: usize,
    pub event: StudyEvent,
    /// `<`, `<=`, `>` or `>=`.
    pub comparison: Comparison,
    /// Between 0 and 1.
    pub limit: f64,
}

/// All studies of a plan.
#[derive(Clone, Debug, Default)]
pub struct Studies {
    pub studies: Vec<Study>,
    pub fragilities: Vec<Fragility>,
    pub requirements: Vec<StudyRequirement>,
}

impl Studies {
    /// The names of the requirements that a study decides, in quotes; None without one.
    #[must_use]
    pub fn requirement_names(&self) -> Option<String> {
        let quoted = |requirement: &StudyRequirement| format!("\"{}\"", requirement.label);
        let names: Vec<String> = self.requirements.iter().map(quoted).collect();
        (!names.is_empty()).then(|| names.join(", "))
    }
}
