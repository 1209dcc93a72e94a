//! A plan as it is written, run to be held against blessed results or to become them. In: the plan's file. Out: every file
//! that a run gives, or, where the plan fails to check, its diagnostics. A virtual rig, nobody who answers otherwise than
//! `--yes`, nothing kept: the same plan gives the same files wherever it runs.

use std::path::Path;

use super::finish_run::numbered;
use super::record_file::{self, Circumstances};
use super::{plan_file, provenance};
use crate::cli::args::PlanSettings;
use crate::files::failure::Failure;
use crate::files::results::put_results;
use crate::golden::{DIAGNOSTICS, Tolerances};
use crate::plan::Plan;
use crate::record::Outcome;
use crate::report::{OutputFile, Provenance, Run, figure_data, numbers};
use crate::rig::virtual_rig;
use crate::run::replay;
use crate::run::{Inspection, Observer};
use crate::text::diagnostic::render::{Appearance, render_all};
use crate::verdict;

/// What a plan gives.
pub struct Trial {
    /// Every file, or those alone that are compared.
    pub files: Vec<OutputFile>,
    pub tolerances: Tolerances,
    /// `pass`; None where the plan fails to check.
    pub verdict: Option<&'static str>,
    /// How the run ended; None where there was none.
    pub ended: Option<Outcome>,
}

/// Which of a plan's files are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    All,
    /// Numbers and words: no picture is drawn and no paper set.
    Compared,
}

/// Runs one plan.
pub fn of(path: &Path, extent: Extent) -> Result<Trial, Failure> {
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
        .find(|(field, _)| *field == "operator")
        .map(|(_, name)| name.clone());
    let provenance = provenance::of(plan, None);
    let mut rig = virtual_rig(plan);
    let device = record_file::device(rig.as_ref());
    let header = record_file::header(
        plan,
        device,
        &PlanSettings::default(),
        &provenance,
        Circumstances::default(),
    );
    let provenance = Provenance {
        equipment: header.equipment.clone(),
        ..provenance
    };
    let journal = record_file::begin_nowhere(plan, &header)?;
    let recorded = replay::record(
        plan,
        rig.as_mut(),
        &mut Unattended { operator },
        journal,
        Box::new(|| None),
    );
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

/// Whether the plan, as the command line sets it up, can be blessed: only as it is written, on its virtual rig.
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
