//! The door to hardware. A [`Rig`] moves actuators to absolute targets and reads displacement and force, one entry a
//! degree of freedom. A virtual rig and a real one are the same to `run`, which drives them only through the guard.

mod actuator;
mod guard;
mod load_cell;
mod settling;
mod virtual_rig;

use crate::quantity::{Dimension, display};

pub use guard::{Guard, Traversed};
pub use virtual_rig::{OWN_SPEED, VirtualRig};

/// Who the rig says it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    pub name: String,
    pub model: String,
    pub serial: String,
    pub firmware: String,
    /// Nothing real moved.
    pub simulated: bool,
}

/// One reading: measured displacement (m) and restoring force (N) of each degree of freedom.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Rig time, s since the run began: motion, settling and pauses.
    pub time: f64,
    pub displacement: Vec<f64>,
    pub force: Vec<f64>,
}

/// Why a rig could not do what was asked. The rig holds its position in every case.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RigFault {
    /// A target or reading lies outside a limit: the run is aborted.
    #[error("{}", breach(*.quantity, *.value, *.low, *.high))]
    LimitBreached { quantity: LimitedQuantity, value: f64, low: f64, high: f64 },
    #[error("the rig did not settle within {timeout} s")]
    NotSettled { timeout: f64 },
    #[error("{0}")]
    Device(String),
}

/// Six digits, since a value just beyond its limit must not read as the limit itself.
fn breach(quantity: LimitedQuantity, value: f64, low: f64, high: f64) -> String {
    let shown = |value| display::plain(value, quantity.dimension(), 6);
    format!("{quantity} {} is outside its limit {} .. {}", shown(value), shown(low), shown(high))
}

/// What a limit bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitedQuantity {
    TargetDisplacement,
    MeasuredDisplacement,
    Force,
    Speed,
    Increment,
    TrackingError,
    EnergyError,
}

impl LimitedQuantity {
    /// What kind of quantity it is; the energy error is a fraction.
    #[must_use]
    pub const fn dimension(self) -> Dimension {
        match self {
            Self::TargetDisplacement | Self::MeasuredDisplacement | Self::Increment | Self::TrackingError => Dimension::LENGTH,
            Self::Force => Dimension::FORCE,
            Self::Speed => Dimension::VELOCITY,
            Self::EnergyError => Dimension::NUMBER,
        }
    }
}

impl std::fmt::Display for LimitedQuantity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::TargetDisplacement => "target displacement",
            Self::MeasuredDisplacement => "measured displacement",
            Self::Force => "force",
            Self::Speed => "speed",
            Self::Increment => "increment",
            Self::TrackingError => "tracking error",
            Self::EnergyError => "energy error",
        })
    }
}

/// The driver contract, one way for every dialect: identify → propose (may refuse) → execute → settle → read; hold at any time.
pub trait Rig {
    fn identity(&self) -> Identity;

    /// Actuators with their load cells, at least 1.
    fn degrees_of_freedom(&self) -> usize;

    /// Rig time, s since the run began.
    fn time(&self) -> f64;

    /// Offers absolute targets (m) at a speed (m/s; None: the rig's own). Nothing moves yet.
    ///
    /// # Errors
    /// The rig refuses the target.
    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<(), RigFault>;

    /// Carries out the proposed move, and waits until in position and settled.
    ///
    /// # Errors
    /// The rig does not settle or cannot be reached; it holds.
    fn execute(&mut self) -> Result<(), RigFault>;

    /// Stays where it is for `seconds` of rig time.
    ///
    /// # Errors
    /// The rig cannot be reached.
    fn pause(&mut self, seconds: f64) -> Result<(), RigFault>;

    /// Reads once.
    ///
    /// # Errors
    /// The rig cannot be reached, or the reading is no number.
    fn read(&mut self) -> Result<Reading, RigFault>;

    /// Moves at constant velocity (m/s, signed towards the target) to absolute targets, and reads `samples` times at equal times on the way,
    /// the last at the end of the motion; no settling in between. Readings come back in order.
    ///
    /// # Errors
    /// As `execute` and `read`.
    fn traverse(&mut self, targets: &[f64], velocity: f64, samples: usize) -> Result<Vec<Reading>, RigFault>;

    /// Stops all motion and keeps the load.
    fn hold(&mut self);

    /// Standard deviation of one force reading, N, and quantum of the displacement reading, m, as declared: they guard the tangent stiffness.
    fn declared_noise(&self) -> DeclaredNoise;
}

/// What the rig declares of its readings.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct DeclaredNoise {
    /// N
    pub force: f64,
    /// m
    pub resolution: f64,
}
