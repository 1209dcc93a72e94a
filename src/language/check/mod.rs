//! The check: from syntax tree to plan, with all errors in one pass. In: the text of the plan and a [`Loader`]
//! for the files it uses. Out: a [`Checked`]. It runs nothing.

pub(crate) mod checker;
pub mod declarations;
pub(crate) mod declared;
mod driver;
pub mod expressions;
mod imports;
pub(crate) mod messages;
mod parsed_plan;
pub(crate) mod procedures;
mod rig;
mod scope;
mod tested;
#[cfg(test)]
mod tests;
pub(crate) mod warnings;

pub use checker::{DEEPEST_VALUES, MOST_TERMS};
pub use declarations::ground::record::MOST_SAMPLES as MOST_GROUND_SAMPLES;
pub use declarations::study::MOST_SAMPLE_ROWS;
pub use expressions::literal::MOST_ENTRIES;
pub use imports::{DEEPEST, MOST_FILES};
pub use parsed_plan::{ParsedPlan, check};

use crate::plan::Plan;
use crate::text::diagnostic::Diagnostic;
use crate::text::source::{Sources, Span};

/// Loads the text of used files. Paths are relative to the plan's folder, with `/`, already free of `..`.
pub type Loader<'l> = dyn Fn(&str) -> Result<String, LoadError> + 'l;

/// The [`Loader`] of a plan that uses no file.
///
/// # Errors
/// Every path: there is no file.
pub fn no_files(_: &str) -> Result<String, LoadError> {
    Err(LoadError::NotFound)
}

/// Why a used file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LoadError {
    NotFound,
    /// A folder, a device, a link out of the folder, a file that is too large or not UTF-8: the reason, for the reader.
    Refused(String),
}

/// The options of the command line that affect the plan.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// `--rig NAME`
    pub rig: Option<String>,
    /// `--set name=value`, in order.
    pub settings: Vec<(String, String)>,
    /// `--date`, ISO 8601.
    pub date: Option<String>,
    /// The day of the check, `YYYY-MM-DD`: due dates of calibrations are compared with it. None: they are not.
    pub today: Option<String>,
    /// A run is about to begin, the command line names no operator, and no operator can be asked.
    pub unattended: bool,
    /// The studies of the plan are about to be run, which a real rig cannot do.
    pub for_studies: bool,
}

/// The outcome of a check. There is a `plan` if there is no error.
#[derive(Debug)]
pub struct Checked {
    pub plan: Option<Plan>,
    pub diagnostics: Vec<Diagnostic>,
    pub sources: Sources,
    /// The entries that state how the rig of the run is connected; empty for the ideal one.
    pub rig_links: Vec<Span>,
}
