//! The uncertainty of the results of a damping sweep. In: the fit of its strokes, the stiffness that corrected them. Out: the
//! contributions to the damping, the friction and the damping ratio.

use crate::procedures::common::fit_uncertainty::{Fits, attribute};
use crate::run::inputs::Inputs;
use psd_plan::formula::Formula;
use psd_plan::procedures::damping_sweep::block as schema;
use psd_plan::record::{BroughtTogether, DampingSweepHistory, NamedResult};
use psd_plan::uncertainty::{Contribution, InstrumentUncertainty, Source, share};
use psd_plan::{DampingSweep, DeclaredNoise, Plan};

/// Gives the results their contributions.
pub(crate) fn propagate(
    sweep: &DampingSweep,
    found: &DampingSweepHistory,
    plan: &Plan,
    inputs: &Inputs<'_>,
    declared: DeclaredNoise,
    results: &mut [NamedResult],
) {
    let shown = found.fit.map_or(1.0, |fit| fit.shown);
    let fits = Fits {
        refit: None,
        line: found.fit,
        bilinear: None,
        curve: None,
        shown: &|_| shown,
        common_resolution: false,
    };
    let instruments = InstrumentUncertainty::of(plan, declared, 1);
    attribute(&fits, plan, inputs.procedure(), &instruments, results);
    of_stroke_stiffness(&found.together, &sweep.stiffness, inputs, results);
    let specimen = plan.specimens.get(sweep.specimen);
    let uncertain = specimen.map_or(0.0, |specimen| specimen.mass_uncertainty / specimen.mass);
    damping_ratio(
        results,
        &sweep.stiffness,
        found.own_stiffness,
        (Source::SpecimenMass(sweep.specimen), uncertain),
        inputs,
    );
}

/// Effect on the line of the stiffness that corrects the pairs to one position: that of the strokes, otherwise that of the plan.
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
    for (name, effect) in [schema::DAMPING.name, schema::COULOMB_FORCE.name]
        .into_iter()
        .zip(together.effects)
    {
        let Some(result) = results.iter_mut().find(|result| result.name == name) else {
            continue;
        };
        if result.value.number().is_some() {
            let parts = in_stiffness
                .iter()
                .map(|part| Contribution::new(part.source, effect * part.amount));
            parts
                .filter(|part| part.amount != 0.0)
                .for_each(|part| share(&mut result.contributions, part));
        }
    }
}

/// ζ = c/(2√(KM)), to first order: contributions to c times ζ/c, to K times −ζ/(2K), to M times −ζ/(2M). `mass` gives the sources of the
/// mass with its relative uncertainty.
fn damping_ratio(
    results: &mut [NamedResult],
    stiffness: &Formula,
    own: Option<(f64, f64)>,
    mass: (Source, f64),
    inputs: &Inputs<'_>,
) {
    let number = |name: &str| NamedResult::of(results, name)?.value.number();
    let (Some(ratio), Some(damping)) = (
        number(schema::DAMPING_RATIO.name),
        number(schema::DAMPING.name),
    ) else {
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
    let of_damping = NamedResult::of(results, schema::DAMPING.name);
    let mut parts = of_damping.map_or_else(Vec::new, |found| found.contributions.clone());
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
        .find(|result| result.name == schema::DAMPING_RATIO.name)
        && parts.iter().all(|part| part.amount.is_finite())
    {
        result.contributions = parts;
    }
}
