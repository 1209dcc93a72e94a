//! `psd report RUN`: regenerates the results from the run log alone. In: the folder of a run. Out: every file of the run, bit-identical,
//! in a folder that has no results or incomplete ones. A different folder also gets a copy of the run log. An amendment gives a separate
//! report beside the one it replaces. It opens no rig, changes no run log and overwrites nothing. It makes no results of a run that is
//! still in progress.

use std::path::{Path, PathBuf};

use clap::Args;

use super::issue::{AmendmentArguments, amend};
use super::replayed::finish_replayed;
use crate::commands::prediction::prediction;
use crate::evidence::{Folder, IssueFile, MANIFEST, ReplayedRun, check_consistency};
use crate::exit::{Exit, Failure};
use crate::files::record_file;
use crate::files::record_file::journal_of;
use crate::files::run_folder::{RunFolder, copy};
use crate::output::print_result;
use crate::settings::Settings;
use psd_rig::journal::FileStorage;

#[derive(Debug, Args)]
#[command(
    after_help = "An amendment changes particulars of the `plan` block, such as the name of the customer. It never changes a measured or computed \
    number. Both reports are kept, each with its own id."
)]
pub struct ReportArguments {
    /// The run folder
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// New or empty folder for the results [default: the run folder, or RUN-amended-N]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub amendment: AmendmentArguments,
}

/// Regenerates the results of one run.
pub fn report(arguments: &ReportArguments, settings: Settings) -> Result<Exit, Failure> {
    let run = &arguments.run;
    if arguments.amendment.amend {
        return amend(
            run,
            arguments.out.as_deref(),
            &arguments.amendment,
            settings,
        );
    }
    let journal = journal_of(run);
    let _still = journal
        .exists()
        .then(|| FileStorage::keep_still(&journal))
        .transpose()?;
    let kept = Folder::read(run)?;
    let issues = IssueFile::of(&kept).map_err(|fault| Failure::file(run, fault))?;
    let read = record_file::read(run)?;
    check_consistency(&read).map_err(|fault| {
        Failure::file(journal, fault)
            .help("no report is created from a run log that does not verify")
    })?;
    let replayed = ReplayedRun::of(read, issues.as_ref(), &prediction)
        .map_err(|fault| Failure::file(run, fault))?;
    replayed.refuse_another_simulation(run)?;
    let folder = match &arguments.out {
        Some(out) => RunFolder::create(Some(out), run)?.path().to_owned(),
        None => without_results(run)?,
    };
    let beside = kept.kept();
    // The files of the manifest are copied: the new folder is a complete run folder and verifies.
    if folder != *run {
        beside
            .iter()
            .try_for_each(|(name, _)| copy(run, &folder, name))?;
    }
    let exit = finish_replayed(&folder, &replayed, &beside, settings)?;
    print_result(&format!("{}\n", folder.display()))?;
    Ok(exit)
}

/// The run folder itself, if its results are incomplete: the manifest is written last.
fn without_results(run: &Path) -> Result<PathBuf, Failure> {
    if run.join(MANIFEST).exists() {
        return Err(
            Failure::file(run, "has results already").help("name a new folder with `--out`")
        );
    }
    Ok(run.to_owned())
}
