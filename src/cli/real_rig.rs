//! A real rig for a command. In: a checked plan that names one. Out: the rig, open, with who watches it.

use super::args::PlanSettings;
use super::exit::Failure;
use super::record_file::Circumstances;
use super::settings::Settings;
use super::watch::{Attendance, Signals, Watcher};
use crate::plan::Plan;
use crate::rig::{Connected, Rig as _, Wish, connect};
use crate::run::tape::Wall;

/// A rig that is open, and who watches it.
pub struct Opened {
    pub connected: Connected,
    pub watcher: Watcher,
}

/// Opens the plan's real rig: asks who it is, moves nothing. Signals are caught from here on.
pub fn open(plan: &Plan, attendance: &Attendance, settings: Settings) -> Result<Opened, Failure> {
    let wish = Wish::default();
    // Caught before the first byte: to be killed in the middle of a word is no way to leave a rig.
    let early = Signals::caught(&wish).map_err(Failure::Signals)?;
    let connected = connect(&plan.rig, &plan.limits, &wish)?;
    let simulated = connected.rig.identity().simulated;
    let watcher = Watcher::new(settings, attendance, plan, simulated, wish).map_err(Failure::Signals)?;
    // A signal that both heard counts twice, which holds at once: the safe side.
    drop(early);
    Ok(Opened { connected, watcher })
}

/// [`open`] for a client that drives: watched in lines, and `wish` is what signals become.
pub fn open_for_client(plan: &Plan, attendance: &Attendance, settings: Settings, wish: &Wish) -> Result<Opened, Failure> {
    let connected = connect(&plan.rig, &plan.limits, wish)?;
    let simulated = connected.rig.identity().simulated;
    let watcher = Watcher::in_lines(settings, attendance, plan, simulated, wish.clone()).map_err(Failure::Signals)?;
    Ok(Opened { connected, watcher })
}

/// Who stands by, on which machine, and when it began.
pub fn circumstances(plan: &Plan, attendance: &Attendance) -> Circumstances {
    let named = plan.particulars.iter().find(|(field, _)| *field == "operator").map(|(_, name)| name.clone());
    let host = rustix::system::uname().nodename().to_string_lossy().into_owned();
    Circumstances { operator: attendance.operator.clone().or(named), host: Some(host), began: wall_clock()(), served: None }
}

/// UTC, to the millisecond.
pub fn wall_clock() -> Wall {
    Box::new(|| Some(jiff::Timestamp::now().strftime("%Y-%m-%dT%H:%M:%S%.3fZ").to_string()))
}

/// What `--rig`, `--set` and `--date` said when a record began.
pub fn settings_of(header: &crate::run::tape::Header) -> PlanSettings {
    PlanSettings { rig: header.rig.clone(), set: header.settings.clone(), date: header.date.clone() }
}
