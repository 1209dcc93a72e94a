//! The history of an impact, on one degree of freedom or on a floor of a frame: one row per step.

use crate::record::{StepState, StruckFrame};
use psd_physics::impact::energy::Energies;
use psd_physics::impact::summary::{ImpactEnding, still_rising};
use psd_physics::tracking::monitor::Tracking;

/// One row of an impact's table; step 0 is the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactStep {
    pub step: u64,
    /// Simulated time \[s\].
    pub time: f64,
    /// Rig time \[s\].
    pub wall_time: f64,
    pub state: StepState,
    /// Commanded to the actuator \[m\].
    pub command: f64,
    /// Computed displacement X \[m\]: the command; under α-OS the command corrected by the force read there.
    pub computed: f64,
    /// Measured \[m\].
    pub displacement: f64,
    pub velocity: f64,
    pub acceleration: f64,
    pub restoring_force: f64,
    /// Mean over the step \[N\]; zero at step 0.
    pub contact_force: f64,
    pub striker_displacement: f64,
    pub striker_velocity: f64,
    pub tangent_stiffness: f64,
    /// Permanent \[m\].
    pub indentation: f64,
    pub energies: Energies,
    /// The tracking errors.
    pub tracking: Tracking,
}

/// An impact, step by step: on one degree of freedom, or on one floor of a frame.
#[derive(Clone, Debug)]
pub struct ImpactHistory {
    /// The striker and the struck point. For a frame: the struck floor and storey, with the energies of the whole frame and
    /// the tracking of all axes together.
    pub steps: Vec<ImpactStep>,
    /// Of an impact whose steps are not kept.
    pub ending: Option<ImpactEnding>,
    /// None for one degree of freedom.
    pub frame: Option<StruckFrame>,
    /// \[s\]
    pub time_step: f64,
    /// \[s\]
    pub critical_time_step: f64,
}

impl ImpactHistory {
    /// How it ended.
    #[must_use]
    pub fn ending(&self) -> ImpactEnding {
        self.ending.unwrap_or_else(|| {
            let after_start = self.steps.get(1..).unwrap_or_default();
            ImpactEnding {
                still_striking: !after_start.is_empty()
                    && after_start.iter().all(|step| step.striker_velocity > 0.0),
                touched: self.steps.iter().any(|step| step.contact_force > 0.0),
                still_rising: self.still_rising(),
                speeding_up: self.last_is_largest(|step| step.velocity.abs()),
                pushing_harder: self.last_is_largest(|step| step.contact_force),
            }
        })
    }

    /// Whether a value is larger at the last step than ever before.
    fn last_is_largest(&self, value: impl Fn(&ImpactStep) -> f64) -> bool {
        self.steps.split_last().is_some_and(|(last, before)| {
            value(last) > 0.0 && before.iter().all(|step| value(step) < value(last))
        })
    }

    /// Whether the structure was still moving beyond its largest displacement at the end of the record: then the maximum
    /// was not reached within the run.
    #[must_use]
    pub fn still_rising(&self) -> bool {
        let largest = self
            .steps
            .iter()
            .map(|step| step.computed)
            .fold(f64::NEG_INFINITY, f64::max);
        self.steps
            .last()
            .is_some_and(|last| still_rising(last.velocity, last.computed >= largest))
    }
}
