//! The command line, parsed. In: the arguments of the process. Out: [`Arguments`], with the form of
//! every value checked. It does not open files and does not know what a command does.

mod evidence;
mod study;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::text::diagnostic::excerpt::escape;

pub use evidence::{
    IssueArguments, KeygenArguments, ReportArguments, SignArguments, VerifyArguments,
};
pub use study::{
    ReportStudyArguments, RunStudyArguments, StudyChoice, StudyCommand, SubmitArguments,
};

/// Pseudo-dynamic structural tests, from a plan to a test report.
#[derive(Debug, Parser)]
#[command(name = "psd", version, long_version = concat!(
    env!("CARGO_PKG_VERSION"), "\nsources, SHA-256 ", env!("PSD_BUILD"), "\nbuilt for ", env!("PSD_TOOLCHAIN"),
), about, max_term_width = 100, arg_required_else_help = true)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,

    /// Colour the output; respects `NO_COLOR`
    #[arg(long, global = true, value_enum, default_value_t = Color::Auto, value_name = "WHEN")]
    pub color: Color,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Check a plan, run it, write results and test report
    Run(RunArguments),
    /// Resume an interrupted run on a real rig
    Resume(ResumeArguments),
    /// Issue the report of a run (no motion)
    Issue(IssueArguments),
    /// Recompute the results of a run from its run log (no motion)
    Report(ReportArguments),
    /// Verify run log, results and signatures of a run (no motion)
    Verify(VerifyArguments),
    /// Sign a verified run folder
    Sign(SignArguments),
    /// Create a pair of signature keys
    Keygen(KeygenArguments),
    /// Report all errors of plans (no motion)
    Check(CheckArguments),
    /// Compare results of two or more runs
    Compare(CompareArguments),
    /// Compare plans on virtual rigs with their accepted results
    Test(TestArguments),
    /// Format plans in the canonical layout
    Fmt(FmtArguments),
    /// Explain a diagnostic code, such as E202, or list all codes
    Explain {
        /// Diagnostic code
        code: Option<String>,
        /// Show the wrong and the right plan in full
        #[arg(long, requires = "code")]
        full: bool,
    },
    /// List the limits of the language: sizes, nesting, steps
    Limits,
    /// Run many simulations of a plan with scattered inputs
    Study {
        #[command(subcommand)]
        command: StudyCommand,
    },
    /// Probe, monitor, jog, emulate or serve a rig
    Rig {
        #[command(subcommand)]
        command: RigCommand,
    },
}

#[derive(Debug, Subcommand)]
pub enum RigCommand {
    /// List serial ports of this machine, with their stable names
    List {
        /// Output format: one line per port, or JSON
        #[arg(long, value_enum, default_value_t = Format::Human)]
        format: Format,
    },
    /// Identify the rig and show its readings and margins (no motion)
    #[command(after_help = "Exit codes:\n\
    \x20 0  the rig answers and is within its limits\n\
    \x20 2  error in the plan or on the command line\n\
    \x20 3  no rig answers, or a different rig than the plan names\n\
    \x20 4  the rig is outside a limit")]
    Probe {
        /// The plan, a `.psd` file or a Markdown document
        #[arg(value_name = "PLAN")]
        plan: PathBuf,
        #[command(flatten)]
        plan_settings: PlanSettings,
    },
    /// Show the readings continuously (no motion)
    #[command(after_help = "In a pipe: one line per reading, in SI units.\n\n\
    Exit codes:\n\
    \x20 0  ended by Ctrl-C, `q`, `--count` or its reader\n\
    \x20 2  error in the plan or on the command line\n\
    \x20 3  fault of the rig, or no answer")]
    Monitor {
        /// The plan, a `.psd` file or a Markdown document
        #[arg(value_name = "PLAN")]
        plan: PathBuf,
        #[command(flatten)]
        plan_settings: PlanSettings,
        /// Stop after this number of readings
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
        count: Option<u64>,
        /// Time between two readings, from 10 ms to 1 min
        #[arg(long, value_name = "TIME", default_value = "100 ms")]
        every: String,
    },
    /// MOVE the rig by hand within the plan's limits
    Jog(JogArguments),
    /// Emulate the rig of a plan at its own port, until Ctrl-C
    Simulate(SimulateArguments),
    /// Let a coordinator or OpenSees MOVE the rig within the plan's limits
    Serve(ServeArguments),
}

#[derive(Debug, Args)]
#[command(
    after_help = "THE RIG MOVES. On a real rig every question, answer and move is logged in a run folder for `psd verify`.\n\n\
    Exit codes:\n\
    \x20 0  all targets reached\n\
    \x20 2  error in the plan or on the command line\n\
    \x20 3  fault of the rig\n\
    \x20 4  stopped by a limit or by the operator"
)]
pub struct JogArguments {
    /// The plan, a `.psd` file or a Markdown document
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// Target, such as "1 mm" or "1 mm, 2 mm" [default: typed]
    #[arg(long, value_name = "POSITION", allow_hyphen_values = true)]
    pub to: Option<String>,
    /// Speed, such as "0.5 mm/s" [default: the rig's own speed]
    #[arg(long, value_name = "SPEED")]
    pub speed: Option<String>,
    /// Answer every prompt with yes: the rig MOVES immediately
    #[arg(long)]
    pub yes: bool,
    /// Clear the hold of an axis without moving it (logged)
    #[arg(long)]
    pub let_go: bool,
    /// Count positions from the zero of this run (`datum = here`)
    #[arg(long, value_name = "RUN")]
    pub datum: Option<PathBuf>,
    /// Operator name [default: the plan's `operator`]
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub operator: Option<String>,
    /// Run folder on a real rig, new or empty [default: runs/PLAN-N]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(
    after_help = "The script has one fault per line, as TIME: FAULT. Times are `at 4.5 s`, `after 12 moves`, `after 20 readings`, `after 3 replies`, \
    `each reply with 0.01`. Faults are, among others, `drop replies 3`, `delay reply 0.4 s`, `flip a bit`, `hang up`, `reboot`, \
    `freeze force`, `scale force by -1`. See docs/reference/emulator-faults.md.\n\n\
    Exit codes:\n\
    \x20 0  all targets within the limits\n\
    \x20 2  error in the plan, the script or on the command line\n\
    \x20 3  fault of a port or a file\n\
    \x20 4  a target outside the limits"
)]
pub struct SimulateArguments {
    /// The plan, a `.psd` file or a Markdown document
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// Script of faults, such as `after 12 moves: drop replies 3`
    #[arg(long, value_name = "FILE")]
    pub script: Option<PathBuf>,
    /// New log file of all bytes and moves, with their times
    #[arg(long, value_name = "FILE")]
    pub log: Option<PathBuf>,
    /// Seed of random noise and faults
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// End when the last host has disconnected
    #[arg(long)]
    pub once: bool,
}

#[derive(Debug, Args)]
#[command(
    after_help = "THE RIG MOVES as the client requests. psd prints `ready` when it listens, and a summary after each session.\n\n\
    Exit codes:\n\
    \x20 0  closed by the client\n\
    \x20 2  error in the plan or on the command line\n\
    \x20 3  fault of the client or the rig\n\
    \x20 4  stopped by a limit or by the operator\n\
    The worst session determines the code."
)]
pub struct ServeArguments {
    /// The plan: its rig, specimen and limits apply
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// Protocol of the client
    #[arg(long, value_enum)]
    pub protocol: ServedProtocol,
    /// Address to listen at; port 0 is any free port
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:8090")]
    pub listen: std::net::SocketAddr,
    /// Stiffness for a generic client [default: initial stiffness]
    #[arg(long, value_name = "STIFFNESS")]
    pub stiffness: Option<String>,
    /// Comma-separated floor names for NEES, the lowest first [default: MDL-00-01, MDL-00-02, …]
    #[arg(long, value_name = "NAMES")]
    pub control_points: Option<String>,
    /// End after the first session
    #[arg(long)]
    pub once: bool,
    /// Run folder, new or empty [default: runs/PLAN-N]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Answer every prompt with yes: a real rig MOVES immediately
    #[arg(long)]
    pub yes: bool,
    /// Operator at the rig [default: the plan's `operator`]
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub operator: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ServedProtocol {
    /// NEES "LabVIEW plugin" ASCII of OpenFresco and UI-SimCor
    Nees,
    /// Socket of OpenSees `genericClient` and OpenFresco `GenericTCP`
    GenericClient,
}

impl ServedProtocol {
    /// The word of the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nees => "nees",
            Self::GenericClient => "generic-client",
        }
    }
}

#[derive(Debug, Args)]
#[command(
    after_help = "A REAL RIG MOVES after its release. psd first shows how far, how fast and with which force; the operator then types RELEASE. \
    With `--yes` it MOVES without this prompt. With `--check-run` it MOVES for the pre-test check and the first stiffness ramps.\n\n\
    Exit codes:\n\
    \x20 0  all requirements met\n\
    \x20 1  a requirement failed or is inconclusive\n\
    \x20 2  error in the plan or on the command line\n\
    \x20 3  fault of the rig or a file\n\
    \x20 4  stopped by a limit or by the operator"
)]
pub struct RunArguments {
    /// The plan, a `.psd` file or a Markdown document
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
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
    /// Standard output: the run folder, or the summary as JSON
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub format: Format,
    /// Also replace the accepted results in reports/PLAN
    #[arg(long, alias = "bless")]
    pub accept: bool,
    /// Check run (A REAL RIG MOVES), and prediction of the rest
    #[arg(long, alias = "rehearse", conflicts_with = "accept")]
    pub check_run: bool,
}

#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of its own")]
#[command(
    after_help = "A REAL RIG MOVES after its release. Before that, psd checks that run log, plan, program and rig belong to the run, and reads the \
    state of the last target from the rig. See docs/how-to/resume.md.\n\n\
    Exit codes:\n\
    \x20 as for `psd run`; 3 also if the run must not continue"
)]
pub struct ResumeArguments {
    /// The run folder
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// Person authorising the resumption (logged)
    #[arg(long, value_name = "NAME")]
    pub operator: String,
    /// Reason of the interruption, and why the run may continue (logged)
    #[arg(long, value_name = "TEXT")]
    pub reason: String,
    /// Plan to compare, or with --amend to use instead
    #[arg(long, value_name = "PLAN")]
    pub plan: Option<PathBuf>,
    /// Accept a different plan or program (logged)
    #[arg(long)]
    pub amend: bool,
    /// Confirm that the restarted rig was referenced (logged)
    #[arg(long)]
    pub re_referenced: bool,
    /// Confirm that the rig was not power-cycled (logged)
    #[arg(long)]
    pub same_power_up: bool,
    /// Clear the hold of an axis without moving it (logged)
    #[arg(long)]
    pub let_go: bool,
    /// Confirm a force change after inspecting the specimen (logged)
    #[arg(long)]
    pub accept_relaxation: bool,
    /// Answer every prompt with yes, including the motion release
    #[arg(long)]
    pub yes: bool,
}

#[derive(Debug, Args)]
pub struct CheckArguments {
    /// The plans, `.psd` files or Markdown documents
    #[arg(value_name = "PLAN", required = true)]
    pub plans: Vec<PathBuf>,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// Predict the run by a dry run on an ideal virtual rig
    #[arg(long)]
    pub explain: bool,
    /// Diagnostics as text on standard error, or JSON on standard output
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub format: Format,
}

#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of its own")]
#[command(
    after_help = "The accepted results of plans/NAME.psd are in reports/NAME, beside the folder of the plans. The `golden` block of a plan sets the \
    tolerances; see docs/golden.md.\n\n\
    Exit codes:\n\
    \x20 0  all results as accepted\n\
    \x20 2  error on the command line\n\
    \x20 3  fault of a file\n\
    \x20 5  a plan differs, has no accepted results, or could not run"
)]
pub struct TestArguments {
    /// Plans, or folders of plans (not recursive) [default: plans]
    #[arg(value_name = "PATH")]
    pub paths: Vec<PathBuf>,
    /// Folder of the accepted results [default: reports]
    #[arg(long, value_name = "DIR")]
    pub golden: Option<PathBuf>,
    /// Accept the present results, and report the changes
    #[arg(long, alias = "bless", conflicts_with_all = ["list", "fail_fast"])]
    pub accept: bool,
    /// With --accept: also write the files of unchanged results
    #[arg(long, requires = "accept")]
    pub anew: bool,
    /// With --accept: also keep report and pictures
    #[arg(long, requires = "accept")]
    pub pages: bool,
    /// Only plans with this text in their path
    #[arg(long, value_name = "TEXT")]
    pub filter: Option<String>,
    /// List the plans without running them
    #[arg(long)]
    pub list: bool,
    /// Number of plans run in parallel [default: number of processors]
    #[arg(long, value_name = "N")]
    pub jobs: Option<std::num::NonZeroUsize>,
    /// Stop at the first plan that fails
    #[arg(long)]
    pub fail_fast: bool,
    /// Folder for new results of plans that differ, with overlay pictures
    #[arg(long, value_name = "DIR", default_value = "runs/golden-failures")]
    pub out: PathBuf,
    /// Also write the outcome as JUnit XML
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
    /// Write the outcome as TAP on standard output
    #[arg(long)]
    pub tap: bool,
    /// Outcome as text on standard error, or JSON on standard output
    #[arg(long, value_enum, default_value_t = Format::Human, conflicts_with = "tap")]
    pub format: Format,
}

#[derive(Debug, Args)]
pub struct CompareArguments {
    /// Run folders, or folders of accepted results; at least two
    #[arg(value_name = "RUN", num_args = 2.., required = true)]
    pub runs: Vec<PathBuf>,
    /// Also write a page, a CSV and figures into this new folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct FmtArguments {
    /// Plans, or folders of plans
    #[arg(value_name = "PATH", required = true)]
    pub paths: Vec<PathBuf>,
    /// Print the difference only; exit with 1 if there is one
    #[arg(long)]
    pub check: bool,
}

/// Settings of the plan on the command line.
#[derive(Debug, Default, Args)]
pub struct PlanSettings {
    /// The rig to use; a real rig moves only when named
    #[arg(long, value_name = "NAME")]
    pub rig: Option<String>,
    /// Set a `param`: `--set impact_speed="1.5 m/s"`
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub set: Vec<(String, String)>,
    /// Date on the test report [real rig: from its run log]
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date)]
    pub date: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Color {
    Auto,
    Always,
    Never,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    Human,
    Json,
}

fn setting(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("write it as NAME=VALUE")?;
    let (name, value) = (name.trim(), value.trim());
    if name.is_empty() || value.is_empty() {
        return Err("write it as NAME=VALUE".to_owned());
    }
    Ok((name.to_owned(), value.to_owned()))
}

/// A person's name: one short line.
pub(super) fn name(text: &str) -> Result<String, String> {
    let name = text.trim();
    if name.is_empty() || name.chars().count() > 200 || name != escape(name) || name.contains('\n')
    {
        return Err("a name must be one line of at most 200 characters".to_owned());
    }
    Ok(name.to_owned())
}

/// A day of the calendar, in the form that a report shows.
pub(super) fn date(text: &str) -> Result<String, String> {
    let day: jiff::civil::Date = text
        .parse()
        .map_err(|_| "not a date; write it as 2026-05-31".to_owned())?;
    // The calendar's reader also takes times and other forms.
    if day.to_string() == text {
        Ok(text.to_owned())
    } else {
        Err(format!("write it as {day}"))
    }
}

#[cfg(test)]
mod tests;
