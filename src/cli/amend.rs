//! `psd report RUN --amend`: a report that takes the place of another and says so. In: a run folder that verifies, the
//! particulars to tell otherwise, by whom and why. Out: a folder of its own beside it, with the same record; the one it
//! replaces stays as it is. No measured number changes.

use std::path::{Path, PathBuf};

use super::args::ReportArguments;
use super::evidence::{AMENDMENT, AmendmentFile, Folder, MANIFEST, One, PlayedBack, Rebuilt, examine, may_be_amended};
use super::exit::{Exit, Failure};
use super::loader::plain;
use super::output::{give, tell};
use super::record_file::{self, JOURNAL};
use super::report::conclude_played;
use super::run_folder::{RunFolder, write_new};
use super::settings::Settings;
use super::verify::refuse_unproven;
use crate::diagnostic::excerpt::one_line;
use crate::output::OutputFile;

/// The largest file of particulars, bytes.
const PARTICULARS_BYTES: u64 = 1 << 20;

/// Makes one amendment report.
pub fn amend(arguments: &ReportArguments, settings: Settings) -> Result<Exit, Failure> {
    let run = &arguments.run;
    let (Some(by), Some(reason)) = (&arguments.by, &arguments.reason) else {
        return Err(Failure::command_line("an amendment needs `--by` and `--reason`"));
    };
    let particulars = particulars(arguments)?;
    if particulars.is_empty() {
        return Err(Failure::command_line("an amendment that changes nothing")
            .help("name what is to be told otherwise: `--set-particular customer=\"Other Ltd\"`"));
    }
    let folder = Folder::read(run)?;
    let rebuilt = Rebuilt::of(&folder);
    refuse_unproven(run, &examine(&folder, &rebuilt, &[]))?;
    let (Some(report), Some(manifest), Some(journal)) = (&rebuilt.report, folder.files.get(MANIFEST), folder.bytes(JOURNAL))
    else {
        return Err(Failure::file(run, "has no results yet").help("make them with `psd report`"));
    };
    let before = folder.bytes(AMENDMENT).map(AmendmentFile::read).transpose();
    let before = before.map_err(|fault| Failure::file(run.join(AMENDMENT), fault))?;
    let one = One {
        replaces: report.id.clone(),
        manifest_sha256: manifest.digest.clone(),
        by: by.clone(),
        reason: reason.clone(),
        particulars,
    };
    let file = AmendmentFile::after(before.as_ref(), one);
    let read = record_file::from_bytes(&run.join(JOURNAL), journal)?;
    let played = PlayedBack::of(read, Some(&file)).map_err(Failure::command_line)?;

    let place = RunFolder::create(Some(&arguments.out.clone().unwrap_or_else(|| beside(run))), run)?;
    let kept = OutputFile { path: JOURNAL.to_owned(), bytes: journal.to_vec() };
    let own = OutputFile { path: AMENDMENT.to_owned(), bytes: file.json().into_bytes() };
    [&kept, &own].into_iter().try_for_each(|file| write_new(place.path(), file))?;
    let made = Folder::read(place.path())?;
    let beside: Vec<(String, String)> = made.listed().map(|(name, held)| (name.clone(), held.digest.clone())).collect();
    conclude_played(place.path(), &played, &beside, settings)?;
    tell(&format!("  report {} takes the place of report {}\n", played.provenance.report_id(), report.id));
    give(&format!("{}\n", place.path().display()))?;
    // Whatever the verdict of the run: the amendment has been made.
    Ok(Exit::Met)
}

/// `RUN-amended-1`, or the next number that is free.
fn beside(run: &Path) -> PathBuf {
    let run = run.canonicalize().unwrap_or_else(|_| run.to_owned());
    let name = run.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let stem = name.rsplit_once("-amended-").map_or(name.as_str(), |(stem, _)| stem);
    let named = |number: u32| run.with_file_name(format!("{stem}-amended-{number}"));
    (1..u32::MAX).map(named).find(|path| path.symlink_metadata().is_err()).unwrap_or_else(|| named(u32::MAX))
}

/// What is told otherwise, of the command line and of the file, in that order; each once.
fn particulars(arguments: &ReportArguments) -> Result<Vec<(String, String)>, Failure> {
    let mut all = arguments.set_particular.clone();
    if let Some(path) = &arguments.particulars {
        all.extend(of_file(path)?);
    }
    for (at, (field, text)) in all.iter().enumerate() {
        may_be_amended(field).map_err(Failure::command_line)?;
        if all[..at].iter().any(|(before, _)| before == field) {
            return Err(Failure::command_line(format!("`{field}` is given twice")));
        }
        if *text != one_line(text) {
            return Err(Failure::command_line(format!("the text of `{field}` holds characters that cannot be seen")));
        }
    }
    Ok(all)
}

/// A file of particulars: `field = text`, one a line; empty lines and those that begin with `#` say nothing.
fn of_file(path: &Path) -> Result<Vec<(String, String)>, Failure> {
    let failed = |error: std::io::Error| Failure::file(path, plain(&error));
    if path.metadata().map_err(failed)?.len() > PARTICULARS_BYTES {
        return Err(Failure::file(path, "is no list of particulars"));
    }
    let text = std::fs::read_to_string(path).map_err(failed)?;
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines
        .map(|line| {
            let (field, text) = line.split_once('=').ok_or_else(|| {
                Failure::file(path, format!("`{line}` is no particular")).help("write each as `customer = Other Ltd`")
            })?;
            Ok((field.trim().to_owned(), text.trim().to_owned()))
        })
        .collect()
}
