//! What the server needs of the program around it: the check of a whole plan, its simulation, and files. It contains no code.

use std::path::{Path, PathBuf};

use psd_language::check::{LoadError, Loader};
use psd_plan::Plan;
use psd_text::diagnostic::Diagnostic;
use psd_text::source::Sources;
use psd_text::units::Dimension;

/// What the server needs of the program around it.
pub trait Program: Send + Sync {
    /// Checks a plan and every file that it uses, as `psd check` does.
    fn check(&self, name: &str, text: &str, loader: &Loader<'_>) -> Checked;

    /// Runs a plan on a simulated rig. No real rig is opened, whatever the plan names.
    fn simulate(&self, plan: &Plan) -> Simulation;

    /// The steps of a plan, as far as they are known before it runs.
    fn steps(&self, plan: &Plan) -> u64;

    /// The text of a file beside a plan; `file` is relative to the plan's folder.
    ///
    /// # Errors
    /// No such file, or one that a plan may not use.
    fn load(&self, plan: &Path, file: &str) -> Result<String, LoadError>;

    /// Every plan below a folder.
    fn plans(&self, folder: &Path) -> Vec<PathBuf>;

    /// The text of a plan; None if it cannot be read.
    fn read(&self, plan: &Path) -> Option<String>;
}

/// A checked plan. There is a `plan` if there is no error.
pub struct Checked {
    pub plan: Option<Plan>,
    pub diagnostics: Vec<Diagnostic>,
    pub sources: Sources,
}

/// The outcome of a simulated run.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Reason and position of a stop; None if the run comes to its end.
    pub stopped: Option<String>,
    /// The results of each procedure, by its name.
    pub procedures: Vec<(String, Vec<SimulatedResult>)>,
    pub requirements: Vec<SimulatedRequirement>,
}

/// A result of a simulated run, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedResult {
    pub name: &'static str,
    pub value: f64,
    pub dimension: Dimension,
}

/// A requirement on a simulated run.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedRequirement {
    pub label: String,
    /// The word of the report: `pass`, `fail`, …
    pub verdict: &'static str,
    /// The value of each of its conditions in SI; None where there is none.
    pub values: Vec<(Option<f64>, Dimension)>,
}
