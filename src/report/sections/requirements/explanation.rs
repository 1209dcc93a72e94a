//! Why a requirement is not met or not decided: the distance of its value to the limit, and the input with the largest part of its
//! uncertainty. In: a condition. Out: lines of its row.

use super::super::results;
use super::super::results::budget_table::is_printed;
use super::super::results::read::read_by;
use super::{Scope, wording};
use crate::report::budget::budgets;
use crate::report::number;
use crate::report::run::Run;
use crate::verdict::{ConditionOutcome, Verdict};
use psd_plan::Condition;
use psd_plan::formula::ResultReference;
use psd_plan::record::Outcome;
use psd_plan::schema::block_of_words;

/// Whether the value of a complete run decides the condition to the disadvantage of the item, or is too near to its
/// limit, or too uncertain for its tolerance.
fn is_explained(run: &Run<'_>, condition: &ConditionOutcome) -> bool {
    let near = || {
        let known = condition.guard_band.zip(condition.margin);
        known.is_some_and(|(band, margin)| margin.abs() < band)
    };
    let too_large = || condition.conforms.is_some() && condition.wider_than_tolerance;
    run.record.outcome == Outcome::Completed
        && match condition.verdict {
            Verdict::Fail => true,
            Verdict::Inconclusive => near() || too_large(),
            _ => false,
        }
}

/// `outside the limit by 0.228 mm`
pub(super) fn distance(run: &Run<'_>, condition: &ConditionOutcome) -> Option<String> {
    let margin = condition.margin.filter(|margin| *margin != 0.0)?;
    let text = number::margin(condition)?;
    is_explained(run, condition).then(|| {
        if margin < 0.0 {
            wording::outside(text.trim_start_matches('−'))
        } else {
            wording::inside(text)
        }
    })
}

/// `an impact passes while max displacement < 15 mm`, for a condition that reads a result decided by it.
pub(super) fn criterion(run: &Run<'_>, planned: &Condition) -> Option<String> {
    let decided = |reference: &ResultReference| {
        let procedure = run.plan.procedures.get(reference.procedure.0);
        let words: Vec<&str> = procedure?.kind.keyword().split(' ').collect();
        let result = block_of_words(&words)?.result(reference.name)?;
        result.decided_by_condition.then_some(reference.procedure.0)
    };
    let index = read_by(planned)
        .iter()
        .find_map(|read| decided(&read.reference))?;
    results::criterion(run, index).map(wording::impact_passes_while)
}

/// `largest part of U: time step (56 % of u²)`; None for the scatter of a fit alone.
pub(super) fn largest_part(
    run: &Run<'_>,
    condition: &ConditionOutcome,
    planned: &Condition,
) -> Option<String> {
    if !is_explained(run, condition) || Scope::of(run) == Scope::PartialReal {
        return None;
    }
    let read = read_by(planned);
    let index = read.first()?.reference.procedure.0;
    let all = budgets(run, index, run.record.procedures.get(index)?);
    let budget = all.iter().find(|budget| is_printed(budget, &read[..1]))?;
    let line = budget.lines.first().filter(|line| !line.input.is_empty())?;
    // A colon precedes the method of evaluation.
    let input = line.input.split(':').next().unwrap_or_default();
    Some(wording::largest_part(input, 100.0 * budget.fraction(line)))
}
