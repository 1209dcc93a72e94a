//! What an amendment report says of itself: which report it takes the place of, why, by whom, and what it says otherwise
//! than that one. Only particulars of the `plan` block: a measured number is never amended.

use super::Run;

/// What makes a report an amendment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Amends {
    /// The id of this report; that of a report that amends nothing is its run's.
    pub report_id: String,
    /// Every amendment up to this one, in order; never empty.
    pub amendments: Vec<Amendment>,
}

/// One amendment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Amendment {
    /// Id of the report that it takes the place of.
    pub replaces: String,
    /// Who answers for it.
    pub by: String,
    pub reason: String,
    pub changes: Vec<Change>,
}

/// A particular that is told otherwise; empty: not given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    pub field: &'static str,
    pub was: String,
    pub is: String,
}

/// Every amendment of a run's report as a sentence of its own, in order.
pub(super) fn told(run: &Run<'_>) -> Vec<String> {
    let all = run.provenance.amends.iter().flat_map(|amends| &amends.amendments);
    all.map(|amendment| {
        let changes: Vec<String> = amendment.changes.iter().map(change).collect();
        let changes = if changes.is_empty() { "nothing".to_owned() } else { changes.join(", ") };
        let (by, reason) = (&amendment.by, amendment.reason.trim_end_matches('.'));
        format!("Amendment to report {} by {by}: {reason}. Changed: {changes}.", amendment.replaces)
    })
    .collect()
}

fn change(change: &Change) -> String {
    let quoted = |text: &str| if text.is_empty() { "not given".to_owned() } else { format!("“{text}”") };
    format!("{} (was {}, is {})", change.field.replace('_', " "), quoted(&change.was), quoted(&change.is))
}
