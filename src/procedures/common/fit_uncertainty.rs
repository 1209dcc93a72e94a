//! The contributions to the uncertainty of fitted results: the scatter of the fit, the calibration of the rig, the resolution of the
//! readings. In: results with the standard errors of their fits. Out: the same with contributions, so that later results know the
//! sources that they share.

use crate::procedures::common::results::{VANISHES, values};
use psd_physics::identification::bilinear_fit::BilinearShares;
use psd_physics::identification::multilinear_fit::{CurveShares, MultilinearFit};
use psd_physics::reintegration::perturbation::{Perturbation, ReadingErrors};
use psd_plan::formula::{ProcedureId, ResultValue};
use psd_plan::procedures::damping_sweep::block as sweep;
use psd_plan::procedures::stiffness_ramp::block as ramp;
use psd_plan::record::{BilinearFit, LineFit, NamedResult};
use psd_plan::schema::{ResultKind, curves};
use psd_plan::uncertainty::{Contribution, InstrumentUncertainty, Source, combined};
use psd_plan::{Calibration, Plan};
use psd_text::units::Dimension;

/// Pairs of fitted results of one line, slope first.
const LINES: [(ResultKind, ResultKind); 2] = [
    (ramp::STIFFNESS, ramp::INTERCEPT_FORCE),
    (sweep::DAMPING, sweep::COULOMB_FORCE),
];

/// Forces that a zero error of the load cell shifts; it has no effect on slopes and differences.
const SHIFTED: [&str; 3] = [
    ramp::INTERCEPT_FORCE.name,
    ramp::YIELD_FORCE.name,
    curves::BREAK_FORCES.name,
];

/// Reads the contributions to the error of one result.
type ReadShares = fn(&BilinearShares) -> [f64; 4];

/// The results of a bilinear fit, each with the contributions to its error. A `cycle` has results of the same names.
const BILINEAR: [(ResultKind, ReadShares); 6] = [
    (ramp::STIFFNESS, |shares| shares.stiffness),
    (ramp::INTERCEPT_FORCE, |shares| shares.intercept),
    (ramp::POST_YIELD_STIFFNESS, |shares| {
        shares.post_yield_stiffness
    }),
    (ramp::YIELD_DISPLACEMENT, |shares| shares.yield_displacement),
    (ramp::YIELD_FORCE, |shares| shares.yield_force),
    (ramp::POST_YIELD_RATIO, |shares| shares.post_yield_ratio),
];

/// The results that name the independent contributions, in their order.
const INDEPENDENT: [ResultKind; 4] = [
    ramp::STIFFNESS,
    ramp::INTERCEPT_FORCE,
    ramp::POST_YIELD_STIFFNESS,
    ramp::YIELD_DISPLACEMENT,
];

/// The results of a fit to the readings of perturbed instruments.
pub(crate) type Refit<'a> = &'a dyn Fn(&Perturbation) -> Vec<NamedResult>;

/// The fits of a procedure, and the fraction of their standard errors that their scatter shows.
pub(crate) struct Fits<'a> {
    /// Gives the results of the same fit to perturbed readings; None if they are not its readings alone.
    pub refit: Option<Refit<'a>>,
    pub line: Option<LineFit>,
    pub bilinear: Option<&'a BilinearFit>,
    pub curve: Option<&'a MultilinearFit>,
    /// Fraction of the standard errors of a result, by its name, that its scatter shows.
    pub shown: &'a dyn Fn(&str) -> f64,
    /// Whether the readings of the fit have a resolution error in common.
    pub common_resolution: bool,
}

/// Gives every fitted result its contributions: the scatter of its fit, the calibration of the rig, the resolution of the readings.
pub(crate) fn attribute(
    fits: &Fits<'_>,
    plan: &Plan,
    procedure: ProcedureId,
    instruments: &InstrumentUncertainty,
    results: &mut [NamedResult],
) {
    let calibration = &plan.rig.calibration_of(0);
    for result in results
        .iter_mut()
        .filter(|result| result.contributions.is_empty())
    {
        if let ResultValue::Number {
            value: Some(value),
            uncertainty: Some(own),
        } = result.value
        {
            result.contributions = match (fits.bilinear, fits.curve) {
                (Some(fit), _) => shares_of(procedure, result.name, own, fit),
                (None, Some(fit)) => shares_of_curve(procedure, result.name, own, fit),
                (None, None) => own_parts(
                    procedure,
                    result.name,
                    own,
                    fits.line.map(|line| line.correlation),
                ),
            };
            result
                .contributions
                .extend(of_calibration(result, value, calibration));
        }
    }
    if let Some(fit) = fits.curve {
        of_lists(procedure, fit, calibration, results);
    }
    for result in results.iter_mut() {
        let shown = (fits.shown)(result.name);
        split(&mut result.contributions, procedure, shown);
    }
    if fits.common_resolution {
        in_common(instruments.errors(0), procedure, results);
    }
    if let Some(refit) = fits.refit {
        below_range(refit, instruments, results);
    }
}

/// Combines the contributions of every result into its standard uncertainty.
pub(crate) fn combine(results: &mut [NamedResult]) {
    for result in results {
        // A result with only a fit keeps its standard error bit-identical.
        let calibrated = |part: &Contribution| {
            !matches!(part.source, Source::Fit { .. } | Source::FitEntry { .. })
        };
        if result.contributions.iter().any(calibrated)
            && let ResultValue::Number { uncertainty, .. } = &mut result.value
        {
            *uncertainty = combined(&result.contributions);
        }
    }
}

/// Divides the errors of a fit into the part that its scatter shows and the part that the resolution of the readings states.
fn split(parts: &mut Vec<Contribution>, procedure: ProcedureId, shown: f64) {
    if shown >= 1.0 {
        return;
    }
    let stated = (1.0 - shown * shown).sqrt();
    let mut by_resolution = Vec::new();
    for part in parts.iter_mut() {
        let (result, entry) = match part.source {
            Source::Fit {
                procedure: own,
                result,
            } if own == procedure => (result, 0),
            Source::FitEntry {
                procedure: own,
                result,
                entry,
            } if own == procedure => (result, entry),
            _ => continue,
        };
        let source = Source::Rounding {
            procedure,
            result,
            entry,
        };
        by_resolution.push(Contribution {
            source,
            amount: stated * part.amount,
            ..*part
        });
        part.amount *= shown;
    }
    parts.extend(by_resolution);
    parts.retain(|part| part.amount != 0.0);
}

/// The error that all readings have in common from their resolution, q/√12. It affects the forces that a zero error shifts, but not
/// slopes and differences. A displacement error e is equivalent to a force error −K·e.
fn in_common(errors: ReadingErrors, procedure: ProcedureId, results: &mut [NamedResult]) {
    let found = NamedResult::of(results, ramp::STIFFNESS.name);
    let Some(stiffness) = found.and_then(|result| result.value.number()) else {
        return;
    };
    let [force, displacement] = errors.quantization();
    let amount = force.hypot(stiffness * displacement);
    let source = Source::CommonRounding { procedure };
    for result in results
        .iter_mut()
        .filter(|result| amount > 0.0 && SHIFTED.contains(&result.name))
    {
        let entries = result.value.values().len();
        let part = |entry| Contribution {
            entry,
            ..Contribution::new(source, amount)
        };
        result.contributions.extend((0..entries).map(part));
    }
}

/// The readings below the lower end of a calibrated range: half the difference between the fits to readings with either error. A result
/// that one of these fits does not have has its uncertainty withheld.
fn below_range(refit: Refit<'_>, instruments: &InstrumentUncertainty, results: &mut [NamedResult]) {
    for source in instruments
        .sources()
        .filter(|source| source.is_below_range())
    {
        let [nominal, up, down] =
            [0.0, 1.0, -1.0].map(|by| refit(&instruments.perturbed(&[(source, by)], None)));
        for NamedResult { name, value, .. } in &nominal {
            let count = value.values().len();
            let Some(result) = results
                .iter_mut()
                .find(|result| result.name == *name && !result.contributions.is_empty())
            else {
                continue;
            };
            let layout = [(*name, count)];
            let [up, down] = [&up, &down].map(|moved| values(&layout, moved));
            let amounts: Vec<f64> = up
                .iter()
                .zip(&down)
                .map(|(up, down)| 0.5 * (up - down))
                .collect();
            if amounts.iter().any(|amount| amount.is_nan()) {
                result.withhold(VANISHES);
                continue;
            }
            let parts = amounts
                .into_iter()
                .enumerate()
                .filter(|(_, amount)| *amount != 0.0);
            result
                .contributions
                .extend(parts.map(|(entry, amount)| Contribution {
                    entry,
                    ..Contribution::new(source, amount)
                }));
        }
    }
}

/// The standard error `own`: the part of an intercept that correlates with the slope of its line is a contribution of the slope.
fn own_parts(
    procedure: ProcedureId,
    name: &'static str,
    own: f64,
    correlation: Option<f64>,
) -> Vec<Contribution> {
    let part = |result, amount| Contribution::new(Source::Fit { procedure, result }, amount);
    match (
        LINES.iter().find(|(_, intercept)| intercept.name == name),
        correlation,
    ) {
        (Some((slope, _)), Some(r)) => vec![
            part(slope.name, r * own),
            part(name, (1.0 - r * r).max(0.0).sqrt() * own),
        ],
        _ => vec![part(name, own)],
    }
}

/// The independent contributions to the errors of a bilinear fit.
fn shares_of(
    procedure: ProcedureId,
    name: &'static str,
    own: f64,
    fit: &BilinearFit,
) -> Vec<Contribution> {
    let part = |result, amount| Contribution::new(Source::Fit { procedure, result }, amount);
    let shares = BILINEAR
        .iter()
        .find(|(kind, _)| kind.name == name)
        .map(|(_, read)| read(&fit.shares))
        .filter(|shares| shares.iter().any(|share| *share != 0.0));
    match shares {
        Some(shares) => INDEPENDENT
            .iter()
            .zip(shares)
            .filter(|(_, share)| *share != 0.0)
            .map(|(kind, share)| part(kind.name, share))
            .collect(),
        None => vec![part(name, own)],
    }
}

/// The independent contributions to the errors of a curve: K₁, the intercept, the further stiffnesses, the breakpoints.
fn parts_of_curve(
    procedure: ProcedureId,
    fit: &MultilinearFit,
    shares: &[f64],
) -> Vec<Contribution> {
    let of_list = |result, entry| Source::FitEntry {
        procedure,
        result,
        entry,
    };
    let further =
        (1..fit.stiffnesses.len()).map(|entry| of_list(curves::CURVE_STIFFNESSES.name, entry));
    let breaks = (0..fit.breakpoints.len()).map(|entry| of_list(curves::BREAKS.name, entry));
    let first = [
        of_list(curves::CURVE_STIFFNESSES.name, 0),
        Source::Fit {
            procedure,
            result: ramp::INTERCEPT_FORCE.name,
        },
    ];
    let parts = first.into_iter().chain(further).chain(breaks).zip(shares);
    parts
        .filter(|(_, share)| **share != 0.0)
        .map(|(source, share)| Contribution::new(source, *share))
        .collect()
}

/// The independent contributions to the error of one result of a multilinear fit.
fn shares_of_curve(
    procedure: ProcedureId,
    name: &'static str,
    own: f64,
    fit: &MultilinearFit,
) -> Vec<Contribution> {
    let MultilinearFit { shares, .. } = fit;
    let softens = fit
        .stiffnesses
        .windows(2)
        .position(|pair| pair[1].0 < pair[0].0);
    let share = match name {
        _ if name == ramp::STIFFNESS.name => shares.stiffnesses.first(),
        _ if name == ramp::INTERCEPT_FORCE.name => Some(&shares.intercept),
        _ if name == ramp::YIELD_DISPLACEMENT.name => {
            softens.and_then(|knee| shares.breakpoints.get(knee))
        }
        _ if name == ramp::YIELD_FORCE.name => softens.and_then(|knee| shares.forces.get(knee)),
        _ if name == ramp::POST_YIELD_STIFFNESS.name => shares.stiffnesses.last(),
        _ if name == ramp::POST_YIELD_RATIO.name => Some(&shares.post_yield_ratio),
        _ => None,
    };
    let parts = share.map_or_else(Vec::new, |share| parts_of_curve(procedure, fit, share));
    if parts.is_empty() {
        vec![Contribution::new(
            Source::Fit {
                procedure,
                result: name,
            },
            own,
        )]
    } else {
        parts
    }
}

/// The same for every entry of the lists of a curve.
fn of_lists(
    procedure: ProcedureId,
    fit: &MultilinearFit,
    calibration: &Calibration,
    results: &mut [NamedResult],
) {
    let CurveShares {
        stiffnesses,
        breakpoints,
        forces,
        ..
    } = &fit.shares;
    for (kind, shares) in [
        (curves::CURVE_STIFFNESSES, stiffnesses),
        (curves::BREAKS, breakpoints),
        (curves::BREAK_FORCES, forces),
    ] {
        let Some(result) = results.iter_mut().find(|result| result.name == kind.name) else {
            continue;
        };
        let ResultValue::List(values) = &result.value else {
            continue;
        };
        let of_entry = |(entry, (value, share)): (usize, (&f64, &Vec<f64>))| {
            let parts = parts_of_curve(procedure, fit, share)
                .into_iter()
                .chain(of_calibration(result, *value, calibration));
            parts
                .map(|part| Contribution { entry, ..part })
                .collect::<Vec<Contribution>>()
        };
        result.contributions = values
            .iter()
            .zip(shares)
            .enumerate()
            .flat_map(of_entry)
            .collect();
    }
}

/// A result that is calculated from forces F, displacements X and times alone, as F^p·X^q, is proportional to the factor of the load cell
/// to the power p and that of the transducer to the power q. p is the exponent of mass in its dimension, q that of length minus p.
fn of_calibration(
    result: &NamedResult,
    value: f64,
    calibration: &Calibration,
) -> Vec<Contribution> {
    let Dimension { mass, length, .. } = result.dimension;
    let (force, displacement) = (mass.as_f64(), length.as_f64() - mass.as_f64());
    let zero = if SHIFTED.contains(&result.name) {
        calibration.zero()
    } else {
        0.0
    };
    let parts = [
        (
            Source::ForceScale(0),
            value * force * calibration.force_uncertainty,
        ),
        (
            Source::DisplacementScale(0),
            value * displacement * calibration.displacement_uncertainty,
        ),
        (Source::ForceZero(0), zero),
    ];
    parts
        .into_iter()
        .filter(|(_, amount)| *amount != 0.0)
        .map(|(source, amount)| Contribution::new(source, amount))
        .collect()
}
