//! The number of time steps of a run, and their times.

/// The number of steps and their times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pace {
    /// Δt \[s\]
    pub time_step: f64,
    pub steps: u64,
    /// \[s\]
    pub pause: f64,
}
