//! Arguments of a distribution that have the unit of the input. In: the option as written. Out: numbers and ranges in SI.

use crate::check::checker::{Checker, Context, Reads, Typed};
use crate::check::expressions::choice::Chosen;
use crate::check::violations::{AbsoluteTemperature, OutOfRange};
use crate::codes::E657;
use psd_plan::Interval;
use psd_plan::formula::Formula;
use psd_plan::schema::{Field, study as schema};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;
use psd_text::units::Dimension;

use super::known;

const CONTEXT: Context = Context {
    entry: None,
    reads: Reads::Nothing("a study"),
    critical: false,
};

/// `sd: 5 %` of a quantity.
#[derive(Violation)]
#[violation(E657, "`sd` has the unit of the input: a relative scatter is `cv`")]
#[help("write `cv: {text}`")]
struct RelativeDeviation<'a> {
    text: &'a str,
    #[label("relative")]
    span: Span,
}

/// An argument in the unit of the input: `Some(None)` if it is omitted, None if it has an error.
#[expect(
    clippy::option_option,
    reason = "left out and faulty are different things here"
)]
pub(super) fn number<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    field: Field,
    dimension: Dimension,
) -> Option<Option<f64>> {
    let Some((field, Some(written))) = chosen.find(field.name) else {
        return Some(None);
    };
    let typed = checker.single(written, CONTEXT)?;
    if typed.percent && dimension != Dimension::NUMBER && field.name == schema::SD.name {
        let text = checker.text(written.span);
        return checker.fail(RelativeDeviation {
            text,
            span: written.span,
        });
    }
    let typed = checker.expect(typed, dimension, field.name, written)?;
    if typed.absolute && field.name == schema::SD.name {
        return checker.fail(AbsoluteTemperature::of_deviation(written.span));
    }
    let value = known(checker, typed.constant(), written.span)?;
    if !field.range.contains(value) {
        return checker.fail(OutOfRange {
            field,
            dimension,
            value,
            text: checker.text(written.span),
            span: written.span,
        });
    }
    Some(Some(value))
}

/// A range in the unit of the input.
#[expect(
    clippy::option_option,
    reason = "left out and faulty are different things here"
)]
pub(super) fn range<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    field: Field,
    dimension: Dimension,
) -> Option<Option<Interval>> {
    let Some((field, Some(written))) = chosen.find(field.name) else {
        return Some(None);
    };
    let (interval, found) = checker.interval(written, CONTEXT)?;
    let typed = Typed {
        bare: found == Dimension::NUMBER && dimension != Dimension::NUMBER,
        ..Typed::number(Formula::Constant(interval.high), found, written.span)
    };
    checker.expect(typed, dimension, field.name, written)?;
    Some(Some(interval))
}
