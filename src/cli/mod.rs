//! The program around the pipeline: arguments → settings → one file a command → exit code. The only folder that
//! reads files, the terminal and the environment, and that writes anything.

mod args;
mod bless;
mod check;
mod columns;
mod compare;
mod conclude;
mod dry_rig;
mod evidence;
mod exit;
mod expected;
mod explain;
mod explain_drift;
mod explain_plan;
mod explain_shake;
mod explain_start;
mod explain_tracking;
mod fmt;
mod held;
mod issue;
mod limits;
mod loader;
mod output;
mod plan_file;
mod provenance;
mod question;
mod real_rig;
mod record_file;
mod rehearse;
mod release;
mod report;
mod resume;
mod rig;
mod room;
mod run;
mod run_folder;
mod screen;
mod settings;
mod sign;
mod test;
mod trial;
mod verify;
mod wall_clock;
mod watch;
mod writing;

use std::ffi::OsString;

use clap::Parser as _;

pub use exit::Exit;
use exit::Failure;

/// Runs one command line, the program's name first, and says how it ended.
#[must_use]
pub fn main(arguments: impl Iterator<Item = OsString>) -> Exit {
    // If it cannot be caught, a file that grows too large ends the program, and the rig's own watchdog holds.
    let _ = watch::catch_full_files();
    let arguments = match args::Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are results on stdout; a wrong command line is told on stderr. A closed pipe is not our fault.
            let _ = error.print();
            return if error.use_stderr() { Exit::Wrong } else { Exit::Met };
        }
    };
    let settings = settings::Settings::from_environment(arguments.color);
    let outcome = match &arguments.command {
        args::Command::Run(arguments) => run::run(arguments, settings),
        args::Command::Resume(arguments) => resume::resume(arguments, settings),
        args::Command::Issue(arguments) => issue::issue(arguments, settings),
        args::Command::Report(arguments) => report::report(arguments, settings),
        args::Command::Verify(arguments) => verify::verify(arguments, settings),
        args::Command::Sign(arguments) => sign::sign(arguments, settings),
        args::Command::Keygen(arguments) => sign::keygen(arguments, settings),
        args::Command::Compare(arguments) => compare::compare(arguments),
        args::Command::Test(arguments) => test::test(arguments, settings),
        args::Command::Check(arguments) => check::check(arguments, settings),
        args::Command::Fmt(arguments) => fmt::fmt(arguments, settings),
        args::Command::Explain { code } => explain::explain(code.as_deref(), settings),
        args::Command::Limits => limits::limits(),
        args::Command::Rig { command } => rig::rig(command, settings),
    };
    outcome.unwrap_or_else(|failure: Failure| {
        output::tell(&failure.report(settings));
        failure.exit()
    })
}
