//! `summary.json`, the results for machines: schema `psd.summary/1`, SI, order stable. In: a run. Out: [`Summary`] and
//! its JSON. The committed `grammar/summary.schema.json` is generated from these types.

use std::collections::BTreeMap;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Serialize;
use serde::ser::SerializeMap as _;

use super::{Run, deviations};
use crate::formula::{Estimate, ResultValue};
use crate::plan::Link;
use crate::quantity::Dimension;
use crate::quantity::display::si_unit;
use crate::record::{EventKind, Outcome, ProcedureRecord};
use crate::verdict::{Bound, ConditionOutcome, RequirementOutcome};

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
    /// The worst of all requirements, or how the run ended if that is worse.
    #[schemars(extend("enum" = ["pass", "inconclusive", "fail", "aborted", "error"]))]
    pub verdict: &'static str,
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

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct OutcomeSummary {
    #[schemars(extend("enum" = ["completed", "aborted", "faulted"]))]
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
}

/// A value, its SI unit and its standard uncertainty in that unit.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Quantity {
    pub value: Value,
    pub unit: String,
    pub u: Option<f64>,
}

/// A number, null where the result does not exist in this run, or a list in one unit.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Value {
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
    /// Why it is inconclusive.
    pub reason: Option<String>,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct EventSummary {
    /// Rig time, s.
    pub wall_time_s: Option<f64>,
    pub procedure: Option<String>,
    pub step: Option<u64>,
    #[schemars(extend("enum" = ["note", "inspection", "limit breach", "hold", "fault", "remark"]))]
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
    /// The summary of a run.
    #[must_use]
    pub fn of(run: &Run<'_>) -> Self {
        let Run { plan, record, assessment, provenance } = run;
        let Link::Virtual(link) = &plan.rig.link;
        let (kind, reason) = match &record.outcome {
            Outcome::Completed => ("completed", None),
            Outcome::Aborted { reason } => ("aborted", Some(reason.clone())),
            Outcome::Faulted { reason } => ("faulted", Some(reason.clone())),
        };
        Self {
            schema: SCHEMA,
            run_id: provenance.run_id.clone(),
            psd: provenance.psd_version.clone(),
            date: provenance.date.clone(),
            plan: PlanSummary { title: plan.title.clone(), sha256: provenance.plan_sha256.clone() },
            rig: RigSummary {
                name: record.rig.name.clone(),
                model: record.rig.model.clone(),
                serial: record.rig.serial.clone(),
                firmware: record.rig.firmware.clone(),
                simulated: record.rig.simulated,
                seed: record.rig.simulated.then_some(link.seed),
            },
            verdict: assessment.verdict.name(),
            outcome: OutcomeSummary { kind, reason },
            procedures: Ordered(record.procedures.iter().map(|p| (p.name.clone(), procedure(p))).collect()),
            requirements: assessment.requirements.iter().map(requirement).collect(),
            events: record
                .events
                .iter()
                .map(|event| EventSummary {
                    wall_time_s: finite(event.time),
                    procedure: event.procedure.clone(),
                    step: event.step,
                    kind: event_kind(event.kind),
                    text: event.text.clone(),
                })
                .collect(),
            parameters: Ordered(
                plan.parameters
                    .iter()
                    .map(|p| {
                        (p.name.clone(), ParameterSummary { value: finite(p.value), unit: si_unit(p.dimension), set: p.set })
                    })
                    .collect(),
            ),
            deviations: deviations::of(run),
        }
    }

    /// Indented JSON with a newline at its end; floats are the shortest that read back the same.
    ///
    /// # Errors
    /// Never in practice: every value is a plain number or text.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self).map(|json| json + "\n")
    }

    /// The JSON Schema of `psd.summary/1`, as committed in `grammar/summary.schema.json`.
    ///
    /// # Errors
    /// Never in practice.
    pub fn json_schema() -> Result<String, serde_json::Error> {
        // As written, not as read: every field is always there, null where it has no value.
        let generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
        serde_json::to_string_pretty(&generator.into_root_schema_for::<Self>()).map(|json| json + "\n")
    }
}

/// The word of an event kind in the summary and the certificate.
pub(super) const fn event_kind(kind: EventKind) -> &'static str {
    match kind {
        EventKind::Note => "note",
        EventKind::Inspection => "inspection",
        EventKind::LimitBreach => "limit breach",
        EventKind::Hold => "hold",
        EventKind::Fault => "fault",
        EventKind::Remark => "remark",
    }
}

/// The condition that decides a requirement: the worst, and of equal ones the first.
pub(super) fn governing(requirement: &RequirementOutcome) -> Option<&ConditionOutcome> {
    let worst = requirement.conditions.iter().map(|condition| condition.verdict).max()?;
    requirement.conditions.iter().find(|condition| condition.verdict == worst)
}

fn procedure(procedure: &ProcedureRecord) -> ProcedureSummary {
    let input = |(name, estimate, dimension): &(&'static str, Estimate, Dimension)| {
        let value = ResultValue::Number { value: Some(estimate.value), uncertainty: estimate.uncertainty };
        ((*name).to_owned(), quantity(&value, *dimension))
    };
    ProcedureSummary {
        kind: procedure.kind,
        complete: procedure.complete,
        inputs: Ordered(procedure.inputs.iter().map(input).collect()),
        results: Ordered(procedure.results.iter().map(|r| (r.name.to_owned(), quantity(&r.value, r.dimension))).collect()),
    }
}

fn quantity(value: &ResultValue, dimension: Dimension) -> Quantity {
    let (value, u) = match value {
        ResultValue::Number { value, uncertainty } => (Value::Number(value.and_then(finite)), uncertainty.and_then(finite)),
        ResultValue::List(values) => (Value::List(values.iter().map(|value| finite(*value)).collect()), None),
    };
    Quantity { value, unit: si_unit(dimension), u }
}

fn requirement(requirement: &RequirementOutcome) -> RequirementSummary {
    let conditions: Vec<ConditionSummary> = requirement.conditions.iter().map(condition).collect();
    let deciding = governing(requirement).map(condition);
    RequirementSummary {
        name: requirement.label.clone(),
        verdict: requirement.verdict.name(),
        value: deciding.as_ref().and_then(|c| c.value),
        limit: deciding.as_ref().and_then(|c| c.limit),
        margin: deciding.as_ref().and_then(|c| c.margin),
        unit: deciding.as_ref().map(|c| c.unit.clone()),
        u: deciding.as_ref().and_then(|c| c.u),
        condition: deciding.map(|c| c.condition),
        conditions,
    }
}

fn condition(outcome: &ConditionOutcome) -> ConditionSummary {
    let (limit, tolerance) = match outcome.bound {
        None => (None, None),
        Some(Bound::Compare { limit, .. }) => (finite(limit), None),
        Some(Bound::Within { target, tolerance }) => (finite(target), finite(tolerance)),
    };
    ConditionSummary {
        condition: outcome.text.clone(),
        verdict: outcome.verdict.name(),
        value: outcome.value.and_then(finite),
        limit,
        tolerance,
        margin: outcome.margin.and_then(finite),
        unit: si_unit(outcome.dimension),
        u: outcome.uncertainty.and_then(finite),
        reason: outcome.reason.clone(),
    }
}

/// JSON has no NaN and no infinity: such a value does not exist.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
