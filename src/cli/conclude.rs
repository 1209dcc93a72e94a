//! The end of a run: verdict, results, manifest. In: what was recorded. Out: the files of the run folder. The record lies
//! there already, whole, whatever becomes of the results.

use std::path::Path;

use super::evidence::{Folder, MANIFEST};
use super::exit::{Exit, Failure};
use super::output::tell;
use super::rehearse;
use super::run_folder::write_new;
use super::settings::Settings;
use crate::output::{self, OutputError, OutputFile, Provenance, Run};
use crate::plan::Plan;
use crate::record::Record;
use crate::run::driven::DrivenStep;
use crate::run::tape::Recorded;
use crate::verdict::{self, Assessment};

/// Tells the verdict and writes every result into the run's own folder. The files come back for who blesses or prints them.
pub fn conclude(
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
    let mut files = made_of(plan, &recorded.record, &assessment, provenance, None)?;
    write_results(folder, &files, &Folder::read(folder)?.kept())?;
    // What is blessed holds no record: its manifest is its own.
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

/// Every file that a run gives; not the manifest, which also lists what lies beside them. A rig that a client drove gives
/// the table of its steps alone.
pub fn made_of(
    plan: &Plan,
    record: &Record,
    assessment: &Assessment,
    provenance: &Provenance,
    driven: Option<&[DrivenStep]>,
) -> Result<Vec<OutputFile>, OutputError> {
    if let Some(steps) = driven {
        return output::driven(steps, record.drift.as_ref());
    }
    let prediction = rehearse::prediction(plan, record);
    let provenance = &Provenance { prediction, ..provenance.clone() };
    let mut files = output::everything(&Run { plan, record, assessment, provenance })?;
    files.retain(|file| file.path != MANIFEST);
    Ok(files)
}

/// Writes the results, and a manifest of them and of what lies beside them, by path and digest.
pub fn write_results(folder: &Path, files: &[OutputFile], beside: &[(String, String)]) -> Result<(), Failure> {
    let manifest = output::manifest_with(files, beside);
    files.iter().chain([&manifest]).try_for_each(|file| write_new(folder, file))
}

/// Of a real rig the provenance is read back from the record, so that a report made from it later says the same. Where
/// it cannot be read back, what the run began with is told, and no head of the record.
fn as_recorded(folder: &Path, plan: &Plan, began: &Provenance) -> Provenance {
    let read = plan.rig.link.as_real().and_then(|_| super::record_file::read(folder).ok());
    read.map_or_else(|| began.clone(), |read| read.provenance)
}
