//! The motion of the actuator between targets, shared by every procedure that integrates.

/// The motion of the actuator between targets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    /// The actuator stops at every target; the reading is at rest.
    RampAndHold,
    /// The actuator does not stop: laboratory time is `time_scale` times simulated time. The force includes the damper force at that
    /// speed.
    Continuous { time_scale: f64 },
}
