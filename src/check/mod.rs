//! Syntax tree → plan, all errors at once. In: the text of the plan and a [`Loader`] for the files it uses.
//! Out: a [`Checked`].

use crate::diagnostic::Diagnostic;
use crate::plan::Plan;
use crate::source::Sources;

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
}

/// The outcome of a check. `plan` is there if no error stands.
#[derive(Debug)]
pub struct Checked {
    pub plan: Option<Plan>,
    pub diagnostics: Vec<Diagnostic>,
    pub sources: Sources,
}

/// Checks a plan and all it uses.
#[must_use]
pub fn check(name: &str, text: &str, _loader: &dyn Loader, _options: &Options) -> Checked {
    let mut sources = Sources::default();
    sources.add(name, text);
    Checked { plan: None, diagnostics: Vec::new(), sources }
}
