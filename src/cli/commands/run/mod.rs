//! `psd run`: check → run → verdict → files, for one plan or for several. Nothing moves while the plan has an error, and nothing moves before the run log is open.

pub(crate) mod check_run;
pub(crate) mod on_rig;
mod recorded_folder;
pub(crate) mod resume;
mod several;

use std::path::{Path, PathBuf};

use clap::Args;

use crate::args::{Format, PlanSettings, RunLog, ScreenForm, name};
use crate::exit::{Exit, Failure};
use crate::files::accepted::AcceptedFolder;
use crate::files::golden_run;
use crate::files::golden_run::Extent;
use crate::files::plan_file;
use crate::files::plans::{Depth, named};
use crate::operator::real_rig;
use crate::operator::watch::Attendance;
use crate::output::{print_message, print_result};
use crate::settings::Settings;
use check_run::check_run;
use on_rig::{End, on_its_rig};
use psd::golden::print::console;
use psd::golden::{Outcome, Tested};
use psd_rig::StopRequest;
use psd_text::diagnostic::json;

#[derive(Debug, Args)]
#[command(
    after_help = "A REAL RIG MOVES after its release. psd first shows how far, how fast and with which force; the operator then types RELEASE. \
    With `--yes` it MOVES without this prompt. With `--check-run` it MOVES for the pre-test check and the first stiffness ramps.\n\n\
    Exit codes:\n\
    \x20 0  all requirements met\n\
    \x20 1  a requirement failed or is inconclusive, or a published number is not reproduced\n\
    \x20 2  error in the plan or on the command line\n\
    \x20 3  fault of the rig or a file\n\
    \x20 4  stopped by a limit or by the operator"
)]
pub struct RunArguments {
    /// Plans, folders of plans, or `-` for standard input
    #[arg(value_name = "PLAN", required = true)]
    pub plans: Vec<PathBuf>,
    /// Run folder, new or empty [default: runs/PLAN-N]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// Answer every prompt with yes, including the motion release
    #[arg(long)]
    pub yes: bool,
    /// Operator name [default: the plan's `operator`]
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub operator: Option<String>,
    /// Progress of the run [default: full on a terminal, else plain]
    #[arg(long, value_enum, value_name = "FORM")]
    pub screen: Option<ScreenForm>,
    /// Standard output: the run folder, or the summary as JSON
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub format: Format,
    /// Run log of a simulation: digests, or every target and reading
    #[arg(long, value_enum, value_name = "FORM")]
    pub log: Option<RunLog>,
    /// Also replace the accepted results in reports/PLAN
    #[arg(long)]
    pub accept: bool,
    /// Check run (A REAL RIG MOVES), and prediction of the rest
    #[arg(long, conflicts_with = "accept")]
    pub check_run: bool,
    /// Number of plans run in parallel, on virtual rigs [default: 1]
    #[arg(long, short, value_name = "N", conflicts_with_all = ["rig", "format"])]
    pub jobs: Option<std::num::NonZeroUsize>,
}

/// One plan of the command line.
pub(crate) struct Job<'a> {
    path: &'a Path,
    arguments: &'a RunArguments,
    /// Ctrl-C during this plan, or during one before it.
    stop_request: &'a StopRequest,
}

/// The end of one plan.
pub(crate) struct Done {
    exit: Exit,
    /// None: there are no results, or they are those of the run that was resumed.
    folder: Option<PathBuf>,
}

impl From<Exit> for Done {
    fn from(exit: Exit) -> Self {
        Self { exit, folder: None }
    }
}

/// Runs the plans that the command line names.
pub fn run(arguments: &RunArguments, settings: Settings) -> Result<Exit, Failure> {
    let plans = named(&arguments.plans, Depth::Folder)?;
    let stop_request = StopRequest::default();
    match plans.as_slice() {
        [path] => run_one(
            &Job {
                path,
                arguments,
                stop_request: &stop_request,
            },
            settings,
        )
        .map(|done| done.exit),
        plans => several::run(plans, arguments, &stop_request, settings),
    }
}

/// Runs one plan.
fn run_one(job: &Job<'_>, settings: Settings) -> Result<Done, Failure> {
    let Job {
        path, arguments, ..
    } = *job;
    let attendance = Attendance {
        yes: arguments.yes,
        operator: arguments.operator.clone(),
        screen: arguments.screen,
    };
    let checked = real_rig::open_plan(path, &arguments.plan_settings, &attendance, settings)?;
    let Some(plan) = &checked.plan else {
        if arguments.format == Format::Json {
            print_result(&json::printed_diagnostics(&plan_file::diagnostics(
                &checked, path,
            )))?;
        }
        return Ok(Exit::Wrong.into());
    };
    if plan.procedures.is_empty() {
        return Err(
            Failure::command_line("the plan has no procedure: nothing would run")
                .help("check declarations that other plans `use` with `psd check`"),
        );
    }
    let attendance = real_rig::named(attendance, plan)?;
    let in_the_plan = |failure: Failure| {
        failure.in_the_plan(|fault| plan_file::location_of_link(&checked, path, fault))
    };
    if arguments.check_run {
        return check_run(plan, job, &attendance, settings).map_err(in_the_plan);
    }
    let accepted = arguments
        .accept
        .then(|| AcceptedFolder::of(path))
        .transpose()?;
    if let Some(accepted) = &accepted
        && let Some(reason) = accepted.belongs_to_another()?
    {
        return Err(Failure::command_line(reason));
    }
    if accepted.is_some() && !golden_run::is_as_written(plan, &arguments.plan_settings) {
        return Err(Failure::command_line(
            "`--accept` requires the plan as it is written, on its virtual rig",
        )
        .help("remove `--set`, `--rig` and `--date`, or write them into the plan"));
    }
    let ran = on_its_rig(plan, job, &attendance, settings).map_err(in_the_plan)?;
    let finished = match ran.finish(plan, &attendance, settings)? {
        End::Resumed(exit) => return Ok(exit.into()),
        End::Finished(finished) => finished,
    };
    if let Some(accepted) = accepted {
        let trial = golden_run::trial(path, Extent::All)?;
        if trial.ended.as_ref() == Some(&finished.recorded.record.outcome) {
            let outcome = Outcome::Accepted(accepted.accept(
                &trial.files,
                &trial.tolerances,
                false,
                false,
            )?);
            print_message(&console::summary_text(
                &Tested {
                    name: path.with_extension("").display().to_string(),
                    folder: accepted.path().display().to_string(),
                    outcome,
                },
                settings.color,
            ));
        } else {
            print_message(
                "  not accepted: the run was stopped, but the plan as it is written continues\n",
            );
        }
    }
    finished.print(arguments.format)?;
    Ok(Done {
        exit: finished.exit,
        folder: Some(finished.folder.path().to_owned()),
    })
}
