//! Comparison of a run with accepted results. In: the result files of both as text, and the tolerances of the plan. Out: [`Finding`]s. It
//! uses no file, no terminal and no picture.

pub mod comparison;
mod figures;
mod finding;
mod number;
pub mod print;
mod summary;
mod table;
mod tested;
mod thinning;
mod tolerance;

use std::collections::BTreeMap;

pub use finding::{Change, Count, Finding, FindingPart, Moved, RowRef};
pub use print::junit::junit;
pub use print::tap::tap;
pub use print::words::Words;
pub use table::{Cells, Table, dimension as column_dimension};
pub use tested::{Accepted, Outcome, Report, Tested};
pub use thinning::thinned;
pub use tolerance::{FLOOR, Rule, Tolerances};

/// The text of the diagnostics of a plan that is intended to fail its check.
pub const DIAGNOSTICS: &str = "diagnostics.txt";
pub const SUMMARY: &str = "summary.json";
pub const FIGURES: &str = crate::report::FIGURE_DATA;
const TABLES: &str = "tables/";

/// The compared part of a folder of results: texts by path. Pictures and test reports are made from the same numbers, and are not
/// included.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Truth(BTreeMap<String, String>);

impl Truth {
    /// Whether a file is compared.
    #[must_use]
    pub fn holds(path: &str) -> bool {
        matches!(path, DIAGNOSTICS | SUMMARY | FIGURES) || table_name(path).is_some()
    }

    /// The texts of the compared files. Only some rows of a long table are compared: see [`thinned`].
    #[must_use]
    pub fn of(files: impl IntoIterator<Item = (String, String)>) -> Self {
        let compared = |(path, text): (String, String)| {
            let text = if table_name(&path).is_some() {
                thinned(&text)
            } else {
                text
            };
            Self::holds(&path).then_some((path, text))
        };
        Self(files.into_iter().filter_map(compared).collect())
    }

    /// Path and text of each file.
    pub fn files(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0
            .iter()
            .map(|(path, text)| (path.as_str(), text.as_str()))
    }

    /// Whether there is nothing to compare with.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether it belongs to a plan that fails its check.
    #[must_use]
    pub fn is_of_faults(&self) -> bool {
        self.0.contains_key(DIAGNOSTICS)
    }

    #[must_use]
    pub fn text(&self, path: &str) -> Option<&str> {
        self.0.get(path).map(String::as_str)
    }

    /// The tables by procedure.
    pub fn tables(&self) -> impl Iterator<Item = (&str, Table)> {
        self.0
            .iter()
            .filter_map(|(path, text)| Some((table_name(path)?, Table::read(text))))
    }

    /// The figures; None if there are none, or if their format is unknown.
    #[must_use]
    pub fn figures(&self) -> Option<crate::report::Figures> {
        self.text(FIGURES)
            .and_then(|text| serde_json::from_str(text).ok())
    }
}

/// `tables/hit.csv` belongs to `hit`.
fn table_name(path: &str) -> Option<&str> {
    path.strip_prefix(TABLES)?.strip_suffix(".csv")
}

/// All differences, the most important first.
#[must_use]
pub fn compare(accepted: &Truth, now: &Truth, tolerances: &Tolerances) -> Vec<Finding> {
    let mut found = Vec::new();
    match (accepted.text(DIAGNOSTICS), now.text(DIAGNOSTICS)) {
        (Some(was), Some(is)) if was != is => {
            found.push(Finding::text(
                FindingPart::Diagnostics,
                DIAGNOSTICS,
                was,
                is,
            ));
        }
        (Some(_), None) => {
            found.push(Finding::new(
                FindingPart::Diagnostics,
                "the plan checks, but is accepted as a plan that does not",
                Change::Missing,
            ));
        }
        (None, Some(_)) => found.push(Finding::new(
            FindingPart::Diagnostics,
            "the plan fails to check",
            Change::New,
        )),
        _ => {}
    }
    if accepted.is_of_faults() || now.is_of_faults() {
        return found;
    }
    summary::compare(
        accepted.text(SUMMARY),
        now.text(SUMMARY),
        tolerances,
        &mut found,
    );
    table::compare_all(accepted, now, tolerances, &mut found);
    figures::compare(accepted, now, tolerances, &mut found);
    if !found.is_empty() {
        found.extend(summary::plan_change(
            accepted.text(SUMMARY),
            now.text(SUMMARY),
        ));
    }
    found.sort_by_key(|finding| finding.part);
    found
}
