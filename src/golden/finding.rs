//! What differs between a run and its accepted results, as data. Whoever tells it chooses the words.

use super::tolerance::Rule;
use crate::units::Dimension;

/// What of the results a finding is about, what weighs most first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    Diagnostics,
    Verdict,
    Requirement,
    Result,
    Table,
    /// A parameter, an input, an event, what is said of plan and rig.
    Other,
    Figure,
}

impl Part {
    /// The word of the JSON report.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
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
    pub part: Part,
    /// `hit.max_displacement`
    pub name: String,
    pub change: Change,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    Moved(Moved),
    Text {
        was: String,
        is: String,
        /// The first of several, in a table.
        first: Option<(Place, Count)>,
    },
    /// Accepted, and not there any more.
    Gone,
    /// There, and not accepted.
    New,
    /// So many of them were accepted, so many are there.
    Length {
        of: &'static str,
        was: usize,
        is: usize,
    },
}

/// A number that is not near enough, or the numbers of a column.
#[derive(Clone, Debug, PartialEq)]
pub struct Moved {
    pub dimension: Dimension,
    /// SI; None where there is no value.
    pub was: Option<f64>,
    pub is: Option<f64>,
    pub rule: Rule,
    /// Size that a relative tolerance is of, SI.
    pub scale: f64,
    /// Of a column or a curve: where this number stands, the largest of the moved ones; `first` the first of them.
    pub largest: Option<Place>,
    pub first: Option<Place>,
    pub count: Option<Count>,
}

/// A row of a table, or a point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// From 0.
    pub row: usize,
    pub step: Option<u64>,
    /// s
    pub time: Option<f64>,
}

/// So many of so many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Count {
    pub moved: usize,
    pub of: usize,
}

impl Moved {
    /// How far, SI.
    #[must_use]
    pub fn by(&self) -> Option<f64> {
        Some(self.is? - self.was?)
    }

    /// How far, of the accepted value; None of a value that was 0.
    #[must_use]
    pub fn by_fraction(&self) -> Option<f64> {
        let was = self.was.filter(|was| *was != 0.0)?;
        Some(self.by()? / was.abs())
    }
}

impl Finding {
    /// A difference of a part.
    #[must_use]
    pub fn new(part: Part, name: impl Into<String>, change: Change) -> Self {
        Self {
            part,
            name: name.into(),
            change,
        }
    }

    /// A text that reads otherwise.
    #[must_use]
    pub fn text(part: Part, name: impl Into<String>, was: &str, is: &str) -> Self {
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
