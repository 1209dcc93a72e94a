//! Issue and amendments of a report, after the test. In: its issues. Out: sentences. An issue states particulars of the `plan` block
//! only, never a measured number.

use crate::report::wording::{amendment as wording, common};
use psd_plan::schema::plan_block::{AUTHORISED_BY, ISSUED};

/// Every issue of the report of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Issues {
    /// The id of this report. A report without issues has the id of its run.
    pub report_id: String,
    /// Every issue up to this one, in order; never empty.
    pub all: Vec<Issue>,
}

/// One issue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Issue {
    pub kind: IssueKind,
    /// Id of the report that it replaces.
    pub replaces: String,
    /// `YYYY-MM-DD`
    pub date: String,
    /// The person responsible.
    pub by: String,
    /// The reason of an amendment.
    pub reason: Option<String>,
    pub changes: Vec<Change>,
}

/// First issue or amendment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IssueKind {
    /// The first issue: it states particulars that are known only after the test.
    First,
    /// It replaces a report that was issued before.
    Amendment,
}

impl IssueKind {
    /// The name in `summary.json`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::First => "issue",
            Self::Amendment => "amendment",
        }
    }
}

/// A particular that an issue states; an empty string means not given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    pub field: &'static str,
    pub was: String,
    pub is: String,
}

/// One sentence per amendment, in order.
pub(in crate::report) fn amendments(issues: Option<&Issues>) -> Vec<String> {
    let sentence = |issue: &Issue| {
        let changed = issue
            .changes
            .iter()
            .filter(|change| change.was != change.is);
        let changes: Vec<String> = changed.map(change).collect();
        let changes = if changes.is_empty() {
            wording::NOTHING.to_owned()
        } else {
            changes.join(", ")
        };
        let reason = issue
            .reason
            .as_deref()
            .unwrap_or_default()
            .trim_end_matches('.');
        wording::amendment(&issue.replaces, &issue.by, &issue.date, reason, changes)
    };
    of_kind(issues, IssueKind::Amendment)
        .map(sentence)
        .collect()
}

/// Date and issuer of the first issue, and the particulars that it states.
pub(in crate::report) fn first(issues: Option<&Issues>) -> Option<String> {
    let issue = of_kind(issues, IssueKind::First).next()?;
    let others = issue
        .changes
        .iter()
        .filter(|change| ![ISSUED.name, AUTHORISED_BY.name].contains(&change.field));
    let stated: Vec<String> = others.map(change).collect();
    let stated = if stated.is_empty() {
        wording::NOTHING_ELSE.to_owned()
    } else {
        stated.join(", ")
    };
    Some(wording::first_issue(
        &issue.date,
        &issue.by,
        &issue.replaces,
        stated,
    ))
}

fn of_kind(issues: Option<&Issues>, kind: IssueKind) -> impl Iterator<Item = &Issue> {
    let all = issues.into_iter().flat_map(|issues| &issues.all);
    all.filter(move |issue| issue.kind == kind)
}

fn change(change: &Change) -> String {
    let quoted = |text: &str| {
        if text.is_empty() {
            common::NOT_GIVEN.to_owned()
        } else {
            wording::quoted(text)
        }
    };
    wording::change(
        change.field.replace('_', " "),
        quoted(&change.was),
        quoted(&change.is),
    )
}
