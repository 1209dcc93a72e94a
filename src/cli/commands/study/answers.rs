//! The answers of a finished study. In: its data set. Out: the answers on the terminal and in `summary.json` beside the data set, and the
//! exit code.

use std::path::Path;

use super::failure;
use crate::args::Format;
use crate::exit::{Exit, Failure};
use crate::files::failure::plain;
use crate::output::{print_message, print_result};
use psd::report::SUMMARY;
use psd::study::answers::{Answers, StudiedAnswer};
use psd::study::console;
use psd::study::data_set::Reader;
use psd::study::report::summary;
use psd_physics::study::probability::Decision;

/// Writes and prints the answers. The exit code is that of the requirements on probabilities.
/// `plan`: the plan and its rig on the command line, for the lines that reproduce a run.
pub fn give(path: &Path, plan: Option<&str>, format: Format) -> Result<Exit, Failure> {
    let reader = Reader::open(path).map_err(|fault| failure::of_data_set(&fault))?;
    let answers = Answers::of(&reader).map_err(|fault| failure::of_data_set(&fault))?;
    let summary = summary(reader.metadata(), &answers);
    let beside = path.with_file_name(SUMMARY);
    // Never half a summary: on a full disk there is none.
    let aside = beside.with_extension("json.part");
    std::fs::write(&aside, &summary)
        .and_then(|()| std::fs::rename(&aside, &beside))
        .map_err(|error| {
            let _ = std::fs::remove_file(&aside);
            Failure::file(&beside, plain(&error))
        })?;
    let plan = plan.unwrap_or(&reader.metadata().plan);
    print_message(&console::summary(reader.metadata(), plan, &answers));
    let folder = path.parent().unwrap_or(path);
    match format {
        Format::Human => print_result(&format!("{}\n", folder.display()))?,
        Format::Json => print_result(&summary)?,
    }
    Ok(exit(&answers))
}

/// 1 if a requirement on a probability is not met or undecided.
pub fn exit(answers: &Answers) -> Exit {
    let is_met = |it: &StudiedAnswer| it.decision == Decision::Met;
    if answers.studied.iter().all(is_met) {
        Exit::Met
    } else {
        Exit::Missed
    }
}
