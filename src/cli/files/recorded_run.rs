//! A recorded run, read from the run log of its folder. In: a folder, or the text of a run log. Out: the run log, and the plan checked again from it.
//! The run log is enough: no other file is read.

use std::fs::File;
use std::path::{Path, PathBuf};

use super::failure::{Failure, plain};
use psd::check::{LoadError, Options, check};
use psd::report::{Build, Provenance, RealRun};
use psd::run::check_run;
use psd::run::replay;
use psd::run::replay::{Header, LogForm, LoggedRun};
use psd_plan::Plan;
use psd_plan::record::equipment::{Device, Equipment};
use psd_rig::journal::{Line, LogText, Recovered, Unreadable, recover};
use psd_text::digest::sha256;

/// Name of the run log in its run folder.
pub const JOURNAL: &str = "journal.psdj";

/// A run log as it was read.
pub struct ReadRecord {
    pub recovered: Recovered,
    pub logged: LoggedRun,
    pub plan: Plan,
    pub provenance: Provenance,
}

/// Reads the run log of a run folder without changing it.
pub fn read(run: &Path) -> Result<ReadRecord, Failure> {
    let path = journal_of(run);
    let failed = |error: std::io::Error| Failure::file(&path, plain(&error));
    let file = File::open(&path).map_err(failed)?;
    of_text(&path, &LogText::of_file(file).map_err(failed)?)
}

/// A run log from its text; `path` is its name in messages.
pub fn of_text(path: &Path, text: &LogText) -> Result<ReadRecord, Failure> {
    let damaged = |reason: String| Failure::file(path, reason);
    let recovered = recover(text).map_err(|fault| match fault {
        Unreadable::Damaged(damage) => damaged(format!("the run log is damaged: {damage}")),
        Unreadable::File(error) => damaged(plain(&error)),
    })?;
    let logged = LoggedRun::of(&recovered).map_err(|fault| damaged(fault.to_string()))?;
    for (file, text) in logged.header.files.iter().zip(&logged.texts) {
        if sha256(text.as_bytes()) != file.sha256 {
            return Err(damaged(format!(
                "the text of `{}` does not match its digest",
                file.name
            )));
        }
    }
    // Another build may check the plan otherwise, which says nothing against its simulation.
    let made_by = super::provenance::other_build(&logged.header)
        .filter(|_| logged.header.log == LogForm::Compact);
    let not_this_plan = |reason: String| match &made_by {
        Some(other) => Failure::NotVerifiable {
            path: path.to_owned(),
            reason: format!("{reason}; the run was made by {other}"),
        },
        None => damaged(reason),
    };
    let plan = plan_of(&logged).map_err(not_this_plan)?;
    replay::well_formed(&recovered, &plan, &logged.header)
        .map_err(|fault| damaged(fault.to_string()))?;
    fits(&logged, &plan).map_err(not_this_plan)?;
    let provenance = provenance_of(&logged.header, &plan, &recovered);
    Ok(ReadRecord {
        recovered,
        logged,
        plan,
        provenance,
    })
}

/// The path of the run log in a run folder.
pub fn journal_of(run: &Path) -> PathBuf {
    run.join(JOURNAL)
}

/// The plan of a run log, checked again from the run log alone.
pub fn plan_of(logged: &LoggedRun) -> Result<Plan, String> {
    let header = &logged.header;
    // The recorded files by the names under which they were used.
    let files = |path: &str| {
        let found = header.files.iter().position(|file| file.name == path);
        found
            .and_then(|index| logged.texts.get(index).cloned())
            .ok_or(LoadError::NotFound)
    };
    let (Some(first), Some(text)) = (header.files.first(), logged.texts.first()) else {
        return Err("the run log has no plan".to_owned());
    };
    let (rig, settings, date) = (
        header.rig.clone(),
        header.settings.clone(),
        header.date.clone(),
    );
    let options = Options {
        rig,
        settings,
        date,
        ..Options::default()
    };
    let checked = check(&first.name, text, &files, &options);
    let plan = checked.plan.ok_or_else(|| {
        let fault = checked.diagnostics.iter().find(|found| found.is_error());
        let fault = fault.map_or_else(String::new, |fault| format!(": {}", fault.message));
        format!("this version of psd finds errors in the recorded plan{fault}")
    })?;
    if header.check_run {
        check_run::measured_part(&plan).map_err(|fault| fault.to_string())
    } else {
        Ok(plan)
    }
}

/// Whether the equipment in the header agrees with plan and rig. This detects a changed calibration.
fn fits(logged: &LoggedRun, plan: &Plan) -> Result<(), String> {
    let Some(rig) = logged.rigs.first() else {
        return Ok(());
    };
    if logged.header.equipment == Equipment::of(plan, Device::of(&rig.identity, rig.noise)) {
        return Ok(());
    }
    Err("rig, calibration or limits of its header differ from its plan and its rig".to_owned())
}

/// The provenance from the run log.
fn provenance_of(header: &Header, plan: &Plan, recovered: &Recovered) -> Provenance {
    let number = super::provenance::report_number(
        &header.run_id,
        plan,
        recovered.ended,
        Some(recovered.head()),
    );
    let stated = Provenance {
        run_id: header.run_id.clone(),
        number,
        psd_version: header.psd.clone(),
        build: Build {
            sources: header.build.clone(),
            toolchain: header.toolchain.clone(),
        },
        plan_sha256: header
            .files
            .first()
            .map_or_else(String::new, |file| file.sha256.clone()),
        equipment: Some(header.equipment.clone()),
        ..super::provenance::of_simulated_run(plan, header.date.as_deref(), header.began.as_deref())
    };
    if plan.rig.link.as_real().is_none() {
        return stated;
    }
    let date = super::provenance::date_of_real_run(plan, header.began.as_deref());
    Provenance {
        date,
        real: Some(real_run(header, recovered)),
        ..stated
    }
}

/// The data of a real run's log about operator and machine, and about itself.
fn real_run(header: &Header, recovered: &Recovered) -> RealRun {
    let wall = |line: &Line| {
        line.body()
            .get("wall")
            .and_then(|wall| wall.as_str())
            .map(str::to_owned)
    };
    RealRun {
        operator: header.operator.clone(),
        host: header.host.clone(),
        began: header.began.clone(),
        ended: recovered.lines.iter().rev().find_map(wall),
        jumps: super::wall_clock::jumps(&recovered.lines),
        sealed: Some((recovered.lines.len() as u64, recovered.head().to_owned())),
    }
}
