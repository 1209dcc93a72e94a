//! The multilinear curve that a plan asks for: fitted, and what a person should know of it. In: measured points. Out: the fit,
//! results, remarks. It moves nothing.

use super::foreseen::Foreseen;
use super::results::measured;
use crate::formula::ResultValue;
use crate::mechanics::multilinear_fit::{BreakCount, MultilinearFit, fit_multilinear};
use crate::quantity::Dimension;
use crate::quantity::display::readable;
use crate::record::{LineFit, NamedResult};

/// The curve through (m, N), means of so many samples; `what` names the points in a remark.
pub(super) fn fitted(
    points: &[(f64, f64)],
    count: BreakCount,
    what: &str,
    (foreseen, samples): (Foreseen, u32),
) -> (Option<MultilinearFit>, Vec<String>) {
    let (x, r): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    let fit = fit_multilinear(&x, &r, count).map(|fit| foreseen.multilinear(&fit, (&x, &r), samples).unwrap_or(fit));
    let remarks = remarks(fit.as_ref(), count, points.len(), what);
    (fit, remarks)
}

/// What a straight line misses of the fit before a remark is made of it, 1 − R².
const MISSED: f64 = 1e-3;

/// The change of stiffness past a break that a straight line hides, over the first one, before a remark is made of it.
const HIDDEN: f64 = 0.1;

/// Says of points (m, N) that a straight line does not fit them, for they bend: by BIC, plainly and by much.
pub(super) fn bends(points: &[(f64, f64)], line: &LineFit) -> Option<String> {
    let (x, r): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    let fit = fit_multilinear(&x, &r, BreakCount::ByCriterion { most: 1 }).filter(|fit| fit.doubtful().is_empty())?;
    let (place, _) = fit.breaks.first()?;
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

fn remarks(fit: Option<&MultilinearFit>, count: BreakCount, points: usize, what: &str) -> Vec<String> {
    let Some(fit) = fit else {
        let wanted = match count {
            BreakCount::Exactly(1) => "with a break".to_owned(),
            BreakCount::Exactly(breaks) => format!("with {breaks} breaks"),
            BreakCount::ByCriterion { .. } => "of any number of breaks".to_owned(),
        };
        return vec![format!("no multilinear curve: {points} {what} bear none {wanted}, three points a stretch and one more")];
    };
    let mut told = Vec::new();
    if fit.breaks.is_empty() {
        told.push(format!("no break: by BIC one straight line fits the {what} best, elastic as far as they went"));
    }
    if matches!(count, BreakCount::ByCriterion { most } if most > 1 && fit.breaks.len() == most) {
        told.push(format!("BIC took as many breaks as it may ({}): the curve may well bend smoothly", fit.breaks.len()));
    }
    told.extend(fit.doubtful().into_iter().map(|at| {
        let place = readable(fit.breaks[at].0, Dimension::LENGTH);
        format!("the {what} hardly show the break at {place}: its change of stiffness is less than twice its standard error")
    }));
    told
}

/// Of a number and its standard error.
type Part = fn(&(f64, f64)) -> f64;

/// The lists of a curve, in the order of the reference; empty without one.
pub(super) fn lists(fit: Option<&MultilinearFit>) -> Vec<NamedResult> {
    let list = |name, dimension, values: fn(&MultilinearFit) -> &[(f64, f64)], part: Part| NamedResult {
        name,
        value: ResultValue::List(fit.map(|fit| values(fit).iter().map(part).collect()).unwrap_or_default()),
        dimension,
        contributions: Vec::new(),
    };
    let (value, error): (Part, Part) = (|pair| pair.0, |pair| pair.1);
    vec![
        list("breaks", Dimension::LENGTH, |fit| &fit.breaks, value),
        list("break_uncertainties", Dimension::LENGTH, |fit| &fit.breaks, error),
        list("break_forces", Dimension::FORCE, |fit| &fit.forces, value),
        list("break_force_uncertainties", Dimension::FORCE, |fit| &fit.forces, error),
        list("curve_stiffnesses", Dimension::STIFFNESS, |fit| &fit.stiffnesses, value),
        list("curve_stiffness_uncertainties", Dimension::STIFFNESS, |fit| &fit.stiffnesses, error),
    ]
}

/// What a curve says of yielding, in the order of the reference: force, place, last stiffness, its ratio to the first.
pub(super) fn yielding(fit: Option<&MultilinearFit>) -> [NamedResult; 4] {
    let told = |pair: (f64, f64)| (pair.0, Some(pair.1));
    let knee = fit.and_then(MultilinearFit::knee);
    let broken = fit.filter(|fit| !fit.breaks.is_empty());
    let last = broken.and_then(|fit| fit.stiffnesses.last()).copied();
    [
        measured("yield_force", Dimension::FORCE, knee.map(|[_, force]| told(force))),
        measured("yield_displacement", Dimension::LENGTH, knee.map(|[place, _]| told(place))),
        measured("hardened_stiffness", Dimension::STIFFNESS, last.map(told)),
        measured("hardening", Dimension::NUMBER, broken.map(|fit| told(fit.hardening))),
    ]
}
