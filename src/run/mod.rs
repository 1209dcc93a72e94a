//! The run loop: plan and rig to record. It opens the session, checks the rig, performs each
//! procedure and ends the run. Every target and reading passes the guard. It knows no equation and
//! no printed form.

pub mod check_run;
pub mod client_run;
mod driver;
mod floors;
mod hybrid;
pub(crate) mod inputs;
mod motion;
pub(crate) mod pretest_check;
pub mod remote_control;
pub mod replay;
pub(crate) mod session;
mod shared;
mod shutdown;
pub mod start;
pub(crate) mod stop;
pub(crate) mod zero_drift;

pub use driver::{run, run_with};
pub use motion::{Extent, Motion};
pub use psd_plan::record::remote::{Disconnect, Request};
pub use shared::Shared;

use serde::{Deserialize, Serialize};

use psd_physics::tracking::monitor::Tracking;
use psd_plan::record::{Event, History, NamedResult};
use stop::Stop;

/// An observer of a run: a progress bar, a live screen, a run log, the operator.
pub trait Observer {
    /// A procedure begins; `steps` is an upper bound of its steps, if one is known.
    fn procedure_started(&mut self, _name: &str, _keyword: &str, _steps: Option<u64>) {}
    fn step_done(&mut self, _report: &StepReport) {}
    /// Whether it follows the steps: without, no step is reported to it, and it asks for nothing between two steps.
    fn follows_steps(&self) -> bool {
        true
    }
    fn procedure_finished(&mut self, _name: &str) {}
    /// The uncertainty of the results is being calculated by re-runs, of which `_done` are done.
    fn studying(&mut self, _done: usize, _of: usize) {}
    /// Asked after every step: true stops the run after holding the rig.
    fn stop_requested(&self) -> bool {
        false
    }
    /// The operator is to inspect the specimen; the answer states whether to continue. Asked again while it is
    /// [`Inspection::Wait`], as it always is of an observer that only displays the run.
    fn inspect(&mut self, _note: &str) -> Inspection {
        Inspection::Wait
    }
    /// A real rig is about to move for the first time: whether the operator enables this motion. `note` is its text in the run log. Asked
    /// again while it is [`Inspection::Wait`].
    fn release(&mut self, note: &str, _motion: &Motion) -> Inspection {
        self.inspect(note)
    }
    /// The run has ended early, and the rig holds: whether it may be unloaded. None: unloading is not requested, and the
    /// rig stays on hold. Asked again while it is [`Inspection::Wait`].
    fn may_unload(&mut self, _question: &str, _motion: &Motion) -> Option<Inspection> {
        None
    }
    /// The operator's request between two steps. Asked until it is [`Next::GoOn`].
    fn next(&mut self) -> Next {
        Next::GoOn
    }
    /// An event of the run; it is in the run log.
    fn event(&mut self, _: &Event) {}
    /// A client that drives the rig has sent a request; it is about to be executed.
    fn asked(&mut self, _: &Request) {}
}

/// The action after a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Next {
    GoOn,
    /// The run is paused: ask again after a short time.
    Wait,
    /// An action or observation of the operator, for the run log.
    Record(String),
}

/// The end of a step, for display and for the run log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Number within its procedure, from 1.
    pub step: u64,
    /// Simulated time of an impact, else laboratory time \[s\].
    pub time: f64,
    /// At least one.
    pub axes: Vec<AxisReport>,
    /// Speed of the last motion of the rig \[m/s\]; only for display.
    pub speed: Option<f64>,
    /// Largest force of the axial axes \[N\]; None without one; only for display.
    pub axial_force: Option<f64>,
    /// Energy error over the input energy; only for procedures that integrate.
    pub energy_error: Option<f64>,
    /// The tracking errors; only for procedures that integrate.
    pub tracking: Option<Tracking>,
    /// Its energy error over the present input energy of the test.
    pub tracking_energy_error: Option<f64>,
}

/// One axis at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisReport {
    /// Target of the step \[m\].
    pub command: f64,
    /// Measured \[m\].
    pub displacement: f64,
    /// Computed \[m/s\]; only for procedures that integrate.
    pub velocity: Option<f64>,
    /// Computed \[m/s²\]; only for procedures that integrate.
    pub acceleration: Option<f64>,
    /// Measured restoring force \[N\].
    pub force: f64,
}

impl StepReport {
    /// A step of a procedure that integrates nothing, for each axis with its command.
    pub fn of_readings(
        step: u64,
        time: f64,
        commands: &[f64],
        displacement: &[f64],
        force: &[f64],
    ) -> Self {
        let read = displacement.iter().zip(force);
        let axis = |(command, (displacement, force)): (&f64, (&f64, &f64))| AxisReport {
            command: *command,
            displacement: *displacement,
            velocity: None,
            acceleration: None,
            force: *force,
        };
        Self {
            step,
            time,
            axes: commands.iter().zip(read).map(axis).collect(),
            speed: None,
            axial_force: None,
            energy_error: None,
            tracking: None,
            tracking_energy_error: None,
        }
    }

    /// Displacement of the last axis \[m\].
    pub fn highest(&self) -> f64 {
        self.axes.last().map_or(0.0, |axis| axis.displacement)
    }
}

/// The operator's answer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Inspection {
    GoOn {
        note: Option<String>,
        /// The operator, if known.
        by: Option<String>,
    },
    Stop {
        reason: String,
        /// The operator, if known.
        by: Option<String>,
    },
    /// No answer yet: ask again after a short time.
    Wait,
}

impl Inspection {
    /// Continues without a note.
    #[must_use]
    pub const fn go_on() -> Self {
        Self::GoOn {
            note: None,
            by: None,
        }
    }
}

/// Displays nothing, and continues at every inspection.
pub struct Unwatched;

impl Observer for Unwatched {
    fn follows_steps(&self) -> bool {
        false
    }

    fn inspect(&mut self, _: &str) -> Inspection {
        Inspection::go_on()
    }
}

/// The record of a procedure, also if it was stopped: all measurements until then, and their results.
pub(crate) struct Performed {
    pub(crate) history: History,
    /// All results, in the order of the schema.
    pub(crate) results: Vec<NamedResult>,
    pub(crate) stop: Option<Stop>,
}

/// The part of a run that its record keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Keep {
    /// Steps, results and their uncertainty.
    #[default]
    Everything,
    /// Steps and results. No uncertainty is evaluated; fits keep the standard errors of their scatter.
    Steps,
    /// The results. A procedure that integrates keeps its last step alone.
    Results,
}
