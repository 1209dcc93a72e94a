//! `summary.json`, the results for programs: schema `psd.summary/2`, SI, stable order. In: a run.
//! Out: [`Summary`] and its JSON. `grammar/summary.schema.json` is generated from these types.

mod fill;
mod prediction;
mod zero_drift;

use std::collections::BTreeMap;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Serialize;
use serde::ser::SerializeMap as _;

use psd_text::sanitize;

pub(super) use fill::governing;
pub(in crate::report) use prediction::file as prediction_file;
pub use prediction::{
    CHECK_RUN_FILE, PredictedLimit, PredictedProcedure, PredictedRequirement, PredictedZeros,
    Prediction,
};
pub use zero_drift::{AxisZeroDriftSummary, ZeroDriftSummary, ZeroSummary};

/// Name and version of the format; a change that breaks a reader raises the number.
pub const SCHEMA: &str = "psd.summary/2";

/// Results of one run of one plan. Every value is in the SI unit beside it.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Summary {
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// First 16 hex digits of SHA-256 over plan, used files, settings, seed and version.
    pub run_id: String,
    /// Version of psd that ran the plan.
    pub psd: String,
    /// Day of the run: as stated by the plan or the command line, else that of its start (UTC). Null in accepted results.
    pub date: Option<String>,
    pub plan: PlanSummary,
    pub rig: RigSummary,
    /// Null on a virtual rig.
    pub record: Option<RecordSummary>,
    /// Only for a rig with a limit on its zero drift.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zero_drift: Option<ZeroDriftSummary>,
    /// The worst verdict of all requirements, or the end of the run if that is worse; `completed` without requirements.
    #[schemars(extend("enum" = ["completed", "pass", "inconclusive", "fail", "aborted", "error"]))]
    pub verdict: &'static str,
    /// Decision rule of all conditions.
    #[schemars(extend("enum" = ["simple", "guarded"]))]
    pub decision_rule: &'static str,
    /// Status of the report: `issued`, or the most serious reason against a test report.
    #[schemars(extend("enum" = ["issued", "draft", "not issuable", "check run", "simulation"]))]
    pub report_status: &'static str,
    /// Missing statements of a report of a real rig: first on the measurement, then particulars.
    pub missing: Vec<String>,
    pub outcome: OutcomeSummary,
    /// By name, in the order of the run.
    pub procedures: Ordered<ProcedureSummary>,
    /// In the plan's order.
    pub requirements: Vec<RequirementSummary>,
    /// Comparisons with published numbers, in the plan's order; absent without one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub reproductions: Vec<ReproductionSummary>,
    pub events: Vec<EventSummary>,
    /// By name, in the plan's order.
    pub parameters: Ordered<ParameterSummary>,
    /// Deviations from the plan.
    pub deviations: Vec<String>,
    /// Only for a report that was issued or amended after the test.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub issues: Option<IssuesSummary>,
}

/// Issues and amendments of a report after the test.
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
    /// Id of the report from which it was made.
    pub replaces: String,
    pub date: String,
    pub by: String,
    /// Only for an amendment.
    pub reason: Option<String>,
    pub changes: Vec<ChangeSummary>,
}

/// A particular of the plan that an issue states; an empty string means not given.
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
    /// Whether the rig is simulated, so that nothing moved.
    pub simulated: bool,
    /// Seed of a virtual rig's noise.
    pub seed: Option<u64>,
}

/// Data of the run log of a real run: people, machine, extent.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RecordSummary {
    pub operator: Option<String>,
    pub host: Option<String>,
    /// UTC
    pub began: Option<String>,
    /// UTC
    pub ended: Option<String>,
    /// Number of entries; null if the run log could not be written.
    pub records: Option<u64>,
    /// Hash of the last entry, which depends on all others.
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
    /// Whether the procedure ran to its end.
    pub complete: bool,
    /// Values of the inputs of the procedure.
    pub inputs: Ordered<Quantity>,
    pub results: Ordered<Quantity>,
    /// Contributions of the uncertain inputs to each result, by its name; a number of a list has its index, `max_drift[1]`.
    #[serde(skip_serializing_if = "Ordered::is_empty")]
    pub uncertainty_budgets: Ordered<BudgetSummary>,
}

/// Uncertainty budget of a result: u² is the sum of the squares of the contributions.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct BudgetSummary {
    pub unit: String,
    pub u: Option<f64>,
    /// Effective degrees of freedom of u; absent above 10,000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub degrees_of_freedom: Option<f64>,
    /// The largest first.
    pub contributions: Vec<ContributionSummary>,
    /// The effect of the time step, which is not in u; absent if it has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_step: Option<StepSummary>,
}

/// Differences of a result in finer time steps from its value, in the unit of the result.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StepSummary {
    /// In half of the time step.
    pub half: Option<f64>,
    /// In a quarter of the time step.
    pub quarter: Option<f64>,
    /// The smallest difference in any finer steps, at most 0.
    pub lowest: Option<f64>,
    /// The largest difference in any finer steps, at least 0.
    pub highest: Option<f64>,
    /// Whether the steps converge; otherwise the interval is an estimate.
    pub smooth: bool,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ContributionSummary {
    pub input: String,
    /// `linearised`: first-order propagation; `sampled`: Monte Carlo trials.
    #[schemars(extend("enum" = ["linearised", "sampled"]))]
    pub method: &'static str,
    /// Value of the input; null if it has none.
    pub value: Option<f64>,
    /// SI unit of the input; empty for a factor.
    pub input_unit: String,
    /// Standard uncertainty of the input.
    pub input_u: Option<f64>,
    /// Sensitivity coefficient: change of the result over that of the input, in SI units.
    pub sensitivity: Option<f64>,
    /// Change of the result for a change of the input by its standard uncertainty, in the unit of the result.
    pub contribution: Option<f64>,
    /// Degrees of freedom of the contribution; absent if it was not estimated from readings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub degrees_of_freedom: Option<f64>,
    /// Whether the one-sided differences agree; otherwise the contribution is the largest change found.
    pub smooth: bool,
}

/// A value, its SI unit and its standard uncertainty in that unit.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Quantity {
    pub value: Value,
    pub unit: String,
    pub u: Uncertainty,
    /// Effective degrees of freedom of u, one per entry of a list; absent above 10,000.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub degrees_of_freedom: Option<Uncertainty>,
    /// Coverage factor of U = k·u for about 95 % coverage; 2 if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k: Option<Uncertainty>,
}

/// Standard uncertainty of a number, or of each entry of a list; null if not evaluated.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Uncertainty {
    Number(Option<f64>),
    List(Vec<Option<f64>>),
}

/// A number, a whole number for a count, or a list in one unit; null if the run has no such result.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Value {
    Count(u64),
    Number(Option<f64>),
    List(Vec<Option<f64>>),
}

/// A requirement with the numbers of its governing condition: the first of the worst ones.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RequirementSummary {
    pub name: String,
    #[schemars(extend("enum" = ["pass", "inconclusive", "fail", "aborted", "error"]))]
    pub verdict: &'static str,
    pub value: Option<f64>,
    /// Limit with which the value was compared; for `within` the target.
    pub limit: Option<f64>,
    /// Distance inside the limit; negative outside.
    pub margin: Option<f64>,
    pub unit: Option<String>,
    /// Standard uncertainty of the value.
    pub u: Option<f64>,
    /// Guard band w = U = k·u of the margin under the guarded rule; null under the simple rule or without uncertainty.
    pub guard_band: Option<f64>,
    /// Text of the condition in the plan.
    pub condition: Option<String>,
    /// Every condition of the requirement.
    pub conditions: Vec<ConditionSummary>,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ConditionSummary {
    /// Text of the condition in the plan.
    pub condition: String,
    #[schemars(extend("enum" = ["pass", "inconclusive", "fail", "aborted", "error"]))]
    pub verdict: &'static str,
    pub value: Option<f64>,
    pub limit: Option<f64>,
    /// Absolute tolerance of `within`.
    pub tolerance: Option<f64>,
    pub margin: Option<f64>,
    pub unit: String,
    pub u: Option<f64>,
    /// Coverage factor of U = k·u of the value for about 95 % coverage; 2 if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k: Option<f64>,
    /// Guard band w = U = k·u of the margin under the guarded rule; null under the simple rule or without uncertainty.
    pub guard_band: Option<f64>,
    /// Probability that the item conforms, the smallest in any finer time steps; null without U.
    pub conforms: Option<f64>,
    /// The smallest and the largest value in any finer time steps; absent if the time step has no effect on it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub in_finer_steps: Option<[f64; 2]>,
    /// Reason if inconclusive.
    pub reason: Option<String>,
}

/// A number of the run beside a published one. It does not change the verdict.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ReproductionSummary {
    pub name: String,
    /// The publication.
    pub source: String,
    #[schemars(extend("enum" = ["reproduces", "does not reproduce"]))]
    pub statement: &'static str,
    pub value: Option<f64>,
    pub published: Option<f64>,
    /// Largest difference.
    pub tolerance: Option<f64>,
    /// Value minus published number.
    pub difference: Option<f64>,
    /// The difference over the size of the published number; null if that is 0.
    pub relative_difference: Option<f64>,
    pub unit: String,
    /// Standard uncertainty of the value.
    pub u: Option<f64>,
    /// Reason why the values cannot be compared.
    pub reason: Option<String>,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct EventSummary {
    /// Rig time, s.
    pub wall_time_s: Option<f64>,
    pub procedure: Option<String>,
    pub step: Option<u64>,
    #[schemars(extend("enum" = ["note", "inspection", "limit breach", "hold", "held", "not confirmed held", "fault", "recovered", "observation", "resume", "amendment"]))]
    pub kind: &'static str,
    pub text: String,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ParameterSummary {
    pub value: Option<f64>,
    pub unit: String,
    /// Whether it was set on the command line.
    pub set: bool,
}

/// A JSON object whose keys keep their order.
#[derive(Clone, Debug)]
pub struct Ordered<T>(pub Vec<(String, T)>);

impl<T> Ordered<T> {
    const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

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
    /// The JSON Schema of `psd.summary/2`, as committed in `grammar/summary.schema.json`.
    #[must_use]
    pub fn json_schema() -> String {
        // As written, not as read: every field is always there, null where it has no value.
        let generator = SchemaSettings::draft2020_12()
            .for_serialize()
            .into_generator();
        sanitize::json_file(&generator.into_root_schema_for::<Self>())
    }
}

/// None for NaN and infinity, which JSON cannot hold.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
