//! Summaries of older versions. In: the text of a `summary.json`. Out: the same with the present names.

use serde_json::{Map, Value};

/// Results of runs without unloading: old and present names.
const RENAMED: [(&str, &str); 2] = [
    ("residual_displacement", "final_displacement"),
    ("residual_drift", "final_drift"),
];

/// Reads a summary. Its results at the last step of a run are called final, whichever version wrote them.
///
/// # Errors
/// If the text is not JSON.
pub fn summary(text: &str) -> Result<Value, serde_json::Error> {
    let mut summary: Value = serde_json::from_str(text)?;
    let procedures = summary.get_mut("procedures").and_then(Value::as_object_mut);
    for procedure in procedures.into_iter().flat_map(Map::values_mut) {
        if matches!(procedure["kind"].as_str(), Some("impact" | "shake")) {
            rename(procedure);
        }
    }
    Ok(summary)
}

/// Versions before the verdict `completed` wrote `pass` if there were no requirements.
pub(super) fn completed(mut was: Value) -> Value {
    let nothing_required = was["requirements"].as_array().is_some_and(Vec::is_empty);
    if nothing_required && was["verdict"] == "pass" {
        was["verdict"] = "completed".into();
    }
    was
}

fn rename(procedure: &mut Value) {
    for (was, is) in RENAMED {
        if let Some(results) = procedure.get_mut("results").and_then(Value::as_object_mut)
            && let Some(result) = results.remove(was)
        {
            results.insert(is.to_owned(), result);
        }
        let budgets = procedure
            .get_mut("uncertainty_budgets")
            .and_then(Value::as_array_mut);
        for name in budgets
            .into_iter()
            .flatten()
            .filter_map(|budget| budget.get_mut("result"))
            .filter(|name| *name == was)
        {
            *name = Value::from(is);
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn what_was_called_residual_at_the_last_step_is_read_as_final() {
        let of = |kind: &str, result: &str| {
            json!({ "procedures": { "one": { "kind": kind, "results": { "max_drift": 1, result: 2 },
                "uncertainty_budgets": [{ "result": result }, { "result": "max_drift" }] } } })
        };
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
