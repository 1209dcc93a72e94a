//! Summaries of older versions. In: the text of a `summary.json`. Out: the same with the present names.

use crate::plan::ProcedureBlock;
use crate::plan::procedures::escalate::block as escalate;
use crate::schema::{self, Kind, NameRole, RENAMED};
use serde_json::{Map, Value};

/// Results of runs without unloading: old and present names. A plan has them under either name, by the kind of its procedure.
const AT_THE_LAST_STEP: [(&str, &str); 2] = [
    (
        escalate::RESIDUAL_DISPLACEMENT.name,
        escalate::FINAL_DISPLACEMENT.name,
    ),
    (escalate::RESIDUAL_DRIFT.name, escalate::FINAL_DRIFT.name),
];

/// Keys of the summary itself.
const KEYS: [(&str, &str); 2] = [("drift", "zero_drift"), ("standing", "report_status")];

/// Names of the status of a report.
const STATUS: [(&str, &str); 3] = [
    ("rehearsal", "simulation"),
    ("certifiable", "issued"),
    ("not certifiable", "not issuable"),
];

/// Kinds of events.
const EVENTS: [(&str, &str); 2] = [("mended", "recovered"), ("remark", "observation")];

/// Reads a summary. Its results have their present names, whichever version wrote them.
///
/// # Errors
/// If the text is not JSON.
pub fn summary(text: &str) -> Result<Value, serde_json::Error> {
    let mut summary: Value = serde_json::from_str(text)?;
    for (was, is) in KEYS {
        if let Some(keys) = summary.as_object_mut()
            && let Some(value) = keys.remove(was)
        {
            keys.insert(is.to_owned(), value);
        }
    }
    for (was, is) in STATUS {
        if summary["report_status"] == was {
            summary["report_status"] = is.into();
        }
    }
    let events = summary.get_mut("events").and_then(Value::as_array_mut);
    for event in events.into_iter().flatten() {
        for (was, is) in EVENTS {
            if event["kind"] == was {
                event["kind"] = is.into();
            }
        }
    }
    let procedures = summary.get_mut("procedures").and_then(Value::as_object_mut);
    for procedure in procedures.into_iter().flat_map(Map::values_mut) {
        for (was, is) in changed(procedure["kind"].as_str().unwrap_or_default()) {
            rename(procedure, was, is);
        }
    }
    Ok(summary)
}

/// Old and present names of the results of a procedure.
fn changed(kind: &str) -> Vec<(&'static str, &'static str)> {
    let words: Vec<&str> = kind.split(' ').collect();
    let Some(kind) = schema::block_of_words(&words).map(|block| block.kind) else {
        return Vec::new();
    };
    let last = AT_THE_LAST_STEP.into_iter().filter(|_| {
        matches!(
            kind,
            Kind::Procedure(ProcedureBlock::Impact | ProcedureBlock::Shake)
        )
    });
    let results = RENAMED
        .iter()
        .filter(|row| matches!(row.role, NameRole::Result(kinds) if kinds.contains(&kind)))
        .map(|row| (row.old, row.new));
    last.chain(results).collect()
}

/// Versions before the verdict `completed` wrote `pass` if there were no requirements.
pub(super) fn completed(mut was: Value) -> Value {
    let nothing_required = was["requirements"].as_array().is_some_and(Vec::is_empty);
    if nothing_required && was["verdict"] == "pass" {
        was["verdict"] = "completed".into();
    }
    was
}

/// Renames one result. A result that is the uncertainty of another now is dropped: the other has it.
fn rename(procedure: &mut Value, was: &str, is: &str) {
    if let Some(results) = procedure.get_mut("results").and_then(Value::as_object_mut)
        && let Some(result) = results.remove(was)
        && !is.contains('.')
    {
        results.insert(is.to_owned(), result);
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_result_of_an_older_version_is_read_under_its_present_name() {
        for row in RENAMED {
            let NameRole::Result(kinds) = row.role else {
                continue;
            };
            for kind in kinds {
                let of = |result: &str| json!({ "procedures": { "one": { "kind": schema::block(*kind).words(), "results": { result: 2 } } } });
                let read = summary(&of(row.old).to_string()).unwrap();
                let present = if row.new.contains('.') {
                    json!({})
                } else {
                    json!({ row.new: 2 })
                };
                assert_eq!(read["procedures"]["one"]["results"], present, "{}", row.old);
            }
        }
    }

    #[test]
    fn the_status_of_an_older_report_is_read_under_its_present_name() {
        for (was, is) in STATUS {
            let read = summary(&json!({ "standing": was }).to_string()).unwrap();
            assert_eq!(read, json!({ "report_status": is }));
        }
    }

    #[test]
    fn what_was_called_residual_at_the_last_step_is_read_as_final() {
        let of = |kind: &str, result: &str| json!({ "procedures": { "one": { "kind": kind, "results": { "max_drift": 1, result: 2 } } } });
        for (kind, was, is) in [
            ("impact", "residual_displacement", "final_displacement"),
            ("impact", "residual_drift", "final_drift"),
            ("shake", "residual_drift", "final_drift"),
            ("impact", "final_drift", "final_drift"),
            ("unload", "residual_drift", "residual_drift"),
            ("escalate", "residual_displacement", "residual_displacement"),
        ] {
            assert_eq!(
                summary(&of(kind, was).to_string()).unwrap(),
                of(kind, is),
                "{kind}: {was}"
            );
        }
        assert!(summary("{").is_err());
        assert_eq!(summary("[1]").unwrap(), json!([1]));
    }
}
