//! The report of a stiffness ramp: its curve, the relaxation in its pauses, the line through its readings. In: a history. Out: blocks.

use super::curve::curve_report;
use crate::report::document::Block;
use crate::report::number;
use crate::report::sections::results::line_fit::{Coefficient, fitted};
use psd_plan::record::{Hold, RelaxationFit, StiffnessRampHistory, SuperpositionFit};
use psd_plan::{RelaxationLaw, RelaxationModel};
use psd_text::units::Dimension;

/// How the contributions to its uncertainty were found; also for every other fitted line.
pub(crate) const UNCERTAINTY: &str = "Scatter of its readings: covariance of the fit; calibration: by the powers of \
 force and displacement in the result; resolution: reported beside the scatter where it is the larger contribution.";

/// The blocks below its results.
pub(crate) fn report(history: &StiffnessRampHistory, body: &mut Vec<Block>) {
    if let Some(fit) = &history.multilinear {
        let reach = history.steps.iter().map(|step| step.displacement);
        curve_report::table(
            fit,
            reach.fold(0.0, |most, x| {
                if fit.direction * x > fit.direction * most {
                    x
                } else {
                    most
                }
            }),
            body,
        );
    }
    if let Some(fit) = &history.relaxation {
        body.push(relaxed(fit, &history.holds));
    }
    if let Some(fit) = &history.reached {
        body.push(relaxed_by_a_law(fit, &history.holds));
    }
    if let Some(fit) = history.fit {
        body.push(fitted(
            "R = K·X + R₀",
            &Coefficient("K", Dimension::STIFFNESS),
            &Coefficient("R₀", Dimension::FORCE),
            fit,
        ));
    }
}

/// The relaxation in the dwells: its model, the scatter of the readings about it, and the remaining relaxation.
fn relaxed(fit: &RelaxationFit, holds: &[Hold]) -> Block {
    let with = |(value, error): (f64, f64), dimension| {
        number::with_uncertainty(value, Some(error), dimension)
    };
    let model = match fit.model {
        RelaxationModel::Exponential => "R = R∞ + A e^(−t/τ) in every pause".to_owned(),
        RelaxationModel::StandardLinearSolid => {
            let solid = fit
                .branch_stiffness
                .map(|stiffness| format!(", K₁ = {}", with(stiffness, Dimension::STIFFNESS)));
            format!(
                "R = R₀ + K∞X + q, q' = K₁X' − q/τ through all moves and pauses{}",
                solid.unwrap_or_default()
            )
        }
    };
    let readings: usize = holds.iter().map(|hold| hold.readings.len()).sum();
    Block::note(format!(
        "Relaxation by least squares over {readings} readings in {} pauses: {model}, τ = {} (in parentheses the \
         standard error); scatter of the readings {}. Remaining relaxation after the pauses: {} at most.",
        holds.len(),
        with(fit.time_constant, Dimension::TIME),
        number::text(fit.scatter, Dimension::FORCE),
        with(fit.remaining, Dimension::FORCE),
    ))
}

/// The law of relaxation of the instantaneous force, the reason for it, and the rate of relaxation at the end of the pauses.
fn relaxed_by_a_law(fit: &SuperpositionFit, holds: &[Hold]) -> Block {
    let with = |(value, error): (f64, f64), dimension| {
        number::with_uncertainty(value, Some(error), dimension)
    };
    let best = fit.best();
    let (law, share) = match best.law {
        RelaxationLaw::Exponential => ("R̂ − R grows by g (1 − e^(−t/τ))", "g"),
        RelaxationLaw::Logarithmic => ("R̂ − R grows by a ln(1 + t/t₀)", "a"),
    };
    let chosen = fit.margin().map_or_else(String::new, |margin| {
        let other = if margin > 0.0 {
            "an exponential"
        } else {
            "the logarithm of time"
        };
        format!(
            " BIC, corrected for few readings, prefers it to {other} by {:.1}.",
            margin.abs()
        )
    });
    let readings: usize = holds.iter().map(|hold| hold.readings.len()).sum();
    Block::note(format!(
        "Relaxation by least squares over {readings} readings in {} pauses, superposed from each step: {law} for each \
         increment of the unrelaxed force R̂, {share} = {}, {} = {} (in parentheses the standard error); scatter of \
         the readings {}.{chosen} Largest force rate at the end of a pause: {}.",
        holds.len(),
        with(best.share, Dimension::NUMBER),
        best.law.time_name(),
        with(best.time, Dimension::TIME),
        number::text(best.scatter, Dimension::FORCE),
        with(best.rate, Dimension::FORCE_RATE),
    ))
}
