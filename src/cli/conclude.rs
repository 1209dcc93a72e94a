//! The end of a run: verdict, results, manifest. In: what was recorded. Out: the files of the run folder. The record lies
//! there already, whole, whatever becomes of the results.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use sha2::{Digest as _, Sha256};

use super::exit::{Exit, Failure};
use super::loader::plain;
use super::output::tell;
use super::provenance::hex;
use super::record_file::{JOURNAL, journal_of};
use super::run_folder::write_new;
use super::settings::Settings;
use crate::output::{self, OutputFile, Provenance, Run};
use crate::plan::Plan;
use crate::run::tape::Recorded;
use crate::verdict;

/// Tells the verdict and writes every result into the run's own folder. The files come back for who blesses or prints them.
pub fn conclude(
    folder: &Path,
    plan: &Plan,
    provenance: &Provenance,
    recorded: &Recorded,
    settings: Settings,
) -> Result<(Exit, Vec<OutputFile>), Failure> {
    conclude_into(folder, folder, plan, provenance, recorded, settings)
}

/// [`conclude`] of the record in `run_folder`, with the results written into `folder`.
pub fn conclude_into(
    run_folder: &Path,
    folder: &Path,
    plan: &Plan,
    provenance: &Provenance,
    recorded: &Recorded,
    settings: Settings,
) -> Result<(Exit, Vec<OutputFile>), Failure> {
    let assessment = verdict::assess(plan, &recorded.record);
    let provenance = &as_recorded(folder, plan, provenance);
    let run = Run { plan, record: &recorded.record, assessment: &assessment, provenance };
    tell(&output::console::verdict_text(&run, settings.color));
    let mut files = output::everything(&run)?;
    let journal = (JOURNAL.to_owned(), digest(&journal_of(run_folder))?);
    let manifest = output::manifest_with(&files, &[journal]);
    let results = files.iter().filter(|file| file.path != manifest.path);
    results.chain([&manifest]).try_for_each(|file| write_new(folder, file))?;
    // What is blessed holds no record: its manifest is its own.
    files.retain(|file| file.path != manifest.path);
    files.push(output::manifest_with(&files, &[]));
    let exit = Exit::from(assessment.verdict);
    match (&recorded.fault, &recorded.mismatch) {
        (None, None) => Ok((exit, files)),
        (Some(fault), _) => {
            tell(&format!("  the record could not be kept to its end: {fault}\n"));
            Ok((exit.max(Exit::Fault), files))
        }
        (None, Some(mismatch)) => {
            tell(&format!("  the record does not fit the plan: {mismatch}\n"));
            Ok((exit.max(Exit::Fault), files))
        }
    }
}

/// Of a real rig the provenance is read back from the record, so that a report made from it later says the same. Where
/// it cannot be read back, what the run began with is told, and no head of the record.
fn as_recorded(folder: &Path, plan: &Plan, began: &Provenance) -> Provenance {
    let read = plan.rig.link.as_real().and_then(|_| super::record_file::read(folder).ok());
    read.map_or_else(|| began.clone(), |read| read.provenance)
}

/// SHA-256 of a file, in hex, read in pieces: a record may be long.
pub fn digest(path: &Path) -> Result<String, Failure> {
    let read = || -> std::io::Result<String> {
        let mut file = File::open(path)?;
        let mut digest = Sha256::new();
        let mut buffer = vec![0; 1 << 16];
        loop {
            match file.read(&mut buffer)? {
                0 => return Ok(hex(&digest.finalize())),
                count => digest.update(&buffer[..count]),
            }
        }
    };
    read().map_err(|error| Failure::file(path, plain(&error)))
}
