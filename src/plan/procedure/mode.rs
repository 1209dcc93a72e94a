//! How the actuator goes from target to target, shared by every procedure that integrates.

/// How the actuator goes from target to target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    /// It stops at every one; the reading is at rest.
    StepAndPause,
    /// It does not stop: rig time is `time_scale` times virtual time, and what a damper does at that speed is in the force.
    Continuous { time_scale: f64 },
}
