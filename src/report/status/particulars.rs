//! The particulars of a report (ISO/IEC 17025, 7.8.2.1). In: a run, and the field of a particular. Out: its text from the run log, the
//! plan or an issue of the report; and the particulars that are missing or whose days are out of order.

use super::days::{days_after, first_day, last_day};
use crate::report::run::Run;
use crate::report::wording::particulars as wording;
use psd_plan::schema::plan_block as schema;
use psd_text::sanitize;

/// A particular of the first page.
pub(in crate::report) struct Particular {
    pub field: &'static str,
    pub name: &'static str,
    pub wanted: Wanted,
}

/// Whether ISO/IEC 17025, 7.8.2.1, requires a particular.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::report) enum Wanted {
    /// Every report states it.
    Always,
    /// A report states it if the validity of the results depends on it.
    WhereItMatters,
    /// The clause does not require it.
    No,
}

const fn particular(field: &'static str, name: &'static str, wanted: Wanted) -> Particular {
    Particular {
        field,
        name,
        wanted,
    }
}

/// The particulars of the first page, in order.
pub(in crate::report) const FRONT: &[Particular] = &[
    particular(schema::LABORATORY.name, wording::LABORATORY, Wanted::Always),
    particular(schema::ADDRESS.name, wording::ADDRESS, Wanted::Always),
    particular(schema::PLACE.name, wording::PLACE, Wanted::No),
    particular(schema::OPERATOR.name, wording::OPERATOR, Wanted::Always),
    particular(
        schema::AUTHORISED_BY.name,
        wording::AUTHORISED_BY,
        Wanted::Always,
    ),
    particular(schema::CUSTOMER.name, wording::CUSTOMER, Wanted::Always),
    particular(schema::CONTACT.name, wording::CONTACT, Wanted::Always),
    particular(schema::PROJECT.name, wording::PROJECT, Wanted::No),
    particular(schema::SPECIMEN_ID.name, wording::ITEM, Wanted::Always),
    particular(schema::MATERIAL.name, wording::MATERIAL, Wanted::No),
    particular(
        schema::CONDITION.name,
        wording::CONDITION,
        Wanted::WhereItMatters,
    ),
    particular(
        schema::RECEIPT_DATE.name,
        wording::RECEIVED,
        Wanted::WhereItMatters,
    ),
    particular(schema::DATE.name, wording::DATE, Wanted::Always),
    particular(schema::ISSUED.name, wording::ISSUED, Wanted::Always),
    particular(schema::STANDARD.name, wording::METHOD, Wanted::Always),
];

/// The text of a particular; None if it is blank. The operator and the days come from the run log, not from the plan. An issue of the
/// report may correct the operator's name.
pub(in crate::report) fn stated(run: &Run<'_>, field: &str) -> Option<String> {
    let restated = || run.provenance.restated(field);
    let recorded = match field {
        _ if field == schema::OPERATOR.name && restated().is_none() => {
            run.provenance.operator().map(str::to_owned)
        }
        _ if field == schema::DATE.name => days(run),
        _ => None,
    };
    let of_plan = || {
        run.plan
            .particulars
            .iter()
            .find(|(name, _)| *name == field)
            .map(|(_, text)| text.clone())
    };
    recorded
        .or_else(of_plan)
        .filter(|text| !text.trim().is_empty())
}

/// The day of the test; the first and the last day if they differ.
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
            Some(wording::first_to_last(first, last))
        }
        _ => Some(first),
    }
}

/// Names of particulars with one of these requirements that are not stated.
pub(in crate::report) fn missing_names(run: &Run<'_>, wanted: &[Wanted]) -> Vec<&'static str> {
    not_stated(run, wanted)
        .map(|particular| particular.name)
        .collect()
}

/// The fields of the required particulars that are not stated.
pub(super) fn missing_fields(run: &Run<'_>) -> Vec<&'static str> {
    not_stated(run, &[Wanted::Always])
        .map(|particular| particular.field)
        .collect()
}

fn not_stated(run: &Run<'_>, wanted: &[Wanted]) -> impl Iterator<Item = &'static Particular> {
    FRONT.iter().filter(move |particular| {
        wanted.contains(&particular.wanted) && stated(run, particular.field).is_none()
    })
}

/// The required particulars that the report of a test does not state, and days that are out of order.
pub(super) fn missing(run: &Run<'_>) -> Vec<String> {
    let names = missing_names(run, &[Wanted::Always])
        .into_iter()
        .map(|name| {
            let mut letters = name.chars();
            letters.next().map_or_else(String::new, |first| {
                first.to_lowercase().collect::<String>() + letters.as_str()
            })
        });
    names.chain(out_of_order(run)).collect()
}

/// An item is received before its test, and the report is issued after it. The run log has days of UTC, which may differ from those of
/// the laboratory by one.
fn out_of_order(run: &Run<'_>) -> Vec<String> {
    const TIME_ZONES: i64 = 1;
    let (first, last) = (first_day(run.provenance), last_day(run.provenance));
    let mut found = Vec::new();
    if let (Some(received), Some(first)) = (stated(run, schema::RECEIPT_DATE.name), first) {
        match days_after(first, &received) {
            Some(days) if days <= TIME_ZONES => {}
            Some(_) => found.push(wording::received_after_test(received, first)),
            None => found.push(wording::received_is_no_day(received)),
        }
    }
    if let (Some(issued), Some(last)) = (stated(run, schema::ISSUED.name), last)
        && days_after(&issued, last).is_none_or(|days| days > TIME_ZONES)
    {
        found.push(wording::issued_before_test(last, issued));
    }
    found
}
