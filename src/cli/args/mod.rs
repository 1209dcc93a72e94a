//! The command line, parsed. In: the arguments of the process. Out: [`Arguments`], with the form of
//! every value checked. It does not open files and does not know what a command does.

mod evidence;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::text::diagnostic::excerpt::escape;

pub use evidence::{
    IssueArguments, KeygenArguments, ReportArguments, SignArguments, VerifyArguments,
};

/// Pseudo-dynamic structural tests, from a plan to a certificate.
#[derive(Debug, Parser)]
#[command(name = "psd", version, long_version = concat!(
    env!("CARGO_PKG_VERSION"), "\nsources, SHA-256 ", env!("PSD_BUILD"), "\nbuilt for ", env!("PSD_TOOLCHAIN"),
), about, max_term_width = 100, arg_required_else_help = true)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,

    /// When to colour what is said; `NO_COLOR` is heeded
    #[arg(long, global = true, value_enum, default_value_t = Color::Auto, value_name = "WHEN")]
    pub color: Color,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Checks a plan, runs it, writes the results and gives the verdict
    Run(RunArguments),
    /// Goes on with a run on a real rig that was stopped or cut off
    Resume(ResumeArguments),
    /// Issues the report of a run: states who authorises it and what else is known only after the test; nothing moves
    Issue(IssueArguments),
    /// Makes the results of a run anew, from its record alone; nothing moves and nothing is overwritten
    Report(ReportArguments),
    /// Proves that a run's record, targets and files belong together, and who signed them; nothing moves
    Verify(VerifyArguments),
    /// Signs a run folder that verifies
    Sign(SignArguments),
    /// Makes a pair of keys to sign with
    Keygen(KeygenArguments),
    /// Shows everything wrong with plans; nothing moves
    Check(CheckArguments),
    /// Lays the results of runs side by side; nothing moves
    Compare(CompareArguments),
    /// Runs plans on virtual rigs and holds what they give against their blessed results
    Test(TestArguments),
    /// Writes plans in the canonical layout
    Fmt(FmtArguments),
    /// Explains a diagnostic code, such as E202; without one, lists them all
    Explain {
        /// The code
        code: Option<String>,
    },
    /// Lists the bounds of the language: sizes, nesting, steps
    Limits,
    /// Talks to rigs by hand, or stands in for one
    Rig {
        #[command(subcommand)]
        command: RigCommand,
    },
}

#[derive(Debug, Subcommand)]
pub enum RigCommand {
    /// Lists the serial ports of this machine, with the names that stay
    List {
        /// What is printed: a line a port, or JSON
        #[arg(long, value_enum, default_value_t = Format::Human)]
        format: Format,
    },
    /// Says who the rig is, what it reads and how far it is from each limit; nothing moves
    #[command(
        after_help = "Exit codes: 0 it answers and stands inside the limits, 2 the plan or the command line is wrong,\n\
        3 no rig answers there, or another than the plan's, 4 it stands outside a limit."
    )]
    Probe {
        /// The plan, a `.psd` file
        #[arg(value_name = "PLAN")]
        plan: PathBuf,
        #[command(flatten)]
        plan_settings: PlanSettings,
    },
    /// Shows the readings as they come; nothing moves
    #[command(
        after_help = "In a pipe one line a reading, in SI: `| head` ends it too.\n\n\
        Exit codes: 0 ended by Ctrl-C, `q`, `--count` or its reader, 2 the plan or the command line is wrong,\n\
        3 the rig failed or was silent."
    )]
    Monitor {
        /// The plan, a `.psd` file
        #[arg(value_name = "PLAN")]
        plan: PathBuf,
        #[command(flatten)]
        plan_settings: PlanSettings,
        /// Ends after so many readings
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
        count: Option<u64>,
        /// Time from one reading to the next, from 10 ms to 1 min
        #[arg(long, value_name = "TIME", default_value = "100 ms")]
        every: String,
    },
    /// Moves the rig by hand inside the plan's limits, asking first on every move
    Jog(JogArguments),
    /// Stands in for the rig of a plan, at the plan's own port, until Ctrl-C
    Simulate(SimulateArguments),
    /// Lets a coordinator or OpenSees drive the plan's rig, inside the plan's limits
    Serve(ServeArguments),
}

#[derive(Debug, Args)]
#[command(
    after_help = "On a real rig every question, answer and move is on record, in a run folder that `psd verify` proves.\n\n\
    Exit codes: 0 it went where it was told, 2 the plan or the command line is wrong, 3 the rig failed,\n\
    4 a limit or a person stood in the way."
)]
pub struct JogArguments {
    /// The plan, a `.psd` file
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// Where to, such as "1 mm"; of several axes "1 mm, 2 mm" [default: places are typed, one a line]
    #[arg(long, value_name = "PLACE", allow_hyphen_values = true)]
    pub to: Option<String>,
    /// How fast, such as "0.5 mm/s" [default: the rig's own, within the plan's limits]
    #[arg(long, value_name = "SPEED")]
    pub speed: Option<String>,
    /// Moves without asking: the rig MOVES at once
    #[arg(long)]
    pub yes: bool,
    /// Lets go of an axis that is found held, where it stands; it is recorded
    #[arg(long)]
    pub let_go: bool,
    /// Counts places from the zero of this run, on a rig with `datum = here`
    #[arg(long, value_name = "RUN")]
    pub datum: Option<PathBuf>,
    /// Whose hand it is [default: the plan's `operator`]
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub operator: Option<String>,
    /// Run folder of the record on a real rig, new or empty [default: runs/PLAN-N]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Faults, one a line: WHEN: WHAT. WHEN is `at 4.5 s`, `after 12 moves`, `after 20 readings`,\n\
    `after 3 replies`, `each reply with 0.01`. WHAT is, among others, `drop replies 3`,\n\
    `delay reply 0.4 s`, `flip a bit`, `hang up`, `reboot`, `freeze force`, `scale force by -1`.\n\n\
    Exit codes: 0 every target lay within the limits, 2 plan, script or command line are wrong,\n\
    3 a port or a file failed, 4 a target lay outside the limits."
)]
pub struct SimulateArguments {
    /// The plan, a `.psd` file
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// What goes wrong, one fault a line: `after 12 moves: drop replies 3`
    #[arg(long, value_name = "FILE")]
    pub script: Option<PathBuf>,
    /// Every byte and every move with its time; a new file
    #[arg(long, value_name = "FILE")]
    pub log: Option<PathBuf>,
    /// Noise and faults by chance are the same for the same seed
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Ends when its last host has hung up
    #[arg(long)]
    pub once: bool,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Prints `ready` once it listens, and after each session what it asked of the specimen.\n\
    Exit codes: 0 closed by the client, 2 the plan or the command line is wrong, 3 the client or the rig\n\
    failed, 4 stopped by a limit or by a person. The worst session counts."
)]
pub struct ServeArguments {
    /// The plan, a `.psd` file: its rig, specimen and limits count
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// What the client speaks
    #[arg(long, value_enum)]
    pub protocol: ServedProtocol,
    /// Where to listen; port 0: any free one. Other machines reach only another address than the loopback's
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:8090")]
    pub listen: std::net::SocketAddr,
    /// The constant stiffness that a generic client is told [default: the specimen's initial one]
    #[arg(long, value_name = "STIFFNESS")]
    pub stiffness: Option<String>,
    /// Names of a frame's floors for a NEES coordinator, the lowest first, with commas between [default: MDL-00-01, MDL-00-02, …;
    /// of one axis any name]
    #[arg(long, value_name = "NAMES")]
    pub control_points: Option<String>,
    /// Ends after the first session
    #[arg(long)]
    pub once: bool,
    /// Run folder, new or empty [default: runs/PLAN-N]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Releases a real rig without asking: it MOVES as soon as it is open. Who starts this answers for it
    #[arg(long)]
    pub yes: bool,
    /// Who stands by at a real rig [default: the plan's `operator`]
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub operator: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ServedProtocol {
    /// NEES "LabVIEW plugin" ASCII, of OpenFresco and UI-SimCor
    Nees,
    /// The socket of OpenSees' `genericClient` and of OpenFresco's `GenericTCP`
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
    after_help = "Exit codes: 0 all requirements met, 1 a requirement failed or is inconclusive,\n\
    2 the plan or the command line is wrong, 3 rig or file fault, 4 stopped by a limit or by a person."
)]
pub struct RunArguments {
    /// The plan, a `.psd` file
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
    /// The run folder, new or empty [default: runs/PLAN-N, N the next free number]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// Releases the rig without asking: it MOVES as soon as it is open, and goes on at every inspection
    #[arg(long)]
    pub yes: bool,
    /// Who runs the test and answers at inspections [default: the plan's `operator`]
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub operator: Option<String>,
    /// What is printed on standard output: the run folder, or the whole summary
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub format: Format,
    /// Also replaces the blessed results in reports/PLAN, beside the plan's folder
    #[arg(long)]
    pub bless: bool,
    /// Runs only the gate and the leading stiffness ramps, on record; predicts the rest on a virtual specimen that is as
    /// stiff, and how far it stays from each limit. Exit code 4: a limit would stop the run
    #[arg(long, conflicts_with = "bless")]
    pub rehearse: bool,
}

#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of its own")]
#[command(
    after_help = "Nothing moves before record, plan, program and rig are known to be those of the run, and the rig\n\
    has said what became of the last target. See docs/record.md.\n\n\
    Exit codes: as `psd run`; 3 also where the run must not go on."
)]
pub struct ResumeArguments {
    /// The run folder
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// Who answers for it that the run goes on; it is recorded
    #[arg(long, value_name = "NAME")]
    pub operator: String,
    /// Why the run was interrupted and may go on; it is recorded
    #[arg(long, value_name = "TEXT")]
    pub reason: String,
    /// A plan that must be the recorded one, or, with --amend, takes its place
    #[arg(long, value_name = "PLAN")]
    pub plan: Option<PathBuf>,
    /// Accepts that the plan or the program is another one; the difference is recorded
    #[arg(long)]
    pub amend: bool,
    /// The rig started anew, and has been referenced since; it is recorded
    #[arg(long)]
    pub re_referenced: bool,
    /// The rig cannot say whether it was switched off since, and it was not; it is recorded
    #[arg(long)]
    pub same_power_up: bool,
    /// Lets go of an axis that is found held, where it stands; it is recorded
    #[arg(long)]
    pub let_go: bool,
    /// The force changed beyond its band since, and someone has looked at the specimen; it is recorded
    #[arg(long)]
    pub accept_relaxation: bool,
    /// Releases the rig without asking: it MOVES as soon as it is open, and goes on at every inspection
    #[arg(long)]
    pub yes: bool,
}

#[derive(Debug, Args)]
pub struct CheckArguments {
    /// The plans, `.psd` files
    #[arg(value_name = "PLAN", required = true)]
    pub plans: Vec<PathBuf>,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// Says what a run would do, from a dry run on an ideal copy of the specimen
    #[arg(long)]
    pub explain: bool,
    /// How diagnostics are given: drawn on standard error, or as JSON on standard output
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub format: Format,
}

#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of its own")]
#[command(
    after_help = "Blessed results of plans/NAME.psd lie in reports/NAME, beside the folder of the plans.\n\
    The plan's `golden` block says how near is near enough; docs/golden.md tells all.\n\n\
    Exit codes: 0 everything is as blessed, 2 the command line is wrong, 3 a file failed,\n\
    5 something differs, is not blessed, or could not be run."
)]
pub struct TestArguments {
    /// Plans, or folders whose plans are meant, not those of folders in them [default: plans]
    #[arg(value_name = "PATH")]
    pub paths: Vec<PathBuf>,
    /// Folder of the blessed results [default: reports, beside the folder of each plan]
    #[arg(long, value_name = "DIR")]
    pub golden: Option<PathBuf>,
    /// Blesses what the plans give now, and says what changed; where nothing did, nothing is written
    #[arg(long, conflicts_with_all = ["list", "fail_fast"])]
    pub bless: bool,
    /// With --bless: writes all files again, also of results that did not change
    #[arg(long, requires = "bless")]
    pub anew: bool,
    /// With --bless: also keeps report and pictures; where they are kept already, they are updated without it
    #[arg(long, requires = "bless")]
    pub pages: bool,
    /// Only plans with this text in their path
    #[arg(long, value_name = "TEXT")]
    pub filter: Option<String>,
    /// Lists the plans and runs none
    #[arg(long)]
    pub list: bool,
    /// Plans run at a time [default: as many as there are processors]; the outcome is the same
    #[arg(long, value_name = "N")]
    pub jobs: Option<std::num::NonZeroUsize>,
    /// Ends at the first plan that fails
    #[arg(long)]
    pub fail_fast: bool,
    /// Where a plan that differs leaves its new results, and old and new on one picture
    #[arg(long, value_name = "DIR", default_value = "runs/golden-failures")]
    pub out: PathBuf,
    /// Also writes the outcome as JUnit XML
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
    /// Gives the outcome on standard output in the Test Anything Protocol
    #[arg(long)]
    pub tap: bool,
    /// How the outcome is given: told on standard error, or as JSON on standard output
    #[arg(long, value_enum, default_value_t = Format::Human, conflicts_with = "tap")]
    pub format: Format,
}

#[derive(Debug, Args)]
pub struct CompareArguments {
    /// Run folders, or folders of blessed results; at least two
    #[arg(value_name = "RUN", num_args = 2.., required = true)]
    pub runs: Vec<PathBuf>,
    /// Also writes a page, a CSV and figures into this folder, new or empty
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct FmtArguments {
    /// Files, or folders whose `.psd` files are meant
    #[arg(value_name = "PATH", required = true)]
    pub paths: Vec<PathBuf>,
    /// Writes nothing; prints the difference and exits with 1 if there is one
    #[arg(long)]
    pub check: bool,
}

/// What the command line says of the plan.
#[derive(Debug, Default, Args)]
pub struct PlanSettings {
    /// The rig to use; a real rig moves only when named
    #[arg(long, value_name = "NAME")]
    pub rig: Option<String>,
    /// Gives a `param` another value: `--set impact_speed="1.5 m/s"`
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub set: Vec<(String, String)>,
    /// The date on the certificate; a virtual rig never takes it from the clock, a real rig's record has its own day
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
        return Err("a name is one line of at most 200 letters".to_owned());
    }
    Ok(name.to_owned())
}

/// A day of the calendar, in the one form that a certificate shows.
pub(super) fn date(text: &str) -> Result<String, String> {
    let day: jiff::civil::Date = text
        .parse()
        .map_err(|_| "no such day; write it as 2026-05-31".to_owned())?;
    // The calendar's reader also takes times and other forms.
    if day.to_string() == text {
        Ok(text.to_owned())
    } else {
        Err(format!("write it as {day}"))
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn a_date_is_a_day_of_the_calendar() {
        assert_eq!(date("2024-02-29").as_deref(), Ok("2024-02-29"));
        assert!(date("2023-02-29").is_err());
        assert!(date("20240229").unwrap_err().contains("2024-02-29"));
        assert!(date("today").is_err());
    }

    #[test]
    fn a_name_is_one_line_that_steers_nothing() {
        assert_eq!(name(" A. Engineer ").as_deref(), Ok("A. Engineer"));
        for wrong in [
            "",
            "  ",
            "A\nB",
            "A\u{1b}[2J",
            "A\u{202e}B",
            &"x".repeat(1024),
        ] {
            assert!(name(wrong).is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn a_setting_keeps_an_equals_sign_of_its_value() {
        assert_eq!(setting("v = 1.5 m/s"), Ok(("v".into(), "1.5 m/s".into())));
        assert_eq!(setting("a=b=c"), Ok(("a".into(), "b=c".into())));
        assert!(setting("v").is_err() && setting("=1").is_err() && setting("v=").is_err());
    }
}
