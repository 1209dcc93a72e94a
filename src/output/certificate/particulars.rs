//! Who asked for the test, who made it, of what, by which method: what clause 7.8.2 wants on the first page, and what else
//! the plan says for the report. In: a run. Out: names and values; what should be there and was not given is said to be so.

use super::super::Run;
use super::super::document::{Block, Text};
use super::words;
use crate::inert;

/// A particular of the first page.
struct Particular {
    field: &'static str,
    name: &'static str,
    /// Clause 7.8.2.1 wants it, or why it does not apply: it is missed where it is not given.
    wanted: bool,
}

const fn wanted(field: &'static str, name: &'static str) -> Particular {
    Particular { field, name, wanted: true }
}

const fn optional(field: &'static str, name: &'static str) -> Particular {
    Particular { field, name, wanted: false }
}

/// On the first page, in this order.
const FRONT: &[Particular] = &[
    wanted("laboratory", "Laboratory"),
    wanted("address", "Address"),
    optional("place", "Place of the test"),
    wanted("operator", "Operator"),
    wanted("authorised_by", "Authorised by"),
    wanted("customer", "Customer"),
    wanted("contact", "Contact"),
    optional("project", "Project"),
    wanted("specimen_id", "Item tested"),
    optional("material", "Material"),
    wanted("condition", "Condition"),
    wanted("receipt_date", "Item received"),
    wanted("date", "Date of the test"),
    wanted("issued", "Date of issue"),
    wanted("standard", "Method"),
];

/// The edition is the language's; these stand where they are used.
const ELSEWHERE: &[&str] =
    &["edition", "revision", "decision_rule", "deviations", "rehearsal", "equipment", "validation", "opinions"];

/// With the conditions of the test, given or not.
const CONDITIONS: &[(&str, &str)] = &[("temperature", "Temperature"), ("humidity", "Humidity")];

/// There too, where they are given.
const MORE: &[(&str, &str)] = &[("sampling", "Sampling"), ("external", "Results from others"), ("notes", "Remarks")];

/// Names and values of the first page, those that are known; the plan with its digest last.
pub(super) fn front(run: &Run<'_>) -> Vec<(Text, Text)> {
    let known = FRONT.iter().filter_map(|one| Some((one.name.into(), stated(run, one.field)?.into())));
    known.chain([("Plan".into(), plan(run))]).collect()
}

/// What the first page should say and cannot.
pub(super) fn lacking(run: &Run<'_>) -> Vec<&'static str> {
    FRONT.iter().filter(|one| one.wanted && stated(run, one.field).is_none()).map(|one| one.name).collect()
}

/// The plan as it was run: its file, its revision, and as much of its digest as tells it from any other.
fn plan(run: &Run<'_>) -> Text {
    let file = run.plan.files.first().map_or("", |file| file.name.as_str());
    let revision = stated(run, "revision").map_or_else(String::new, |revision| format!(", revision {revision}"));
    let digest = run.provenance.plan_sha256.get(..16).unwrap_or(&run.provenance.plan_sha256);
    Text::from(format!("{file}{revision}, SHA-256 ")).id(format!("{digest}…"))
}

/// Temperature and what else the plan says of the test.
pub(super) fn others(run: &Run<'_>) -> Vec<(Text, Text)> {
    let mut rows: Vec<(Text, Text)> =
        CONDITIONS.iter().map(|(field, name)| ((*name).into(), Text::given(stated(run, field).as_deref()))).collect();
    rows.extend(MORE.iter().filter_map(|(field, name)| Some(((*name).into(), stated(run, field)?.into()))));
    let known = |field: &str| {
        ELSEWHERE.contains(&field)
            || FRONT.iter().any(|one| one.field == field)
            || CONDITIONS.iter().chain(MORE).any(|(name, _)| *name == field)
    };
    let more = run.plan.particulars.iter().filter(|(field, _)| !known(field));
    rows.extend(more.map(|(field, text)| (words(field).into(), Text::given(Some(text)))));
    rows
}

/// Opinions are the issuer's own, marked as such (clause 7.8.7).
pub(super) fn opinions(run: &Run<'_>, body: &mut Vec<Block>) {
    if let Some(text) = stated(run, "opinions") {
        body.push(Block::section("Opinions and interpretations"));
        body.push(Block::note("Not results of the test: what the issuer makes of them, and on which grounds."));
        body.push(Block::paragraph(text));
    }
}

/// A particular of the plan, unless it says nothing. Who stood by is known from the record, whoever the plan names; so are
/// the days.
pub(super) fn stated(run: &Run<'_>, field: &str) -> Option<String> {
    let told = match field {
        "operator" => run.provenance.operator().map(str::to_owned),
        "date" => days(run),
        _ => None,
    };
    let of_plan = || run.plan.particulars.iter().find(|(name, _)| *name == field).map(|(_, text)| text.clone());
    told.or_else(of_plan).filter(|text| !text.trim().is_empty())
}

/// The day of the test; of one that ended on another day, both.
fn days(run: &Run<'_>) -> Option<String> {
    let first = run.provenance.date.as_deref().map(inert::printed)?;
    let ended = run.provenance.real.as_ref().and_then(|real| real.ended.as_deref()).and_then(|ended| ended.get(..10));
    match ended {
        Some(last) if first.len() == last.len() && first.as_str() < last => Some(format!("{first} to {last}")),
        _ => Some(first),
    }
}
