//! What the uncertainty of an identified result is made of: the scatter of its own fit, and the calibration of the rig. In:
//! the results of a ramp or a sweep with the standard errors of their fits. Out: the same with their contributions, so that
//! what follows from them knows what they share.

use super::inputs::Inputs;
use crate::formula::{Formula, ProcedureId, ResultValue};
use crate::mechanics::backbone::SHARED;
use crate::plan::{Calibration, ProcedureKind};
use crate::quantity::Dimension;
use crate::record::{BilinearFit, History, NamedResult};
use crate::uncertainty::{Contribution, Source, combined, share};

/// Results of a fit that lie on one line, slope first.
const LINES: [(&str, &str); 2] = [("stiffness", "intercept_force"), ("damping", "coulomb_force")];

/// Forces that a false zero of the load cell shifts; slopes and differences do not show it.
const SHIFTED: [&str; 2] = ["intercept_force", "yield_force"];

/// Says of every identified result what its uncertainty is made of.
pub(super) fn attribute(
    kind: &ProcedureKind,
    history: &History,
    calibration: &Calibration,
    inputs: &Inputs<'_>,
    results: &mut [NamedResult],
) {
    let (line, bilinear) = match history {
        History::Ramp(ramp) => (ramp.fit, ramp.bilinear.as_ref()),
        History::Sweep(sweep) => (sweep.fit, None),
        // What is fitted to the backbone; its loops know already.
        History::Cycle(_) => (None, None),
        _ => return,
    };
    let procedure = inputs.procedure();
    for result in results.iter_mut().filter(|result| result.contributions.is_empty()) {
        if let ResultValue::Number { value: Some(value), uncertainty: Some(own) } = result.value {
            result.contributions = match bilinear {
                Some(fit) => shares_of(procedure, result.name, own, fit),
                None => own_parts(procedure, result.name, own, line.map(|line| line.correlation)),
            };
            result.contributions.extend(of_calibration(result, value, calibration));
        }
    }
    if let (ProcedureKind::DampingSweep(sweep), History::Sweep(_)) = (kind, history) {
        damping_ratio(results, &sweep.stiffness, inputs);
    }
    for result in results.iter_mut() {
        // A fit alone keeps its standard error as it is, to the bit.
        let calibrated = |part: &Contribution| !matches!(part.source, Source::Fit { .. });
        if result.contributions.iter().any(calibrated)
            && let ResultValue::Number { uncertainty, .. } = &mut result.value
        {
            *uncertainty = combined(&result.contributions);
        }
    }
}

/// The standard error `own`, of which the intercept of a line shares with the slope what they are correlated by.
fn own_parts(procedure: ProcedureId, name: &'static str, own: f64, correlation: Option<f64>) -> Vec<Contribution> {
    let part = |result, amount| Contribution::new(Source::Fit { procedure, result }, amount);
    match (LINES.iter().find(|(_, intercept)| *intercept == name), correlation) {
        (Some((slope, _)), Some(r)) => vec![part(slope, r * own), part(name, (1.0 - r * r).max(0.0).sqrt() * own)],
        _ => vec![part(name, own)],
    }
}

/// The errors of a bilinear fit by what they share.
fn shares_of(procedure: ProcedureId, name: &'static str, own: f64, fit: &BilinearFit) -> Vec<Contribution> {
    let part = |result, amount| Contribution::new(Source::Fit { procedure, result }, amount);
    match SHARED.iter().position(|shared| *shared == name) {
        Some(row) if fit.shares[row].iter().any(|share| *share != 0.0) => SHARED
            .iter()
            .zip(fit.shares[row])
            .filter(|(_, share)| *share != 0.0)
            .map(|(result, share)| part(result, share))
            .collect(),
        _ => vec![part(name, own)],
    }
}

/// A result that is made of forces F, displacements X and times alone, as F^p·X^q, grows with the factor of the load cell
/// to the p and that of the transducer to the q: p is the exponent of mass in its dimension, q that of length less p.
fn of_calibration(result: &NamedResult, value: f64, calibration: &Calibration) -> Vec<Contribution> {
    let Dimension { mass, length, .. } = result.dimension;
    let (force, displacement) = (mass.as_f64(), length.as_f64() - mass.as_f64());
    let zero = if SHIFTED.contains(&result.name) { calibration.zero_uncertainty } else { 0.0 };
    let parts = [
        (Source::ForceScale(0), value * force * calibration.force_uncertainty),
        (Source::DisplacementScale(0), value * displacement * calibration.displacement_uncertainty),
        (Source::ForceZero(0), zero),
    ];
    parts.into_iter().filter(|(_, amount)| *amount != 0.0).map(|(source, amount)| Contribution::new(source, amount)).collect()
}

/// ζ = c/(2√(KM)): by first order, ζ/c of what is in c and −ζ/(2K) of what is in K.
fn damping_ratio(results: &mut [NamedResult], stiffness: &Formula, inputs: &Inputs<'_>) {
    let number = |name: &str| match results.iter().find(|result| result.name == name)?.value {
        ResultValue::Number { value, .. } => value,
        ResultValue::List(_) => None,
    };
    let (Some(ratio), Some(damping)) = (number("damping_ratio"), number("damping")) else { return };
    let (Ok(known), Ok(in_stiffness)) =
        (stiffness.evaluate(inputs.results(), None), stiffness.contributions(inputs.results(), None))
    else {
        return;
    };
    let of_damping = results.iter().find(|result| result.name == "damping").map(|found| found.contributions.clone());
    let mut parts: Vec<Contribution> = of_damping.unwrap_or_default();
    for part in &mut parts {
        part.amount *= ratio / damping;
    }
    for part in in_stiffness {
        share(&mut parts, Contribution::new(part.source, -0.5 * ratio / known.value * part.amount));
    }
    if let Some(result) = results.iter_mut().find(|result| result.name == "damping_ratio")
        && parts.iter().all(|part| part.amount.is_finite())
    {
        result.contributions = parts;
    }
}
