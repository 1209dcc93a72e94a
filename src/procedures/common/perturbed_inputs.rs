//! Inputs with some of their sources perturbed, for every procedure that is re-integrated. In: formulas, results, perturbed sources. Out:
//! the uncertain sources of the formulas, and results with those sources perturbed.

use crate::plan::formula::{Formula, Results};
use crate::run::stop::Stop;
use crate::uncertainty::engine::Shifts;
use crate::uncertainty::{Moved, Source, sources_of};

/// The reason why no uncertainty of a run is reported.
pub(crate) const LEADS_ELSEWHERE: &str =
    "re-integration along the recorded path does not reproduce the recorded results";

/// Calls with results that have sources perturbed.
pub(crate) fn with_shifts<T>(
    results: &dyn Results,
    shifts: Shifts<'_>,
    then: &mut dyn FnMut(&dyn Results) -> T,
) -> T {
    match shifts.split_first() {
        None => then(results),
        Some(((source, by), rest)) => with_shifts(
            &Moved {
                results,
                source: *source,
                by: *by,
            },
            rest,
            then,
        ),
    }
}

/// Sources of the results and statements that `formulas` read, followed by the `stated` ones with their uncertainties.
pub(crate) fn uncertain_inputs(
    formulas: &[&Formula],
    stated: impl Iterator<Item = (Source, f64)>,
    results: &dyn Results,
) -> Vec<Source> {
    let mut references = Vec::new();
    for formula in formulas {
        formula.collect_references(&mut references);
    }
    let mut sources = sources_of(&references, results);
    for formula in formulas {
        formula.collect_stated(&mut sources);
    }
    sources.extend(
        stated
            .filter(|(_, uncertainty)| *uncertainty > 0.0)
            .map(|(source, _)| source),
    );
    sources
}

pub(crate) fn out_of_bounds(stop: &Stop) -> String {
    format!("an input perturbed by its uncertainty is invalid: {stop}")
}
