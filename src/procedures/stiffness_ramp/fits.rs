//! The fits of a stiffness ramp, for the uncertainty of its results.

use crate::procedures::fit_uncertainty::Fits;
use crate::record::RampHistory;

/// Results of a ramp that are fitted to its holds.
const OF_HOLDS: [&str; 8] = [
    "time_constant",
    "relaxed_stiffness",
    "branch_stiffness",
    "remaining_relaxation",
    "needed_pause",
    "relaxation_share",
    "reference_time",
    "relaxation_rate",
];

/// Calls with the fits of a ramp.
pub(crate) fn with_fits(ramp: &RampHistory, give: &mut dyn FnMut(&Fits<'_>)) {
    give(&Fits {
        line: ramp.fit,
        bilinear: ramp.bilinear.as_ref(),
        curve: ramp.multilinear.as_deref(),
        shown: &|name| shown(ramp, name),
        common_resolution: true,
    });
}

/// Fraction of the standard errors of a fitted result that its scatter shows.
fn shown(ramp: &RampHistory, name: &str) -> f64 {
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
