//! The fits of a stiffness ramp, for the uncertainty of its results.

use super::run::fitted;
use super::uncertainty::Readings;
use crate::procedures::common::fit_uncertainty::Fits;
use psd_plan::StiffnessRamp;
use psd_plan::record::StiffnessRampHistory;
use psd_plan::uncertainty::InstrumentUncertainty;

/// Calls with the fits of a ramp.
pub(crate) fn with_fits(
    ramp: &StiffnessRampHistory,
    plan: &StiffnessRamp,
    instruments: &InstrumentUncertainty,
    give: &mut dyn FnMut(&Fits<'_>),
) {
    let readings = Readings {
        starts: Vec::new(),
        steps: ramp.steps.clone(),
    };
    let stated = instruments.stated_variance(0, plan.samples);
    give(&Fits {
        refit: Some(&|by| fitted(&readings.perturbed(by, plan.samples).steps, plan, stated)),
        line: ramp.fit,
        bilinear: ramp.bilinear.as_ref(),
        curve: ramp.multilinear.as_deref(),
        shown: &|name| ramp.shown(name).unwrap_or(1.0),
        common_resolution: true,
    });
}
