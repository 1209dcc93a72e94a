//! The results of one evaluation of a procedure in a fixed order, and the contributions to each. A number that is not finite does not
//! exist in the run.

use psd_plan::formula::ResultValue;
use psd_plan::record::NamedResult;
use psd_plan::schema::ResultKind;
use psd_plan::uncertainty::{Contribution, Source, combined};

/// The largest of some sizes; None of nothing.
pub(crate) fn largest(values: impl Iterator<Item = f64>) -> Option<f64> {
    values.map(f64::abs).reduce(f64::max)
}

/// Contributions that count; of a result that nothing moves, not even the time step, that of the step, because its uncertainty is
/// known to be none.
fn counting(mut parts: Vec<Contribution>) -> Vec<Contribution> {
    let moves = parts.iter().any(|part| part.amount != 0.0);
    parts.retain(|part| {
        if moves {
            part.amount != 0.0
        } else {
            matches!(part.source, Source::TimeStep(_))
        }
    });
    parts
}

/// The results of one evaluation, each with its values: one number, or one for each entry of a list.
pub(crate) type Evaluated = Vec<(ResultKind, Vec<f64>)>;

/// The layout of these results.
pub(crate) fn layout_of(evaluated: &Evaluated) -> Layout {
    evaluated
        .iter()
        .map(|(kind, values)| (kind.name, values.len()))
        .collect()
}

/// Their values after each other.
pub(crate) fn flat(evaluated: Evaluated) -> Vec<f64> {
    evaluated
        .into_iter()
        .flat_map(|(_, values)| values)
        .collect()
}

/// The position of the first value of a result in a layout.
pub(crate) fn index_of(layout: &[(&'static str, usize)], kind: ResultKind) -> Option<usize> {
    let at = layout.iter().position(|(name, _)| *name == kind.name)?;
    Some(layout[..at].iter().map(|(_, count)| count).sum())
}

/// Names of results in the order of their values, each with how many values it has.
pub(crate) type Layout = Vec<(&'static str, usize)>;

/// The values of a layout, as results have them; NaN if one does not exist.
pub(crate) fn values(layout: &[(&'static str, usize)], results: &[NamedResult]) -> Vec<f64> {
    let of_result = |(name, count): &(&'static str, usize)| {
        let found = NamedResult::of(results, name);
        let values = found.map_or(&[][..], |result| result.value.values());
        values
            .iter()
            .copied()
            .chain(std::iter::repeat(f64::NAN))
            .take(*count)
            .collect::<Vec<f64>>()
    };
    layout.iter().flat_map(of_result).collect()
}

/// Why a result has no uncertainty although its contributions were evaluated: one of them is not finite.
pub(crate) const VANISHES: &str =
    "the run has no such result once its inputs or readings are moved by their uncertainty";

/// Gives results the contributions to their values. A result with one that is not finite has its uncertainty withheld.
pub(crate) fn give(
    layout: &[(&'static str, usize)],
    contributions: Vec<Vec<Contribution>>,
    results: &mut [NamedResult],
) {
    let mut contributions = contributions.into_iter();
    for (name, count) in layout {
        let of_result: Vec<Vec<Contribution>> = contributions.by_ref().take(*count).collect();
        let Some(result) = results.iter_mut().find(|result| result.name == *name) else {
            continue;
        };
        let finite = |part: &Contribution| part.amount.is_finite();
        if !of_result.iter().flatten().all(finite) {
            result.withhold(VANISHES);
            continue;
        }
        let parts = of_result.into_iter().map(counting).enumerate();
        result.contributions = parts
            .flat_map(|(entry, parts)| {
                parts
                    .into_iter()
                    .map(move |part| Contribution { entry, ..part })
            })
            .collect();
        if let ResultValue::Number {
            value: Some(_),
            uncertainty,
        } = &mut result.value
        {
            *uncertainty = combined(&result.contributions);
        }
    }
}
