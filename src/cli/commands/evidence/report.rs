//! `psd report RUN`: regenerates the results from the run log alone. In: the folder of a run. Out: every file of the run, bit-identical,
//! in a folder that has no results or incomplete ones. A different folder also gets a copy of the run log. An amendment gives a separate
//! report beside the one it replaces. It opens no rig, changes no run log and overwrites nothing. It makes no results of a run that is
//! still in progress.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;

use super::issue::{AmendmentArguments, amend};
use super::replayed::finish_replayed;
use crate::commands::prediction::prediction;
use crate::evidence::{Folder, IssueFile, MANIFEST, ReplayedRun, check_consistency};
use crate::exit::{Exit, Failure};
use crate::files::failure::plain;
use crate::files::record_file;
use crate::files::record_file::journal_of;
use crate::files::run_folder::{RunFolder, copy};
use crate::output::print_result;
use crate::settings::Settings;
use psd::report::{PAGE, PAPER};
use psd_rig::journal::FileStorage;

/// The program that opens a file as the desktop does.
#[cfg(target_os = "macos")]
const OPENER: &str = "open";
#[cfg(not(target_os = "macos"))]
const OPENER: &str = "xdg-open";

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
    /// Open the report, that of the run folder if it has one
    #[arg(long)]
    pub open: bool,
    #[command(flatten)]
    pub amendment: AmendmentArguments,
}

/// Regenerates the results of one run.
pub fn report(arguments: &ReportArguments, settings: Settings) -> Result<Exit, Failure> {
    let run = &arguments.run;
    let has_results = arguments.out.is_none() && run.join(MANIFEST).exists();
    if arguments.open && has_results && !arguments.amendment.amend {
        open(run)?;
        return Ok(Exit::Met);
    }
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
    if arguments.open {
        open(&folder)?;
    }
    print_result(&format!("{}\n", folder.display()))?;
    Ok(exit)
}

/// Opens the report of a folder in the browser or PDF reader of the desktop.
fn open(folder: &Path) -> Result<(), Failure> {
    let pages = [PAGE, PAPER].map(|name| folder.join(name));
    let Some(page) = pages.iter().find(|page| page.is_file()) else {
        return Err(Failure::file(folder, "has no report")
            .help("write `html` or `pdf` into the `formats` of the plan's `report` block"));
    };
    let opened = Command::new(OPENER)
        .arg(page)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    match opened {
        Ok(status) if status.success() => print_result(&format!("{}\n", page.display())),
        Ok(status) => Err(unopened(page, &status.to_string())),
        Err(error) => Err(unopened(page, &plain(&error))),
    }
}

fn unopened(page: &Path, reason: &str) -> Failure {
    Failure::file(page, format!("not opened by `{OPENER}`: {reason}"))
        .help("open this file in a browser or a PDF reader")
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
