//! The ends of the inputs of studies: the plan must be valid there too. In: distributions with limits, columns of files, the values of an
//! intensity. Out: values to be bound once the plan has no error.

use super::target::Target;
use super::varied::{Law, Varied};
use crate::language::check::checker::{Checker, End};
use crate::text::source::Span;
use crate::units::Quantity;

/// Notes the smallest and the largest value of every input that has both.
pub(super) fn note(checker: &mut Checker, varied: &[Varied]) {
    for one in varied {
        let ends = match &one.law {
            Law::Distribution(_, reach) => reach.map(|reach| [reach.low, reach.high]),
            Law::Measured(_) => None,
            Law::Column { values, .. } if one.target.is_record() => {
                // Every record is read once.
                for value in values {
                    note_ends(checker, &one.target, [*value; 2], one.span);
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
            note_ends(checker, &one.target, ends, one.span);
        }
    }
}

/// Notes two values of an input.
pub(super) fn note_ends(checker: &mut Checker, target: &Target, ends: [f64; 2], span: Span) {
    let ends = if ends[0].to_bits() == ends[1].to_bits() {
        &ends[..1]
    } else {
        &ends[..]
    };
    checker.ends.extend(ends.iter().map(|value| End {
        name: target.name.clone(),
        value: Quantity::new(*value, target.dimension),
        span,
    }));
}
