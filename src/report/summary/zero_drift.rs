//! The zero drift of a rig in `summary.json`. In: the zero drift of a record. Out: its part of the summary, only where the rig
//! declares an allowed drift. It makes no assessment.

use schemars::JsonSchema;
use serde::Serialize;

use super::finite;
use crate::record::{AxisDrift, Drift, Zero};

/// What the zeros of the rig did in the run, and how far they may drift.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ZeroDriftSummary {
    /// Whether none drifted farther than is allowed.
    pub within: bool,
    /// Why not.
    pub reasons: Vec<String>,
    /// Change of the zero of the force, by size, at most, N.
    pub force_allowed: Option<f64>,
    /// Of displacement less target, m; null where it is told only.
    pub displacement_allowed: Option<f64>,
    /// Time over which a zero is read; a hold as long tells a slope, s.
    pub over: Option<f64>,
    #[schemars(extend("enum" = ["start", "free", "nowhere"]))]
    pub after: &'static str,
    /// Holds that were long enough.
    pub holds: u64,
    /// s
    pub longest_hold: Option<f64>,
    /// Largest growth of the force in a hold farther out than ever before, where a specimen can only relax, N.
    pub grown: Option<f64>,
    /// Lowest floor first.
    pub axes: Vec<AxisZeroDriftSummary>,
}

/// Of one actuator and its load cell.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct AxisZeroDriftSummary {
    pub before: ZeroSummary,
    /// Null where it was not read.
    pub after: Option<ZeroSummary>,
    /// N
    pub force_change: Option<f64>,
    /// m
    pub displacement_change: Option<f64>,
    /// Fastest in a hold, by size, N/s; null without a hold.
    pub held_force_slope: Option<f64>,
    /// m/s
    pub held_displacement_slope: Option<f64>,
}

/// A reading of no load.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ZeroSummary {
    /// Rig time, s.
    pub wall_time_s: Option<f64>,
    /// N
    pub force: Option<f64>,
    /// Measured displacement less its target, m.
    pub displacement: Option<f64>,
    /// N/s
    pub force_slope: Option<f64>,
    /// m/s
    pub displacement_slope: Option<f64>,
}

impl ZeroDriftSummary {
    pub(super) fn of(drift: &Drift) -> Self {
        let reasons: Vec<String> = drift.all_beyond().map(|beyond| beyond.reason).collect();
        let slope_in_holds =
            |axis: usize| drift.held.slopes.get(axis).filter(|_| drift.held.count > 0);
        let axis = |(index, axis): (usize, &AxisDrift)| AxisZeroDriftSummary {
            before: zero(&axis.before),
            after: axis.after.as_ref().map(zero),
            force_change: axis.change().and_then(|(force, _)| finite(force)),
            displacement_change: axis
                .change()
                .and_then(|(_, displacement)| finite(displacement)),
            held_force_slope: slope_in_holds(index).and_then(|(force, _)| finite(*force)),
            held_displacement_slope: slope_in_holds(index)
                .and_then(|(_, displacement)| finite(*displacement)),
        };
        Self {
            within: reasons.is_empty(),
            reasons,
            force_allowed: finite(drift.check.force),
            displacement_allowed: drift.check.displacement.and_then(finite),
            over: finite(drift.check.over),
            after: drift.check.after.name(),
            holds: drift.held.count,
            longest_hold: finite(drift.held.longest).filter(|_| drift.held.count > 0),
            grown: drift.held.grown.and_then(finite),
            axes: drift.axes.iter().enumerate().map(axis).collect(),
        }
    }
}

fn zero(zero: &Zero) -> ZeroSummary {
    ZeroSummary {
        wall_time_s: finite(zero.time),
        force: finite(zero.force),
        displacement: finite(zero.displacement),
        force_slope: finite(zero.force_slope),
        displacement_slope: finite(zero.displacement_slope),
    }
}
