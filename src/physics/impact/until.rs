//! When an impact is over. It reads no state itself.

/// When an impact is over, before its `duration` at the latest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Until {
    /// The first step end with Ẋs ≤ 0 and Ẋ ≤ 0.
    StrikerStop,
    /// Striker and structure are apart for good.
    Rebound,
    /// The first step end at which the drift of a storey is at least this \[m\].
    Drift(f64),
    /// The whole `duration`.
    Duration,
}

impl Until {
    /// Whether a run has ended, by whether its striker has stopped or has rebounded for good, or a storey has reached a drift \[m\].
    pub fn reached(
        self,
        stopped: impl FnOnce() -> bool,
        apart: impl FnOnce() -> bool,
        drifted: impl FnOnce(f64) -> bool,
    ) -> bool {
        match self {
            Self::StrikerStop => stopped(),
            Self::Rebound => apart(),
            Self::Drift(drift) => drifted(drift),
            Self::Duration => false,
        }
    }
}
