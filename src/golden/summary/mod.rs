//! Comparison of two `summary.json`. A number has the unit beside it; degrees of freedom, coverage factors and probabilities are plain
//! numbers. Texts must be identical. Data that identify the run and not its results are left out.

use serde_json::{Map, Value};

use crate::golden::finding::{Change, Finding, FindingPart};
use crate::golden::tolerance::{Rule, Tolerances};
use crate::golden::{SUMMARY, number};
use psd_text::units::{Dimension, unit};

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
    "guard_band",
    "condition",
    "difference",
    "relative_difference",
];

/// The lists of statements on the run; each entry has a name.
const STATED: [&str; 2] = ["requirements", "reproductions"];

/// Printed digits of a digest.
const DIGITS: usize = 12;

/// Whether the text of the plan is another one than when its results were accepted.
pub(in crate::golden) fn plan_change(was: Option<&str>, is: Option<&str>) -> Option<Finding> {
    let digest = |text: Option<&str>| {
        let summary: Value = serde_json::from_str(text?).ok()?;
        let digest = summary["plan"]["sha256"].as_str()?;
        Some(digest.chars().take(DIGITS).collect::<String>())
    };
    let (was, is) = (digest(was)?, digest(is)?);
    (was != is).then(|| Finding::text(FindingPart::Cause, "text of the plan (SHA-256)", &was, &is))
}

pub(in crate::golden) fn compare(
    was: Option<&str>,
    is: Option<&str>,
    tolerances: &Tolerances,
    found: &mut Vec<Finding>,
) {
    let read = |text: Option<&str>| serde_json::from_str::<Value>(text?).ok();
    let Some(was) = read(was) else {
        found.push(Finding::new(FindingPart::Verdict, SUMMARY, Change::New));
        return;
    };
    let Some(is) = read(is) else {
        found.push(Finding::new(FindingPart::Verdict, SUMMARY, Change::Missing));
        return;
    };
    Walk { tolerances, found }.value(&mut Vec::new(), &was, &is, None);
}

struct Walk<'a> {
    tolerances: &'a Tolerances,
    found: &'a mut Vec<Finding>,
}

impl Walk<'_> {
    /// `unit` is that of the enclosing object.
    fn value(&mut self, path: &mut Vec<String>, was: &Value, is: &Value, unit: Option<Dimension>) {
        if NOT_COMPARED.contains(&path.join(".").as_str()) {
            return;
        }
        match (was, is) {
            (Value::Object(was), Value::Object(is)) => self.object(path, was, is, unit),
            (Value::Array(was), Value::Array(is)) => self.array(path, was, is, unit),
            (Value::Number(_), Value::Number(_)) => {
                let (was, is) = (was.as_f64(), is.as_f64());
                let scale = number::scale(was.into_iter().chain(is));
                let change =
                    number::single(was, is, Dimension::NUMBER, self.tolerances.general(), scale);
                self.note(path, change);
            }
            _ if was != is => self.note(path, Some(changed_text(was, is))),
            _ => {}
        }
    }

    fn object(
        &mut self,
        path: &mut Vec<String>,
        was: &Map<String, Value>,
        is: &Map<String, Value>,
        unit: Option<Dimension>,
    ) {
        let requirement = path.len() == 2 && STATED.contains(&path[0].as_str());
        let units = Units::of(was, unit).filter(|_| was.get("unit") == is.get("unit"));
        for (key, old) in was
            .iter()
            .filter(|(key, _)| !requirement || !FOLLOWS.contains(&key.as_str()))
        {
            path.push(key.clone());
            match (is.get(key), units) {
                (None, _) => self.note(path, Some(Change::Missing)),
                (Some(_), _) if key == "margin" => {}
                (Some(new), Some(units)) if is_numeric(old) && is_numeric(new) => {
                    let scale = ["value", "limit"]
                        .into_iter()
                        .flat_map(|key| [was.get(key), is.get(key)])
                        .flatten();
                    let scale = number::scale(scale.flat_map(numbers).flatten());
                    self.quantity(path, [old, new], units, scale);
                }
                (Some(new), _) => self.value(path, old, new, units.map(|units| units.own)),
            }
            path.pop();
        }
        for key in is.keys().filter(|key| !was.contains_key(*key)) {
            path.push(key.clone());
            self.note(path, Some(Change::New));
            path.pop();
        }
    }

    /// A number with a unit, or a list of them; `scale` is the largest value of the object. A plain number beside a quantity, such as
    /// its degrees of freedom, has the relative tolerance of that quantity.
    fn quantity(&mut self, path: &[String], both: [&Value; 2], units: Units, scale: f64) {
        let [old, new] = both.map(numbers);
        let own = number::scale(old.iter().chain(&new).copied().flatten());
        let key = path.last().map_or("", String::as_str);
        let (dimension, rule, scale) = match units.number(key) {
            Some(dimension) if scale > 0.0 => (dimension, self.rule(path, dimension), scale),
            Some(dimension) => (dimension, self.rule(path, dimension), own),
            None => {
                let rule = self.rule(path, units.own);
                let general = self.tolerances.general();
                let relative = if scale > 0.0 {
                    rule.bound(scale) / scale
                } else {
                    rule.relative
                };
                (
                    Dimension::NUMBER,
                    Rule {
                        relative,
                        ..general
                    },
                    own,
                )
            }
        };
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
        let parts: Vec<&str> = path.iter().map(String::as_str).collect();
        match parts.as_slice() {
            ["procedures", name, "results", result, ..]
            | [
                "procedures",
                name,
                BUDGETS,
                result,
                "u" | "degrees_of_freedom",
            ]
            | [
                "procedures",
                name,
                BUDGETS,
                result,
                _,
                _,
                "contribution" | "degrees_of_freedom",
            ] => self.tolerances.result(name, without_index(result)),
            ["parameters", ..] => self.tolerances.general(),
            _ => self.tolerances.follows(dimension),
        }
    }

    /// Requirements by their name and contributions by their input, so that an additional one does not shift the others; other entries
    /// by their index.
    fn array(
        &mut self,
        path: &mut Vec<String>,
        was: &[Value],
        is: &[Value],
        unit: Option<Dimension>,
    ) {
        if let (Some(old_names), Some(new_names)) = (names(was), names(is))
            && !(was.is_empty() && is.is_empty())
        {
            let new_index = |name: &str| new_names.iter().position(|other| *other == name);
            for (name, old) in old_names.iter().zip(was) {
                path.push((*name).to_owned());
                match new_index(name) {
                    Some(index) => self.value(path, old, &is[index], unit),
                    None => self.note(path, Some(Change::Missing)),
                }
                path.pop();
            }
            for name in new_names.iter().filter(|name| !old_names.contains(name)) {
                path.push((*name).to_owned());
                self.note(path, Some(Change::New));
                path.pop();
            }
            return;
        }
        self.note(path, Change::length("entries", was.len(), is.len()));
        for (index, (old, new)) in was.iter().zip(is).enumerate() {
            path.push((index + 1).to_string());
            self.value(path, old, new, unit);
            path.pop();
        }
    }

    fn note(&mut self, path: &[String], change: Option<Change>) {
        let Some(change) = change else {
            return;
        };
        let (part, name) = named(path);
        let parts: Vec<&str> = path.iter().map(String::as_str).collect();
        let is_result = |finding: &Finding| finding.part == FindingPart::Result;
        let part = match parts.as_slice() {
            // The budget of a result that came or went is no second difference.
            ["procedures", procedure, BUDGETS, result]
                if self.found.iter().any(|finding| {
                    is_result(finding)
                        && finding.change == change
                        && finding.name == format!("{procedure}.{}", without_index(result))
                }) =>
            {
                return;
            }
            // Results come in the order of the run: an input before the first changed one follows from none of them.
            ["procedures", _, "inputs", ..] if !self.found.iter().any(is_result) => {
                FindingPart::Cause
            }
            _ => part,
        };
        self.found.push(Finding::new(part, name, change));
    }
}

/// The key of the budgets of a procedure.
const BUDGETS: &str = "uncertainty_budgets";

/// `max_drift[1]` is a number of `max_drift`.
fn without_index(result: &str) -> &str {
    result.split('[').next().unwrap_or(result)
}

/// The entries by name, if each has one.
fn names(entries: &[Value]) -> Option<Vec<&str>> {
    entries
        .iter()
        .map(|entry| entry.get("name").or_else(|| entry.get("input"))?.as_str())
        .collect()
}

/// The units of the numbers of an object.
#[derive(Clone, Copy)]
struct Units {
    /// Of its value, or of the result whose budget it is a part of.
    own: Dimension,
    /// Of the input of a contribution.
    input: Option<Dimension>,
}

impl Units {
    /// None for an object without a quantity.
    fn of(object: &Map<String, Value>, enclosing: Option<Dimension>) -> Option<Self> {
        let dimension = |key: &str| {
            let unit = object.get(key)?.as_str()?;
            Some(unit::parse(unit).map_or(Dimension::NUMBER, |unit| unit.dimension))
        };
        Some(Self {
            own: dimension("unit").or(enclosing)?,
            input: dimension("input_unit"),
        })
    }

    /// The dimension of a number by its key; None for a plain number.
    fn number(self, key: &str) -> Option<Dimension> {
        match (key, self.input) {
            ("value" | "input_u", Some(input)) => Some(input),
            ("sensitivity", Some(input)) => self.own.over(input),
            (
                "value" | "limit" | "published" | "tolerance" | "u" | "guard_band" | "contribution"
                | "in_finer_steps",
                _,
            ) => Some(self.own),
            _ => None,
        }
    }
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

fn changed_text(was: &Value, is: &Value) -> Change {
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
fn named(path: &[String]) -> (FindingPart, String) {
    let parts: Vec<&str> = path.iter().map(String::as_str).collect();
    match parts.as_slice() {
        ["verdict"] => (FindingPart::Verdict, "verdict".to_owned()),
        ["outcome", ..] => (FindingPart::Verdict, parts.join(".")),
        ["requirements", name] => (FindingPart::Requirement, format!("require \"{name}\"")),
        // The values in a requirement follow from results, which are more important.
        [
            "requirements",
            name,
            "conditions",
            index,
            rest @ ("value" | "limit" | "tolerance"),
        ] => (
            FindingPart::Other,
            format!("require \"{name}\", condition {index}: {rest}"),
        ),
        ["requirements", name, "conditions", index, rest @ ..] => (
            FindingPart::Requirement,
            format!("require \"{name}\", condition {index}: {}", rest.join(".")),
        ),
        ["requirements", name, rest @ ..] => (
            FindingPart::Requirement,
            format!("require \"{name}\": {}", rest.join(".")),
        ),
        ["reproductions", name] => (FindingPart::Requirement, format!("reproduces {name}")),
        ["reproductions", name, rest @ ..] => (
            FindingPart::Requirement,
            format!("reproduces {name}: {}", rest.join(".")),
        ),
        ["procedures", name, "results", result, "value", index @ ..] => {
            let entries = index
                .iter()
                .fold(String::new(), |text, index| text + "[" + index + "]");
            (FindingPart::Result, format!("{name}.{result}{entries}"))
        }
        ["procedures", name, "results", rest @ ..] => {
            (FindingPart::Result, format!("{name}.{}", rest.join(".")))
        }
        ["procedures", name, BUDGETS, result, rest @ ..] => {
            let rest = rest.strip_prefix(&["contributions"]).unwrap_or(rest);
            let rest = rest
                .iter()
                .fold(String::new(), |text, key| text + ": " + key);
            (
                FindingPart::Result,
                format!("budget of {name}.{result}{rest}"),
            )
        }
        ["procedures", name, "inputs", input, "value"] => {
            (FindingPart::Other, format!("input {name}.{input}"))
        }
        ["procedures", name, "inputs", rest @ ..] => (
            FindingPart::Other,
            format!("input {name}.{}", rest.join(".")),
        ),
        ["procedures", name] => (FindingPart::Result, (*name).to_owned()),
        ["procedures", name, rest @ ..] => {
            (FindingPart::Result, format!("{name}: {}", rest.join(".")))
        }
        ["parameters", name, "value"] => (FindingPart::Cause, format!("param {name}")),
        ["parameters" | "plan" | "rig", ..] => (FindingPart::Cause, parts.join(".")),
        ["events", index, rest @ ..] => (
            FindingPart::Other,
            format!("event {index}: {}", rest.join(".")),
        ),
        _ => (FindingPart::Other, parts.join(".")),
    }
}

#[cfg(test)]
mod tests;
