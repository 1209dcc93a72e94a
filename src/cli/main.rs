//! The program `psd` around the pipeline: arguments, settings, one file per command, exit code. In: the command
//! line. Out: an exit code. It is the only folder that reads the environment and writes to the terminal;
//! it decides nothing about physics or conformity.

mod args;
mod commands;
mod evidence;
mod exit;
mod files;
mod hints;
mod operator;
mod output;
mod settings;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser as _;

use exit::{Exit, Failure};

fn main() -> ExitCode {
    run_command_line(std::env::args_os()).into()
}

/// Runs one command line, which begins with the name of the program, and returns its exit.
fn run_command_line(arguments: impl Iterator<Item = OsString>) -> Exit {
    // If the signal cannot be caught, a file over the size limit ends the program, and the watchdog of the rig puts it on hold.
    let _ = operator::watch::catch_full_files();
    let line: Vec<OsString> = arguments.collect();
    let arguments = match commands::Arguments::try_parse_from(&line) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version go to stdout, errors of the command line to stderr. A closed pipe is not an error.
            let error = hints::with_hint(error, &line);
            let _ = error.print();
            return if error.use_stderr() {
                Exit::Wrong
            } else {
                Exit::Met
            };
        }
    };
    let settings = settings::Settings::from_environment(arguments.color);
    let outcome = arguments.command.run(settings);
    outcome.unwrap_or_else(|failure: Failure| {
        output::print_message(&failure.report(settings));
        failure.exit()
    })
}
