//! `psd test [PATH…]`: plans compared with their accepted results. In: paths. Out: the differences, in the formats asked for, and exit
//! code 5 if there are any. It uses simulated rigs only, one plan per processor at a time. The output does not depend on their number.

mod cases;
mod failures;
mod overlay;
mod trials;

use std::path::{Path, PathBuf};

use clap::Args;

use crate::args::Format;
use crate::exit::{Exit, Failure};
use crate::files::failure::plain;
use crate::output::{print_message, print_result};
use crate::settings::Settings;
use cases::Case;
use psd::golden;
use psd::golden::Report;
use psd::golden::print::console;
use trials::Trials;

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
    #[arg(long, conflicts_with_all = ["list", "fail_fast"])]
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
        print_result(&golden::print::json::comparison_as_json(&report))?;
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
