//! What was stated of a report after the test: its issue, and every amendment of it. In: a run. Out: sentences. Only
//! particulars of the `plan` block are stated so: a measured number never is.

use super::Run;

/// Every issue of the report of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Issues {
    /// The id of this report; that of a report without issues is its run's.
    pub report_id: String,
    /// Every issue up to this one, in order; never empty.
    pub all: Vec<Issue>,
}

/// One issue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Issue {
    pub kind: IssueKind,
    /// Id of the report that it is made from.
    pub replaces: String,
    /// `YYYY-MM-DD`; None of an amendment by an older version.
    pub date: Option<String>,
    /// Who answers for it.
    pub by: String,
    /// Why there is an amendment.
    pub reason: Option<String>,
    pub changes: Vec<Change>,
}

/// What an issue is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IssueKind {
    /// The first one: it states what is known only after the test.
    First,
    /// It takes the place of a report that was out already.
    Amendment,
}

impl IssueKind {
    /// As in `summary.json`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::First => "issue",
            Self::Amendment => "amendment",
        }
    }
}

/// A particular that an issue states; empty: not given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    pub field: &'static str,
    pub was: String,
    pub is: String,
}

/// Every amendment of a run's report as a sentence of its own, in order.
pub(super) fn amendments(run: &Run<'_>) -> Vec<String> {
    let sentence = |issue: &Issue| {
        let changes: Vec<String> = issue.changes.iter().map(change).collect();
        let changes = if changes.is_empty() {
            "nothing".to_owned()
        } else {
            changes.join(", ")
        };
        let date = issue
            .date
            .as_ref()
            .map_or_else(String::new, |date| format!(" on {date}"));
        let reason = issue
            .reason
            .as_deref()
            .unwrap_or_default()
            .trim_end_matches('.');
        format!(
            "Amendment to report {} by {}{date}: {reason}. Changed: {changes}.",
            issue.replaces, issue.by
        )
    };
    of_kind(run, IssueKind::Amendment).map(sentence).collect()
}

/// When and by whom the report was issued first, and which particulars were stated only then.
pub(super) fn first(run: &Run<'_>) -> Option<String> {
    let issue = of_kind(run, IssueKind::First).next()?;
    let others = issue
        .changes
        .iter()
        .filter(|change| !matches!(change.field, "issued" | "authorised_by"));
    let stated: Vec<String> = others.map(change).collect();
    let stated = if stated.is_empty() {
        "nothing else".to_owned()
    } else {
        stated.join(", ")
    };
    let date = issue.date.as_deref().unwrap_or_default();
    Some(format!(
        "on {date} by {}, from the report {}; stated after the test: {stated}",
        issue.by, issue.replaces
    ))
}

fn of_kind<'a>(run: &Run<'a>, kind: IssueKind) -> impl Iterator<Item = &'a Issue> {
    let all = run.provenance.issues.iter().flat_map(|issues| &issues.all);
    all.filter(move |issue| issue.kind == kind)
}

fn change(change: &Change) -> String {
    let quoted = |text: &str| {
        if text.is_empty() {
            "not given".to_owned()
        } else {
            format!("“{text}”")
        }
    };
    format!(
        "{} (was {}, is {})",
        change.field.replace('_', " "),
        quoted(&change.was),
        quoted(&change.is)
    )
}
