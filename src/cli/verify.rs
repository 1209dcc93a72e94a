//! `psd verify RUN`: the record is whole and in order; the run, done again from the recorded readings, asks for the very
//! same targets; and every file of the folder is the one its manifest names. Moves nothing, writes nothing.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

use super::exit::{Exit, Failure};
use super::loader::plain;
use super::output::give;
use super::provenance::sha256;
use super::record_file::{self, JOURNAL};
use super::settings::Settings;
use crate::diagnostic::excerpt::escape;
use crate::record::Outcome;
use crate::record::journal::EntryKind;
use crate::run::tape;

/// What one part of the proof says.
struct Finding {
    part: &'static str,
    fault: Option<String>,
    told: String,
}

impl Finding {
    fn sound(part: &'static str, told: String) -> Self {
        Self { part, fault: None, told }
    }

    fn wrong(part: &'static str, fault: String) -> Self {
        Self { part, told: fault.clone(), fault: Some(fault) }
    }
}

/// Proves what can be proven of a run folder.
pub fn verify(run: &Path, settings: Settings) -> Result<Exit, Failure> {
    let mut findings = Vec::new();
    match record_file::read(run) {
        Err(Failure::File { path, reason, help }) if !path.exists() => return Err(Failure::File { path, reason, help }),
        Err(failure) => findings.push(Finding::wrong("record", failure.to_string())),
        Ok(read) => record(read, &mut findings),
    }
    findings.push(files(run)?);
    let mut text = String::new();
    for finding in &findings {
        let word = if finding.fault.is_some() { settings.paint_bad("WRONG") } else { "ok".to_owned() };
        let _ = writeln!(text, "  {:<9}{word}  {}", finding.part, escape(&finding.told));
    }
    give(&text)?;
    Ok(if findings.iter().any(|finding| finding.fault.is_some()) { Exit::Fault } else { Exit::Met })
}

fn record(read: record_file::ReadRecord, findings: &mut Vec<Finding>) {
    let record_file::ReadRecord { recovered, played, plan, provenance } = read;
    let count = |kind| recovered.lines.iter().filter(|line| line.kind == kind).count();
    let (targets, steps) = (count(EntryKind::Intent), count(EntryKind::Step));
    let torn = recovered.torn.as_ref().map_or(String::new(), |torn| format!(", {} bytes torn at its end", torn.end - torn.start));
    let whole = format!("run {}, {} records{torn}, head {}", provenance.run_id, recovered.lines.len(), recovered.head());
    findings.push(Finding::sound("record", whole));
    let ended = played.ended;
    let build = played.header.build.clone();
    let replayed = tape::replay(&plan, played);
    let built = if build == record_file::BUILD { "" } else { " by another build of psd" };
    findings.push(match (replayed.mismatch, &replayed.record.outcome) {
        (Some(mismatch), _) => Finding::wrong("targets", mismatch.to_string()),
        (None, Outcome::Completed) if ended => {
            Finding::sound("targets", format!("all {targets} came out again bit for bit, and {steps} steps{built}"))
        }
        (None, Outcome::Completed) => Finding::wrong("targets", "the run came to its end, and the record has none".to_owned()),
        (None, _) if ended => Finding::wrong("targets", "the record has an end that the run does not come to".to_owned()),
        (None, Outcome::Aborted { reason } | Outcome::Faulted { reason }) => {
            Finding::sound("targets", format!("all {targets} came out again bit for bit; INCOMPLETE: {reason}{built}"))
        }
    });
}

/// Every file of the folder against its manifest.
fn files(run: &Path) -> Result<Finding, Failure> {
    let path = run.join("manifest.sha256");
    let manifest = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            return Ok(Finding::sound("files", "no results yet: there is no manifest".to_owned()));
        }
        Err(error) => return Err(Failure::file(path, plain(&error))),
    };
    let mut named = BTreeSet::from(["manifest.sha256".to_owned()]);
    for line in manifest.lines() {
        let Some((hash, name)) = line.split_once("  ") else {
            return Ok(Finding::wrong("files", "the manifest is no list of digests".to_owned()));
        };
        named.insert(name.to_owned());
        match std::fs::read(run.join(name)) {
            Ok(bytes) if sha256(&bytes) == hash => {}
            Ok(_) => return Ok(Finding::wrong("files", format!("`{name}` is not the one of the manifest"))),
            Err(error) => return Ok(Finding::wrong("files", format!("`{name}`: {}", plain(&error)))),
        }
    }
    if !named.contains(JOURNAL) {
        return Ok(Finding::wrong("files", "the manifest does not name the record".to_owned()));
    }
    Ok(Finding::sound("files", format!("all {} are those of the manifest", named.len() - 1)))
}
