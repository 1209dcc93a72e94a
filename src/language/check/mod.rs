//! The check: syntax tree to plan, all errors at once. In: the text of the plan and a [`Loader`]
//! for the files it uses. Out: a [`Checked`]. It runs nothing.

pub(crate) mod checker;
pub mod declarations;
pub(crate) mod declared;
mod driver;
pub mod expressions;
mod imports;
pub(crate) mod messages;
pub(crate) mod procedures;
mod rig;
mod scope;
mod tested;
#[cfg(test)]
mod tests;
pub(crate) mod warnings;

pub use checker::{DEEPEST_VALUES, MOST_TERMS};
pub use declarations::ground_record::MOST_SAMPLES as MOST_GROUND_SAMPLES;
pub use driver::check;
pub use expressions::literal::MOST_ENTRIES;
pub use imports::{DEEPEST, MOST_FILES};

use crate::plan::Plan;
use crate::text::diagnostic::Diagnostic;
use crate::text::source::{Sources, Span};

/// Gives the text of used files. Paths are relative to the plan's folder, with `/`, already free of `..`.
pub trait Loader {
    /// # Errors
    /// Why the file cannot be used.
    fn load(&self, path: &str) -> Result<String, LoadFault>;
}

/// Why a used file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LoadFault {
    NotFound,
    /// A folder, device, link out of the folder, too large, no UTF-8: the reason for a person.
    Refused(String),
}

/// What the command line says of the plan.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// `--rig NAME`
    pub rig: Option<String>,
    /// `--set name=value`, in order.
    pub settings: Vec<(String, String)>,
    /// `--date`, ISO 8601.
    pub date: Option<String>,
    /// A run is to begin, the command line names nobody, and nobody can be asked.
    pub unattended: bool,
    /// The plan is of a record: names of older versions are read.
    pub recorded: bool,
}

/// The outcome of a check. `plan` is there if no error stands.
#[derive(Debug)]
pub struct Checked {
    pub plan: Option<Plan>,
    pub diagnostics: Vec<Diagnostic>,
    pub sources: Sources,
    /// Where the rig of the run says how it is reached; empty for the ideal one.
    pub rig_links: Vec<Span>,
}
