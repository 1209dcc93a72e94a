//! The program around the pipeline: arguments, settings, one file per command, exit code. In: the command
//! line. Out: an exit code. It is the only folder that reads the environment and writes to the terminal;
//! it decides nothing about physics or conformity.

mod args;
pub mod commands;
pub(crate) mod exit;
pub mod files;
pub mod operator;
mod output;
pub(crate) mod settings;

use std::ffi::OsString;

use clap::Parser as _;

pub use exit::Exit;
use exit::Failure;

/// Runs one command line, which begins with the name of the program, and returns its exit.
#[must_use]
pub fn main(arguments: impl Iterator<Item = OsString>) -> Exit {
    // If the signal cannot be caught, a file over the size limit ends the program, and the watchdog of the rig puts it on hold.
    let _ = operator::watch::catch_full_files();
    let arguments = match args::Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version go to stdout, errors of the command line to stderr. A closed pipe is not an error.
            let _ = error.print();
            return if error.use_stderr() {
                Exit::Wrong
            } else {
                Exit::Met
            };
        }
    };
    let settings = settings::Settings::from_environment(arguments.color);
    let outcome = match &arguments.command {
        args::Command::Run(arguments) => commands::run::run(arguments, settings),
        args::Command::Resume(arguments) => commands::run::resume::resume(arguments, settings),
        args::Command::Issue(arguments) => commands::evidence::issue::issue(arguments, settings),
        args::Command::Report(arguments) => commands::evidence::report::report(arguments, settings),
        args::Command::Verify(arguments) => commands::evidence::verify::verify(arguments, settings),
        args::Command::Sign(arguments) => commands::evidence::sign::sign(arguments, settings),
        args::Command::Keygen(arguments) => commands::evidence::sign::keygen(arguments, settings),
        args::Command::Compare(arguments) => commands::compare::compare(arguments),
        args::Command::Test(arguments) => commands::test::test(arguments, settings),
        args::Command::Check(arguments) => commands::check::check(arguments, settings),
        args::Command::Fmt(arguments) => commands::fmt::fmt(arguments, settings),
        args::Command::Explain { code, full } => {
            commands::explain::explain(code.as_deref(), *full, settings)
        }
        args::Command::Limits => commands::limits::limits(),
        args::Command::Study { command } => commands::study::study(command, settings),
        args::Command::Rig { command } => commands::rig::rig(command, settings),
    };
    outcome.unwrap_or_else(|failure: Failure| {
        output::print_message(&failure.report(settings));
        failure.exit()
    })
}
