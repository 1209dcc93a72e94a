//! Who asked for the test, who made it, of what, by which method: what clause 7.8.2 wants on the first page, and what else
//! the plan says for the report. In: a run. Out: names and values; what was not given is said to be so.

use super::super::Run;
use super::super::document::Text;
use super::words;

/// On the first page, the laboratory's side first.
const FRONT: &[(&str, &str)] = &[
    ("laboratory", "Laboratory"),
    ("place", "Place of the test"),
    ("operator", "Operator"),
    ("customer", "Customer"),
    ("project", "Project"),
    ("date", "Date of the test"),
    ("specimen_id", "Item tested"),
    ("material", "Material"),
    ("condition", "Condition"),
    ("receipt_date", "Item received"),
    ("standard", "Method"),
    ("revision", "Plan, revision"),
];

/// The edition is the language's, the decision rule stands beside the requirements, deviations with the others.
const ELSEWHERE: &[&str] = &["edition", "decision_rule", "deviations", "rehearsal"];

/// With the conditions of the test, given or not.
const CONDITIONS: &[(&str, &str)] = &[("temperature", "Temperature"), ("humidity", "Humidity"), ("equipment", "Equipment")];

/// Names and values of the first page.
pub(super) fn front(run: &Run<'_>) -> Vec<(Text, Text)> {
    FRONT.iter().map(|(field, name)| ((*name).into(), Text::given(stated(run, field)))).collect()
}

/// Temperature and what else the plan says of the test.
pub(super) fn others(run: &Run<'_>) -> Vec<(Text, Text)> {
    let mut rows: Vec<(Text, Text)> =
        CONDITIONS.iter().map(|(field, name)| ((*name).into(), Text::given(stated(run, field)))).collect();
    let known = |field: &str| ELSEWHERE.contains(&field) || FRONT.iter().chain(CONDITIONS).any(|(name, _)| *name == field);
    let more = run.plan.particulars.iter().filter(|(field, _)| !known(field));
    rows.extend(more.map(|(field, text)| (words(field).into(), Text::given(Some(text)))));
    rows
}

/// Who stood by is known from the record, whoever the plan names; so is the day.
fn stated<'a>(run: &Run<'a>, field: &str) -> Option<&'a str> {
    let told = match field {
        "operator" => run.provenance.operator(),
        "date" => run.provenance.date.as_deref(),
        _ => None,
    };
    told.or_else(|| run.plan.particulars.iter().find(|(name, _)| *name == field).map(|(_, text)| text.as_str()))
}
