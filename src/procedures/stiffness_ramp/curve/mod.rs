//! The multilinear curve that a plan requests: the fit and the observations on it. In: measured points. Out: the fit, results,
//! observations. It moves nothing.

pub(crate) mod curve_report;

use psd_physics::identification::StatedVariance;
use psd_physics::identification::multilinear_fit::{BreakCount, MultilinearFit, fit_multilinear};
use psd_plan::procedures::stiffness_ramp::block as schema;
use psd_plan::record::{LineFit, NamedResult};
use psd_plan::schema::{ResultKind, curves};
use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// The curve through points (m, N); `what` names the points in an observation.
pub(crate) fn fitted(
    points: &[(f64, f64)],
    count: BreakCount,
    what: &str,
    stated: StatedVariance,
) -> (Option<MultilinearFit>, Vec<String>) {
    let (x, r): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    let fit = fit_multilinear(&x, &r, count, stated);
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
    let fit = fit_multilinear(
        &x,
        &r,
        BreakCount::ByCriterion { most: 1 },
        StatedVariance::default(),
    )
    .filter(|fit| fit.indistinct_breakpoints().is_empty())?;
    let (displacement, _) = fit.breakpoints.first()?;
    let ((first, _), (last, _)) = (fit.stiffnesses.first()?, fit.stiffnesses.last()?);
    let hidden = (last - first).abs() > HIDDEN * first.abs();
    (hidden && 1.0 - line.r_squared > MISSED).then(|| {
        format!(
            "the outward steps are nonlinear near {}: one straight line is a poor fit; use `fit = bilinear` or `fit = multilinear`",
            readable(*displacement, Dimension::LENGTH)
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
            BreakCount::Exactly(1) => "with one breakpoint".to_owned(),
            BreakCount::Exactly(breaks) => format!("with {breaks} breakpoints"),
            BreakCount::ByCriterion { .. } => "with any number of breakpoints".to_owned(),
        };
        return vec![format!(
            "no multilinear curve: {points} {what} are too few for a curve {wanted} (three points per segment and one more)"
        )];
    };
    let mut texts = Vec::new();
    if fit.breakpoints.is_empty() {
        texts.push(format!(
            "no breakpoint: by BIC one straight line is the best fit of the {what}"
        ));
    }
    if matches!(count, BreakCount::ByCriterion { most } if most > 1 && fit.breakpoints.len() == most)
    {
        texts.push(format!(
            "BIC chose the largest allowed number of breakpoints ({}): the curve may be smooth",
            fit.breakpoints.len()
        ));
    }
    texts.extend(fit.indistinct_breakpoints().into_iter().map(|at| {
        let displacement = readable(fit.breakpoints[at].0, Dimension::LENGTH);
        format!("the breakpoint at {displacement} is weak in the {what}: its change of stiffness is less than twice its standard error")
    }));
    texts
}

/// The lists of a curve, in the order of the reference; empty without one.
pub(crate) fn lists(fit: Option<&MultilinearFit>) -> Vec<NamedResult> {
    let list = |kind: ResultKind, values: fn(&MultilinearFit) -> &[(f64, f64)]| {
        let values = fit.map_or(&[][..], values).iter();
        kind.found_list(Some(values.map(|(value, _)| *value).collect()))
    };
    vec![
        list(curves::BREAKS, |fit| &fit.breakpoints),
        list(curves::BREAK_FORCES, |fit| &fit.forces),
        list(curves::CURVE_STIFFNESSES, |fit| &fit.stiffnesses),
    ]
}

/// The yield results of a curve, in the order of the reference: force, position, last stiffness, its ratio to the first.
pub(crate) fn yielding(fit: Option<&MultilinearFit>) -> [NamedResult; 4] {
    let with_error = |pair: (f64, f64)| (pair.0, Some(pair.1));
    let knee = fit.and_then(MultilinearFit::yield_point);
    let broken = fit.filter(|fit| !fit.breakpoints.is_empty());
    let last = broken.and_then(|fit| fit.stiffnesses.last()).copied();
    [
        schema::YIELD_FORCE.found_with(knee.map(|[_, force]| with_error(force))),
        schema::YIELD_DISPLACEMENT
            .found_with(knee.map(|[displacement, _]| with_error(displacement))),
        schema::POST_YIELD_STIFFNESS.found_with(last.map(with_error)),
        schema::POST_YIELD_RATIO.found_with(broken.map(|fit| with_error(fit.post_yield_ratio))),
    ]
}
