//! The run of a plan for a comparison with its accepted results, or to accept them. In: the plan's file. Out: every file of the run, or
//! the diagnostics if the plan has errors. The rig is simulated, every question is answered as by `--yes`, and no run log is kept: the
//! same plan gives the same files everywhere.

use psd_plan::schema::plan_block::OPERATOR;
use std::path::Path;

use super::finish_run::numbered;
use super::record_file::{self, Circumstances};
use super::{plan_file, provenance};
use crate::args::PlanSettings;
use crate::files::failure::Failure;
use crate::files::results::put_results;
use psd::golden::{DIAGNOSTICS, Tolerances};
use psd::report::{OutputFile, Provenance, Run, figure_data, numbers};
use psd::run::replay;
use psd::run::replay::{Header, LogForm};
use psd::run::{Inspection, Observer};
use psd::verdict;
use psd_plan::Plan;
use psd_plan::record::Outcome;
use psd_rig::virtual_rig;
use psd_text::diagnostic::render::{Appearance, render_all};

/// The results of a plan.
pub struct Trial {
    /// All files, or only those that are compared.
    pub files: Vec<OutputFile>,
    pub tolerances: Tolerances,
    /// Verdict such as `pass`; None if the plan has errors.
    pub verdict: Option<&'static str>,
    /// Outcome of the run; None if the plan has errors.
    pub ended: Option<Outcome>,
}

/// The extent of the results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    All,
    /// Summary, tables and figure data: no image and no report.
    Compared,
}

/// Runs one plan.
pub fn trial(path: &Path, extent: Extent) -> Result<Trial, Failure> {
    let checked = plan_file::open(path, &PlanSettings::default())?;
    let Some(plan) = &checked.plan else {
        let text = render_all(&checked.diagnostics, &checked.sources, &Appearance::plain());
        let files = vec![OutputFile {
            path: DIAGNOSTICS.to_owned(),
            bytes: text.into_bytes(),
        }];
        return Ok(Trial {
            files,
            tolerances: Tolerances::default(),
            verdict: None,
            ended: None,
        });
    };
    let operator = plan
        .particulars
        .iter()
        .find(|(field, _)| *field == OPERATOR.name)
        .map(|(_, name)| name.clone());
    let provenance = provenance::of_this_run(plan, None);
    let mut rig = virtual_rig(plan);
    let device = record_file::device(rig.as_ref());
    let header = Header {
        log: LogForm::Compact,
        ..record_file::header(
            plan,
            device,
            &PlanSettings::default(),
            &provenance,
            Circumstances::default(),
        )
    };
    let provenance = Provenance {
        equipment: Some(header.equipment.clone()),
        ..provenance
    };
    let journal = record_file::begin_nowhere(plan, &header)?;
    let recorded =
        replay::record_compactly(plan, rig.as_mut(), &mut Unattended { operator }, journal);
    let provenance = numbered(provenance, plan, &recorded);
    let record = recorded.record;
    let assessment = verdict::assess(plan, &record);
    let run = Run {
        plan,
        record: &record,
        assessment: &assessment,
        provenance: &provenance,
    };
    let mut files = match extent {
        Extent::All => {
            let mut files = Vec::new();
            put_results(plan, &record, &assessment, &provenance, None, &mut files)?;
            files
        }
        Extent::Compared => numbers(&run)?,
    };
    files.push(figure_data(&run));
    let verdict = Some(assessment.verdict.name());
    Ok(Trial {
        files,
        tolerances: Tolerances::of(plan),
        verdict,
        ended: Some(record.outcome),
    })
}

/// Whether the results of this run can be accepted: only those of an unchanged plan on its simulated rig.
pub fn is_as_written(plan: &Plan, settings: &PlanSettings) -> bool {
    plan.rig.link.as_virtual().is_some()
        && settings.set.is_empty()
        && settings.rig.is_none()
        && settings.date.is_none()
}

/// Answers as `--yes` does.
struct Unattended {
    operator: Option<String>,
}

impl Observer for Unattended {
    fn inspect(&mut self, _: &str) -> Inspection {
        Inspection::GoOn {
            note: Some("answered by --yes".to_owned()),
            by: self.operator.clone(),
        }
    }
}
