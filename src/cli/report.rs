//! `psd report RUN`: the results anew, from the record alone. In: the folder of a run. Out: every file the run wrote, byte
//! for byte, into a folder that has none. It opens no rig and changes no record.

use std::path::Path;

use super::args::ReportArguments;
use super::conclude::conclude_into;
use super::exit::{Exit, Failure};
use super::loader::plain;
use super::output::give;
use super::record_file;
use super::run_folder::RunFolder;
use super::settings::Settings;
use crate::record::Outcome;
use crate::run::tape::{self, CUT_OFF, Recorded, Replayed};

/// Makes the results of one run.
pub fn report(arguments: &ReportArguments, settings: Settings) -> Result<Exit, Failure> {
    let run = &arguments.run;
    let read = record_file::read(run)?;
    let Replayed { mut record, mismatch } = tape::replay(&read.plan, read.played);
    if let Outcome::Faulted { reason } | Outcome::Aborted { reason } = &mut record.outcome
        && reason.contains(CUT_OFF)
    {
        *reason = format!("INCOMPLETE: {reason}");
    }
    let recorded = Recorded { record, mismatch, fault: None, sealed: None };
    let folder = match &arguments.out {
        Some(out) => RunFolder::create(Some(out), run)?.path().to_owned(),
        None => without_results(run)?,
    };
    let (exit, _) = conclude_into(run, &folder, &read.plan, &read.provenance, &recorded, settings)?;
    give(&format!("{}\n", folder.display()))?;
    Ok(exit)
}

/// The run folder itself, if nothing but the record lies in it.
fn without_results(run: &Path) -> Result<std::path::PathBuf, Failure> {
    let failed = |error: std::io::Error| Failure::file(run, plain(&error));
    for entry in std::fs::read_dir(run).map_err(failed)? {
        let name = entry.map_err(failed)?.file_name().to_string_lossy().into_owned();
        if !name.starts_with("journal.") && !name.starts_with("before-resume-") {
            return Err(
                Failure::file(run, format!("has results already, such as `{name}`")).help("name a new folder with `--out`")
            );
        }
    }
    Ok(run.to_owned())
}
