//! The check of a whole plan: from its text to the plan, with all errors in one pass. In: the text of the plan and a [`Loader`] for the
//! files it uses. Out: a [`Checked`]. It asks the procedures for what is theirs, and it runs nothing.

pub mod binding;
mod driver;
mod golden;
mod parsed_plan;
mod parts;
mod procedures;
mod report;
#[cfg(test)]
mod tests;
mod warnings;

pub use parsed_plan::{ParsedPlan, check};
pub use psd_language::check::{LoadError, Loader, no_files};
pub use warnings::dry_run::is_short;

use psd_plan::Plan;
use psd_text::diagnostic::Diagnostic;
use psd_text::source::{Sources, Span};

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
    /// The plan is also run on an ideal copy of its rig, if that takes milliseconds.
    pub dry_run: bool,
    /// The studies of the plan are about to be run, which a real rig cannot do.
    pub for_studies: bool,
}

/// The outcome of a check. There is a `plan` if there is no error.
#[derive(Debug)]
pub struct Checked {
    pub plan: Option<Plan>,
    pub diagnostics: Vec<Diagnostic>,
    pub sources: Sources,
    /// The rigs that the plan declares, in its order.
    pub rigs: Vec<String>,
    /// The entries that state how the rig of the run is connected; empty for the ideal one.
    pub rig_links: Vec<Span>,
}
