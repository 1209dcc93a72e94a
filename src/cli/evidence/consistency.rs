//! Consistency of a run log with itself: repeated entries agree, the run id follows from the plan and its circumstances, and no entry
//! that this program writes is missing. In: a run log as it was read. Out: the first error. It replays nothing.

use crate::files::provenance::recorded_id;
use crate::files::recorded_run::{ReadRecord, plan_of};
use psd::report::Provenance;
use psd::run::replay::{self, LoggedRun};
use psd_plan::Plan;
use psd_rig::journal::EntryKind;

/// Compares the entries of a run log with each other.
///
/// # Errors
/// The first contradiction.
pub fn check_consistency(read: &ReadRecord) -> Result<(), String> {
    replay::check_consistency(&read.recovered, &read.logged, &read.plan)
        .map_err(|fault| fault.to_string())?;
    match read
        .recovered
        .lines
        .iter()
        .position(|line| line.kind == EntryKind::Amend)
    {
        None => begins(&read.logged, &read.plan)?,
        Some(amended) => {
            let mut first = read.recovered.clone();
            first.lines.truncate(amended);
            let logged = LoggedRun::of(&first).map_err(|fault| fault.to_string())?;
            let plan =
                plan_of(&logged).map_err(|fault| format!("before it was amended: {fault}"))?;
            begins(&logged, &plan)?;
            if read.logged.header.run_id != logged.header.run_id {
                return Err("an amendment makes it a different run".to_owned());
            }
        }
    }
    Ok(())
}

/// The start of the run log: its run id.
fn begins(logged: &LoggedRun, plan: &Plan) -> Result<(), String> {
    let header = &logged.header;
    let id = recorded_id(header, plan);
    if header.run_id != id {
        return Err(format!(
            "its run id is not {id}, which follows from its plan and its circumstances"
        ));
    }
    Ok(())
}

/// Observations on a consistent run log.
pub fn remarks(provenance: &Provenance) -> String {
    match provenance.real.as_ref().map_or(0, |real| real.jumps.len()) {
        0 => String::new(),
        1 => ", its wall clock jumped once".to_owned(),
        jumps => format!(", its wall clock jumped {jumps} times"),
    }
}
