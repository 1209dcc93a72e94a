//! A varied input of a study, and where its values come from. The columns of one file are one source.

use super::target::Target;
use psd_physics::study::distribution::Distribution;
use psd_plan::Interval;
use psd_plan::formula::ResultReference;
use psd_text::source::Span;

/// A varied input.
pub(super) struct Varied<'a> {
    pub target: Target<'a>,
    pub law: Law,
    /// The distribution as the plan writes it.
    pub text: String,
    /// The whole entry.
    pub span: Span,
}

/// Where the values of an input come from.
pub(super) enum Law {
    /// With its limits, where it has some.
    Distribution(Distribution, Option<Interval>),
    /// A column of a file, SI; or the numbers of ground-motion records.
    Column { file: String, values: Vec<f64> },
    /// Normal, by the value and the uncertainty of this result in a run.
    Measured(ResultReference),
}

impl Law {
    /// The file, of a column.
    pub(super) fn file(&self) -> Option<&str> {
        match self {
            Self::Distribution(..) | Self::Measured(_) => None,
            Self::Column { file, .. } => Some(file),
        }
    }
}

/// The source of each input, as an index.
pub(super) fn source_of(varied: &[Varied], input: usize) -> usize {
    let is_new = |at: &usize| {
        let file = varied[*at].law.file();
        *at == 0 || file.is_none() || file != varied[at - 1].law.file()
    };
    (1..=input).filter(is_new).count()
}
