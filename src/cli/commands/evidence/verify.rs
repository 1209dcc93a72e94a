//! `psd verify RUN…`. The checks: the run log is complete and in order; its replay gives the same targets and the same results; every file
//! of the folder matches the manifest; and the signatures. It moves nothing and writes nothing.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::commands::prediction::prediction;
use crate::evidence::keys::KnownKey;
use crate::evidence::{Finding, Folder, Judgement, Rebuilt, examine, keys};
use crate::exit::{Exit, Failure};
use crate::files::failure::{NOT_VERIFIABLE, plain};
use crate::files::loader::is_stdin;
use crate::files::record_file::{JOURNAL, journal_of};
use crate::output::{print_message, print_result};
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
    /// Run folders, folders of them, or `-` for names on standard input
    #[arg(value_name = "RUN", required = true)]
    pub runs: Vec<PathBuf>,
    /// Required public key; repeat for each signatory
    #[arg(long, value_name = "FILE")]
    pub key: Vec<PathBuf>,
}

/// Verifies run folders. A run that is still in progress cannot be verified.
pub fn verify(arguments: &VerifyArguments, settings: Settings) -> Result<Exit, Failure> {
    let keys = arguments
        .key
        .iter()
        .map(|path| keys::public(path))
        .collect::<Result<Vec<_>, _>>()?;
    let runs = named(&arguments.runs)?;
    let mut exit = Exit::Met;
    for run in &runs {
        if runs.len() > 1 {
            let name = one_line(&run.display().to_string());
            print_result(&format!("{}\n", settings.paint_heading(&name)))?;
        }
        let done = match verify_one(run, &keys, settings) {
            Ok(done) => done,
            // A folder that cannot be read does not stop the verification of the others.
            Err(failure) if runs.len() > 1 => {
                print_message(&failure.report(settings));
                failure.exit()
            }
            Err(failure) => return Err(failure),
        };
        exit = exit.max(done);
    }
    Ok(exit)
}

/// The run folders that the command line names: a folder without a run log stands for the runs in it.
fn named(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut runs = Vec::new();
    for path in paths {
        if is_stdin(path) {
            let lines = std::io::stdin()
                .lines()
                .collect::<Result<Vec<_>, _>>()
                .map_err(|error| Failure::file("standard input", plain(&error)))?;
            let lines = lines.iter().map(|line| line.trim());
            runs.extend(lines.filter(|line| !line.is_empty()).map(PathBuf::from));
        } else if journal_of(path).exists() {
            runs.push(path.clone());
        } else {
            let mut inside = runs_in(path);
            if inside.is_empty() {
                // The message about what it lacks is that of a single folder.
                inside.push(path.clone());
            }
            runs.append(&mut inside);
        }
    }
    if runs.is_empty() {
        return Err(Failure::command_line("standard input names no run folder")
            .help("write one run folder on each line, as `psd run` prints them"));
    }
    Ok(runs)
}

/// The run folders in a folder, by name; the numbers of runs count as numbers.
fn runs_in(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut runs: Vec<PathBuf> = entries
        .map(|entry| entry.path())
        .filter(|path| journal_of(path).exists())
        .collect();
    runs.sort_by_cached_key(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let (plan, number) = name.rsplit_once('-').unwrap_or((&name, ""));
        (
            plan.to_owned(),
            number.parse::<u64>().ok(),
            name.to_string(),
        )
    });
    runs
}

fn verify_one(run: &Path, keys: &[KnownKey], settings: Settings) -> Result<Exit, Failure> {
    let _still = match FileStorage::keep_still(&journal_of(run)) {
        Err(fault @ FileFault::InUse { .. }) => return Err(fault.into()),
        // Other errors are reported below; some file systems have no locks.
        still => still.ok(),
    };
    let folder = Folder::read(run)?;
    if !folder.files.contains_key(JOURNAL) {
        return Err(
            Failure::file(journal_of(run), "no such file").help("a run folder has a run log")
        );
    }
    let rebuilt = Rebuilt::of(&folder, &prediction);
    let findings = examine(&folder, &rebuilt, keys);
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
    let sound = findings.iter().all(Finding::is_sound);
    let conclusion = if sound {
        settings.paint_heading("VERIFIED")
    } else {
        settings.paint_bad("NOT VERIFIED")
    };
    let name = one_line(&run.display().to_string());
    print_result(&format!("{text}{conclusion}  {name}\n"))?;
    Ok(if sound { Exit::Met } else { Exit::Fault })
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
