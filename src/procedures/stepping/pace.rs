//! How many time steps a run takes, and how long they are.

/// How many steps there are, and how long they take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pace {
    /// Δt, s
    pub time_step: f64,
    pub steps: u64,
    /// s
    pub pause: f64,
}
