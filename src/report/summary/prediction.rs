//! The prediction of the whole run by a check run, as data. In: a run on the virtual specimen. Out: `check_run.json`; the section
//! of the report prints the same data. SI; a limit or a range that does not exist is null.

use serde::Serialize;

use crate::report::output::file::OutputFile;
use psd_text::sanitize;

/// Name of the file in the run folder.
pub const CHECK_RUN_FILE: &str = "check_run.json";

/// Name and version of the format.
const SCHEMA: &str = "psd.check_run/1";

/// The predicted course of the whole run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Prediction {
    /// Description of the model.
    pub model: String,
    /// Reason and position of a predicted stop; None where the run would come to its end.
    pub stopped: Option<String>,
    pub procedures: Vec<PredictedProcedure>,
    pub limits: Vec<PredictedLimit>,
    pub requirements: Vec<PredictedRequirement>,
    /// Only for a rig with an allowed zero drift.
    pub zeros: Option<PredictedZeros>,
}

/// Times of the predicted zero readings, and the drift that they allow.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PredictedZeros {
    pub allowed_force_n: f64,
    /// None: reported, not assessed.
    pub allowed_displacement_m: Option<f64>,
    /// Duration of a zero reading; a hold of this length gives a slope.
    pub over_s: f64,
    /// `start`, `free` or `nowhere`.
    pub after: &'static str,
    /// Number of holds that are long enough.
    pub holds: u64,
    pub longest_hold_s: Option<f64>,
    /// Time between the zero readings before and after; None where they are not read again.
    pub between_s: Option<f64>,
    /// Largest steady drift that is allowed.
    pub steady_force_n_per_s: f64,
}

/// The predicted demand of one procedure on the rig.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PredictedProcedure {
    pub name: String,
    pub kind: String,
    pub steps: u64,
    pub rig_time_s: f64,
    /// Lowest and highest measured or commanded value; None where nothing moves.
    pub displacement_m: Option<[f64; 2]>,
    pub force_n: Option<[f64; 2]>,
    pub speed_m_per_s: Option<f64>,
    pub increment_m: Option<f64>,
}

/// A limit of the run, and the predicted range.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PredictedLimit {
    pub quantity: String,
    pub unit: String,
    pub low: Option<f64>,
    pub high: Option<f64>,
    pub reached: Option<[f64; 2]>,
    /// Distance to the nearer end; negative beyond it.
    pub margin: Option<f64>,
}

/// The predicted verdict on a requirement.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PredictedRequirement {
    pub name: String,
    pub verdict: &'static str,
}

/// The file.
pub(in crate::report) fn file(prediction: &Prediction) -> OutputFile {
    #[derive(Serialize)]
    struct File<'a> {
        schema: &'static str,
        #[serde(flatten)]
        prediction: &'a Prediction,
    }
    let text = sanitize::json_file(&File {
        schema: SCHEMA,
        prediction,
    });
    OutputFile {
        path: CHECK_RUN_FILE.to_owned(),
        bytes: text.into_bytes(),
    }
}
