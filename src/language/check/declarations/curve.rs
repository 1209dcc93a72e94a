//! `fit = multilinear(…)`: how many breaks a curve has. In: the variant as it was written. Out: a [`BreakCount`].

use crate::language::check::checker::{Checker, Place};
use crate::language::check::expressions::choice::Chosen;
use crate::language::check::expressions::fields::whole;
use crate::language::check::messages::specimens as fault;
use crate::plan::BreakCount;

/// `breaks`, or else as many as the criterion chooses up to `most`.
pub fn breaks<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    place: Place,
) -> Option<BreakCount> {
    let breaks = checker.optional_argument(chosen, "breaks", place)?;
    let most = checker
        .constant_argument(chosen, "most", place)
        .and_then(whole)?;
    match (breaks, chosen.span("most"), chosen.span("breaks")) {
        (Some(_), Some(most), Some(breaks)) => {
            checker.fail(fault::breaks_counted_twice(breaks, most))
        }
        (Some(breaks), ..) => Some(BreakCount::Exactly(whole(breaks)? as usize)),
        (None, ..) => Some(BreakCount::ByCriterion {
            most: most as usize,
        }),
    }
}
