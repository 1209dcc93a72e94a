//! `summary.json`, the results for programs: schema `psd.summary/1`, SI, stable order. In: a run.
//! Out: [`Summary`] and its JSON. `grammar/summary.schema.json` is generated from these types.

mod fill;
mod prediction;
mod zero_drift;

use std::collections::BTreeMap;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Serialize;
use serde::ser::SerializeMap as _;

use crate::text::sanitize;

pub(super) use fill::governing;
pub(in crate::report) use prediction::file as prediction_file;
pub use prediction::{
    CHECK_RUN_FILE, PredictedLimit, PredictedProcedure, PredictedRequirement, PredictedZeros,
    Prediction,
};
pub use zero_drift::{AxisZeroDriftSummary, ZeroDriftSummary, ZeroSummary};

/// Name and version of the format; a change that breaks a reader raises the number.
pub const SCHEMA: &str = "psd.summary/1";

/// Results of one run of one plan. Every value is in the SI unit beside it.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Summary {
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// First 16 hex digits of SHA-256 over plan, used files, settings, seed and version.
    pub run_id: String,
    /// Version of psd that ran the plan.
    pub psd: String,
    /// From the plan or the command line.
    pub date: Option<String>,
    pub plan: PlanSummary,
    pub rig: RigSummary,
    /// Null on a virtual rig.
    pub record: Option<RecordSummary>,
    /// Only of a rig that says how far its zeros may drift.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zero_drift: Option<ZeroDriftSummary>,
    /// The worst of all requirements, or how the run ended if that is worse; `completed` where nothing is required.
    #[schemars(extend("enum" = ["completed", "pass", "inconclusive", "fail", "aborted", "error"]))]
    pub verdict: &'static str,
    /// By which every condition was decided.
    #[schemars(extend("enum" = ["simple", "guarded"]))]
    pub decision_rule: &'static str,
    /// What the report may be taken for: its gravest ground against a test report.
    #[schemars(extend("enum" = ["certifiable", "check run", "simulation", "incomplete", "not certifiable", "particulars missing"]))]
    #[serde(rename = "standing")]
    pub report_status: &'static str,
    /// What the report of a real rig must state and does not: of how it was measured, then particulars.
    pub missing: Vec<String>,
    pub outcome: OutcomeSummary,
    /// By name, in the order run.
    pub procedures: Ordered<ProcedureSummary>,
    /// In the plan's order.
    pub requirements: Vec<RequirementSummary>,
    pub events: Vec<EventSummary>,
    /// By name, in the plan's order.
    pub parameters: Ordered<ParameterSummary>,
    /// What departed from the plan as written.
    pub deviations: Vec<String>,
    /// Only of a report that was issued or amended after the test.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub issues: Option<IssuesSummary>,
}

/// What was stated of a report after the test.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct IssuesSummary {
    /// Id of this report.
    pub report_id: String,
    /// Every issue up to this report, in order.
    pub issues: Vec<IssueSummary>,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct IssueSummary {
    #[schemars(extend("enum" = ["issue", "amendment"]))]
    pub kind: &'static str,
    /// Id of the report that it is made from.
    pub replaces: String,
    /// Null of an amendment by an older version.
    pub date: Option<String>,
    pub by: String,
    /// Of an amendment.
    pub reason: Option<String>,
    pub changes: Vec<ChangeSummary>,
}

/// A particular of the plan that an issue states; empty: not given.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ChangeSummary {
    pub field: &'static str,
    pub was: String,
    pub is: String,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PlanSummary {
    pub title: String,
    /// SHA-256 of the plan's text, hex.
    pub sha256: String,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RigSummary {
    pub name: String,
    pub model: String,
    pub serial: String,
    pub firmware: String,
    /// Nothing real moved.
    pub simulated: bool,
    /// Seed of a virtual rig's noise.
    pub seed: Option<u64>,
}

/// What the record of a real run says of people and place, and of itself.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RecordSummary {
    pub operator: Option<String>,
    pub host: Option<String>,
    /// UTC
    pub began: Option<String>,
    /// UTC
    pub ended: Option<String>,
    /// Number of records; null where the record could not be kept.
    pub records: Option<u64>,
    /// Hash of the last record, which all others lead to.
    pub head: Option<String>,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct OutcomeSummary {
    #[schemars(extend("enum" = ["completed", "aborted", "blocked", "faulted"]))]
    pub kind: &'static str,
    pub reason: Option<String>,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ProcedureSummary {
    /// The block's keyword, such as `impact`.
    pub kind: &'static str,
    /// Whether it ran to its own end.
    pub complete: bool,
    /// Values the procedure was run with.
    pub inputs: Ordered<Quantity>,
    pub results: Ordered<Quantity>,
    /// Of each result that uncertain inputs enter, what they contribute, largest first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub uncertainty_budgets: Vec<BudgetSummary>,
}

/// What the standard uncertainty of a result is made of: u² is the sum of the squares of the contributions.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct BudgetSummary {
    pub result: &'static str,
    /// Which entry of a list it is of, from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub entry: Option<usize>,
    pub unit: String,
    pub u: Option<f64>,
    /// Effective degrees of freedom of u; absent where they are more than 10,000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub degrees_of_freedom: Option<f64>,
    pub contributions: Vec<ContributionSummary>,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ContributionSummary {
    pub input: String,
    /// `sampled` where errors were drawn.
    #[schemars(extend("enum" = ["linearised", "sampled"]))]
    pub method: &'static str,
    /// Of the input; null where it has none of its own.
    pub value: Option<f64>,
    /// SI unit of the input; of a factor, none.
    pub input_unit: String,
    /// Standard uncertainty of the input.
    pub input_u: Option<f64>,
    /// Change of the result over that of the input, both in SI units.
    pub sensitivity: Option<f64>,
    /// Change of the result when the input moves by its standard uncertainty, in the unit of the result.
    pub contribution: Option<f64>,
    /// By which the size of the contribution is known; absent of what was not estimated from readings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub degrees_of_freedom: Option<f64>,
    /// Whether the result follows the input smoothly; where not, the contribution is the largest change seen.
    pub smooth: bool,
}

/// A value, its SI unit and its standard uncertainty in that unit.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Quantity {
    pub value: Value,
    pub unit: String,
    pub u: Uncertainty,
    /// Effective degrees of freedom of u, of a list entry by entry; absent where they are more than 10,000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub degrees_of_freedom: Option<Uncertainty>,
    /// The factor of the expanded uncertainty U = k·u, which holds about 95 %; 2 where it is absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k: Option<Uncertainty>,
}

/// The standard uncertainty of a number, or of each entry of a list; null where none is known.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Uncertainty {
    Number(Option<f64>),
    List(Vec<Option<f64>>),
}

/// A number, null where the result does not exist in this run, a count as a whole number, or a list in one unit.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Value {
    Count(u64),
    Number(Option<f64>),
    List(Vec<Option<f64>>),
}

/// A requirement with the numbers of the condition that decides it: the worst, and of equal ones the first.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RequirementSummary {
    pub name: String,
    #[schemars(extend("enum" = ["pass", "inconclusive", "fail", "aborted", "error"]))]
    pub verdict: &'static str,
    pub value: Option<f64>,
    /// What the value was held against; the target of `within`.
    pub limit: Option<f64>,
    /// Distance inside the bound; negative: missed by so much.
    pub margin: Option<f64>,
    pub unit: Option<String>,
    /// Standard uncertainty of the value.
    pub u: Option<f64>,
    /// w = U = k·u of the margin under the guarded rule; null under the simple one, and where no uncertainty is known.
    pub guard_band: Option<f64>,
    /// As the plan wrote it.
    pub condition: Option<String>,
    /// Every condition of the requirement.
    pub conditions: Vec<ConditionSummary>,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ConditionSummary {
    /// As the plan wrote it.
    pub condition: String,
    #[schemars(extend("enum" = ["pass", "inconclusive", "fail", "aborted", "error"]))]
    pub verdict: &'static str,
    pub value: Option<f64>,
    pub limit: Option<f64>,
    /// Of `within`, absolute.
    pub tolerance: Option<f64>,
    pub margin: Option<f64>,
    pub unit: String,
    pub u: Option<f64>,
    /// The factor of the expanded uncertainty U = k·u of the value, which holds about 95 %; 2 where it is absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k: Option<f64>,
    /// w = U = k·u of the margin under the guarded rule; null under the simple one, and where no uncertainty is known.
    pub guard_band: Option<f64>,
    /// Probability that what was measured conforms; null where its uncertainty is not known.
    pub conforms: Option<f64>,
    /// Why it is inconclusive.
    pub reason: Option<String>,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct EventSummary {
    /// Rig time, s.
    pub wall_time_s: Option<f64>,
    pub procedure: Option<String>,
    pub step: Option<u64>,
    #[schemars(extend("enum" = ["note", "inspection", "limit breach", "hold", "fault", "remark", "resume", "amendment"]))]
    pub kind: &'static str,
    pub text: String,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ParameterSummary {
    pub value: Option<f64>,
    pub unit: String,
    /// Whether the command line gave it.
    pub set: bool,
}

/// A JSON object whose keys keep their order.
#[derive(Clone, Debug)]
pub struct Ordered<T>(pub Vec<(String, T)>);

impl<T: Serialize> Serialize for Ordered<T> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

impl<T: JsonSchema> JsonSchema for Ordered<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        format!("Ordered_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        BTreeMap::<String, T>::json_schema(generator)
    }
}

impl Summary {
    /// Indented JSON with a newline at its end; floats are the shortest that read back the same.
    ///
    /// # Errors
    /// Never in practice: every value is a plain number or text.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self).map(|json| sanitize::json(&json) + "\n")
    }

    /// The JSON Schema of `psd.summary/1`, as committed in `grammar/summary.schema.json`.
    ///
    /// # Errors
    /// Never in practice.
    pub fn json_schema() -> Result<String, serde_json::Error> {
        // As written, not as read: every field is always there, null where it has no value.
        let generator = SchemaSettings::draft2020_12()
            .for_serialize()
            .into_generator();
        serde_json::to_string_pretty(&generator.into_root_schema_for::<Self>())
            .map(|json| json + "\n")
    }
}

/// None for NaN and infinity, which JSON cannot hold.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
