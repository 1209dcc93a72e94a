//! `psd report RUN`: the results anew, from the record alone. In: the folder of a run. Out: every file the run wrote, byte
//! for byte, into a folder that has none, with a copy of the record where that is another folder; with an amendment, a report
//! of its own beside the one it takes the place of. It opens no rig, changes no record and overwrites nothing; of a run that is
//! still going on it makes nothing.

use std::path::{Path, PathBuf};

use super::args::ReportArguments;
use super::conclude::write_made;
use super::evidence::{Folder, ISSUE, IssueFile, OLDER_ISSUE, PlayedBack, held_issue};
use super::exit::{Exit, Failure};
use super::issue::amend;
use super::loader::plain;
use super::output::{give, tell, tell_words};
use super::record_file::{self, JOURNAL, journal_of};
use super::run_folder::RunFolder;
use super::settings::Settings;
use crate::output::{self, Run};
use crate::record::journal::FileStorage;

/// Makes the results of one run.
pub fn report(arguments: &ReportArguments, settings: Settings) -> Result<Exit, Failure> {
    if arguments.amend {
        return amend(arguments, settings);
    }
    let run = &arguments.run;
    let journal = journal_of(run);
    let _still = journal.exists().then(|| FileStorage::keep_still(&journal)).transpose()?;
    let kept = Folder::read(run)?;
    let issues = IssueFile::of(&kept).map_err(|fault| Failure::file(run, fault))?;
    let played = PlayedBack::of(record_file::read(run)?, issues.as_ref()).map_err(|fault| Failure::file(run, fault))?;
    let folder = match &arguments.out {
        Some(out) => RunFolder::create(Some(out), run)?.path().to_owned(),
        None => without_results(run)?,
    };
    let beside = held_issue(&kept).map(|(name, held)| (name.to_owned(), held.digest.clone()));
    let beside: Vec<(String, String)> = kept.kept().into_iter().chain(beside).collect();
    // What a manifest lists lies beside it: another folder is a whole run folder, and verifies.
    if folder != *run {
        beside.iter().try_for_each(|(name, _)| copy(run, &folder, name))?;
    }
    let exit = conclude_played(&folder, &played, &beside, settings)?;
    give(&format!("{}\n", folder.display()))?;
    Ok(exit)
}

/// Copies one file of a run, by its name in the folder.
fn copy(run: &Path, folder: &Path, name: &str) -> Result<(), Failure> {
    let to = folder.join(name);
    let failed = |error: std::io::Error| Failure::file(&to, plain(&error));
    if let Some(above) = to.parent() {
        std::fs::create_dir_all(above).map_err(failed)?;
    }
    std::fs::copy(run.join(name), &to).map(drop).map_err(failed)
}

/// Tells the verdict of a record played back, and writes its results.
pub fn conclude_played(
    folder: &Path,
    played: &PlayedBack,
    beside: &[(String, String)],
    settings: Settings,
) -> Result<Exit, Failure> {
    let PlayedBack { plan, provenance, record, assessment, mismatch, steps } = played;
    if steps.is_none() {
        tell_words(&output::console::verdict_text(&Run { plan, record, assessment, provenance }, settings.color), settings);
    }
    write_made(folder, beside, |shelf| played.results(shelf))?;
    let exit = Exit::from(assessment.verdict);
    let Some(mismatch) = mismatch else { return Ok(exit) };
    tell(&format!("  the record does not fit the plan: {mismatch}\n"));
    Ok(exit.max(Exit::Fault))
}

/// The run folder itself, if nothing but the record lies in it.
fn without_results(run: &Path) -> Result<PathBuf, Failure> {
    let failed = |error: std::io::Error| Failure::file(run, plain(&error));
    for entry in std::fs::read_dir(run).map_err(failed)? {
        let name = entry.map_err(failed)?.file_name().to_string_lossy().into_owned();
        if !name.starts_with(JOURNAL) && !name.starts_with("before-resume-") && name != ISSUE && name != OLDER_ISSUE {
            return Err(
                Failure::file(run, format!("has results already, such as `{name}`")).help("name a new folder with `--out`")
            );
        }
    }
    Ok(run.to_owned())
}
