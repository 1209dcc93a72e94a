//! What a rehearsal foretells of the whole run, as data. In: how far a run on the virtual specimen went. Out: `rehearsal.json`, and the
//! page of the report is set from the same. SI throughout; a bound or a reach that there is not is null.

use serde::Serialize;

use super::OutputFile;
use crate::text::sanitize;

/// Its name in the run folder.
pub const REHEARSAL_FILE: &str = "rehearsal.json";

/// Name and version of the format.
const SCHEMA: &str = "psd.rehearsal/1";

/// How the whole run would go.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Prediction {
    /// What it was predicted on, in words.
    pub model: String,
    /// What would end the run early, and where; None: it would come to its end.
    pub stopped: Option<String>,
    pub procedures: Vec<PredictedProcedure>,
    pub limits: Vec<PredictedLimit>,
    pub requirements: Vec<PredictedRequirement>,
    /// Of a rig that says how far its zeros may drift.
    pub zeros: Option<PredictedZeros>,
}

/// When the zeros of the rig would be read, and the drift that leaves room for.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PredictedZeros {
    pub allowed_force_n: f64,
    /// None: told, and not judged.
    pub allowed_displacement_m: Option<f64>,
    /// Time over which a zero is read; a hold as long tells a slope.
    pub over_s: f64,
    /// `start`, `free` or `nowhere`.
    pub after: &'static str,
    /// Holds that are long enough, and the longest of them.
    pub holds: u64,
    pub longest_hold_s: Option<f64>,
    /// From the zeros before to those after; None: they are not read again.
    pub between_s: Option<f64>,
    /// A steady drift up to this size is within what is allowed.
    pub steady_force_n_per_s: f64,
}

/// What one procedure would ask of the rig.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PredictedProcedure {
    pub name: String,
    pub kind: String,
    pub steps: u64,
    pub rig_time_s: f64,
    /// Lowest and highest, measured or asked for; None where nothing moves.
    pub displacement_m: Option<[f64; 2]>,
    pub force_n: Option<[f64; 2]>,
    pub speed_m_per_s: Option<f64>,
    pub increment_m: Option<f64>,
}

/// A limit of the run, and how near the run would come.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PredictedLimit {
    pub quantity: String,
    pub unit: String,
    pub low: Option<f64>,
    pub high: Option<f64>,
    pub reached: Option<[f64; 2]>,
    /// What is left to the nearer end; negative: past it.
    pub margin: Option<f64>,
}

/// A requirement, as the predicted run would meet it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PredictedRequirement {
    pub name: String,
    pub verdict: &'static str,
}

/// The file.
pub(super) fn file(prediction: &Prediction) -> Result<OutputFile, serde_json::Error> {
    #[derive(Serialize)]
    struct File<'a> {
        schema: &'static str,
        #[serde(flatten)]
        prediction: &'a Prediction,
    }
    let text = serde_json::to_string_pretty(&File {
        schema: SCHEMA,
        prediction,
    })? + "\n";
    Ok(OutputFile {
        path: REHEARSAL_FILE.to_owned(),
        bytes: sanitize::json(&text).into_bytes(),
    })
}
