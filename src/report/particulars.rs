//! What is stated of a test for its report. In: a run, and the name of a particular. Out: its text, as the record, the plan
//! or an issue of the report states it; and what clause 7.8.2.1 wants and nobody states, or states out of order.

use super::Run;
use super::days::{days_after, first_day, last_day};
use crate::text::sanitize;

/// A particular of the first page.
pub(super) struct Particular {
    pub field: &'static str,
    pub name: &'static str,
    pub wanted: Wanted,
}

/// What ISO/IEC 17025, 7.8.2.1, says of a particular.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Wanted {
    /// Every report states it.
    Always,
    /// It is stated where the validity of the results depends on it.
    WhereItMatters,
    /// The clause does not ask for it.
    No,
}

const fn particular(field: &'static str, name: &'static str, wanted: Wanted) -> Particular {
    Particular {
        field,
        name,
        wanted,
    }
}

/// On the first page, in this order.
pub(super) const FRONT: &[Particular] = &[
    particular("laboratory", "Laboratory", Wanted::Always),
    particular("address", "Address", Wanted::Always),
    particular("place", "Place of the test", Wanted::No),
    particular("operator", "Operator", Wanted::Always),
    particular("authorised_by", "Authorised by", Wanted::Always),
    particular("customer", "Customer", Wanted::Always),
    particular("contact", "Contact", Wanted::Always),
    particular("project", "Project", Wanted::No),
    particular("specimen_id", "Item tested", Wanted::Always),
    particular("material", "Material", Wanted::No),
    particular("condition", "Condition", Wanted::WhereItMatters),
    particular("receipt_date", "Item received", Wanted::WhereItMatters),
    particular("date", "Date of the test", Wanted::Always),
    particular("issued", "Date of issue", Wanted::Always),
    particular("standard", "Method", Wanted::Always),
];

/// A particular, unless it says nothing. Who stood by is known from the record, whoever the plan names, unless an issue of
/// the report corrects the name; the days are the record's.
pub(super) fn stated(run: &Run<'_>, field: &str) -> Option<String> {
    let restated = || run.provenance.restated(field);
    let told = match field {
        "operator" if restated().is_none() => run.provenance.operator().map(str::to_owned),
        "date" => days(run),
        _ => None,
    };
    let of_plan = || {
        run.plan
            .particulars
            .iter()
            .find(|(name, _)| *name == field)
            .map(|(_, text)| text.clone())
    };
    told.or_else(of_plan).filter(|text| !text.trim().is_empty())
}

/// The day of the test; of one that ended on another day, both.
fn days(run: &Run<'_>) -> Option<String> {
    let first = run.provenance.date.as_deref().map(sanitize::printed)?;
    let ended = run
        .provenance
        .real
        .as_ref()
        .and_then(|real| real.ended.as_deref())
        .and_then(|ended| ended.get(..10));
    match ended {
        Some(last) if first.len() == last.len() && first.as_str() < last => {
            Some(format!("{first} to {last}"))
        }
        _ => Some(first),
    }
}

/// Names of what is wanted in one of these ways and not stated.
pub(super) fn lacking(run: &Run<'_>, wanted: &[Wanted]) -> Vec<&'static str> {
    FRONT
        .iter()
        .filter(|one| wanted.contains(&one.wanted) && stated(run, one.field).is_none())
        .map(|one| one.name)
        .collect()
}

/// What a report of a test must state and does not, in words: particulars that every report has, and days in their order.
pub(super) fn missing(run: &Run<'_>) -> Vec<String> {
    let names = lacking(run, &[Wanted::Always]).into_iter().map(|name| {
        let mut letters = name.chars();
        letters.next().map_or_else(String::new, |first| {
            first.to_lowercase().collect::<String>() + letters.as_str()
        })
    });
    names.chain(out_of_order(run)).collect()
}

/// The item is received before it is tested, and the report issued after. The record has days of UTC: a laboratory's own may
/// be the one before or after.
fn out_of_order(run: &Run<'_>) -> Vec<String> {
    const ZONES: i64 = 1;
    let (first, last) = (first_day(run.provenance), last_day(run.provenance));
    let mut found = Vec::new();
    if let (Some(received), Some(first)) = (stated(run, "receipt_date"), first) {
        match days_after(first, &received) {
            Some(days) if days <= ZONES => {}
            Some(_) => found.push(format!(
                "days in their order (received {received}, tested {first})"
            )),
            None => found.push(format!(
                "a day on which the item was received (“{received}” is none)"
            )),
        }
    }
    if let (Some(issued), Some(last)) = (stated(run, "issued"), last)
        && days_after(&issued, last).is_none_or(|days| days > ZONES)
    {
        found.push(format!(
            "days in their order (tested {last}, issued {issued})"
        ));
    }
    found
}
