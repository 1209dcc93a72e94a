//! `fragility NAME { … }`: the probability of an exceedance by the intensity. In: the block. Out: a [`Fragility`].

use crate::check::checker::{Checker, Context, Reads};
use crate::check::violations::{ReadsNoResult, VariesNothing};
use crate::codes::{E304, E402};
use crate::syntax::ast::{Expr, ExprKind};
use psd_plan::Condition;
use psd_plan::schema::study as schema;
use psd_plan::study::Fragility;
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

use super::target::{self, Target};
use super::{confidence, ends, inputs, known, reads_a_result, whole};

pub(super) fn fragility(checker: &mut Checker, block: usize) -> Option<Fragility> {
    let confidence = confidence(checker, block);
    let stepped = stepped(checker, block);
    let exceeds = exceeds(checker, block);
    let runs = whole(checker, block, schema::STRIPE_RUNS.name);
    let (varies, intensity) = (
        checker.field(block, schema::VARY_OTHERS.name).is_some(),
        stepped.as_ref().map(|(target, _)| target),
    );
    let variation = if varies {
        inputs::variation(checker, block, schema::VARY_OTHERS.name, intensity).map(Some)
    } else {
        Some(None)
    };
    let runs = runs?;
    if !varies && runs > 1 {
        let head = checker.scope.blocks[block].block.head;
        return checker.fail(VariesNothing { head });
    }
    let (target, stripes) = stepped?;
    Some(Fragility {
        name: checker.scope.blocks[block].name?.node.clone(),
        intensity: target.input(String::new()),
        stripes,
        exceeds: exceeds?,
        variation: variation?,
        runs,
        confidence: confidence?,
    })
}

#[derive(Violation)]
#[violation(E304, "`{text}` gives no values of an intensity")]
#[help("write it as in `intensity = impact_speed in 0.5 .. 1.5 step 0.1 m/s`")]
struct IntensityWanted<'a> {
    text: &'a str,
    #[label("not `INPUT in VALUES`")]
    span: Span,
}

/// A range that falls. `rising`: the same values in increasing order.
#[derive(Violation)]
#[violation(E402, "the values of an intensity must increase from above 0")]
#[help("write `{rising}`")]
struct StripesFall<'a> {
    rising: &'a str,
    #[label("decreases")]
    span: Span,
}

#[derive(Violation)]
#[violation(E402, "the values of an intensity must increase from above 0")]
#[help("write each value once, in increasing order, all above 0")]
struct StripesDoNotRise<'a> {
    text: &'a str,
    #[label("`{text}` is not above the value before")]
    span: Span,
}

/// The help for an intensity that reaches an invalid value.
const ENDS: &str = "end the values of the intensity inside the valid range, or widen this range";

/// `impact_speed in 0.5 .. 1.5 step 0.1 m/s`: the input and its values.
fn stepped<'a>(checker: &mut Checker<'a>, block: usize) -> Option<(Target<'a>, Vec<f64>)> {
    let (entry, written) = checker.field(block, schema::INTENSITY.name)?;
    let context = checker.context_of(block, entry);
    let (input, values): (&'a Expr, &'a Expr) = match &written.value.kind {
        ExprKind::Stepped { input, values } => (input, values),
        ExprKind::Faulty => return None,
        _ => {
            let span = written.value.span;
            return checker.fail(IntensityWanted {
                text: checker.text(span),
                span,
            });
        }
    };
    let target = target::target(checker, input);
    if let Some(rising) = rising(checker, values, context) {
        return checker.fail(StripesFall {
            rising: &rising,
            span: values.span,
        });
    }
    let typed = checker.value(values, context);
    let (target, typed) = (target?, typed?);
    let typed = checker.expect(typed, target.dimension, &target.name, values)?;
    let mut stripes: Vec<f64> = Vec::new();
    for (at, part) in typed.parts().iter().enumerate() {
        let span = match &values.kind {
            ExprKind::List { items, .. } if items.len() == typed.parts().len() => items[at].span,
            _ => values.span,
        };
        let value = known(checker, part.constant(), span)?;
        if value <= stripes.last().copied().unwrap_or(0.0) {
            return checker.fail(StripesDoNotRise {
                text: checker.text(span),
                span,
            });
        }
        stripes.push(value);
    }
    if let (Some(first), Some(last)) = (stripes.first(), stripes.last()) {
        let (ends, span) = ([*first, *last], written.value.span);
        ends::note_ends(checker, &target, ends, span, ENDS);
    }
    Some((target, stripes))
}

/// `0.4 .. 1.2 step 0.1 m/s` for `1.2 .. 0.4 step 0.1 m/s`. None for any other values.
fn rising<'a>(checker: &mut Checker<'a>, values: &'a Expr, context: Context) -> Option<String> {
    let ExprKind::Range {
        start,
        end,
        step: Some(step),
    } = &values.kind
    else {
        return None;
    };
    // Its errors are those of the values.
    let before = checker.diagnostics.len();
    let parts = checker.range_parts(values, None, context);
    checker.diagnostics.truncate(before);
    let parts = parts?;
    if parts.start.constant()? <= parts.end.constant()? {
        return None;
    }
    let [start, end, step] = [start, end, step].map(|part| checker.text(part.span));
    let step = step.trim_start_matches(['-', ' ']);
    Some(format!("{end} .. {start} step {step}"))
}

#[derive(Violation)]
#[violation(E304, "an exceedance is one condition, without `and`")]
#[help("write one `fragility` for each, or one condition of `max(a, b)`")]
struct OneExceedance {
    #[label("several conditions")]
    span: Span,
}

/// The one condition, which reads a result.
fn exceeds(checker: &mut Checker, block: usize) -> Option<Condition> {
    let (entry, written) = checker.field(block, schema::EXCEEDS.name)?;
    let context = Context {
        entry: Some((block, entry)),
        reads: Reads::All,
        critical: false,
    };
    let conditions = checker.conditions_at(&written.value, context)?;
    let span = written.value.span;
    let Ok([condition]) = <[Condition; 1]>::try_from(conditions) else {
        return checker.fail(OneExceedance { span });
    };
    if !condition.formulas().any(reads_a_result) && checker.results.is_empty() {
        return checker.fail(ReadsNoResult {
            text: checker.text(span),
            example: "hit.max_displacement > 50 mm",
            span,
        });
    }
    Some(condition)
}
