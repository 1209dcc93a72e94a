//! `psd test [PATH…]`: plans against their blessed results. In: paths. Out: what differs, told and in the formats asked
//! for; exit code 5 where anything does. It runs on virtual rigs alone, as many plans at a time as there are processors,
//! and says the same however many that are.

mod cases;
mod failures;
mod overlay;
mod trials;

use std::path::Path;

use super::args::{Format, TestArguments};
use super::exit::{Exit, Failure};
use super::loader::plain;
use super::output::{give, tell};
use super::settings::Settings;
use crate::golden::{self, Report, console};
use cases::Case;
use trials::Trials;

/// Tests plans, or blesses what they give.
pub fn test(arguments: &TestArguments, settings: Settings) -> Result<Exit, Failure> {
    let found = cases::find(arguments)?;
    if arguments.list {
        return list(&found.cases);
    }
    let human = arguments.format == Format::Human && !arguments.tap;
    let report = Report {
        tested: Trials { arguments, settings, human }.run(&found.cases)?,
        unused: found.unused.iter().map(|folder| folder.display().to_string()).collect(),
    };
    if human {
        tell(&console::closing(&report));
    }
    if let Some(path) = &arguments.junit {
        let text = golden::junit(&report).map_err(|error| Failure::file(path, error.to_string()))?;
        std::fs::write(path, text).map_err(|error| Failure::file(path, plain(&error)))?;
    }
    if arguments.tap {
        give(&golden::tap(&report))?;
    } else if arguments.format == Format::Json {
        give(&golden::json::text(&report))?;
    }
    Ok(if report.good() == report.tested.len() { Exit::Met } else { Exit::Differs })
}

/// The names, and which have no blessed results.
fn list(cases: &[Case]) -> Result<Exit, Failure> {
    for case in cases {
        let note = if case.golden.truth()?.is_empty() { "  (not blessed)" } else { "" };
        give(&format!("{}{note}\n", case.name))?;
    }
    Ok(Exit::Met)
}

/// A folder as a person typed it, or the one they stand in.
fn shown(path: &Path) -> &Path {
    if path.as_os_str().is_empty() { Path::new(".") } else { path }
}
