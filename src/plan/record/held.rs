//! The changes of force and displacement while the rig held its position.

/// Results of the dwells of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Held {
    /// Dwells that were long enough for a slope.
    pub count: u64,
    /// \[s\]
    pub longest: f64,
    /// The fastest of each axis, in absolute value: \[N/s\] and \[m/s\].
    pub slopes: Vec<(f64, f64)>,
    /// Largest increase of the force in one of them at a displacement beyond all earlier ones \[N\]. None: no such dwell.
    pub grown: Option<f64>,
}
