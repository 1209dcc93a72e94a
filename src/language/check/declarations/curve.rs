//! `fit = multilinear(…)`: the number of breakpoints of a curve. In: the variant as written. Out: a [`BreakCount`].

use crate::check::checker::{Checker, Context};
use crate::check::expressions::choice::Chosen;
use crate::check::expressions::fields::whole;
use crate::codes::E649;
use psd_plan::BreakCount;
use psd_plan::schema::curves::{BREAK_COUNT, LARGEST_BREAK_COUNT};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

#[derive(Violation)]
#[violation(
    E649,
    "`breaks` states the number of breakpoints: `most` has no effect"
)]
#[help("remove `most`, or remove `breaks` for an automatic choice")]
struct BreaksCountedTwice {
    #[label("bounds an automatic choice")]
    most: Span,
    #[label("number stated here")]
    breaks: Span,
}

/// `breaks`, else the number up to `most` that the criterion chooses.
pub fn breaks<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
) -> Option<BreakCount> {
    let breaks = checker.optional_argument(chosen, BREAK_COUNT.name, context)?;
    let most = checker
        .constant_argument(chosen, LARGEST_BREAK_COUNT.name, context)
        .and_then(whole)?;
    match (
        breaks,
        chosen.span(LARGEST_BREAK_COUNT.name),
        chosen.span(BREAK_COUNT.name),
    ) {
        (Some(_), Some(most), Some(breaks)) => checker.fail(BreaksCountedTwice { most, breaks }),
        (Some(breaks), ..) => Some(BreakCount::Exactly(whole(breaks)? as usize)),
        (None, ..) => Some(BreakCount::ByCriterion {
            most: most as usize,
        }),
    }
}
