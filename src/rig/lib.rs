//! The hardware abstraction. A [`Rig`] moves actuators to absolute targets and reads displacement
//! and force, one entry per axis. Virtual and real rigs are the same to `run`, which drives them
//! through the guard only. It knows no procedure.

mod connect;
pub mod controllers;
pub mod emulator;
mod guard;
pub mod journal;
mod motion;
pub mod protocols;
pub mod real;
pub mod safety;
mod scalar_or_list;
pub mod transport;
mod virtual_rig;

#[cfg(test)]
extern crate self as psd_rig;
#[cfg(test)]
#[path = "../testing/lib.rs"]
pub mod testing;

use serde::{Deserialize, Serialize};

use psd_physics::tracking::trajectory::Path;
use psd_plan::record::IS_OUTSIDE;
use psd_plan::{Interval, Limits, Plan};
use psd_text::units::{Dimension, display};

pub use connect::{Connected, connect};
pub use guard::{Guard, IdealSteps, Traversed, fault_of_ideal_step};
pub use psd_plan::DeclaredNoise;
pub use psd_plan::record::{Held, Identity};
pub use psd_plan::{named_axis, of_axis, who};
pub use safety::final_hold::{FinalHold, position_and_force};
pub use safety::live::{Feedback, Live};
pub use safety::stop_request::StopRequest;
pub use virtual_rig::{OWN_SPEED, VirtualRig};

/// The virtual rig of a plan, with an axis for each degree of freedom of its specimen. For a plan with a real rig, an ideal
/// virtual rig.
#[must_use]
pub fn virtual_rig(plan: &Plan) -> Box<dyn Rig> {
    Box::new(VirtualRig::of_plan(plan))
}

/// Boot identifier of a device that has none and was seen to restart.
pub const JUST_STARTED: &str = "just started";

/// Boot identifier of one device of several that has none.
pub const NO_POWER_UP: &str = "-";

/// One reading: measured displacement \[m\] and restoring force \[N\] of each degree of freedom.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Rig time since the start of the run \[s\], with motion, settling and pauses.
    pub time: f64,
    pub displacement: Vec<f64>,
    pub force: Vec<f64>,
    /// The bytes from which it was decoded, one entry per reply; none on a virtual rig.
    pub raw: Vec<Vec<u8>>,
}

impl Reading {
    /// Whether all its values are finite. A reading that is not finite is not kept.
    pub fn is_finite(&self) -> bool {
        let mut values = self.displacement.iter().chain(&self.force);
        values.all(|value| value.is_finite())
    }
}

/// A move as it would be sent. Nothing has been sent yet.
#[derive(Clone, Debug, PartialEq)]
pub struct EncodedMove {
    /// Absolute targets \[m\], decoded from the bytes. The guard compares these with the limits.
    pub targets: Vec<f64>,
    /// \[m/s\], decoded from the bytes if they contain a speed.
    pub speed: f64,
    /// The bytes that carry the target; empty on a virtual rig.
    pub wire: Vec<u8>,
    /// Number of the move, if the rig remembers its last move.
    pub move_id: Option<u64>,
    /// The targets in the rig's own coordinate \[m\], if its zero differs from that of the plan.
    pub at_the_rig: Option<Vec<f64>>,
}

/// The last move a rig remembers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LastMove {
    pub id: u64,
    /// One per axis \[m\]. In the run log, a rig of one axis has a number here, not a list.
    #[serde(rename = "target", with = "scalar_or_list")]
    pub targets: Vec<f64>,
}

/// Communication errors that were recovered without harm, for the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct LineStatistics {
    /// Frames that were sent again because of a missing answer.
    pub resent: u64,
    /// Replies that were discarded: broken, late, duplicated or unsolicited.
    pub ignored: u64,
    /// Readings that were repeated because one was not usable.
    pub reread: u64,
}

impl LineStatistics {
    /// Both counts together.
    #[must_use]
    pub const fn plus(self, other: Self) -> Self {
        Self {
            resent: self.resent.saturating_add(other.resent),
            ignored: self.ignored.saturating_add(other.ignored),
            reread: self.reread.saturating_add(other.reread),
        }
    }
}

impl std::fmt::Display for LineStatistics {
    /// Only the counts that are not zero.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let counted = [
            (self.resent, "frame", "sent again"),
            (self.ignored, "reply", "ignored"),
            (self.reread, "reading", "repeated"),
        ];
        let counts = counted.into_iter().filter(|(count, ..)| *count > 0).map(
            |(count, what, became)| match (count, what) {
                (1, _) => format!("1 {what} {became}"),
                (_, "reply") => format!("{count} replies {became}"),
                _ => format!("{count} {what}s {became}"),
            },
        );
        f.write_str(&counts.collect::<Vec<_>>().join(", "))
    }
}

/// The reason why a rig could not execute a request. The rig holds its position in every case.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RigFault {
    /// A target or reading is outside a limit: the run is aborted.
    #[error("{}", breach(*.quantity, *.value, *.axis, *.low, *.high))]
    LimitBreached {
        quantity: LimitedQuantity,
        value: f64,
        low: f64,
        high: f64,
        /// The axis of a rig with several axes, from 1.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        axis: Option<usize>,
    },
    #[error("{} did not settle within {timeout} s", who(*.axis))]
    NotSettled {
        timeout: f64,
        /// The first axis of several that did not settle, from 1.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        axis: Option<usize>,
    },
    /// The rig reports that it has arrived, at a different position \[m\].
    #[error("following error{}: stopped {:.6} mm from its target (settling band {:.6} mm)", of_axis(*.axis), .error * 1e3, .band * 1e3)]
    Following {
        error: f64,
        band: f64,
        /// The axis of a rig with several axes, from 1.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        axis: Option<usize>,
    },
    /// The operator requests a hold now, not at the end of the step.
    #[error("held on request during a step")]
    Interrupted,
    #[error("{0}")]
    Device(String),
}

/// Six digits, because a value just beyond its limit must not appear equal to the limit. Fractions are in percent.
fn breach(
    quantity: LimitedQuantity,
    value: f64,
    axis: Option<usize>,
    low: f64,
    high: f64,
) -> String {
    let shown = |value: f64| match quantity.dimension() {
        Dimension::NUMBER => display::plain(100.0 * value, Dimension::NUMBER, 6) + " %",
        dimension => display::plain(value, dimension, 6),
    };
    format!(
        "{quantity}{} {}{IS_OUTSIDE}{} .. {}",
        of_axis(axis),
        shown(value),
        shown(low),
        shown(high)
    )
}

/// The quantity that a limit bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LimitedQuantity {
    TargetDisplacement,
    MeasuredDisplacement,
    Force,
    /// Of an axis in force control: the target.
    TargetForce,
    /// The same: measured − target.
    ForceError,
    Speed,
    Increment,
    TrackingError,
    EnergyError,
    TrackingEnergyError,
    NrmsError,
}

impl LimitedQuantity {
    /// The dimension of the quantity. Energy errors and the NRMS error are fractions.
    #[must_use]
    pub const fn dimension(self) -> Dimension {
        match self {
            Self::TargetDisplacement
            | Self::MeasuredDisplacement
            | Self::Increment
            | Self::TrackingError => Dimension::LENGTH,
            Self::Force | Self::TargetForce | Self::ForceError => Dimension::FORCE,
            Self::Speed => Dimension::VELOCITY,
            Self::EnergyError | Self::TrackingEnergyError | Self::NrmsError => Dimension::NUMBER,
        }
    }
}

impl std::fmt::Display for LimitedQuantity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::TargetDisplacement => "target displacement",
            Self::MeasuredDisplacement => "measured displacement",
            Self::Force => "force",
            Self::TargetForce => "target force",
            Self::ForceError => "force error",
            Self::Speed => "speed",
            Self::Increment => "increment",
            Self::TrackingError => "tracking error",
            Self::EnergyError => "energy error",
            Self::TrackingEnergyError => "tracking energy error",
            Self::NrmsError => "NRMS tracking error",
        })
    }
}

/// The contract of every driver: identify → propose (may refuse) → execute → settle → read; hold at any time.
pub trait Rig {
    fn identity(&self) -> Identity;

    /// The replies with its identity. A virtual rig has none.
    fn introduction(&self) -> Vec<Vec<u8>> {
        Vec::new()
    }

    /// Actuators with their load cells, at least 1. Those in force control are the last: the entries of their targets are forces \[N\], and
    /// no path moves them.
    fn degrees_of_freedom(&self) -> usize;

    /// Rig time since the start of the run \[s\].
    fn time(&self) -> f64;

    /// The next call moves to these targets \[m\] at this speed (\[m/s\]; None: not known). A run log that ends here is continued before
    /// the speed is decided and compared with its limit.
    ///
    /// # Errors
    /// The run log ends with a different motion.
    fn before_motion(&mut self, _targets: &[f64], _speed: Option<f64>) -> Result<(), RigFault> {
        Ok(())
    }

    /// Encodes a move to absolute targets \[m\] at a speed (\[m/s\]; None: the rig's own), and decodes the bytes again.
    /// Nothing is sent, and nothing moves yet.
    ///
    /// # Errors
    /// The rig cannot encode it.
    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<EncodedMove, RigFault>;

    /// Executes the proposed move, and waits until the rig is in position and settled.
    ///
    /// # Errors
    /// The rig does not settle or cannot be reached; it holds.
    fn execute(&mut self) -> Result<(), RigFault>;

    /// Stays at its position for `seconds` of rig time.
    ///
    /// # Errors
    /// The rig cannot be reached.
    fn pause(&mut self, seconds: f64) -> Result<(), RigFault>;

    /// Reads once.
    ///
    /// # Errors
    /// The rig cannot be reached, or the reading is not a number.
    fn read(&mut self) -> Result<Reading, RigFault>;

    /// Reads once. Also reports the time of its last move, if it was observed: start and end of the equivalent uniform motion, in rig
    /// time \[s\].
    ///
    /// # Errors
    /// As `read`.
    fn read_moved(&mut self) -> Result<(Reading, Option<[f64; 2]>), RigFault> {
        Ok((self.read()?, None))
    }

    /// This rig, if it is simulated, settles equally long after every move, and no entry is logged for each of its calls: its guard then
    /// takes whole steps in one call.
    fn at_once(&mut self) -> Option<&mut dyn WholeSteps> {
        None
    }

    /// Whether it is a virtual rig, or one that is recorded, on which every reading at rest is its target and the force of the specimen
    /// there. It is then [`Rig::at_once`] too.
    fn is_ideal(&mut self) -> bool {
        false
    }

    /// Moves at constant velocity (\[m/s\], signed towards the target) to absolute targets, and reads at up to `samples`
    /// equally spaced times during the motion, the last at its end. There is no settling in between. A rig that cannot keep
    /// up reads as often as it can, at least twice. Every reading has its own time and position. Each reading is passed to
    /// `each` as it is made; if `each` refuses, the rig holds immediately and the refusal is the error.
    ///
    /// # Errors
    /// As `execute`, `read` and `each`; or fewer than two readings if two or more were requested.
    fn traverse(
        &mut self,
        targets: &[f64],
        velocity: f64,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault>;

    /// Follows smooth paths, one per degree of freedom and of equal duration. It reads at `samples` equally spaced times, the last at the
    /// end of the paths. The rig continues to move there until the next path or a hold. Each reading is passed to `each` as it is made;
    /// if `each` refuses, the rig holds immediately and the refusal is the error.
    ///
    /// # Errors
    /// As `traverse`; a rig that accepts only one target at a time follows no path.
    fn follow_paths(
        &mut self,
        _paths: &[Path],
        _samples: usize,
        _each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.hold();
        Err(RigFault::Device(
            "this rig follows no path without a stop".to_owned(),
        ))
    }

    /// The rest of a traverse that was interrupted after some of its readings, from the present position: no part of it is
    /// travelled twice. A rig that is at the end already reads once more, if a reading is left.
    ///
    /// # Errors
    /// As `traverse`.
    fn traverse_on(
        &mut self,
        cut_off: &CutOff<'_>,
        velocity: f64,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.traverse(cut_off.to, velocity, cut_off.left(), each)
    }

    /// The same for paths.
    ///
    /// # Errors
    /// As `follow_paths`.
    fn resume_paths(
        &mut self,
        _paths: &[Path],
        _samples: usize,
        _done: usize,
        _each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.hold();
        Err(RigFault::Device(
            "this rig follows no path without a stop".to_owned(),
        ))
    }

    /// Stops all motion and keeps the load.
    fn hold(&mut self);

    /// The last hold of a run that ends early, and its result: whether the rig was seen at rest, and where. None for a rig
    /// without moving parts.
    fn halt(&mut self) -> Option<FinalHold> {
        self.hold();
        None
    }

    /// Replaces the limits of displacement and force that the rig itself keeps, one entry per axis.
    ///
    /// # Errors
    /// The rig cannot be reached, or does not accept them.
    fn set_limits(&mut self, _limits: &[Limits]) -> Result<(), RigFault> {
        Ok(())
    }

    /// Declared standard deviation of one force reading \[N\] and resolution of the displacement reading \[m\]. They protect the tangent
    /// stiffness from noise.
    fn declared_noise(&self) -> DeclaredNoise;

    /// The position of the plan's zero in the rig's own coordinate \[m\], one per axis. None: the rig has no other
    /// coordinate than the plan's.
    fn datum(&self) -> Option<Vec<f64>> {
        None
    }

    /// Speed of a move without a requested speed \[m/s\]; None: the highest speed that the plan's limits allow.
    fn own_speed(&self) -> Option<f64> {
        None
    }

    /// The limit of speed under which the next motion was made \[m/s\], if it is in a run log. None: that of the plan.
    fn logged_speed_limit(&self) -> Option<Interval> {
        None
    }

    /// The reading that exceeded a limit during a motion and ended it, given only once. None: the motion was not read, or no limit
    /// ended it.
    fn take_broken(&mut self) -> Option<Reading> {
        None
    }

    /// Mean speed of the last move as it was seen \[m/s\]: its length divided by the time from its command until every axis
    /// had arrived, so never more than the true speed. None: only the commanded speed is known.
    fn seen_speed(&self) -> Option<f64> {
        None
    }

    /// The last move that the rig remembers, as it reported when it was opened.
    fn last_move(&self) -> Option<LastMove> {
        None
    }

    /// Communication errors recovered so far.
    fn line_statistics(&self) -> LineStatistics {
        LineStatistics::default()
    }
}

/// A step that ended early.
#[derive(Debug)]
pub struct UnfinishedStep {
    /// Whether the targets were reached.
    pub is_reached: bool,
    pub fault: RigFault,
}

/// A rig that is [`Rig::at_once`].
pub trait WholeSteps {
    /// Moves to finite targets \[m\] at this speed of the fastest axis, above 0 and finite (\[m/s\]; None: the rig's own), settles, pauses
    /// for so long \[s\] and reads: to propose, execute, pause and read, without an allocation.
    ///
    /// # Errors
    /// The run log cannot take the target or the reading, or the reading is not a number.
    fn step(
        &mut self,
        targets: &[f64],
        speed: Option<f64>,
        pause: f64,
        reading: &mut Reading,
    ) -> Result<(), UnfinishedStep>;
}

/// A traverse that was interrupted.
#[derive(Clone, Copy, Debug)]
pub struct CutOff<'a> {
    /// Its start and its target \[m\].
    pub from: &'a [f64],
    pub to: &'a [f64],
    /// Readings that were requested for the whole motion, and those that were made.
    pub samples: usize,
    pub done: usize,
}

impl CutOff<'_> {
    #[must_use]
    pub const fn left(&self) -> usize {
        self.samples.saturating_sub(self.done)
    }
}

/// Receives each reading of a traverse as it is made.
pub type EachReading<'a> = &'a mut dyn FnMut(Reading) -> Result<(), RigFault>;
