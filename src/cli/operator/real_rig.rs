//! A real rig for a command. In: a checked plan that names one. Out: the open rig, with its observer.

use std::path::Path;

use super::dialogue::typed::throw_away;
use super::watch::{Attendance, Signals, Watcher, can_draw};
use crate::args::{PlanSettings, ScreenForm, name};
use crate::exit::Failure;
use crate::files::plan_file;
use crate::files::record_file::Circumstances;
use crate::output::print_message;
use crate::settings::Settings;
use psd::check::Checked;
use psd::run::replay::Wall;
use psd_plan::Plan;
use psd_rig::{Connected, Rig as _, StopRequest, connect};

/// Reads and checks the plan of a command that may move a rig, and prints its diagnostics. The plan is checked as unattended if the
/// command line names no operator, and none can be asked.
pub fn open_plan(
    path: &Path,
    given: &PlanSettings,
    attendance: &Attendance,
    settings: Settings,
) -> Result<Checked, Failure> {
    if attendance.screen == Some(ScreenForm::Full) && !can_draw(settings) {
        return Err(Failure::command_line(
            "the live screen requires a UTF-8 terminal of at least 60 × 16",
        )
        .help("enlarge the window, or write `--screen plain`"));
    }
    let unattended = attendance.operator.is_none() && (attendance.yes || !settings.can_ask);
    let checked = plan_file::open_to_run(path, given, unattended)?;
    plan_file::show(&checked, path, settings);
    Ok(checked)
}

/// The name of the operator of a test on a real rig. It is asked for at the terminal if neither command line nor plan gives it. Nothing
/// is open yet, and Ctrl-C ends the program.
pub fn named(attendance: Attendance, plan: &Plan) -> Result<Attendance, Failure> {
    if plan.rig.link.as_real().is_none() || attendance.operator_of(plan).is_some() {
        return Ok(attendance);
    }
    let unnamed = || {
        Failure::command_line("no operator is named: nothing was opened")
            .help("--operator \"A. Tester\"")
    };
    let operator = Some(asked("name of the operator?", name).ok_or_else(unnamed)?);
    Ok(Attendance {
        operator,
        ..attendance
    })
}

/// The answer of the operator at the terminal, asked until `read` takes it. None: the input has ended.
pub fn asked(question: &str, read: fn(&str) -> Result<String, String>) -> Option<String> {
    // Input typed before the question is not an answer.
    throw_away();
    loop {
        print_message(&format!("  {question} "));
        let mut line = String::new();
        if std::io::stdin().read_line(&mut line).ok()? == 0 {
            print_message("\n");
            return None;
        }
        match read(&line) {
            Ok(answer) => return Some(answer),
            Err(reason) => print_message(&format!("  {reason}\n")),
        }
    }
}

/// An open rig, and its observer.
pub struct Opened {
    pub connected: Connected,
    pub watcher: Watcher,
}

/// Opens the plan's real rig: reads its identity, moves nothing. Signals are caught from here on, and become `stop_request`. A program
/// that is killed in the middle of a command would leave the rig in an unknown state. `drawn`: as for [`Watcher::new`].
pub fn open(
    plan: &Plan,
    attendance: &Attendance,
    stop_request: &StopRequest,
    settings: Settings,
    drawn: bool,
) -> Result<Opened, Failure> {
    let signals = Signals::caught(stop_request).map_err(Failure::Signals)?;
    let connected = connect(&plan.rig, &plan.limits, stop_request)?;
    let simulated = connected.rig.identity().simulated;
    let mut watcher = Watcher::new(settings, attendance, plan, simulated, signals, drawn);
    watcher.watch(connected.rig.live());
    Ok(Opened { connected, watcher })
}

/// The operator, the machine and the start time.
pub fn circumstances(plan: &Plan, attendance: &Attendance) -> Circumstances {
    let host = rustix::system::uname()
        .nodename()
        .to_string_lossy()
        .into_owned();
    Circumstances {
        operator: attendance.operator_of(plan),
        host: Some(host),
        began: wall_clock()(),
        served: None,
    }
}

/// The start of a run on a simulated rig, which needs no operator.
pub fn start_alone() -> Circumstances {
    Circumstances {
        began: wall_clock()(),
        ..Circumstances::default()
    }
}

/// UTC, to the millisecond.
pub fn wall_clock() -> Wall {
    Box::new(|| {
        Some(
            jiff::Timestamp::now()
                .strftime("%Y-%m-%dT%H:%M:%S%.3fZ")
                .to_string(),
        )
    })
}

/// The values of `--rig`, `--set` and `--date` at the start of a run log.
pub fn settings_of(header: &psd::run::replay::Header) -> PlanSettings {
    PlanSettings {
        rig: header.rig.clone(),
        set: header.settings.clone(),
        date: header.date.clone(),
    }
}
