//! Comparison of two `summary.json`. Every value in an object with a `unit` is a number of that unit. The general tolerance applies to
//! every other number, and texts must be identical. Data that identify the run and not its results are left out.

use serde_json::{Map, Value};

use super::finding::{Change, Finding, Part};
use super::tolerance::{Rule, Tolerances};
use super::{number, older};
use crate::units::{Dimension, unit};

/// Fields that identify the run, the program, the day and the machine.
const NOT_COMPARED: &[&str] = &[
    "run_id",
    "psd",
    "plan.sha256",
    "rig.firmware",
    "rig.serial",
    "record",
];

/// A requirement repeats the condition that decides it. Margin, difference and uncertainty follow from compared values.
const FOLLOWS: &[&str] = &[
    "value",
    "limit",
    "margin",
    "unit",
    "u",
    "condition",
    "difference",
    "relative_difference",
];

/// The lists of statements about the run; each entry has a name.
const STATED: [&str; 2] = ["requirements", "reproductions"];

pub(super) fn compare(
    was: Option<&str>,
    is: Option<&str>,
    tolerances: &Tolerances,
    found: &mut Vec<Finding>,
) {
    let read = |text: Option<&str>| text.and_then(|text| older::summary(text).ok());
    let Some(was) = read(was).map(older::completed) else {
        found.push(Finding::new(Part::Verdict, super::SUMMARY, Change::New));
        return;
    };
    let Some(is) = read(is) else {
        found.push(Finding::new(Part::Verdict, super::SUMMARY, Change::Missing));
        return;
    };
    Walk { tolerances, found }.value(&mut Vec::new(), &was, &is);
}

struct Walk<'a> {
    tolerances: &'a Tolerances,
    found: &'a mut Vec<Finding>,
}

impl Walk<'_> {
    fn value(&mut self, path: &mut Vec<String>, was: &Value, is: &Value) {
        if NOT_COMPARED.contains(&path.join(".").as_str()) {
            return;
        }
        match (was, is) {
            (Value::Object(was), Value::Object(is)) => self.object(path, was, is),
            (Value::Array(was), Value::Array(is)) => self.array(path, was, is),
            (Value::Number(_), Value::Number(_)) => {
                let (was, is) = (was.as_f64(), is.as_f64());
                let scale = number::scale(was.into_iter().chain(is));
                let change =
                    number::single(was, is, Dimension::NUMBER, self.tolerances.general(), scale);
                self.note(path, change);
            }
            _ if was != is => self.note(path, Some(text(was, is))),
            _ => {}
        }
    }

    fn object(
        &mut self,
        path: &mut Vec<String>,
        was: &Map<String, Value>,
        is: &Map<String, Value>,
    ) {
        let requirement = path.len() == 2 && STATED.contains(&path[0].as_str());
        let measure = measure(was).filter(|_| was.get("unit") == is.get("unit") && !requirement);
        for (key, old) in was
            .iter()
            .filter(|(key, _)| !requirement || !FOLLOWS.contains(&key.as_str()))
        {
            path.push(key.clone());
            match (is.get(key), measure) {
                (None, _) => self.note(path, Some(Change::Missing)),
                (Some(new), Some(dimension))
                    if is_numeric(old) && is_numeric(new) && key != "margin" =>
                {
                    let scale = ["value", "limit"]
                        .into_iter()
                        .flat_map(|key| [was.get(key), is.get(key)])
                        .flatten();
                    let scale = number::scale(scale.flat_map(numbers).flatten());
                    self.quantity(path, [old, new], dimension, scale);
                }
                (Some(_), Some(_)) if key == "margin" => {}
                (Some(new), _) => self.value(path, old, new),
            }
            path.pop();
        }
        for key in is.keys().filter(|key| !was.contains_key(*key)) {
            path.push(key.clone());
            self.note(path, Some(Change::New));
            path.pop();
        }
    }

    /// A number with a unit, or a list of them; its `scale` is the largest number of that object.
    fn quantity(&mut self, path: &[String], both: [&Value; 2], dimension: Dimension, scale: f64) {
        let rule = self.rule(path, dimension);
        let [old, new] = both.map(numbers);
        self.note(path, Change::length("entries", old.len(), new.len()));
        let listed = old.len() > 1;
        for (index, (old, new)) in old.into_iter().zip(new).enumerate() {
            let change = number::single(old, new, dimension, rule, scale);
            if listed {
                let mut path = path.to_vec();
                path.push(index.to_string());
                self.note(&path, change);
            } else {
                self.note(path, change);
            }
        }
    }

    fn rule(&self, path: &[String], dimension: Dimension) -> Rule {
        match path {
            [procedures, name, results, result, ..]
                if procedures == "procedures" && results == "results" =>
            {
                self.tolerances.result(name, result)
            }
            [parameters, ..] if parameters == "parameters" => self.tolerances.general(),
            _ => self.tolerances.follows(dimension),
        }
    }

    /// Entries by their index; requirements by their name, so that an additional one does not shift the others.
    fn array(&mut self, path: &mut Vec<String>, was: &[Value], is: &[Value]) {
        let named = |entries: &[Value]| {
            entries
                .iter()
                .map(|entry| Some(entry.get("name")?.as_str()?.to_owned()))
                .collect()
        };
        let (old_names, new_names): (Option<Vec<String>>, Option<Vec<String>>) =
            (named(was), named(is));
        if let (Some(old_names), Some(new_names)) = (old_names, new_names)
            && !(was.is_empty() && is.is_empty())
        {
            let new_index = |name: &String| new_names.iter().position(|other| other == name);
            for (name, old) in old_names.iter().zip(was) {
                path.push(name.clone());
                match new_index(name) {
                    Some(index) => self.value(path, old, &is[index]),
                    None => self.note(path, Some(Change::Missing)),
                }
                path.pop();
            }
            for name in new_names.iter().filter(|name| !old_names.contains(name)) {
                path.push(name.clone());
                self.note(path, Some(Change::New));
                path.pop();
            }
            return;
        }
        self.note(path, Change::length("entries", was.len(), is.len()));
        for (index, (old, new)) in was.iter().zip(is).enumerate() {
            path.push((index + 1).to_string());
            self.value(path, old, new);
            path.pop();
        }
    }

    fn note(&mut self, path: &[String], change: Option<Change>) {
        if let Some(change) = change {
            let (part, name) = named(path);
            self.found.push(Finding::new(part, name, change));
        }
    }
}

/// The dimension of an object with a `unit`.
fn measure(object: &Map<String, Value>) -> Option<Dimension> {
    let unit = object.get("unit")?.as_str()?;
    Some(unit::parse(unit).map_or(Dimension::NUMBER, |unit| unit.dimension))
}

/// Whether it can be a number: a number, null, or a list of them.
fn is_numeric(value: &Value) -> bool {
    match value {
        Value::Number(_) | Value::Null => true,
        Value::Array(entries) => entries
            .iter()
            .all(|entry| matches!(entry, Value::Number(_) | Value::Null)),
        _ => false,
    }
}

fn numbers(value: &Value) -> Vec<Option<f64>> {
    match value {
        Value::Array(entries) => entries.iter().map(Value::as_f64).collect(),
        one => vec![one.as_f64()],
    }
}

fn text(was: &Value, is: &Value) -> Change {
    let shown = |value: &Value| match value {
        Value::String(text) => text.clone(),
        Value::Null => "none".to_owned(),
        other => other.to_string(),
    };
    Change::Text {
        was: shown(was),
        is: shown(is),
        first: None,
    }
}

/// `procedures hit results stop_time value` gives `hit.stop_time`.
fn named(path: &[String]) -> (Part, String) {
    let parts: Vec<&str> = path.iter().map(String::as_str).collect();
    match parts.as_slice() {
        ["verdict"] => (Part::Verdict, "verdict".to_owned()),
        ["outcome", ..] => (Part::Verdict, parts.join(".")),
        ["requirements", name] => (Part::Requirement, format!("require \"{name}\"")),
        // The values in a requirement follow from results, which are more important.
        [
            "requirements",
            name,
            "conditions",
            index,
            rest @ ("value" | "limit" | "tolerance"),
        ] => (
            Part::Other,
            format!("require \"{name}\", condition {index}: {rest}"),
        ),
        ["requirements", name, "conditions", index, rest @ ..] => (
            Part::Requirement,
            format!("require \"{name}\", condition {index}: {}", rest.join(".")),
        ),
        ["requirements", name, rest @ ..] => (
            Part::Requirement,
            format!("require \"{name}\": {}", rest.join(".")),
        ),
        ["reproductions", name] => (Part::Requirement, format!("reproduces {name}")),
        ["reproductions", name, rest @ ..] => (
            Part::Requirement,
            format!("reproduces {name}: {}", rest.join(".")),
        ),
        ["procedures", name, "results", result, "value", index @ ..] => {
            let entries = index
                .iter()
                .fold(String::new(), |text, index| text + "[" + index + "]");
            (Part::Result, format!("{name}.{result}{entries}"))
        }
        ["procedures", name, "results", rest @ ..] => {
            (Part::Result, format!("{name}.{}", rest.join(".")))
        }
        ["procedures", name, "inputs", input, "value"] => {
            (Part::Other, format!("input {name}.{input}"))
        }
        ["procedures", name, "inputs", rest @ ..] => {
            (Part::Other, format!("input {name}.{}", rest.join(".")))
        }
        ["procedures", name] => (Part::Result, (*name).to_owned()),
        ["procedures", name, rest @ ..] => (Part::Result, format!("{name}: {}", rest.join("."))),
        ["parameters", name, "value"] => (Part::Other, format!("param {name}")),
        ["events", index, rest @ ..] => (Part::Other, format!("event {index}: {}", rest.join("."))),
        _ => (Part::Other, parts.join(".")),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn summary() -> Value {
        let condition = json!({ "condition": "hit.x < 1 m", "verdict": "pass", "value": 0.5, "limit": 1.0, "tolerance": null,
            "margin": 0.5, "unit": "m", "u": null, "reason": null });
        json!({
            "schema": "psd.summary/1", "run_id": "a", "psd": "0.1.0", "plan": { "title": "T", "sha256": "b" },
            "verdict": "pass",
            "procedures": { "hit": { "kind": "impact", "complete": true,
                "inputs": { "mass": { "value": 2.0, "unit": "kg", "u": null } },
                "results": {
                    "x": { "value": 0.5, "unit": "m", "u": 1e-3 },
                    "drift": { "value": [1e-3, 2e-3], "unit": "m", "u": null },
                    "stop_time": { "value": null, "unit": "s", "u": null } } } },
            "requirements": [{ "name": "stays", "verdict": "pass", "value": 0.5, "limit": 1.0, "margin": 0.5, "unit": "m",
                "u": null, "condition": "hit.x < 1 m", "conditions": [condition] }],
            "events": [{ "wall_time_s": 1.0, "text": "seen" }],
        })
    }

    fn findings(change: impl FnOnce(&mut Value)) -> Vec<String> {
        let mut now = summary();
        change(&mut now);
        let mut found = Vec::new();
        compare(
            Some(&summary().to_string()),
            Some(&now.to_string()),
            &Tolerances::default(),
            &mut found,
        );
        found
            .iter()
            .map(|finding| format!("{} {}", finding.part.name(), finding.name))
            .collect()
    }

    #[test]
    fn what_names_the_run_is_not_compared_and_a_number_within_tolerance_is_the_same() {
        let same = findings(|now| {
            now["run_id"] = json!("other");
            now["psd"] = json!("9.9.9");
            now["plan"]["sha256"] = json!("other");
            now["procedures"]["hit"]["results"]["x"]["value"] = json!(0.5 * (1.0 + 0.9e-9));
            // Relative to the longest entry, and to the value that it is the uncertainty of.
            now["procedures"]["hit"]["results"]["drift"]["value"][0] = json!(1e-3 + 1.9e-12);
            now["procedures"]["hit"]["results"]["x"]["u"] = json!(1e-3 + 0.4e-9);
        });
        assert_eq!(same, Vec::<String>::new());
    }

    #[test]
    fn a_pass_of_an_older_version_is_completed_only_where_nothing_was_required() {
        let compared = |was: &Value, is: &Value| {
            let mut found = Vec::new();
            compare(
                Some(&was.to_string()),
                Some(&is.to_string()),
                &Tolerances::default(),
                &mut found,
            );
            found
                .iter()
                .map(|finding| finding.name.clone())
                .collect::<Vec<_>>()
        };
        let mut older = summary();
        older["requirements"] = json!([]);
        let mut now = older.clone();
        now["verdict"] = json!("completed");
        assert_eq!(compared(&older, &now), [""; 0]);
        assert_eq!(compared(&now, &now), [""; 0]);
        assert_eq!(compared(&now, &older), ["verdict"]);
        now["verdict"] = json!("aborted");
        assert_eq!(compared(&older, &now), ["verdict"]);
        let mut completed = summary();
        completed["verdict"] = json!("completed");
        assert_eq!(compared(&summary(), &completed), ["verdict"]);
    }

    #[test]
    fn every_difference_has_its_name() {
        let results = |now: &mut Value, result: &str, value: Value| {
            now["procedures"]["hit"]["results"][result]["value"] = value;
        };
        assert_eq!(
            findings(|now| results(now, "x", json!(0.500_000_001))),
            ["result hit.x"]
        );
        assert_eq!(
            findings(|now| results(now, "drift", json!([1e-3, 2.1e-3]))),
            ["result hit.drift[1]"]
        );
        assert_eq!(
            findings(|now| results(now, "drift", json!([1e-3]))),
            ["result hit.drift"]
        );
        assert_eq!(
            findings(|now| results(now, "stop_time", json!(0.1))),
            ["result hit.stop_time"]
        );
        assert_eq!(
            findings(|now| now["procedures"]["hit"]["inputs"]["mass"]["value"] = json!(2.1)),
            ["other input hit.mass"]
        );
        assert_eq!(
            findings(|now| now["events"][0]["text"] = json!("said")),
            ["other event 1: text"]
        );
        assert_eq!(
            findings(|now| now["plan"]["title"] = json!("U")),
            ["other plan.title"]
        );
        assert_eq!(
            findings(|now| now["requirements"] = json!([])),
            ["requirement require \"stays\""]
        );
        let verdicts = findings(|now| {
            now["verdict"] = json!("fail");
            now["requirements"][0]["verdict"] = json!("fail");
            now["requirements"][0]["margin"] = json!(-0.5);
        });
        assert_eq!(
            verdicts,
            ["verdict verdict", "requirement require \"stays\": verdict"]
        );
        let gone = findings(|now| {
            now["procedures"]["hit"]["results"]
                .as_object_mut()
                .unwrap()
                .remove("x");
        });
        assert_eq!(gone, ["result hit.x"]);
    }
}
