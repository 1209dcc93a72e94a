//! The differences between a run and its accepted results, as data. The printing modules choose the text.

use super::tolerance::Rule;
use psd_text::units::Dimension;

/// The part of the results that a finding is about, the most important first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FindingPart {
    /// The plan's text, a parameter, an input that follows from no changed result, or the rig.
    Cause,
    Diagnostics,
    Verdict,
    Requirement,
    Result,
    Table,
    /// An input that follows from results, an event, or a deviation.
    Other,
    Figure,
}

impl FindingPart {
    /// The name in the JSON report.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cause => "cause",
            Self::Diagnostics => "diagnostics",
            Self::Verdict => "verdict",
            Self::Requirement => "requirement",
            Self::Result => "result",
            Self::Table => "table",
            Self::Other => "other",
            Self::Figure => "figure",
        }
    }
}

/// One difference.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    pub part: FindingPart,
    /// For example `hit.max_displacement`.
    pub name: String,
    pub change: Change,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    Moved(Moved),
    Text {
        was: String,
        is: String,
        /// The first of several differences, in a table.
        first: Option<(RowRef, Count)>,
    },
    /// Accepted, but missing now.
    Missing,
    /// Present now, but not accepted.
    New,
    /// The accepted number of entries, and the present one.
    Length {
        of: &'static str,
        was: usize,
        is: usize,
    },
}

/// A number outside its tolerance, or the numbers of a column.
#[derive(Clone, Debug, PartialEq)]
pub struct Moved {
    pub dimension: Dimension,
    /// SI; None if there is no value.
    pub was: Option<f64>,
    pub is: Option<f64>,
    pub rule: Rule,
    /// Reference value of a relative tolerance, SI.
    pub scale: f64,
    /// For a column or a curve: the position of this number, the largest of the changed ones; `first` is the position of the first.
    pub largest: Option<RowRef>,
    pub first: Option<RowRef>,
    pub count: Option<Count>,
}

/// A row of a table, or a point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowRef {
    /// From 0.
    pub row: usize,
    pub step: Option<u64>,
    /// s
    pub time: Option<f64>,
}

/// A count and its total.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Count {
    pub moved: usize,
    pub of: usize,
}

impl Change {
    /// Another number of entries.
    #[must_use]
    pub fn length(of: &'static str, was: usize, is: usize) -> Option<Self> {
        (was != is).then_some(Self::Length { of, was, is })
    }
}

impl Moved {
    /// The difference, SI.
    #[must_use]
    pub fn by(&self) -> Option<f64> {
        Some(self.is? - self.was?)
    }

    /// The difference relative to the accepted value; None if that was 0.
    #[must_use]
    pub fn by_fraction(&self) -> Option<f64> {
        let was = self.was.filter(|was| *was != 0.0)?;
        Some(self.by()? / was.abs())
    }
}

impl Finding {
    /// A difference in a part.
    #[must_use]
    pub fn new(part: FindingPart, name: impl Into<String>, change: Change) -> Self {
        Self {
            part,
            name: name.into(),
            change,
        }
    }

    /// A text that is different.
    #[must_use]
    pub fn text(part: FindingPart, name: impl Into<String>, was: &str, is: &str) -> Self {
        Self::new(
            part,
            name,
            Change::Text {
                was: was.to_owned(),
                is: is.to_owned(),
                first: None,
            },
        )
    }
}
