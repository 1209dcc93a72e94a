//! The end of a run: verdict, results, manifest. In: the recorded run. Out: the files of the run folder. The run log is complete before
//! any result is written.

use std::fmt::Write as _;
use std::path::Path;

use super::record_file::{self, journal_of};
use super::run_folder::{FolderSink, write_new};
use super::writing::ProgressSink;
use crate::commands::prediction::prediction;
use crate::evidence::Folder;
use crate::exit::{Exit, Failure};
use crate::files::failure::plain;
use crate::files::provenance;
use crate::files::results::put_results;
use crate::operator::hold_status;
use crate::output::{print_message, print_wrapped};
use crate::settings::Settings;
use psd::report;
use psd::report::{FileDigest, OutputError, OutputSink, Provenance, Run};
use psd::run::replay::Recorded;
use psd::verdict;
use psd_plan::Plan;
use psd_plan::record::{EventKind, Outcome, Record};
use psd_text::diagnostic::excerpt::escape;

/// Prints the verdict and writes every result into the run folder.
pub fn finish_run(
    folder: &Path,
    plan: &Plan,
    provenance: &Provenance,
    recorded: &Recorded,
    settings: Settings,
) -> Result<Exit, Failure> {
    let provenance = as_recorded(folder, plan, provenance, recorded).inspect_err(|_| {
        // No report is made, but the state of the rig is printed.
        print_message(&rig_state(folder, plan, &recorded.record, settings));
    })?;
    let provenance = &Provenance {
        prediction: prediction(plan, &recorded.record),
        ..provenance
    };
    let assessment = verdict::assess(plan, &recorded.record);
    let run = Run {
        plan,
        record: &recorded.record,
        assessment: &assessment,
        provenance,
    };
    if !hold_status::is_held(&recorded.record) {
        // The state of the rig is printed first.
        print_message(&rig_state(folder, plan, &recorded.record, settings));
    }
    print_wrapped(
        &report::console::verdict_text(&run, settings.color),
        settings,
    );
    if hold_status::is_held(&recorded.record) {
        print_message(&rig_state(folder, plan, &recorded.record, settings));
    }
    print_message(&folder_message(folder));
    let kept = Folder::digests(folder)?.kept();
    write_made(FolderSink::new(folder), &kept, |sink| {
        let sink = &mut ProgressSink::new(sink, settings);
        put_results(plan, &recorded.record, &assessment, provenance, None, sink)
    })?;
    let exit = Exit::from(&assessment);
    match (&recorded.fault, &recorded.mismatch) {
        (None, None) => Ok(exit),
        (Some(fault), _) => {
            print_message(&format!(
                "  the run log could not be written to its end: {fault}\n"
            ));
            Ok(exit.max(Exit::Fault))
        }
        (None, Some(mismatch)) => {
            print_message(&format!(
                "  the run log does not match the plan: {mismatch}\n"
            ));
            Ok(exit.max(Exit::Fault))
        }
    }
}

/// The message that names the run folder.
pub fn folder_message(folder: &Path) -> String {
    format!("  run folder {}\n", escape(&folder.display().to_string()))
}

/// State of the rig after a run that ended early, and the command to resume; the operator needs it first.
fn rig_state(folder: &Path, plan: &Plan, record: &Record, settings: Settings) -> String {
    // A rig that was not released has not moved.
    let unmoved =
        matches!(record.outcome, Outcome::NotReleased { .. }) && hold_status::is_held(record);
    if plan.rig.link.as_real().is_none() || record.outcome == Outcome::Completed || unmoved {
        return String::new();
    }
    let last = record
        .events
        .iter()
        .rev()
        .find(|event| matches!(event.kind, EventKind::Held | EventKind::NotHeld));
    let mut text = last.map_or_else(String::new, |event| match event.kind {
        EventKind::NotHeld => format!("  {}\n", settings.paint_error(&escape(&event.text))),
        _ => format!("  the rig is {}\n", escape(&event.text)),
    });
    if hold_status::is_held(record) && hold_status::can_go_on(record) {
        let folder = folder.display();
        let _ = writeln!(
            text,
            "  to resume: psd resume {folder} --operator \"your name\" --reason \"why it stopped\""
        );
    }
    text
}

/// Writes the results of `make`, and a manifest of them and of the other files there, by path and digest. The manifest is written last:
/// results without a manifest are incomplete.
pub fn write_made(
    mut sink: FolderSink<'_>,
    beside: &[FileDigest],
    make: impl FnOnce(&mut dyn OutputSink) -> Result<Vec<FileDigest>, OutputError>,
) -> Result<(), Failure> {
    let folder = sink.folder();
    let listed = match make(&mut sink) {
        Ok(listed) => listed,
        Err(error) => return Err(sink.failed(error)),
    };
    let all: Vec<FileDigest> = listed.into_iter().chain(beside.iter().cloned()).collect();
    write_new(folder, &report::manifest_with(&[], &all))
}

/// The summary of the written results; for a rig that was not released, only the outcome.
pub fn summary(folder: &Path, record: &Record) -> Result<String, Failure> {
    if let Outcome::NotReleased { reason } = &record.outcome {
        return Ok(format!(
            "{}\n",
            serde_json::json!({ "outcome": "not released", "reason": reason })
        ));
    }
    let path = folder.join(report::SUMMARY);
    std::fs::read_to_string(&path).map_err(|error| Failure::file(&path, plain(&error)))
}

/// The provenance as read back from the run log of a real rig, so that a later report states the same. If the run log could not be kept
/// and cannot be read, it is the provenance at the start, without the head hash. A run log that was kept but differs from the written one
/// was changed by another program: this is an error, and no results are made.
fn as_recorded(
    folder: &Path,
    plan: &Plan,
    began: &Provenance,
    recorded: &Recorded,
) -> Result<Provenance, Failure> {
    if plan.rig.link.as_real().is_none() {
        return Ok(numbered(began.clone(), plan, recorded));
    }
    let read = record_file::read(folder);
    let failed = recorded.fault.as_ref();
    if failed.is_some_and(|fault| !fault.is_foreign()) {
        return Ok(read.map_or_else(
            |_| numbered(began.clone(), plan, recorded),
            |read| read.provenance,
        ));
    }
    let read = read?;
    let on_disk = (
        read.recovered.lines.len() as u64,
        read.recovered.head().to_owned(),
    );
    if recorded.sealed.as_ref() != Some(&on_disk) {
        return Err(Failure::file(
            journal_of(folder),
            "differs from the run log that this run has written: no results are created",
        )
        .help("find the other program that writes there; `psd verify` reports the difference"));
    }
    Ok(read.provenance)
}

/// Adds the number of the report, if the run log gives one.
pub fn numbered(provenance: Provenance, plan: &Plan, recorded: &Recorded) -> Provenance {
    let head = recorded.sealed.as_ref().map(|(_, head)| head.as_str());
    let ended = recorded.record.outcome == Outcome::Completed;
    Provenance {
        number: provenance::report_number(&provenance.run_id, plan, ended, head),
        ..provenance
    }
}
