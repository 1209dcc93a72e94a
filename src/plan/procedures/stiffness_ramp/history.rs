//! The history of a stiffness ramp: one row per dwell, and the fits.

use crate::procedures::stiffness_ramp::block;
use crate::record::{BilinearFit, Hold, LineFit, MultilinearFit, RelaxationFit, SuperpositionFit};

/// One dwell of a stiffness ramp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RampStep {
    pub step: u64,
    /// Rig time \[s\].
    pub wall_time: f64,
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
    /// Secant from the step before \[N/m\]; None at the first or without motion.
    pub tangent_stiffness: Option<f64>,
    /// Whether this step is on the unloading branch.
    pub returning: bool,
}

/// A stiffness ramp, position by position, and the fits.
#[derive(Clone, Debug)]
pub struct StiffnessRampHistory {
    /// The reading before the first increment of each repetition, numbered by the steps before it.
    pub before: Vec<RampStep>,
    pub steps: Vec<RampStep>,
    /// None if too few steps were recorded, or if two lines are fitted.
    pub fit: Option<LineFit>,
    /// For a ramp beyond yield, if the plan requests it.
    pub bilinear: Option<BilinearFit>,
    pub multilinear: Option<Box<MultilinearFit>>,
    /// Dwells that were evaluated, and their results.
    pub holds: Vec<Hold>,
    pub relaxation: Option<Box<RelaxationFit>>,
    /// The law of relaxation of the instantaneous force, if the plan requests it.
    pub reached: Option<Box<SuperpositionFit>>,
}

impl StiffnessRampHistory {
    /// Degrees of freedom of the scatter of a fitted result. None without a fit.
    #[must_use]
    pub fn degrees(&self, result: &str) -> Option<f64> {
        let dwells = || match (&self.reached, self.relaxation.as_deref()) {
            (Some(fit), _) => Some(fit.best().degrees),
            (None, Some(fit)) if result == block::RELAXED_STIFFNESS.name => {
                Some(fit.degrees_of_stiffness())
            }
            (None, fit) => fit.map(|fit| fit.degrees),
        };
        let steps = || {
            let line = self.fit.map(|fit| fit.degrees);
            let bilinear = || self.bilinear.as_ref().map(|fit| fit.degrees);
            line.or_else(bilinear)
                .or_else(|| self.multilinear.as_ref().map(|fit| fit.degrees))
        };
        if is_fitted_to_dwells(result) {
            dwells()
        } else {
            steps()
        }
    }

    /// The fraction of the standard errors of a fitted result that its scatter shows. None without a fit.
    #[must_use]
    pub fn shown(&self, result: &str) -> Option<f64> {
        if is_fitted_to_dwells(result) {
            let law = || self.reached.as_ref().map(|fit| fit.best().shown);
            return self.relaxation.as_ref().map(|fit| fit.shown).or_else(law);
        }
        let line = self.fit.map(|fit| fit.shown);
        let bilinear = || self.bilinear.as_ref().map(|fit| fit.shown);
        line.or_else(bilinear)
            .or_else(|| self.multilinear.as_ref().map(|fit| fit.shown))
    }
}

/// Whether a result is fitted to the readings in dwells, not to the steps.
fn is_fitted_to_dwells(result: &str) -> bool {
    block::BLOCK
        .result(result)
        .is_some_and(|kind| kind.fitted_to_dwells)
}
