//! `psd issue RUN` and `psd report RUN --amend`: a report that states particulars known only after the test, or that replaces another
//! report. In: a run folder that verifies, the particulars, the day, the issuer and the reason. Out: a new folder beside it with the same
//! run log. The original folder and all measured numbers are not changed. Only the report of a test that lacks nothing is issued.

use std::path::{Path, PathBuf};

use clap::Args;

use super::replayed::finish_replayed;
use super::verify::refuse_unproven;
use crate::args::{date, name, particular, reason};
use crate::commands::prediction::prediction;
use crate::evidence::{
    Folder, ISSUE, IssueFile, MANIFEST, One, OneKind, Rebuilt, ReplayedRun, examine, may_be_stated,
};
use crate::exit::{Exit, Failure};
use crate::files::failure::plain;
use crate::files::record_file;
use crate::files::recorded_run::JOURNAL;
use crate::files::run_folder::{RunFolder, copy, write_new};
use crate::output::{print_message, print_result};
use crate::settings::{Settings, today};
use psd::report::status::days::days_after;
use psd::report::{OutputFile, ReportStatus, Run, report_status};
use psd_plan::schema::plan_block::{AUTHORISED_BY, ISSUED};
use psd_text::diagnostic::excerpt::one_line;

/// The largest file of particulars \[bytes\].
const PARTICULARS_BYTES: u64 = 1 << 20;

/// The issue of a report.
struct Wanted<'a> {
    run: &'a Path,
    out: Option<&'a Path>,
    kind: OneKind,
    date: &'a str,
    by: String,
    reason: Option<String>,
    particulars: Vec<(String, String)>,
}

#[derive(Debug, Args)]
#[command(
    after_help = "psd writes a new folder, RUN-issued, with the same run log and all results recomputed from it. Only particulars of the `plan` \
    block can be stated, such as `condition`, `temperature`, `humidity` or `deviations`. To change an issued report, use \
    `psd report --amend`.\n\n\
    Exit codes:\n\
    \x20 0  issued\n\
    \x20 2  error on the command line, dates out of order, or a report that cannot be issued\n\
    \x20 3  the folder does not verify, or fault of a file"
)]
pub struct IssueArguments {
    /// The run folder; it must verify
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// Person authorising the report
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub authorised_by: String,
    /// Date of issue
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date)]
    pub date: String,
    /// State a particular; an empty text removes it
    #[arg(long, value_name = "FIELD=TEXT", value_parser = particular)]
    pub set_particular: Vec<(String, String)>,
    /// File of particulars, one `field = text` per line
    #[arg(long, value_name = "FILE")]
    pub particulars: Option<PathBuf>,
    /// New or empty folder for the issued report [default: RUN-issued]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Issues a report: issuer, day, and particulars that are known only after the test.
pub fn issue(arguments: &IssueArguments, settings: Settings) -> Result<Exit, Failure> {
    let particulars = particulars(
        &arguments.set_particular,
        arguments.particulars.as_deref(),
        "--authorised-by",
    )?;
    make(
        Wanted {
            run: &arguments.run,
            out: arguments.out.as_deref(),
            kind: OneKind::Issue,
            date: &arguments.date,
            by: arguments.authorised_by.clone(),
            reason: None,
            particulars,
        },
        settings,
    )
}

/// An amendment of a report.
#[derive(Debug, Args)]
pub struct AmendmentArguments {
    /// Create a report that replaces the one in RUN
    #[arg(long, requires = "by", requires = "reason", requires = "date")]
    pub amend: bool,
    /// Person authorising the amendment
    #[arg(long, value_name = "NAME", value_parser = name, requires = "amend")]
    pub by: Option<String>,
    /// Date of the amendment, and of issue of the new report
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date, requires = "amend")]
    pub date: Option<String>,
    /// Reason of the amendment
    #[arg(long, value_name = "TEXT", value_parser = reason, requires = "amend")]
    pub reason: Option<String>,
    /// Change a particular; an empty text removes it
    #[arg(long, value_name = "FIELD=TEXT", value_parser = particular, requires = "amend")]
    pub set_particular: Vec<(String, String)>,
    /// File of particulars, one `field = text` per line
    #[arg(long, value_name = "FILE", requires = "amend")]
    pub particulars: Option<PathBuf>,
}

/// Makes one amendment report.
pub fn amend(
    run: &Path,
    out: Option<&Path>,
    arguments: &AmendmentArguments,
    settings: Settings,
) -> Result<Exit, Failure> {
    let (Some(by), Some(reason), Some(date)) = (&arguments.by, &arguments.reason, &arguments.date)
    else {
        return Err(Failure::command_line(
            "an amendment requires `--by`, `--date` and `--reason`",
        ));
    };
    let particulars = particulars(
        &arguments.set_particular,
        arguments.particulars.as_deref(),
        "--by",
    )?;
    if particulars.is_empty() {
        return Err(Failure::command_line("the amendment changes nothing")
            .help("state the change: `--set-particular customer=\"Other Ltd\"`"));
    }
    make(
        Wanted {
            run,
            out,
            kind: OneKind::Amendment,
            date,
            by: by.clone(),
            reason: Some(reason.clone()),
            particulars,
        },
        settings,
    )
}

fn make(wanted: Wanted<'_>, settings: Settings) -> Result<Exit, Failure> {
    let run = wanted.run;
    let folder = Folder::read(run)?;
    let rebuilt = Rebuilt::of(&folder, &prediction);
    refuse_unproven(run, &examine(&folder, &rebuilt, &[]))?;
    let (Some(report), Some(manifest), Some(run_log)) = (
        &rebuilt.report,
        folder.files.get(MANIFEST),
        folder.run_log(),
    ) else {
        return Err(Failure::file(run, "has no results yet").help("create them with `psd report`"));
    };
    refuse_rival(run, &report.id, &manifest.digest)?;
    let before = IssueFile::of(&folder).map_err(|fault| Failure::file(run, fault))?;
    // The issuer authorises this report, and the day of the issue is its day.
    let particulars = [
        vec![(AUTHORISED_BY.name.to_owned(), wanted.by.clone())],
        wanted.particulars,
        vec![(ISSUED.name.to_owned(), wanted.date.to_owned())],
    ]
    .concat();
    let one = One {
        kind: wanted.kind,
        replaces: report.id.clone(),
        manifest_sha256: manifest.digest.clone(),
        date: wanted.date.to_owned(),
        by: wanted.by,
        reason: wanted.reason,
        particulars,
    };
    let file = IssueFile::after(before.as_ref(), one);
    let read = record_file::of_text(&run.join(JOURNAL), run_log)?;
    let replayed =
        ReplayedRun::of(read, Some(&file), &prediction).map_err(Failure::command_line)?;
    refuse_unissuable(run, &replayed.run())?;
    print_message(&in_the_future(wanted.date));

    let beside = beside(run, wanted.kind);
    let created = RunFolder::create(Some(wanted.out.unwrap_or(&beside)), run)?;
    copy(run, created.path(), JOURNAL)?;
    let own = OutputFile {
        path: ISSUE.to_owned(),
        bytes: file.json().into_bytes(),
    };
    write_new(created.path(), &own)?;
    let made = Folder::read(created.path())?;
    let beside: Vec<(String, String)> = made
        .listed()
        .map(|(name, held)| (name.clone(), held.digest.clone()))
        .collect();
    finish_replayed(created.path(), &replayed, &beside, settings)?;
    let does = match wanted.kind {
        OneKind::Issue => "issues",
        OneKind::Amendment => "replaces",
    };
    print_message(&format!(
        "  report {} {does} report {}\n",
        replayed.provenance.report_id(),
        report.id
    ));
    print_result(&format!("{}\n", created.path().display()))?;
    // The exit does not depend on the verdict of the run.
    Ok(Exit::Met)
}

/// Only the report of a test is issued, and only with everything that it must state.
fn refuse_unissuable(folder: &Path, run: &Run<'_>) -> Result<(), Failure> {
    let (mut why, mut never) = (Vec::new(), false);
    for reason in ReportStatus::reasons(run) {
        let (text, for_ever) = match reason {
            ReportStatus::Issued => continue,
            ReportStatus::Simulation => (
                "it is a simulation: no specimen was tested".to_owned(),
                true,
            ),
            ReportStatus::CheckRun => (
                "it is a check run, not the test of the plan".to_owned(),
                true,
            ),
            // A simulation has neither operator nor calibration.
            ReportStatus::NotIssuable { .. } if run.record.rig.simulated => continue,
            ReportStatus::NotIssuable { missing } => (
                format!(
                    "it lacks {}, which cannot be added after the test",
                    missing.join(", ")
                ),
                true,
            ),
            ReportStatus::Draft { missing } => (format!("it lacks {}", missing.join(", ")), false),
        };
        why.push(text);
        never |= for_ever;
    }
    if why.is_empty() {
        return Ok(());
    }
    let fields = report_status::missing_particular_fields(run);
    let given: Vec<String> = fields
        .iter()
        .map(|field| format!("--set-particular {field}=\"…\""))
        .collect();
    let help = match (never, given.is_empty()) {
        (true, true) => {
            "issue the report of a test on a real rig whose plan states all of this".to_owned()
        }
        (true, false) => format!(
            "repeat the test with all of this in the plan; after a test only these can be added: {}",
            given.join(" ")
        ),
        (false, false) => format!("add {}", given.join(" ")),
        (false, true) => {
            "state the right days, for example `--set-particular receipt_date=\"2026-05-31\"`"
                .to_owned()
        }
    };
    Err(Failure::command_line(format!(
        "the report of {} cannot be issued: {}",
        folder.display(),
        one_line(&why.join("; "))
    ))
    .help(help))
}

/// A remark on a day of issue that is not there yet; empty for any other. Time zones are a day apart.
fn in_the_future(date: &str) -> String {
    const TIME_ZONES: i64 = 1;
    let today = today();
    match days_after(&today, date) {
        Some(days) if days > TIME_ZONES => format!(
            "  the date of issue, {date}, is {days} days after today ({today}, by the clock of this computer): is it right?\n"
        ),
        _ => String::new(),
    }
}

/// A report can be replaced only once. With two replacements, neither would be the valid one.
fn refuse_rival(run: &Path, report: &str, manifest_sha256: &str) -> Result<(), Failure> {
    let run = run
        .canonicalize()
        .map_err(|error| Failure::file(run, plain(&error)))?;
    let Some(parent) = run.parent() else {
        return Ok(());
    };
    let failed = |error: std::io::Error| Failure::file(parent, plain(&error));
    for entry in std::fs::read_dir(parent).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        // A file that is not an issue is ignored.
        let Ok(bytes) = std::fs::read(path.join(ISSUE)) else {
            continue;
        };
        if IssueFile::read(&bytes).is_ok_and(|file| file.replaces(manifest_sha256)) {
            return Err(Failure::file(
                &run,
                format!(
                    "report {report} has already been replaced by the report in {}",
                    path.display()
                ),
            )
            .help("amend that report; as long as it has not left the laboratory, you can delete its folder and issue again"));
        }
    }
    Ok(())
}

/// `RUN-issued`; for an amendment `RUN-amended-1`, or the next free number.
fn beside(run: &Path, kind: OneKind) -> PathBuf {
    let run = run.canonicalize().unwrap_or_else(|_| run.to_owned());
    let name = run
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let stem = name
        .rsplit_once("-amended-")
        .map_or(name.as_str(), |(stem, _)| stem);
    let stem = stem.strip_suffix("-issued").unwrap_or(stem);
    if kind == OneKind::Issue {
        return run.with_file_name(format!("{stem}-issued"));
    }
    let named = |number: u32| run.with_file_name(format!("{stem}-amended-{number}"));
    (1..u32::MAX)
        .map(named)
        .find(|path| path.symlink_metadata().is_err())
        .unwrap_or_else(|| named(u32::MAX))
}

/// The particulars of the command line and of the file, in this order, each once. `issuer`: the option that names the issuer.
fn particulars(
    given: &[(String, String)],
    file: Option<&Path>,
    issuer: &str,
) -> Result<Vec<(String, String)>, Failure> {
    let mut all = given.to_vec();
    if let Some(path) = file {
        all.extend(of_file(path)?);
    }
    for (at, (field, text)) in all.iter().enumerate() {
        may_be_stated(field).map_err(Failure::command_line)?;
        if field == AUTHORISED_BY.name {
            return Err(
                Failure::command_line(format!("`{field}` is the issuer of this report"))
                    .help(format!("write `{issuer} NAME`")),
            );
        }
        if field == ISSUED.name {
            return Err(Failure::command_line("`issued` is the date of this report")
                .help("write `--date YYYY-MM-DD`"));
        }
        if all[..at].iter().any(|(before, _)| before == field) {
            return Err(Failure::command_line(format!("`{field}` is given twice")));
        }
        if *text != one_line(text) {
            return Err(Failure::command_line(format!(
                "the text of `{field}` has invisible characters"
            )));
        }
    }
    Ok(all)
}

/// A file of particulars: `field = text`, one per line; empty lines and lines that begin with `#` are ignored.
fn of_file(path: &Path) -> Result<Vec<(String, String)>, Failure> {
    let failed = |error: std::io::Error| Failure::file(path, plain(&error));
    if path.metadata().map_err(failed)?.len() > PARTICULARS_BYTES {
        return Err(Failure::file(path, "is not a list of particulars"));
    }
    let text = std::fs::read_to_string(path).map_err(failed)?;
    let lines = text
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines
        .map(|line| {
            let (field, text) = line.split_once('=').ok_or_else(|| {
                Failure::file(path, format!("`{line}` is not a particular"))
                    .help("write each as `customer = Other Ltd`")
            })?;
            Ok((field.trim().to_owned(), text.trim().to_owned()))
        })
        .collect()
}
