//! `psd study`: run, observe, merge and submit studies. In: a plan and the name of a study, or a folder. Out: data sets and answers. No
//! rig moves: all runs are simulated.

mod answers;
mod failure;
mod folder;
mod progress;
mod report;
mod run;
mod slurm;
mod submit;

use std::path::{Path, PathBuf};

use crate::cli::args::{StudyChoice, StudyCommand};
use crate::cli::exit::{Exit, Failure};
use crate::cli::files::plan_file;
use crate::cli::settings::Settings;
use crate::language::check::ParsedPlan;
use crate::plan::Plan;
use crate::study::definition::Definition;
use crate::study::definition::measured;
use crate::text::sanitize;

/// One command of studies.
pub fn study(command: &StudyCommand, settings: Settings) -> Result<Exit, Failure> {
    match command {
        StudyCommand::Run(arguments) => run::run(arguments, settings),
        StudyCommand::Status { folder } => folder::status(folder),
        StudyCommand::Merge { folder } => folder::merge(folder),
        StudyCommand::Report(arguments) => report::report(arguments, settings),
        StudyCommand::Submit(arguments) => submit::submit(arguments, settings),
    }
}

/// A plan with the study that is asked for.
struct Opened {
    parsed: ParsedPlan,
    plan: Plan,
    study: Definition,
    folder: PathBuf,
}

/// Reads and checks a plan; None if it has errors, which are printed.
fn open(path: &Path, choice: &StudyChoice, settings: Settings) -> Result<Option<Opened>, Failure> {
    let (parsed, checked) = plan_file::open_for_studies(path, &choice.plan_settings)?;
    plan_file::show(&checked, path, settings);
    let Some(mut plan) = checked.plan else {
        return Ok(None);
    };
    measured::known(&mut plan).map_err(|error| failure::of_measured(&error))?;
    let study = Definition::of(&plan.studies, choice.study.as_deref(), choice.runs)
        .map_err(|error| failure::of_definition(&error))?;
    let folder = choice.out.clone().unwrap_or_else(|| {
        let plan = path.file_stem().unwrap_or_default().to_string_lossy();
        let name = format!("{plan}-{}", study.name);
        Path::new("studies").join(sanitize::file_part(&name))
    });
    Ok(Some(Opened {
        parsed,
        plan,
        study,
        folder,
    }))
}
