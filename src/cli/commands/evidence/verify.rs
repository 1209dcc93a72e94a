//! `psd verify RUN`. The checks: the run log is complete and in order; its replay gives the same targets and the same results; every file
//! of the folder matches the manifest; and the signatures. It moves nothing and writes nothing.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::commands::prediction::prediction;
use crate::evidence::{Finding, Folder, Judgement, Rebuilt, examine, keys};
use crate::exit::{Exit, Failure};
use crate::files::failure::NOT_VERIFIABLE;
use crate::files::record_file::{JOURNAL, journal_of};
use crate::output::print_result;
use crate::settings::Settings;
use psd_rig::journal::{FileFault, FileStorage};
use psd_text::diagnostic::excerpt::one_line;

#[derive(Debug, Args)]
#[command(
    after_help = "psd recomputes targets, results, figures, report and manifest from the run log, and compares them with the files. An unsigned \
    folder is reported as unsigned; this is not an error.\n\n\
    Exit codes:\n\
    \x20 0  everything is verified\n\
    \x20 2  error on the command line\n\
    \x20 3  a difference, a named key did not sign, or a simulation by another\n\
    \x20    build of psd is NOT VERIFIABLE BY THIS BUILD"
)]
pub struct VerifyArguments {
    /// The run folder
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// Required public key; repeat for each signatory
    #[arg(long, value_name = "FILE")]
    pub key: Vec<PathBuf>,
}

/// Verifies a run folder. A run that is still in progress cannot be verified.
pub fn verify(arguments: &VerifyArguments, settings: Settings) -> Result<Exit, Failure> {
    let _still = match FileStorage::keep_still(&journal_of(&arguments.run)) {
        Err(fault @ FileFault::InUse { .. }) => return Err(fault.into()),
        // Other errors are reported below; some file systems have no locks.
        still => still.ok(),
    };
    let folder = Folder::read(&arguments.run)?;
    if !folder.files.contains_key(JOURNAL) {
        return Err(Failure::file(journal_of(&arguments.run), "no such file")
            .help("a run folder has a run log"));
    }
    let keys = arguments
        .key
        .iter()
        .map(|path| keys::public(path))
        .collect::<Result<Vec<_>, _>>()?;
    let rebuilt = Rebuilt::of(&folder, &prediction);
    let findings = examine(&folder, &rebuilt, &keys);
    let mut text = String::new();
    for finding in &findings {
        let word = match finding.judgement {
            Judgement::Sound => "ok".to_owned(),
            Judgement::Wrong => settings.paint_bad("WRONG"),
            Judgement::NotVerifiable => settings.paint_bad(NOT_VERIFIABLE),
        };
        let _ = writeln!(
            text,
            "  {:<11}  {word}  {}",
            finding.part,
            one_line(&finding.statement)
        );
    }
    print_result(&text)?;
    Ok(if findings.iter().all(Finding::is_sound) {
        Exit::Met
    } else {
        Exit::Fault
    })
}

/// An error if the run does not verify: it can be neither signed nor amended.
pub fn refuse_unproven(run: &Path, findings: &[Finding]) -> Result<(), Failure> {
    match findings.iter().find(|finding| !finding.is_sound()) {
        Some(finding) => Err(Failure::file(
            run,
            format!("does not verify: {}: {}", finding.part, finding.statement),
        )
        .help("see `psd verify`")),
        None => Ok(()),
    }
}
