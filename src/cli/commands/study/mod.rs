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

use clap::{Args, Subcommand};

use crate::args::PlanSettings;
use crate::exit::{Exit, Failure};
use crate::files::plan_file;
use crate::settings::Settings;
use psd::check::ParsedPlan;
use psd::study::definition::Definition;
use psd::study::definition::measured;
use psd_plan::Plan;
use psd_text::sanitize;

#[derive(Debug, Subcommand)]
pub enum StudyCommand {
    /// Run a study of a plan, or continue one (no motion)
    Run(run::RunStudyArguments),
    /// Show the progress of a study or of its shards
    Status {
        /// The folder of the study
        #[arg(value_name = "FOLDER")]
        folder: PathBuf,
    },
    /// Put the shards of a study together
    #[command(
        after_help = "The file equals the file of one process, byte for byte.\n\n\
    Exit codes:\n\
    \x20 0  all requirements on probabilities are met, or there is none\n\
    \x20 1  a requirement on a probability is not met or undecided\n\
    \x20 3  a shard is missing, damaged or of another study"
    )]
    Merge {
        /// The folder of the shards
        #[arg(value_name = "FOLDER")]
        folder: PathBuf,
        /// The plan as the lines that reproduce a run name it
        #[arg(long, value_name = "PLAN")]
        plan: Option<PathBuf>,
    },
    /// Make summary, figures and report of a study from its data set
    #[command(
        after_help = "Needs neither the plan nor the build of psd that ran the study. Equal data sets give equal files.\n\n\
    Exit codes:\n\
    \x20 0  all requirements on probabilities are met, or there is none\n\
    \x20 1  a requirement on a probability is not met or undecided\n\
    \x20 3  the data set is missing or damaged, or a file cannot be written"
    )]
    Report(report::ReportStudyArguments),
    /// Print the scripts of a job array, or submit them
    Submit(submit::SubmitArguments),
}

/// A study of a plan, and where it is kept.
#[derive(Debug, Args)]
pub struct StudyChoice {
    /// The study or fragility, if the plan has several
    #[arg(long, value_name = "NAME")]
    pub study: Option<String>,
    /// Number of runs, or most runs, instead of the plan's
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub runs: Option<u64>,
    /// Folder of the study [default: studies/PLAN-STUDY]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
}

/// One command of studies.
pub fn study(command: &StudyCommand, settings: Settings) -> Result<Exit, Failure> {
    match command {
        StudyCommand::Run(arguments) => run::run(arguments, settings),
        StudyCommand::Status { folder } => folder::status(folder),
        StudyCommand::Merge { folder, plan } => folder::merge(folder, plan.as_deref()),
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
