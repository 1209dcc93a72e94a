//! The history of a `cycle`: every reading, and the results of each cycle.

use psd_physics::identification::cyclic::{Loop, LoopPoint};
use psd_physics::identification::multilinear_fit::MultilinearFit;

/// One reading of a cycle: the mean of the samples at a target, or a single reading during the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycleStep {
    pub step: u64,
    /// Rig time \[s\].
    pub wall_time: f64,
    /// From 1; 0 is the start of the first cycle.
    pub cycle: u64,
    /// As requested \[m\].
    pub amplitude: f64,
    /// \[m\]
    pub command: f64,
    /// Mean of the samples \[m\].
    pub displacement: f64,
    /// Mean of the samples \[N\].
    pub restoring_force: f64,
    /// Standard deviation of the samples \[N\]; 0 for one sample.
    pub force_scatter: f64,
    /// First reading after settling minus the mean at the end of the dwell \[N\].
    pub relaxation: f64,
    /// ∫R dX from the first reading on \[J\].
    pub energy: f64,
}

impl CycleStep {
    /// As a point of its loop.
    #[must_use]
    pub fn point(&self) -> LoopPoint {
        LoopPoint {
            command: self.command,
            displacement: self.displacement,
            force: self.restoring_force,
        }
    }
}

/// One complete cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WholeCycle {
    /// From 1.
    pub cycle: u64,
    /// As requested \[m\].
    pub amplitude: f64,
    /// Number of the cycle at this amplitude, from 1.
    pub repeat: u32,
    /// As measured.
    pub found: Loop,
}

/// Cyclic loading, target by target, and each closed cycle.
#[derive(Clone, Debug, Default)]
pub struct CycleHistory {
    /// The first is the start of the cycles.
    pub steps: Vec<CycleStep>,
    pub cycles: Vec<WholeCycle>,
    /// The backbone, as displacements from the middle with both sides combined, if the plan requests it.
    pub backbone: Option<MultilinearFit>,
}

impl CycleHistory {
    /// The middle of the cycles \[m\].
    #[must_use]
    pub fn middle(&self) -> f64 {
        self.steps.first().map_or(0.0, |step| step.command)
    }

    /// The start and the reversal points of the first cycle at each amplitude, relative to the middle: displacement \[m\] and force
    /// \[N\]. Those on the pull side have the opposite sign, so that both sides can be compared.
    #[must_use]
    pub fn backbone_points(&self) -> Vec<(f64, f64)> {
        let middle = self.middle();
        let folded = |(x, force): (f64, f64)| {
            if x < middle {
                (middle - x, -force)
            } else {
                (x - middle, force)
            }
        };
        let first = self
            .steps
            .first()
            .map(|step| (step.displacement - middle, step.restoring_force));
        // One-sided cycles return to the middle: that is not a backbone point.
        let far = |(x, _): &(f64, f64), amplitude: f64| (x - middle).abs() > 0.5 * amplitude;
        let first_cycles = self.cycles.iter().filter(|cycle| cycle.repeat == 1);
        let ends = first_cycles.flat_map(|cycle| {
            cycle
                .found
                .ends
                .into_iter()
                .filter(|end| far(end, cycle.amplitude))
                .map(folded)
        });
        first.into_iter().chain(ends).collect()
    }
}
