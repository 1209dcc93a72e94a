//! The zero drift of a rig in `summary.json`. In: the zero drift of a record. Out: its part of the summary, only where the rig
//! declares an allowed drift. It makes no assessment.

use schemars::JsonSchema;
use serde::Serialize;

use super::finite;
use psd_plan::record::{AxisDrift, Drift, Zero};

/// Zero drift of the rig in the run, and its limits.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ZeroDriftSummary {
    /// Whether every zero drift is within its limit.
    pub within: bool,
    /// Reasons if not.
    pub reasons: Vec<String>,
    /// Largest allowed zero drift of the force, absolute, N.
    pub force_allowed: Option<f64>,
    /// Largest allowed zero drift of the displacement, absolute, m; null: reported, not checked.
    pub displacement_allowed: Option<f64>,
    /// Time over which a zero is read, s; a dwell of this length has a slope.
    pub over: Option<f64>,
    #[schemars(extend("enum" = ["start", "free", "nowhere"]))]
    pub after: &'static str,
    /// Number of dwells that were long enough.
    pub holds: u64,
    /// s
    pub longest_hold: Option<f64>,
    /// Largest growth of the force in a dwell beyond all earlier displacements, where a specimen can only relax, N.
    pub grown: Option<f64>,
    /// Lowest floor first.
    pub axes: Vec<AxisZeroDriftSummary>,
}

/// Zero drift of one actuator and its load cell.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct AxisZeroDriftSummary {
    pub before: ZeroSummary,
    /// Null if it was not read.
    pub after: Option<ZeroSummary>,
    /// N
    pub force_change: Option<f64>,
    /// m
    pub displacement_change: Option<f64>,
    /// Largest slope in a dwell, absolute, N/s; null without a dwell.
    pub held_force_slope: Option<f64>,
    /// m/s
    pub held_displacement_slope: Option<f64>,
}

/// Mean of the readings at zero load.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ZeroSummary {
    /// Rig time, s.
    pub wall_time_s: Option<f64>,
    /// N
    pub force: Option<f64>,
    /// Measured displacement minus target, m.
    pub displacement: Option<f64>,
    /// N/s
    pub force_slope: Option<f64>,
    /// m/s
    pub displacement_slope: Option<f64>,
}

impl ZeroDriftSummary {
    pub(super) fn of(drift: &Drift) -> Self {
        let reasons: Vec<String> = drift.beyond().map(|beyond| beyond.reason).collect();
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
