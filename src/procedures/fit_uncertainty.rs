//! What the uncertainty of an identified result is made of: the scatter of its own fit, and the calibration of the rig. In:
//! the results of a ramp or a sweep with the standard errors of their fits. Out: the same with their contributions, so that
//! what follows from them knows what they share.

use crate::physics::identification::bilinear_fit::SHARED;
use crate::physics::identification::multilinear_fit::{CurveShares, MultilinearFit};
use crate::physics::reintegration::perturbation::ReadingErrors;
use crate::plan::formula::{Formula, ProcedureId, ResultValue};
use crate::plan::{Calibration, Plan, ProcedureKind};
use crate::record::{BilinearFit, BroughtTogether, History, NamedResult};
use crate::rig::DeclaredNoise;
use crate::run::inputs::Inputs;
use crate::uncertainty::{Contribution, InstrumentUncertainty, Source, combined, share};
use crate::units::Dimension;

/// Results of a fit that lie on one line, slope first.
const LINES: [(&str, &str); 2] = [
    ("stiffness", "intercept_force"),
    ("damping", "coulomb_force"),
];

/// Forces that a false zero of the load cell shifts; slopes and differences do not show it.
const SHIFTED: [&str; 3] = ["intercept_force", "yield_force", "break_forces"];

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

/// Says of every identified result what its uncertainty is made of.
pub(crate) fn attribute(
    kind: &ProcedureKind,
    history: &History,
    plan: &Plan,
    (inputs, declared): (&Inputs<'_>, DeclaredNoise),
    results: &mut [NamedResult],
) {
    let calibration = &plan.rig.calibration_of(0);
    let instruments = InstrumentUncertainty::of(plan, declared, 1);
    let (line, bilinear, curve) = match history {
        History::Ramp(ramp) => (
            ramp.fit,
            ramp.bilinear.as_ref(),
            ramp.multilinear.as_deref(),
        ),
        History::Sweep(sweep) => (sweep.fit, None, None),
        // What is fitted to the backbone; its loops know already.
        History::Cycle(cycle) => (None, None, cycle.backbone.as_ref()),
        _ => return,
    };
    let procedure = inputs.procedure();
    for result in results
        .iter_mut()
        .filter(|result| result.contributions.is_empty())
    {
        if let ResultValue::Number {
            value: Some(value),
            uncertainty: Some(own),
        } = result.value
        {
            result.contributions = match (bilinear, curve) {
                (Some(fit), _) => shares_of(procedure, result.name, own, fit),
                (None, Some(fit)) => shares_of_curve(procedure, result.name, own, fit),
                (None, None) => own_parts(
                    procedure,
                    result.name,
                    own,
                    line.map(|line| line.correlation),
                ),
            };
            result
                .contributions
                .extend(of_calibration(result, value, calibration));
        }
    }
    if let Some(fit) = curve {
        of_lists(procedure, fit, calibration, results);
    }
    for result in results.iter_mut() {
        split(
            &mut result.contributions,
            procedure,
            shown(history, result.name),
        );
    }
    if let History::Ramp(_) | History::Cycle(_) = history {
        in_common(instruments.errors(0), procedure, results);
    }
    if let (ProcedureKind::DampingSweep(sweep), History::Sweep(found)) = (kind, history) {
        of_stroke_stiffness(&found.together, &sweep.stiffness, inputs, results);
        let specimen = plan.specimens.get(sweep.specimen);
        let uncertain = specimen.map_or(0.0, |specimen| specimen.mass_uncertainty / specimen.mass);
        damping_ratio(
            results,
            (&sweep.stiffness, found.own_stiffness),
            (Source::SpecimenMass(sweep.specimen), uncertain),
            inputs,
        );
    }
    for result in results.iter_mut() {
        // A fit alone keeps its standard error as it is, to the bit.
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

/// Fraction of the standard errors of a fitted result that its scatter shows.
fn shown(history: &History, name: &str) -> f64 {
    match history {
        History::Ramp(ramp) => {
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
        History::Sweep(sweep) => sweep.fit.map_or(1.0, |fit| fit.shown),
        History::Cycle(cycle) => cycle.backbone.as_ref().map_or(1.0, |fit| fit.shown),
        _ => 1.0,
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

/// The error that all readings have in common by their resolution, q/√12: forces that a false zero shifts have it, slopes and
/// differences do not. A displacement that is off by e is a force that is off by −K·e.
fn in_common(errors: ReadingErrors, procedure: ProcedureId, results: &mut [NamedResult]) {
    let stiffness = match results
        .iter()
        .find(|result| result.name == "stiffness")
        .map(|result| &result.value)
    {
        Some(ResultValue::Number {
            value: Some(stiffness),
            ..
        }) => *stiffness,
        _ => return,
    };
    let [force, displacement] = errors.quantization();
    let amount = force.hypot(stiffness * displacement);
    let source = Source::CommonRounding { procedure };
    for result in results
        .iter_mut()
        .filter(|result| amount > 0.0 && SHIFTED.contains(&result.name))
    {
        let entries = match &result.value {
            ResultValue::Number { value: Some(_), .. } => 1,
            ResultValue::Number { value: None, .. } => 0,
            ResultValue::List(values) => values.len(),
        };
        let part = |entry| Contribution {
            entry,
            ..Contribution::new(source, amount)
        };
        result.contributions.extend((0..entries).map(part));
    }
}

/// The standard error `own`, of which the intercept of a line shares with the slope what they are correlated by.
fn own_parts(
    procedure: ProcedureId,
    name: &'static str,
    own: f64,
    correlation: Option<f64>,
) -> Vec<Contribution> {
    let part = |result, amount| Contribution::new(Source::Fit { procedure, result }, amount);
    match (
        LINES.iter().find(|(_, intercept)| *intercept == name),
        correlation,
    ) {
        (Some((slope, _)), Some(r)) => vec![
            part(slope, r * own),
            part(name, (1.0 - r * r).max(0.0).sqrt() * own),
        ],
        _ => vec![part(name, own)],
    }
}

/// The errors of a bilinear fit by what they share.
fn shares_of(
    procedure: ProcedureId,
    name: &'static str,
    own: f64,
    fit: &BilinearFit,
) -> Vec<Contribution> {
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

/// The independent errors of a curve by what they are of: K₁, the intercept, the further stiffnesses, the breaks.
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
    let further = (1..fit.stiffnesses.len()).map(|entry| of_list("curve_stiffnesses", entry));
    let breaks = (0..fit.breakpoints.len()).map(|entry| of_list("breaks", entry));
    let first = [
        of_list("curve_stiffnesses", 0),
        Source::Fit {
            procedure,
            result: "intercept_force",
        },
    ];
    let parts = first.into_iter().chain(further).chain(breaks).zip(shares);
    parts
        .filter(|(_, share)| **share != 0.0)
        .map(|(source, share)| Contribution::new(source, *share))
        .collect()
}

/// The errors of a multilinear fit by what they share.
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
        "stiffness" => shares.stiffnesses.first(),
        "intercept_force" => Some(&shares.intercept),
        "yield_displacement" => softens.and_then(|knee| shares.breakpoints.get(knee)),
        "yield_force" => softens.and_then(|knee| shares.forces.get(knee)),
        "hardened_stiffness" => shares.stiffnesses.last(),
        "hardening" => Some(&shares.post_yield_ratio),
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

/// The same of every entry of the lists of a curve.
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
    for (name, shares) in [
        ("curve_stiffnesses", stiffnesses),
        ("breaks", breakpoints),
        ("break_forces", forces),
    ] {
        let Some(result) = results.iter_mut().find(|result| result.name == name) else {
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

/// A result that is made of forces F, displacements X and times alone, as F^p·X^q, grows with the factor of the load cell
/// to the p and that of the transducer to the q: p is the exponent of mass in its dimension, q that of length less p.
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

/// What the stiffness that brought the pairs of a sweep to one place makes of its line: that of the strokes, else that of the plan.
fn of_stroke_stiffness(
    together: &BroughtTogether,
    planned: &Formula,
    inputs: &Inputs<'_>,
    results: &mut [NamedResult],
) {
    let of_strokes = |error| {
        vec![Contribution::new(
            Source::StrokeStiffness {
                procedure: inputs.procedure(),
            },
            error,
        )]
    };
    let of_plan = || {
        planned
            .contributions(inputs.results(), None)
            .unwrap_or_default()
    };
    let in_stiffness = together.error.map_or_else(of_plan, of_strokes);
    for (name, effect) in ["damping", "coulomb_force"]
        .into_iter()
        .zip(together.effects)
    {
        let Some(result) = results.iter_mut().find(|result| result.name == name) else {
            continue;
        };
        if matches!(result.value, ResultValue::Number { value: Some(_), .. }) {
            let parts = in_stiffness
                .iter()
                .map(|part| Contribution::new(part.source, effect * part.amount));
            parts
                .filter(|part| part.amount != 0.0)
                .for_each(|part| share(&mut result.contributions, part));
        }
    }
}

/// ζ = c/(2√(KM)): by first order, ζ/c of what is in c, −ζ/(2K) of what is in K and −ζ/(2M) of what is in M; `mass` is what
/// the mass hangs on and its relative uncertainty.
fn damping_ratio(
    results: &mut [NamedResult],
    (stiffness, own): (&Formula, Option<(f64, f64)>),
    mass: (Source, f64),
    inputs: &Inputs<'_>,
) {
    let number = |name: &str| match results.iter().find(|result| result.name == name)?.value {
        ResultValue::Number { value, .. } => value,
        ResultValue::List(_) => None,
    };
    let (Some(ratio), Some(damping)) = (number("damping_ratio"), number("damping")) else {
        return;
    };
    let (known, in_stiffness) = if let Some((stiffness, error)) = own {
        (
            stiffness,
            vec![Contribution::new(
                Source::StrokeStiffness {
                    procedure: inputs.procedure(),
                },
                error,
            )],
        )
    } else {
        let found = (
            stiffness.evaluate(inputs.results(), None),
            stiffness.contributions(inputs.results(), None),
        );
        let (Ok(known), Ok(in_stiffness)) = found else {
            return;
        };
        (known.value, in_stiffness)
    };
    let of_damping = results
        .iter()
        .find(|result| result.name == "damping")
        .map(|found| found.contributions.clone());
    let mut parts: Vec<Contribution> = of_damping.unwrap_or_default();
    for part in &mut parts {
        part.amount *= ratio / damping;
    }
    for part in in_stiffness {
        share(
            &mut parts,
            Contribution::new(part.source, -0.5 * ratio / known * part.amount),
        );
    }
    if mass.1 > 0.0 {
        share(&mut parts, Contribution::new(mass.0, -0.5 * ratio * mass.1));
    }
    if let Some(result) = results
        .iter_mut()
        .find(|result| result.name == "damping_ratio")
        && parts.iter().all(|part| part.amount.is_finite())
    {
        result.contributions = parts;
    }
}
