//! What a data set says about itself. In: plan, study and build that made it. Out: the JSON in the footer of its file. Two files belong
//! together if their metadata are equal but for the runs that they contain.

use serde::{Deserialize, Serialize};

use psd_plan::Comparison;
use psd_plan::study::{RareEvent, Sampling};
use psd_text::units::Dimension;
use psd_text::units::display::si_unit;

/// Number of the format; a reader refuses others.
pub(super) const FORMAT: u32 = 1;

/// A study, and the part of its runs that a file contains.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Metadata {
    /// The build of psd that simulated the runs.
    pub version: String,
    /// Title of the plan, and its file.
    pub title: String,
    pub plan: String,
    /// SHA-256 of all files and settings of the plan.
    pub digest: String,
    /// `--set` values that hold for every run: name and text.
    pub settings: Vec<Setting>,
    /// Name of the study.
    pub study: String,
    pub kind: StudyKind,
    pub seed: u64,
    #[serde(with = "keywords::sampling")]
    pub sampling: Sampling,
    /// Scrambled replicates of a Sobol' study: run i belongs to replicate i modulo this. 1 for the others.
    pub replicates: u32,
    /// Rank correlations as the plan writes them. A table of rows correlates its inputs as well; see `is_correlated`.
    pub correlations: Vec<String>,
    /// Some inputs are not independent of each other.
    pub is_correlated: bool,
    /// The plan has a series of impacts, whose `while` every run decides on its value alone.
    pub has_series: bool,
    /// Level of confidence of its intervals, such as 0.95.
    pub confidence: f64,
    /// Most runs of the study; for a fragility the runs of all stripes.
    pub at_most: u64,
    /// Runs `first..end` are in this file.
    pub first: u64,
    pub end: u64,
    /// In the order of the columns; for a fragility with its intensity.
    pub inputs: Vec<Column>,
    pub results: Vec<Column>,
    /// What is decided in every run. For a fragility, the first one is its condition `exceeds`, which is met by a run that exceeds.
    pub requirements: Vec<Decision>,
    /// Requirements on the probabilities of this study.
    pub studied: Vec<StudiedRequirement>,
}

/// A `--set` value.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Setting {
    pub name: String,
    pub text: String,
}

/// What the runs are for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StudyKind {
    Study(Stopping),
    Fragility(Stripes),
}

/// When a study ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stopping {
    /// After `at_most` runs.
    Fixed,
    /// Once every studied requirement is decided.
    Decided,
    /// Once half of the interval of every probability is at most this wide.
    HalfWidth(f64),
    /// Once every replicate of a subset simulation has ended.
    Rare(RareEvent),
}

/// The intensities of a fragility. Run i is at intensity i modulo their number, so that more runs leave the first ones as they are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stripes {
    /// Index of the intensity among the inputs.
    pub intensity: usize,
    /// Rising, SI.
    pub values: Vec<f64>,
    /// Runs at each intensity.
    pub runs: u64,
    /// Index of the number of the ground-motion record among the inputs, if it varies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub record: Option<usize>,
}

/// A column of inputs or results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// An input as `--set` writes it, a result as a requirement reads it.
    pub name: String,
    /// SI unit of the values in the file, in the language's syntax; `1` for a number.
    pub unit: String,
    #[serde(with = "exponents")]
    pub dimension: Dimension,
    /// The distribution of an input as the plan writes it, the description of a result.
    pub text: String,
    /// The value of an input in the plan without the study, SI.
    pub nominal: Option<f64>,
}

/// A condition that each run meets or not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    pub label: String,
    /// As the plan writes it.
    pub text: String,
    /// The result that is compared with a constant limit, if it is that simple: its index among the results and the limit, SI.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<Limit>,
}

/// A limit of one result, for figures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Index of the result.
    pub result: usize,
    /// SI
    pub value: f64,
}

/// A requirement on a probability of the study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudiedRequirement {
    pub label: String,
    /// As the plan writes it.
    pub text: String,
    /// Index into `requirements`.
    pub requirement: usize,
    pub event: Event,
    /// `<`, `<=`, `>` or `>=`.
    #[serde(with = "keywords::comparison")]
    pub comparison: Comparison,
    /// Between 0 and 1.
    pub limit: f64,
}

/// What a probability is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Event {
    /// The requirement is not met.
    Fails,
    /// The requirement is met.
    Holds,
}

impl Metadata {
    /// Whether two files contain runs of one study, made by one build.
    #[must_use]
    pub fn belongs_to(&self, other: &Self) -> bool {
        let whole = |metadata: &Self| Self {
            first: 0,
            end: 0,
            ..metadata.clone()
        };
        whole(self) == whole(other)
    }

    /// Number of runs in the file.
    #[must_use]
    pub const fn runs(&self) -> u64 {
        self.end.saturating_sub(self.first)
    }
}

impl Column {
    /// Of a value of the plan, in SI.
    #[must_use]
    pub fn new(name: &str, dimension: Dimension, text: &str) -> Self {
        Self {
            name: name.to_owned(),
            unit: si_unit(dimension),
            dimension,
            text: text.to_owned(),
            nominal: None,
        }
    }
}

/// A dimension as its exponents of length, mass and time; of angle and temperature too, unless both are 0.
mod exponents {
    use serde::de::Error as _;
    use serde::{Deserialize as _, Deserializer, Serialize as _, Serializer};

    use psd_text::units::{Dimension, Exponent};

    pub fn serialize<S: Serializer>(
        dimension: &Dimension,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let Dimension {
            length,
            mass,
            time,
            angle,
            temperature,
        } = *dimension;
        let all = [length, mass, time, angle, temperature].map(Exponent::as_f64);
        let written = if angle.is_zero() && temperature.is_zero() {
            &all[..3]
        } else {
            &all[..]
        };
        written.serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Dimension, D::Error> {
        let read = Vec::<f64>::deserialize(deserializer)?;
        let exponents: Option<Vec<Exponent>> =
            read.into_iter().map(Exponent::from_decimal).collect();
        match exponents.as_deref() {
            Some([length, mass, time]) => Ok(Dimension {
                length: *length,
                mass: *mass,
                time: *time,
                ..Dimension::NUMBER
            }),
            Some([length, mass, time, angle, temperature]) => Ok(Dimension {
                length: *length,
                mass: *mass,
                time: *time,
                angle: *angle,
                temperature: *temperature,
            }),
            _ => Err(D::Error::custom("no such exponents of a dimension")),
        }
    }
}

/// Words of the plan language for types of the plan.
mod keywords {
    /// The value whose word was read.
    fn named<'de, T: Copy, D: serde::Deserializer<'de>>(
        deserializer: D,
        all: &[T],
        word: fn(T) -> &'static str,
    ) -> Result<T, D::Error> {
        use serde::Deserialize as _;
        let read = String::deserialize(deserializer)?;
        let found = all.iter().copied().find(|value| word(*value) == read);
        found.ok_or_else(|| serde::de::Error::custom(format!("`{read}` is unknown")))
    }

    pub mod sampling {
        use psd_plan::study::Sampling;

        const ALL: [Sampling; 4] = [
            Sampling::Random,
            Sampling::LatinHypercube,
            Sampling::Sobol,
            Sampling::Subset,
        ];

        #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde gives a reference")]
        pub fn serialize<S: serde::Serializer>(
            value: &Sampling,
            serializer: S,
        ) -> Result<S::Ok, S::Error> {
            serializer.serialize_str(value.name())
        }

        pub fn deserialize<'de, D: serde::Deserializer<'de>>(
            deserializer: D,
        ) -> Result<Sampling, D::Error> {
            super::named(deserializer, &ALL, Sampling::name)
        }
    }

    pub mod comparison {
        use psd_plan::Comparison;

        const ALL: [Comparison; 4] = [
            Comparison::Less,
            Comparison::LessEqual,
            Comparison::Greater,
            Comparison::GreaterEqual,
        ];

        pub const fn sign(comparison: Comparison) -> &'static str {
            match comparison {
                Comparison::Less => "<",
                Comparison::LessEqual => "<=",
                Comparison::Greater => ">",
                Comparison::GreaterEqual => ">=",
                Comparison::Equal => "==",
                Comparison::NotEqual => "!=",
            }
        }

        #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde gives a reference")]
        pub fn serialize<S: serde::Serializer>(
            value: &Comparison,
            serializer: S,
        ) -> Result<S::Ok, S::Error> {
            serializer.serialize_str(sign(*value))
        }

        pub fn deserialize<'de, D: serde::Deserializer<'de>>(
            deserializer: D,
        ) -> Result<Comparison, D::Error> {
            super::named(deserializer, &ALL, sign)
        }
    }
}
