//! The replay of a run log: record, verdict, every file of the results. In: the run log of a run folder, and the data stated after the
//! test. Out: the results, and the findings of the replay itself.

use std::path::Path;

use super::consistency;
use super::finding::Finding;
use super::folder::Folder;
use super::issues::{IssueFile, apply};
use crate::files::failure::Failure;
use crate::files::provenance::other_build;
use crate::files::recorded_run;
use crate::files::recorded_run::{JOURNAL, ReadRecord};
use crate::files::results::put_results;
use psd::report::{
    FileDigest, Issue, IssueKind, NullSink, OutputError, OutputSink, Prediction, Provenance,
    ReportStatus, Run,
};
use psd::run::replay;
use psd::run::replay::{CUT_OFF, LogForm, Mismatch, Replayed, number_of_steps};
use psd::verdict::{self, Assessment};
use psd_plan::Plan;
use psd_plan::record::remote::DrivenStep;
use psd_plan::record::{Outcome, Record};
use psd_plan::schema::plan_block::ISSUED;

/// Predicts a whole run from the record of its low-level check run; None for any other run.
pub type Predict<'a> = &'a dyn Fn(&Plan, &Record) -> Option<Prediction>;

/// A run, replayed from its run log alone.
pub struct ReplayedRun {
    pub plan: Plan,
    pub provenance: Provenance,
    pub record: Record,
    pub assessment: Assessment,
    pub mismatch: Option<Mismatch>,
    /// Whether it was simulated again: its run log is compact.
    pub is_repeated: bool,
    /// The program that made the run, if it was a different one.
    pub other_build: Option<String>,
    /// The steps of a rig that a client drove.
    pub steps: Option<Vec<DrivenStep>>,
}

impl ReplayedRun {
    /// Replays a run log, with the data stated for its report after the test.
    pub fn of(
        read: ReadRecord,
        issues: Option<&IssueFile>,
        predict: Predict<'_>,
    ) -> Result<Self, String> {
        let ReadRecord {
            mut plan,
            mut provenance,
            logged,
            recovered,
        } = read;
        // The replay no longer needs the entries: their memory is freed.
        drop(recovered);
        let is_repeated = logged.header.log == LogForm::Compact;
        let other_build = other_build(&logged.header);
        let Replayed {
            mut record,
            mismatch,
            steps,
        } = replay::replay(&plan, logged);
        if let Outcome::Faulted { reason }
        | Outcome::Aborted { reason }
        | Outcome::NotReleased { reason } = &mut record.outcome
            && reason.contains(CUT_OFF)
        {
            *reason = format!("INCOMPLETE: {reason}");
        }
        let assessment = verdict::assess(&plan, &record);
        if let Some(file) = issues {
            apply(&mut plan, &mut provenance, file)?;
        }
        provenance.prediction = predict(&plan, &record);
        Ok(Self {
            plan,
            provenance,
            record,
            assessment,
            mismatch,
            is_repeated,
            other_build,
            steps,
        })
    }

    /// An error if the repetition of a simulation differs from its run log: it has no results.
    pub fn refuse_another_simulation(&self, run: &Path) -> Result<(), Failure> {
        let Some(mismatch) = self.mismatch.as_ref().filter(|_| self.is_repeated) else {
            return Ok(());
        };
        Err(match &self.other_build {
            Some(other) => Failure::NotVerifiable {
                path: run.to_owned(),
                reason: format!("{mismatch}; the run was made by {other}"),
            },
            None => Failure::file(
                run,
                format!("the run log does not match the plan: {mismatch}"),
            ),
        })
    }

    /// The run as its report reads it.
    #[must_use]
    pub const fn run(&self) -> Run<'_> {
        Run {
            plan: &self.plan,
            record: &self.record,
            assessment: &self.assessment,
            provenance: &self.provenance,
        }
    }

    /// Puts every file of the results into a sink, except the manifest.
    pub fn results(&self, sink: &mut dyn OutputSink) -> Result<Vec<FileDigest>, OutputError> {
        put_results(
            &self.plan,
            &self.record,
            &self.assessment,
            &self.provenance,
            self.steps.as_deref(),
            sink,
        )
    }
}

/// The findings of a run log, and the required content of the folder.
#[derive(Clone, Debug)]
pub struct Rebuilt {
    /// Findings on the run log itself, and on its targets.
    pub findings: Vec<Finding>,
    /// None if the run log gives no report.
    pub report: Option<Report>,
}

/// The identity of a report, and its files.
#[derive(Clone, Debug)]
pub struct Report {
    pub run_id: String,
    pub id: String,
    /// Its status, as in `summary.json`.
    pub status: &'static str,
    /// Its day of issue, as stated.
    pub issued: Option<String>,
    /// The roles that sign it, as in the plan.
    pub roles: Vec<String>,
    /// Path and SHA-256 of every file of the results, in hex, without the manifest.
    pub files: Vec<FileDigest>,
    /// The program that made the run, if it was a different one.
    pub other_build: Option<String>,
    /// Whether its run was simulated again.
    pub is_repeated: bool,
    /// Whether the run log is complete.
    pub ended: bool,
}

impl Report {
    /// Whether the simulation of another build was repeated: a difference says nothing against that build.
    pub const fn is_of_another_build(&self) -> bool {
        self.is_repeated && self.other_build.is_some()
    }
}

impl Rebuilt {
    /// Replays the run log of a folder.
    pub fn of(folder: &Folder, predict: Predict<'_>) -> Self {
        let nothing = |part, fault: String| Self {
            findings: vec![Finding::wrong(part, fault)],
            report: None,
        };
        let Some(text) = folder.run_log() else {
            return nothing("record", format!("`{JOURNAL}` is missing"));
        };
        let read = match recorded_run::of_text(JOURNAL.as_ref(), text) {
            Ok(read) => read,
            Err(Failure::NotVerifiable { reason, .. }) => {
                return Self {
                    findings: vec![Finding::not_verifiable("record", reason)],
                    report: None,
                };
            }
            Err(failure) => return nothing("record", failure.to_string()),
        };
        match IssueFile::of(folder) {
            Ok(issues) => Self::replayed(read, issues.as_ref(), predict),
            Err(fault) => nothing("issue", fault),
        }
    }

    fn replayed(read: ReadRecord, issues: Option<&IssueFile>, predict: Predict<'_>) -> Self {
        let (targets, steps) = number_of_steps(&read.recovered);
        let torn = read.recovered.torn.as_ref();
        let torn = torn.map_or(String::new(), |torn| {
            format!(", {} bytes incomplete at its end", torn.end - torn.start)
        });
        let (records, head) = (read.recovered.lines.len(), read.recovered.head());
        let remarks = consistency::remarks(&read.provenance);
        let mut findings = vec![match consistency::check_consistency(&read) {
            Ok(()) => Finding::sound(
                "record",
                format!(
                    "run {}, {records} entries{torn}{remarks}, head {head}",
                    read.provenance.run_id
                ),
            ),
            Err(fault) => Finding::wrong("record", fault),
        }];
        let ended = read.logged.ended;
        let replayed = match ReplayedRun::of(read, issues, predict) {
            Ok(replayed) => replayed,
            Err(fault) => {
                return Self {
                    findings: vec![Finding::wrong("issue", fault)],
                    report: None,
                };
            }
        };
        let built = if replayed.other_build.is_some() {
            " by another build of psd"
        } else {
            ""
        };
        let again = || {
            let again = if replayed.is_repeated {
                "simulated again"
            } else {
                "recomputed"
            };
            format!("all {targets} {again}, bit-identical")
        };
        findings.push(match (&replayed.mismatch, &replayed.record.outcome) {
            (Some(mismatch), _) => match &replayed.other_build {
                Some(other) if replayed.is_repeated => Finding::not_verifiable(
                    "targets",
                    format!("{mismatch}; the run was made by {other}"),
                ),
                _ => Finding::wrong("targets", mismatch.to_string()),
            },
            (None, Outcome::Completed) if ended => {
                Finding::sound("targets", format!("{}, and {steps} steps{built}", again()))
            }
            (None, Outcome::Completed) => Finding::wrong(
                "targets",
                "the run was completed, but the run log has no end".to_owned(),
            ),
            (None, _) if ended => Finding::wrong(
                "targets",
                "the run log has an end that the run does not reach".to_owned(),
            ),
            (
                None,
                Outcome::Aborted { reason }
                | Outcome::NotReleased { reason }
                | Outcome::Blocked { reason }
                | Outcome::Faulted { reason },
            ) => {
                let statement = if reason.contains("INCOMPLETE") {
                    reason.clone()
                } else {
                    format!("INCOMPLETE: {reason}")
                };
                Finding::sound("targets", format!("{}; {statement}{built}", again()))
            }
        });
        if replayed.mismatch.is_some() {
            return Self {
                findings,
                report: None,
            };
        }
        let issues = replayed.provenance.issues.as_ref();
        findings.extend(issues.and_then(|issues| {
            Some(Finding::sound(
                "issue",
                issue_text(&issues.report_id, issues.all.last()?),
            ))
        }));
        Self::with_results(findings, &replayed, ended)
    }

    fn with_results(mut findings: Vec<Finding>, replayed: &ReplayedRun, ended: bool) -> Self {
        let files = match replayed.results(&mut NullSink) {
            Ok(files) => files,
            Err(error) => {
                findings.push(Finding::wrong("results", error.to_string()));
                return Self {
                    findings,
                    report: None,
                };
            }
        };
        let report = Report {
            run_id: replayed.provenance.run_id.clone(),
            id: replayed.provenance.report_id().to_owned(),
            status: ReportStatus::of(&replayed.run()).name(),
            issued: super::issues::stated(&replayed.plan, ISSUED.name),
            roles: replayed.plan.report.sign.clone(),
            files,
            other_build: replayed.other_build.clone(),
            is_repeated: replayed.is_repeated,
            ended,
        };
        Self {
            findings,
            report: Some(report),
        }
    }
}

/// The identity of this report, and the report that it was made from.
fn issue_text(report_id: &str, last: &Issue) -> String {
    let (by, replaces, date) = (&last.by, &last.replaces, &last.date);
    match last.kind {
        IssueKind::First => {
            format!("report {report_id}, issued on {date} by {by} from report {replaces}")
        }
        IssueKind::Amendment => {
            format!("report {report_id} amends report {replaces}, on {date} by {by}")
        }
    }
}
