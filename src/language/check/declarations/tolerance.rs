//! A tolerance beside a number: absolute, or in percent of it. In: an expression of the plan. Out: the tolerance, in SI.

use crate::check::checker::{Checker, Context, Reads};
use crate::codes::E401;
use crate::syntax::ast::Expr;
use psd_plan::Tolerance;
use psd_text::diagnostic::Violation;
use psd_text::source::Span;
use psd_text::units::Dimension;

const CONSTANT: Context = Context {
    entry: None,
    reads: Reads::Nothing("a tolerance"),
    critical: false,
};

#[derive(Violation)]
#[violation(E401, "a tolerance must be at least 0")]
#[help("write its absolute value")]
struct NegativeAcceptance<'a> {
    #[label("`{text}` is negative")]
    span: Span,
    text: &'a str,
}

/// `1 us` is absolute, `0.1 %` is relative to the absolute value of the number.
pub fn tolerance<'a>(
    checker: &mut Checker<'a>,
    field: &str,
    written: &'a Expr,
    dimension: Dimension,
) -> Option<Tolerance> {
    let typed = checker.single(written, CONSTANT)?;
    let relative = typed.percent
        || (typed.dimension == Dimension::NUMBER && dimension != Dimension::NUMBER && !typed.bare);
    let typed = if relative {
        typed
    } else {
        checker.expect(typed, dimension, field, written)?
    };
    let value = typed.constant()?;
    if value < 0.0 {
        return checker.fail(NegativeAcceptance {
            span: written.span,
            text: checker.text(written.span),
        });
    }
    Some(if relative {
        Tolerance::Relative(value)
    } else {
        Tolerance::Absolute(value)
    })
}
