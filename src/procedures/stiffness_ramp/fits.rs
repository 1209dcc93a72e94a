//! The fits of a stiffness ramp, for the uncertainty of its results.

use super::run::fitted;
use super::uncertainty::Readings;
use crate::procedures::common::fit_uncertainty::Fits;
use psd_plan::StiffnessRamp;
use psd_plan::procedures::stiffness_ramp::block as schema;
use psd_plan::record::StiffnessRampHistory;
use psd_plan::uncertainty::InstrumentUncertainty;

/// Results of a ramp that are fitted to its holds.
const OF_HOLDS: [&str; 8] = [
    schema::TIME_CONSTANT.name,
    schema::RELAXED_STIFFNESS.name,
    schema::BRANCH_STIFFNESS.name,
    schema::REMAINING_RELAXATION.name,
    schema::REQUIRED_PAUSE.name,
    schema::RELAXATION_SHARE.name,
    schema::REFERENCE_TIME.name,
    schema::RELAXATION_RATE.name,
];

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
        shown: &|name| shown(ramp, name),
        common_resolution: true,
    });
}

/// Fraction of the standard errors of a fitted result that its scatter shows.
fn shown(ramp: &StiffnessRampHistory, name: &str) -> f64 {
    let of_holds = ramp
        .relaxation
        .as_ref()
        .map(|fit| fit.shown)
        .or(ramp.reached.as_ref().map(|fit| fit.best().shown));
    let of_steps = ramp
        .fit
        .map(|fit| fit.shown)
        .or(ramp.bilinear.as_ref().map(|fit| fit.shown));
    let of_steps = of_steps.or(ramp.multilinear.as_ref().map(|fit| fit.shown));
    if OF_HOLDS.contains(&name) {
        of_holds
    } else {
        of_steps
    }
    .unwrap_or(1.0)
}
