//! `psd test [PATH…]`: plans compared with their accepted results. In: paths. Out: the differences, in the formats asked for, and exit
//! code 5 if there are any. It uses simulated rigs only, one plan per processor at a time. The output does not depend on their number.

mod cases;
mod failures;
mod overlay;
mod trials;

use std::path::Path;

use crate::cli::args::{Format, TestArguments};
use crate::cli::exit::{Exit, Failure};
use crate::cli::output::{print_message, print_result};
use crate::cli::settings::Settings;
use crate::files::failure::plain;
use crate::golden;
use crate::golden::Report;
use crate::golden::print::console;
use cases::Case;
use trials::Trials;

/// Tests plans, or accepts their results.
pub fn test(arguments: &TestArguments, settings: Settings) -> Result<Exit, Failure> {
    let found = cases::find(arguments)?;
    if arguments.list {
        return list(&found.cases);
    }
    let human = arguments.format == Format::Human && !arguments.tap;
    let report = Report {
        tested: Trials {
            arguments,
            settings,
            human,
        }
        .run(&found.cases)?,
        unused: found
            .unused
            .iter()
            .map(|folder| folder.display().to_string())
            .collect(),
    };
    if human {
        print_message(&console::closing(&report));
    }
    if let Some(path) = &arguments.junit {
        let text =
            golden::junit(&report).map_err(|error| Failure::file(path, error.to_string()))?;
        std::fs::write(path, text).map_err(|error| Failure::file(path, plain(&error)))?;
    }
    if arguments.tap {
        print_result(&golden::tap(&report))?;
    } else if arguments.format == Format::Json {
        print_result(&golden::print::json::text(&report))?;
    }
    Ok(if report.good() == report.tested.len() {
        Exit::Met
    } else {
        Exit::Differs
    })
}

/// The names of the plans, with a note for those without accepted results.
fn list(cases: &[Case]) -> Result<Exit, Failure> {
    for case in cases {
        let note = if case.golden.truth()?.is_empty() {
            "  (not accepted)"
        } else {
            ""
        };
        print_result(&format!("{}{note}\n", case.name))?;
    }
    Ok(Exit::Met)
}

/// A folder as typed, or the working folder.
fn shown(path: &Path) -> &Path {
    if path.as_os_str().is_empty() {
        Path::new(".")
    } else {
        path
    }
}
