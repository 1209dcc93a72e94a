//! A study or a fragility as a list of runs with numbers. In: the studies of a plan, a name, another number of runs. Out: the inputs,
//! their draws and the number of runs. It runs nothing.

pub mod measured;

use thiserror::Error;

use crate::study::data_set::{Stopping, Stripes, StudyKind};
use crate::study::draws::Draws;
use psd_physics::study::Confidence;
use psd_physics::study::inputs::InputError;
use psd_plan::Studies;
use psd_plan::study::{Collected, Fragility, Input, MOST_RUNS, Runs, Sampling, Study};

/// A study or a fragility of a plan.
#[derive(Clone, Debug)]
pub struct Definition {
    pub name: String,
    /// A study, or a fragility with its intensities.
    pub kind: StudyKind,
    /// The varied values in the order of the columns of the data set; first the intensity of a fragility.
    pub inputs: Vec<Input>,
    pub seed: u64,
    pub sampling: Sampling,
    /// All runs; those of a fragility at all of its stripes.
    pub runs: Runs,
    pub confidence: Confidence,
    pub collect: Vec<Collected>,
    /// Index into `Studies::studies` or `Studies::fragilities`.
    pub index: usize,
    pub draws: Draws,
}

/// Why a study cannot run.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum DefinitionError {
    #[error("the plan has no study and no fragility")]
    NoStudy,
    #[error("the plan has several studies: {0}")]
    Several(String),
    #[error("the plan has no study `{name}`; it has: {known}")]
    Unknown { name: String, known: String },
    #[error("a study requires at least one run")]
    NoRuns,
    #[error("a study has at most {MOST_RUNS} runs")]
    TooManyRuns,
    #[error("a subset simulation ends by its levels and has no number of runs")]
    RunsOfSubset,
    #[error(
        "the limit of the requirement depends on an input of the study: a subset simulation has one limit"
    )]
    LimitVaries,
    #[error(transparent)]
    Inputs(#[from] InputError),
}

impl Definition {
    /// The study of this name, or the only one. `runs` replaces its `runs`, or the most runs of its stopping rule; for a
    /// fragility it is the number at each intensity.
    ///
    /// # Errors
    /// There is no such study, or its inputs cannot be drawn.
    pub fn of(
        studies: &Studies,
        name: Option<&str>,
        runs: Option<u64>,
    ) -> Result<Self, DefinitionError> {
        if runs == Some(0) {
            return Err(DefinitionError::NoRuns);
        }
        let names: Vec<&str> = studies
            .studies
            .iter()
            .map(|study| study.name.as_str())
            .chain(studies.fragilities.iter().map(|it| it.name.as_str()))
            .collect();
        let known = || names.join(", ");
        let index = match name {
            Some(wanted) => names
                .iter()
                .position(|name| *name == wanted)
                .ok_or_else(|| DefinitionError::Unknown {
                    name: wanted.to_owned(),
                    known: known(),
                })?,
            None => match names.len() {
                0 => return Err(DefinitionError::NoStudy),
                1 => 0,
                _ => return Err(DefinitionError::Several(known())),
            },
        };
        if let Some(study) = studies.studies.get(index) {
            return Self::of_study(study, index, runs);
        }
        let index = index - studies.studies.len();
        Self::of_fragility(&studies.fragilities[index], index, runs)
    }

    fn of_study(study: &Study, index: usize, runs: Option<u64>) -> Result<Self, DefinitionError> {
        if runs.is_some() && matches!(study.runs, Runs::Rare(_)) {
            return Err(DefinitionError::RunsOfSubset);
        }
        let runs = in_bounds(runs.map_or(study.runs, |runs| with_most(study.runs, runs)))?;
        let variation = &study.variation;
        Ok(Self {
            name: study.name.clone(),
            kind: StudyKind::Study(match runs {
                Runs::Fixed(_) => Stopping::Fixed,
                Runs::Decided { .. } => Stopping::Decided,
                Runs::HalfWidth { half_width, .. } => Stopping::HalfWidth(half_width),
                Runs::Rare(rare) => Stopping::Rare(rare),
            }),
            inputs: variation.inputs.clone(),
            seed: variation.seed,
            sampling: variation.sampling,
            runs,
            // The intervals of a study that chooses its own end are those of its looks.
            confidence: match runs {
                Runs::Fixed(_) | Runs::Rare(_) => study.confidence,
                Runs::Decided { confidence, .. } | Runs::HalfWidth { confidence, .. } => confidence,
            },
            collect: study.collect.clone(),
            index,
            draws: Draws::of_study(variation, runs.at_most())?,
        })
    }

    fn of_fragility(
        fragility: &Fragility,
        index: usize,
        runs: Option<u64>,
    ) -> Result<Self, DefinitionError> {
        let each = runs.unwrap_or(fragility.runs);
        let stripes = &fragility.stripes;
        let all = each.saturating_mul(stripes.len() as u64);
        let variation = fragility.variation.as_ref();
        let others = variation.map_or(&[][..], |variation| &variation.inputs);
        let record = others.iter().position(|input| input.is_record);
        Ok(Self {
            name: fragility.name.clone(),
            kind: StudyKind::Fragility(Stripes {
                intensity: 0,
                values: stripes.clone(),
                runs: each,
                // Behind the intensity.
                record: record.map(|at| at + 1),
            }),
            inputs: std::iter::once(&fragility.intensity)
                .chain(others)
                .cloned()
                .collect(),
            seed: variation.map_or(0, |variation| variation.seed),
            sampling: variation.map_or(Sampling::Random, |variation| variation.sampling),
            runs: in_bounds(Runs::Fixed(all))?,
            confidence: fragility.confidence,
            collect: Vec::new(),
            index,
            draws: Draws::of_fragility(stripes, variation, each)?,
        })
    }
}

/// The same end with this number of runs, at most.
const fn with_most(end: Runs, runs: u64) -> Runs {
    match end {
        Runs::Fixed(_) => Runs::Fixed(runs),
        Runs::Decided { confidence, .. } => Runs::Decided {
            confidence,
            at_most: runs,
        },
        Runs::HalfWidth {
            half_width,
            confidence,
            ..
        } => Runs::HalfWidth {
            half_width,
            confidence,
            at_most: runs,
        },
        Runs::Rare(rare) => Runs::Rare(rare),
    }
}

fn in_bounds(runs: Runs) -> Result<Runs, DefinitionError> {
    match runs.at_most() {
        0 => Err(DefinitionError::NoRuns),
        1..=MOST_RUNS => Ok(runs),
        _ => Err(DefinitionError::TooManyRuns),
    }
}
