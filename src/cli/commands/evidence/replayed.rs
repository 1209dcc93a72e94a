//! The results of a replayed run, written to a folder. In: the replayed run. Out: its files, the verdict on the console.

use std::path::Path;

use crate::evidence::ReplayedRun;
use crate::exit::{Exit, Failure};
use crate::files::finish_run::{folder_message, write_made};
use crate::files::run_folder::FolderSink;
use crate::files::writing::ProgressSink;
use crate::output::{print_message, print_wrapped};
use crate::settings::Settings;
use psd::report;

/// Prints the verdict of a replayed run, and writes its results.
pub fn finish_replayed(
    folder: &Path,
    replayed: &ReplayedRun,
    beside: &[(String, String)],
    settings: Settings,
) -> Result<Exit, Failure> {
    if replayed.steps.is_none() {
        print_wrapped(
            &report::console::verdict_text(&replayed.run(), settings.color),
            settings,
        );
    }
    print_message(&folder_message(folder));
    write_made(FolderSink::replacing(folder), beside, |sink| {
        replayed.results(&mut ProgressSink::new(sink, settings))
    })?;
    let exit = Exit::from(&replayed.assessment);
    let Some(mismatch) = &replayed.mismatch else {
        return Ok(exit);
    };
    print_message(&format!(
        "  the run log does not match the plan: {mismatch}\n"
    ));
    Ok(exit.max(Exit::Fault))
}
