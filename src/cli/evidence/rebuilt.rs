//! The replay of a run log: record, verdict, every file of the results. In: the run log of a run folder, and the data stated after the
//! test. Out: the results, and the findings of the replay itself.

use super::consistency;
use super::finding::Finding;
use super::folder::Folder;
use super::issues::{IssueFile, apply};
use crate::files::provenance::BUILD;
use crate::files::recorded_run;
use crate::files::recorded_run::{JOURNAL, ReadRecord};
use crate::files::results::put_results;
use psd::report::{
    FileDigest, Issue, IssueKind, NullSink, OutputError, OutputSink, Prediction, Provenance,
    ReportStatus, Run,
};
use psd::run::replay;
use psd::run::replay::{CUT_OFF, Mismatch, Replayed};
use psd::verdict::{self, Assessment};
use psd_plan::Plan;
use psd_plan::record::remote::DrivenStep;
use psd_plan::record::{Outcome, Record};
use psd_plan::schema::plan_block::ISSUED;
use psd_rig::journal::EntryKind;

/// Predicts a whole run from the record of its low-level check run; None for any other run.
pub type Predict<'a> = &'a dyn Fn(&Plan, &Record) -> Option<Prediction>;

/// A run, replayed from its run log alone.
pub struct ReplayedRun {
    pub plan: Plan,
    pub provenance: Provenance,
    pub record: Record,
    pub assessment: Assessment,
    pub mismatch: Option<Mismatch>,
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
            steps,
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
    /// Whether the run log is complete.
    pub ended: bool,
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
            Err(failure) => return nothing("record", failure.to_string()),
        };
        match IssueFile::of(folder) {
            Ok(issues) => Self::replayed(read, issues.as_ref(), predict),
            Err(fault) => nothing("issue", fault),
        }
    }

    fn replayed(read: ReadRecord, issues: Option<&IssueFile>, predict: Predict<'_>) -> Self {
        let count = |kind| {
            read.recovered
                .lines
                .iter()
                .filter(|line| line.kind == kind)
                .count()
        };
        let (targets, steps) = (count(EntryKind::Intent), count(EntryKind::Step));
        let torn = read.recovered.torn.as_ref();
        let torn = torn.map_or(String::new(), |torn| {
            format!(", {} bytes incomplete at its end", torn.end - torn.start)
        });
        let (records, head) = (read.recovered.lines.len(), read.recovered.head());
        let remarks = consistency::remarks(&read.recovered);
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
        let header = &read.logged.header;
        let other_build =
            (header.build != BUILD).then(|| format!("psd {} build {}", header.psd, header.build));
        let replayed = match ReplayedRun::of(read, issues, predict) {
            Ok(replayed) => replayed,
            Err(fault) => {
                return Self {
                    findings: vec![Finding::wrong("issue", fault)],
                    report: None,
                };
            }
        };
        let built = if other_build.is_some() {
            " by another build of psd"
        } else {
            ""
        };
        let again = || format!("all {targets} recomputed, bit-identical");
        findings.push(match (&replayed.mismatch, &replayed.record.outcome) {
            (Some(mismatch), _) => Finding::wrong("targets", mismatch.to_string()),
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
        Self::with_results(findings, &replayed, other_build, ended)
    }

    fn with_results(
        mut findings: Vec<Finding>,
        replayed: &ReplayedRun,
        other_build: Option<String>,
        ended: bool,
    ) -> Self {
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
            other_build,
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
