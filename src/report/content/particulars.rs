//! Who asked for the test, who made it, of what, by which method: what clause 7.8.2 wants on the first page, and what else
//! the plan says for the report. In: a run. Out: names and values; what should be there and was not given is said to be so.

use super::super::Run;
use super::super::document::{Block, Text};
use super::super::particulars::{FRONT, Wanted, lacking as lacks, stated};
use super::words;
use crate::report::report_status;

/// The edition is the language's; these stand where they are used.
const ELSEWHERE: &[&str] = &[
    "edition",
    "revision",
    "decision_rule",
    "deviations",
    "rehearsal",
    "equipment",
    "validation",
    "opinions",
];

/// With the conditions of the test, given or not.
const CONDITIONS: &[(&str, &str)] = &[("temperature", "Temperature"), ("humidity", "Humidity")];

/// There too, where they are given.
const MORE: &[(&str, &str)] = &[
    ("sampling", "Sampling"),
    ("external", "Results from others"),
    ("notes", "Remarks"),
];

/// Names and values of the first page, those that are known; the plan with its digest last.
pub(super) fn front(run: &Run<'_>) -> Vec<(Text, Text)> {
    let known = FRONT
        .iter()
        .filter_map(|one| Some((one.name.into(), stated(run, one.field)?.into())));
    known.chain([("Plan".into(), plan(run))]).collect()
}

/// What the first page should say and cannot, unless a mark below the verdict says so.
pub(super) fn lacking(run: &Run<'_>) -> Vec<&'static str> {
    let marked = !report_status::particulars_missing(run).is_empty();
    lacks(
        run,
        if marked {
            &[Wanted::WhereItMatters]
        } else {
            &[Wanted::Always, Wanted::WhereItMatters]
        },
    )
}

/// The plan as it was run: its file, its revision, and as much of its digest as tells it from any other.
fn plan(run: &Run<'_>) -> Text {
    let file = run.plan.files.first().map_or("", |file| file.name.as_str());
    let revision = stated(run, "revision")
        .map_or_else(String::new, |revision| format!(", revision {revision}"));
    let digest = run
        .provenance
        .plan_sha256
        .get(..16)
        .unwrap_or(&run.provenance.plan_sha256);
    Text::from(format!("{file}{revision}, SHA-256 ")).id(format!("{digest}…"))
}

/// Temperature and what else the plan says of the test.
pub(super) fn others(run: &Run<'_>) -> Vec<(Text, Text)> {
    let mut rows: Vec<(Text, Text)> = CONDITIONS
        .iter()
        .map(|(field, name)| ((*name).into(), Text::given(stated(run, field).as_deref())))
        .collect();
    rows.extend(
        MORE.iter()
            .filter_map(|(field, name)| Some(((*name).into(), stated(run, field)?.into()))),
    );
    let known = |field: &str| {
        ELSEWHERE.contains(&field)
            || FRONT.iter().any(|one| one.field == field)
            || CONDITIONS
                .iter()
                .chain(MORE)
                .any(|(name, _)| *name == field)
    };
    let more = run
        .plan
        .particulars
        .iter()
        .filter(|(field, _)| !known(field));
    rows.extend(more.map(|(field, text)| (words(field).into(), Text::given(Some(text)))));
    rows
}

/// Opinions are the issuer's own, marked as such (clause 7.8.7).
pub(super) fn opinions(run: &Run<'_>, body: &mut Vec<Block>) {
    if let Some(text) = stated(run, "opinions") {
        body.push(Block::section("Opinions and interpretations"));
        body.push(Block::note(
            "Not results of the test: what the issuer makes of them, and on which grounds.",
        ));
        body.push(Block::paragraph(text));
    }
}
