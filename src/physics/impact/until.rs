//! When an impact is over. It reads no state itself.

/// When an impact is over, before its `duration` at the latest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Until {
    /// The first step end with Ẋs ≤ 0 and Ẋ ≤ 0.
    StrikerStop,
    /// Striker and structure are apart for good.
    Rebound,
    /// The whole `duration`.
    Duration,
}

impl Until {
    /// Whether a run has ended, by whether its striker has stopped or has rebounded for good.
    pub fn reached(self, stopped: impl FnOnce() -> bool, apart: impl FnOnce() -> bool) -> bool {
        match self {
            Self::StrikerStop => stopped(),
            Self::Rebound => apart(),
            Self::Duration => false,
        }
    }
}
