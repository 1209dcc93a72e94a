//! `correlate = [rank(impact_speed, beam.mass, 0.6)]`: rank correlations of inputs. In: the list and the varied inputs. Out: pairs of
//! sources, with the span of each.

use super::target::path_of;
use super::varied::{Varied, source_of};
use crate::check::checker::Checker;
use crate::check::expressions::choice::Chosen;
use crate::check::messages::{inputs as names, studies as message};
use crate::syntax::ast::Expr;
use psd_physics::study::correlation::{CorrelationError, Pair};
use psd_plan::schema::study as schema;
use psd_text::source::{Span, Spanned};

/// The pairs of a block. None if one has an error.
pub(super) fn correlations(
    checker: &mut Checker,
    block: usize,
    varied: &[Varied],
) -> Option<Vec<Spanned<Pair>>> {
    if checker.field(block, schema::CORRELATE.name).is_none() {
        return Some(Vec::new());
    }
    let (entry, _) = checker.field(block, schema::CORRELATE.name)?;
    let context = checker.context_of(block, entry);
    let chosen = checker.choices(block, schema::CORRELATE.name)?;
    let pairs: Vec<Option<Spanned<Pair>>> = chosen
        .iter()
        .map(|chosen| {
            let first = input(checker, chosen, schema::FIRST.name, varied);
            let other = input(checker, chosen, schema::OTHER.name, varied);
            let correlation = checker.constant_argument(chosen, schema::CORRELATION.name, context);
            let ((first, from), (other, to)) = (first?, other?);
            let span = chosen.span(schema::CORRELATION.name).unwrap_or(to);
            if first == other {
                let name = &varied[first].target.name;
                return checker.fail(message::correlated_with_itself(name, from.to(to)));
            }
            let inputs = [first, other].map(|input| source_of(varied, input));
            let correlation = correlation?;
            let pair = Pair {
                inputs,
                correlation,
            };
            Some(Spanned::new(pair, span))
        })
        .collect();
    pairs.into_iter().collect()
}

/// An input of the study that an argument names, with the span of the name.
fn input<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    argument: &str,
    varied: &[Varied],
) -> Option<(usize, Span)> {
    let written: &'a Expr = chosen.find(argument)?.1?;
    let span = written.span;
    let Some(path) = path_of(written) else {
        return checker.fail(names::input_wanted(checker.text(span), span));
    };
    let name = path.join(".");
    let Some(at) = varied.iter().position(|one| one.target.name == name) else {
        let known: Vec<&str> = varied.iter().map(|one| one.target.name.as_str()).collect();
        return checker.fail(message::not_varied(&name, span, &known));
    };
    if varied[at].law.file().is_some() {
        return checker.fail(message::correlated_table(&name, span));
    }
    Some((at, span))
}

/// Reports correlations that cannot be.
pub(super) fn refused<T>(
    checker: &mut Checker,
    reason: CorrelationError,
    pairs: &[Spanned<Pair>],
    varied: &[Varied],
) -> Option<T> {
    let name = |source: usize| {
        let input = (0..varied.len()).find(|input| source_of(varied, *input) == source);
        input.map_or("", |input| varied[input].target.name.as_str())
    };
    let of_pair = |inputs: [usize; 2]| {
        let reversed = [inputs[1], inputs[0]];
        let same = |pair: &&Spanned<Pair>| [inputs, reversed].contains(&pair.node.inputs);
        pairs.iter().rfind(same).map(|pair| pair.span)
    };
    let whole = pairs.last()?.span;
    let diagnostic = match reason {
        CorrelationError::OutsideRange(value) => {
            let wrong = pairs.iter().find(|pair| pair.node.correlation == value);
            message::correlation_out_of_range(value, wrong.map_or(whole, |pair| pair.span))
        }
        CorrelationError::WithItself(input) => message::correlated_with_itself(name(input), whole),
        CorrelationError::NoSuchInput(_) => return None,
        CorrelationError::Twice(inputs) => {
            let span = of_pair(inputs).unwrap_or(whole);
            message::correlated_twice(name(inputs[0]), name(inputs[1]), span)
        }
        CorrelationError::Impossible { pair, range } => message::impossible_correlation(
            pair.inputs.map(name),
            pair.correlation,
            range,
            of_pair(pair.inputs).unwrap_or(whole),
        ),
    };
    checker.fail(diagnostic)
}
