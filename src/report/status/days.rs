//! Days of a test and of its report, `YYYY-MM-DD`. In: strings. Out: days and the number of days between them. No clock is
//! read.

use crate::report::run::Provenance;

/// The last day of the test, from the run log, or from the plan or the command line if the run log has no times.
#[must_use]
pub fn last_day(provenance: &Provenance) -> Option<&str> {
    let real = provenance.real.as_ref();
    let stated = [
        real.and_then(|real| real.ended.as_deref()),
        real.and_then(|real| real.began.as_deref()),
    ];
    stated
        .into_iter()
        .flatten()
        .chain(provenance.date.as_deref())
        .find_map(first_ten)
}

/// The first day of the test, from the same sources.
#[must_use]
pub fn first_day(provenance: &Provenance) -> Option<&str> {
    let began = provenance
        .real
        .as_ref()
        .and_then(|real| real.began.as_deref());
    began
        .into_iter()
        .chain(provenance.date.as_deref())
        .find_map(first_ten)
}

/// The day at the start of an ISO 8601 time. Such strings sort in the order of the days.
fn first_ten(text: &str) -> Option<&str> {
    let day = text.get(..10)?;
    let fits = |(index, byte): (usize, u8)| {
        if matches!(index, 4 | 7) {
            byte == b'-'
        } else {
            byte.is_ascii_digit()
        }
    };
    day.bytes().enumerate().all(fits).then_some(day)
}

/// A calendar day, written in full as `YYYY-MM-DD`.
#[must_use]
pub fn day(text: &str) -> Option<jiff::civil::Date> {
    let day: jiff::civil::Date = text.parse().ok()?;
    // The parser also accepts times and other forms.
    (day.to_string() == text).then_some(day)
}

/// Number of days from `earlier` to `later`; negative if `later` comes first. None if one of them is not a day.
#[must_use]
pub fn days_after(earlier: &str, later: &str) -> Option<i64> {
    let apart = day(earlier)?.until(day(later)?).ok()?;
    Some(i64::from(apart.get_days()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_lie_apart_by_the_calendar_and_what_is_no_day_lies_nowhere() {
        assert_eq!(days_after("2024-02-28", "2024-03-01"), Some(2));
        assert_eq!(days_after("2026-01-01", "2025-12-31"), Some(-1));
        assert_eq!(days_after("2020-01-01", "2026-11-22"), Some(2517));
        for no_day in ["", "soon", "2026-02-30", "20260101", "2026-01-01T00:00:00"] {
            assert_eq!(days_after(no_day, "2026-01-01"), None, "{no_day}");
        }
    }
}
