//! A test report for machines: schema `psd.test/1`, SI, every difference. In: the report. Out: a JSON value.

use serde_json::{Value, json};

use crate::golden::finding::{Change, Finding, Moved, RowRef};
use crate::golden::tested::{Outcome, Report};
use psd_text::sanitize;
use psd_text::units::display::si_unit;

/// Name and version of the format; an incompatible change increases the number.
pub const SCHEMA: &str = "psd.test/1";

/// The document.
#[must_use]
pub fn document(report: &Report) -> Value {
    let plans: Vec<Value> = report
        .tested
        .iter()
        .map(|tested| {
            let verdict = if let Outcome::Same { verdict } = &tested.outcome {
                *verdict
            } else {
                None
            };
            json!({
                "plan": tested.name,
                "folder": tested.folder,
                "outcome": tested.outcome.name(),
                "good": tested.outcome.is_good(),
                "verdict": verdict,
                "message": tested.complaint(),
                "differences": tested.outcome.findings().iter().map(finding).collect::<Vec<_>>(),
            })
        })
        .collect();
    let failed = report.tested.len() - report.good();
    json!({ "schema": SCHEMA, "plans": plans, "good": report.good(), "failed": failed, "unused": report.unused })
}

/// The printed document: indented, and without control sequences from the text of a plan.
#[must_use]
pub fn comparison_as_json(report: &Report) -> String {
    sanitize::json(&format!("{:#}\n", document(report)))
}

/// One difference.
#[must_use]
pub fn finding(finding: &Finding) -> Value {
    let mut value = json!({ "part": finding.part.name(), "name": finding.name });
    let more = match &finding.change {
        Change::Moved(moved) => number(moved),
        Change::Text { was, is, first } => {
            let first_row = first.as_ref().map(|(at, _)| row_json(*at));
            json!({ "kind": "text", "was": was, "is": is, "first": first_row, "rows": first.as_ref().map(|(_, count)| count.moved) })
        }
        Change::Missing => json!({ "kind": "gone" }),
        Change::New => json!({ "kind": "new" }),
        Change::Length { of, was, is } => {
            json!({ "kind": "length", "of": of, "was": was, "is": is })
        }
    };
    if let (Some(object), Value::Object(more)) = (value.as_object_mut(), more) {
        object.extend(more);
    }
    value
}

fn number(moved: &Moved) -> Value {
    json!({
        "kind": "moved",
        "was": moved.was,
        "is": moved.is,
        "by": moved.by(),
        "by_fraction": moved.by_fraction(),
        "unit": si_unit(moved.dimension),
        "allowed": moved.rule.bound(moved.scale),
        "first": moved.first.map(row_json),
        "largest": moved.largest.map(row_json),
        "rows": moved.count.map(|count| count.moved),
        "rows_compared": moved.count.map(|count| count.of),
    })
}

fn row_json(at: RowRef) -> Value {
    json!({ "row": at.row, "step": at.step, "time_s": at.time })
}
