//! The ends of the inputs of studies: the plan must be valid there too. In: distributions with limits, columns of files, the values of an
//! intensity. Out: values to be bound once the plan has no error.

use crate::check::checker::{Checker, End};
use psd_physics::study::distribution::Tails;
use psd_text::source::Span;
use psd_text::units::Quantity;

use super::target::Target;
use super::varied::{Law, Varied};

/// The help for a distribution that reaches an invalid value.
const INSIDE: &str = "write limits inside the valid range: `uniform(a .. b)`, or `between: a .. b` of another distribution";

/// Notes the smallest and the largest value of every input that has both.
pub(super) fn note(checker: &mut Checker, varied: &[Varied]) {
    for one in varied {
        let ends = match &one.law {
            Law::Distribution(_, Some(reach)) => Some([reach.low, reach.high]),
            Law::Distribution(distribution, None) => {
                let ends = [-RARE, RARE].map(|score| distribution.quantile(Tails::of_score(score)));
                note_tails(checker, &one.target, ends, one.span);
                None
            }
            Law::Measured(_) => None,
            Law::Column { values, .. } if one.target.is_record() => {
                // Every record is read once.
                for value in values {
                    note_ends(checker, &one.target, [*value; 2], one.span, INSIDE);
                }
                None
            }
            Law::Column { values, .. } => {
                let least = values.iter().copied().fold(f64::INFINITY, f64::min);
                let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                Some([least, most])
            }
        };
        if let Some(ends) = ends {
            note_ends(checker, &one.target, ends, one.span, INSIDE);
        }
    }
}

/// The standard normal number that one draw in 1000 exceeds.
const RARE: f64 = 3.090;

/// Notes two values of an input beyond which one draw in 1000 is.
fn note_tails(checker: &mut Checker, target: &Target, ends: [f64; 2], span: Span) {
    checker.tails.extend(ends.iter().map(|value| End {
        name: target.name.clone(),
        value: Quantity::new(*value, target.dimension),
        span,
        help: INSIDE,
    }));
}

/// Notes two values of an input; `help` for a plan that is invalid there.
pub(super) fn note_ends(
    checker: &mut Checker,
    target: &Target,
    ends: [f64; 2],
    span: Span,
    help: &'static str,
) {
    let ends = if ends[0].to_bits() == ends[1].to_bits() {
        &ends[..1]
    } else {
        &ends[..]
    };
    checker.ends.extend(ends.iter().map(|value| End {
        name: target.name.clone(),
        value: Quantity::new(*value, target.dimension),
        span,
        help,
    }));
}
