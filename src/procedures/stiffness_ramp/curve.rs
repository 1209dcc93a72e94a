//! The multilinear curve that a plan requests: the fit and the observations on it. In: measured points. Out: the fit, results,
//! observations. It moves nothing.

use crate::physics::identification::StatedVariance;
use crate::physics::identification::multilinear_fit::{
    BreakCount, MultilinearFit, fit_multilinear, fit_multilinear_stated,
};
use crate::plan::formula::ResultValue;
use crate::record::{LineFit, NamedResult};
use crate::schema::procedures::stiffness_ramp as schema;
use crate::schema::{ResultKind, curves};
use crate::units::Dimension;
use crate::units::display::readable;

/// The curve through points (m, N); `what` names the points in an observation.
pub(crate) fn fitted(
    points: &[(f64, f64)],
    count: BreakCount,
    what: &str,
    stated: StatedVariance,
) -> (Option<MultilinearFit>, Vec<String>) {
    let (x, r): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    let fit = fit_multilinear_stated(&x, &r, count, stated);
    let remarks = remarks(fit.as_ref(), count, points.len(), what);
    (fit, remarks)
}

/// An observation is made if the misfit 1 − R² of a straight line exceeds this.
const MISSED: f64 = 1e-3;

/// An observation is made if a straight line hides a change of stiffness at a breakpoint above this fraction of the first stiffness.
const HIDDEN: f64 = 0.1;

/// An observation that a straight line does not fit the points (m, N) because they bend: strong by BIC, and large in size.
pub(crate) fn bends(points: &[(f64, f64)], line: &LineFit) -> Option<String> {
    let (x, r): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    let fit = fit_multilinear(&x, &r, BreakCount::ByCriterion { most: 1 })
        .filter(|fit| fit.indistinct_breakpoints().is_empty())?;
    let (place, _) = fit.breakpoints.first()?;
    let ((first, _), (last, _)) = (fit.stiffnesses.first()?, fit.stiffnesses.last()?);
    let hidden = (last - first).abs() > HIDDEN * first.abs();
    (hidden && 1.0 - line.r_squared > MISSED).then(|| {
        format!(
            "the outward steps bend near {}: one straight line fits neither side, and its stiffness is that of none; \
             `fit = bilinear` or `fit = multilinear` tells both",
            readable(*place, Dimension::LENGTH)
        )
    })
}

fn remarks(
    fit: Option<&MultilinearFit>,
    count: BreakCount,
    points: usize,
    what: &str,
) -> Vec<String> {
    let Some(fit) = fit else {
        let wanted = match count {
            BreakCount::Exactly(1) => "with a break".to_owned(),
            BreakCount::Exactly(breaks) => format!("with {breaks} breaks"),
            BreakCount::ByCriterion { .. } => "of any number of breaks".to_owned(),
        };
        return vec![format!(
            "no multilinear curve: {points} {what} bear none {wanted}, three points a stretch and one more"
        )];
    };
    let mut told = Vec::new();
    if fit.breakpoints.is_empty() {
        told.push(format!(
            "no break: by BIC one straight line fits the {what} best, elastic as far as they went"
        ));
    }
    if matches!(count, BreakCount::ByCriterion { most } if most > 1 && fit.breakpoints.len() == most)
    {
        told.push(format!(
            "BIC took as many breaks as it may ({}): the curve may well bend smoothly",
            fit.breakpoints.len()
        ));
    }
    told.extend(fit.indistinct_breakpoints().into_iter().map(|at| {
        let place = readable(fit.breakpoints[at].0, Dimension::LENGTH);
        format!("the {what} hardly show the break at {place}: its change of stiffness is less than twice its standard error")
    }));
    told
}

/// A number or its standard error.
type Part = fn(&(f64, f64)) -> f64;

/// The lists of a curve, in the order of the reference; empty without one.
pub(crate) fn lists(fit: Option<&MultilinearFit>) -> Vec<NamedResult> {
    let list =
        |kind: ResultKind, values: fn(&MultilinearFit) -> &[(f64, f64)], part: Part| NamedResult {
            name: kind.name,
            value: ResultValue::List(
                fit.map(|fit| values(fit).iter().map(part).collect())
                    .unwrap_or_default(),
            ),
            dimension: kind.dimension,
            contributions: Vec::new(),
        };
    let (value, error): (Part, Part) = (|pair| pair.0, |pair| pair.1);
    vec![
        list(curves::BREAKS, |fit| &fit.breakpoints, value),
        list(curves::BREAK_UNCERTAINTIES, |fit| &fit.breakpoints, error),
        list(curves::BREAK_FORCES, |fit| &fit.forces, value),
        list(curves::BREAK_FORCE_UNCERTAINTIES, |fit| &fit.forces, error),
        list(curves::CURVE_STIFFNESSES, |fit| &fit.stiffnesses, value),
        list(
            curves::CURVE_STIFFNESS_UNCERTAINTIES,
            |fit| &fit.stiffnesses,
            error,
        ),
    ]
}

/// The yield results of a curve, in the order of the reference: force, position, last stiffness, its ratio to the first.
pub(crate) fn yielding(fit: Option<&MultilinearFit>) -> [NamedResult; 4] {
    let told = |pair: (f64, f64)| (pair.0, Some(pair.1));
    let knee = fit.and_then(MultilinearFit::yield_point);
    let broken = fit.filter(|fit| !fit.breakpoints.is_empty());
    let last = broken.and_then(|fit| fit.stiffnesses.last()).copied();
    [
        schema::YIELD_FORCE.found_with(knee.map(|[_, force]| told(force))),
        schema::YIELD_DISPLACEMENT.found_with(knee.map(|[place, _]| told(place))),
        schema::HARDENED_STIFFNESS.found_with(last.map(told)),
        schema::HARDENING.found_with(broken.map(|fit| told(fit.post_yield_ratio))),
    ]
}
