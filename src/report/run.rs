//! The input of every output: plan, record, assessment and provenance of one run. On a simulated rig the date is the only field that
//! is read from the machine, so that equal runs give equal results.

use std::borrow::Cow;

use super::status::Issues;
use super::summary::Prediction;
use crate::verdict::Assessment;
use psd_plan::DeclaredNoise;
use psd_plan::record::Record;
use psd_plan::record::equipment::{Device, Equipment};
use psd_plan::{Link, Plan};

/// One run, complete or stopped, with its assessment.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    pub plan: &'a Plan,
    pub record: &'a Record,
    pub assessment: &'a Assessment,
    pub provenance: &'a Provenance,
}

impl Run<'_> {
    /// Measuring channels and limits of the run: as logged, else as declared by the plan and the rig.
    pub(super) fn equipment(&self) -> Cow<'_, Equipment> {
        let planned = || {
            let noise = match &self.plan.rig.link {
                Link::Virtual(link) => DeclaredNoise {
                    force: link.noise,
                    resolution: link.resolution,
                },
                Link::Real(link) => DeclaredNoise {
                    force: link.readings.noise,
                    resolution: link.readings.resolution,
                },
            };
            Cow::Owned(Equipment::of(
                self.plan,
                Device::of(&self.record.rig, noise),
            ))
        };
        self.provenance
            .equipment
            .as_ref()
            .map_or_else(planned, Cow::Borrowed)
    }
}

/// Origin of the numbers: identifiers, program, dates, operator and issues of the report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Provenance {
    /// First 16 hex digits of SHA-256 over plan, used files, `--set` values, seed and version.
    pub run_id: String,
    /// Number of the report if it differs from the run id: each run log of one run has a separate number.
    pub number: Option<String>,
    pub psd_version: String,
    /// Build of that version.
    pub build: Build,
    /// SHA-256 of the plan's text, hex.
    pub plan_sha256: String,
    /// Date from the plan or `--date`, otherwise the day of the start.
    pub date: Option<String>,
    /// Only for a run on a real rig.
    pub real: Option<RealRun>,
    /// Equipment from the first line of the run log; None if the run log does not state it or does not exist.
    pub equipment: Option<Equipment>,
    /// Prediction of the whole run, only for a completed check run.
    pub prediction: Option<Prediction>,
    /// Only for a report that was issued or amended after the test.
    pub issues: Option<Issues>,
}

impl Provenance {
    /// The id of the report: that of the issue, else that of the run log, else that of the run.
    #[must_use]
    pub fn report_id(&self) -> &str {
        let own = self.number.as_ref().unwrap_or(&self.run_id);
        self.issues.as_ref().map_or(own, |issues| &issues.report_id)
    }

    /// The text that the latest issue of the report states for an administrative field.
    pub(super) fn restated(&self, field: &str) -> Option<&str> {
        let mut changes = self
            .issues
            .iter()
            .flat_map(|issues| &issues.all)
            .flat_map(|issue| &issue.changes);
        changes
            .rfind(|change| change.field == field)
            .map(|change| change.is.as_str())
    }

    /// The operator, as logged.
    #[must_use]
    pub fn operator(&self) -> Option<&str> {
        self.real.as_ref().and_then(|real| real.operator.as_deref())
    }
}

/// Sources and toolchain of the program that made the run. A regenerated report states the same build.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Build {
    /// SHA-256 over the digests of its sources, hex.
    pub sources: String,
    /// Target, profile, compiler.
    pub toolchain: String,
}

/// Operator, machine and times of a real run, from its run log. Times are UTC, ISO 8601.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RealRun {
    pub operator: Option<String>,
    /// The machine that controlled the rig.
    pub host: Option<String>,
    pub began: Option<String>,
    /// Time of the last logged reading, target or fault.
    pub ended: Option<String>,
    /// Differences between the wall clock and the time of the rig.
    pub jumps: Vec<ClockJump>,
    /// Number of entries of the run log and hash of the last one; None if the run log could not be written.
    pub sealed: Option<(u64, String)>,
}

/// The wall clock was set, or stopped, between two readings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClockJump {
    /// Rig time of the reading after the jump \[s\].
    pub time: f64,
    /// Advance of the wall clock over the rig time \[s\]; negative if it falls behind.
    pub seconds: f64,
}
