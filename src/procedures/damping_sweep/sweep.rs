//! The readings of a damping sweep so far. In: the steps of each stroke. Out: the same for pairing, findings and results. It moves nothing.

use std::ops::Range;

use psd_plan::formula::Estimate;
use psd_plan::record::SweepStep;

/// Steps of one stroke, out and back.
pub(super) struct Stroke {
    pub out: Range<usize>,
    pub back: Range<usize>,
    /// Commanded \[m/s\].
    pub speed: f64,
    /// Duration of a pass \[s\].
    pub seconds: f64,
    /// Whether every reading was made at the requested time.
    pub on_grid: bool,
}

pub(super) struct Sweep {
    pub steps: Vec<SweepStep>,
    /// The steps of each stroke that was completed, out and back.
    pub strokes: Vec<Stroke>,
    /// K of the plan \[N/m\].
    pub stiffness: Option<Estimate>,
    /// \[s\]
    pub lag: f64,
    /// Whether the rig reads at the requested times.
    pub exact: bool,
}

impl Sweep {
    /// K of the plan \[N/m\].
    pub(super) fn planned(&self) -> f64 {
        self.stiffness.map_or(0.0, |stiffness| stiffness.value)
    }
}
