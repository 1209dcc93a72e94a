//! `correlate = [rank(impact_speed, beam.mass, 0.6)]`: rank correlations of inputs. In: the list and the varied inputs. Out: pairs of
//! sources, with the span of each.

use crate::check::checker::Checker;
use crate::check::expressions::choice::Chosen;
use crate::check::violations::InputWanted;
use crate::check::wording::suggestion;
use crate::codes::{E203, E658};
use crate::syntax::ast::Expr;
use psd_physics::study::correlation::{CorrelationError, Pair};
use psd_plan::schema::study as schema;
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::{Span, Spanned};

use super::target::path_of;
use super::varied::{Varied, source_of};

#[derive(Violation)]
#[violation(E658, "`{name}` is correlated with itself")]
#[help("write two different inputs")]
struct CorrelatedWithItself<'a> {
    name: &'a str,
    #[label("no such correlation")]
    span: Span,
}

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
                return checker.fail(CorrelatedWithItself {
                    name,
                    span: from.to(to),
                });
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

/// `name`: an input that is not varied.
#[derive(Violation)]
#[violation(E203, "this study does not vary `{name}`")]
#[help("{}", suggestion(name, varied.iter().copied()))]
struct NotVaried<'a> {
    name: &'a str,
    #[label("not in `vary`")]
    span: Span,
    varied: &'a [&'a str],
}

#[derive(Violation)]
#[violation(E658, "`{name}` comes from a file, whose columns are drawn together")]
#[help("write both inputs as columns of one file, or as distributions")]
struct CorrelatedTable<'a> {
    name: &'a str,
    #[label("no such correlation")]
    span: Span,
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
        return checker.fail(InputWanted {
            text: checker.text(span),
            span,
        });
    };
    let name = path.join(".");
    let Some(at) = varied.iter().position(|one| one.target.name == name) else {
        let known: Vec<&str> = varied.iter().map(|one| one.target.name.as_str()).collect();
        return checker.fail(NotVaried {
            name: &name,
            span,
            varied: &known,
        });
    };
    if varied[at].law.file().is_some() {
        return checker.fail(CorrelatedTable { name: &name, span });
    }
    Some((at, span))
}

#[derive(Violation)]
#[violation(
    E658,
    "a rank correlation is between -1 and 1, both excluded, here {value}"
)]
#[help(
    "write a value such as `0.6`; for a fixed ratio, calculate one input from the other with `let`"
)]
struct CorrelationOutOfRange {
    value: f64,
    #[label("no such correlation")]
    span: Span,
}

#[derive(Violation)]
#[violation(E658, "the correlation of `{one}` and `{other}` is stated twice")]
#[help("remove one of them")]
struct CorrelatedTwice<'a> {
    one: &'a str,
    other: &'a str,
    #[label("no such correlation")]
    span: Span,
}

/// `range`: what the other correlations allow.
struct ImpossibleCorrelation<'a> {
    names: [&'a str; 2],
    value: f64,
    range: Option<[f64; 2]>,
    span: Span,
}

impl Violation for ImpossibleCorrelation<'_> {
    const CODE: Code = E658;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            names,
            value,
            range,
            span,
        } = self;
        let [one, other] = names;
        let help = range.map_or_else(
            || "write smaller correlations".to_owned(),
            |[low, high]| {
                // Rounded inwards, so that both ends are possible.
                let (low, high) = ((low * 100.0).ceil() / 100.0, (high * 100.0).floor() / 100.0);
                format!("write a value from {low} to {high}, or change the others")
            },
        );
        Diagnostic::new(
            Self::CODE,
            format!(
                "`{one}` and `{other}` cannot have the rank correlation {value} beside the others"
            ),
        )
        .at(span, "no such correlation")
        .help(&help)
    }
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
            CorrelationOutOfRange {
                value,
                span: wrong.map_or(whole, |pair| pair.span),
            }
            .diagnostic()
        }
        CorrelationError::WithItself(input) => CorrelatedWithItself {
            name: name(input),
            span: whole,
        }
        .diagnostic(),
        CorrelationError::NoSuchInput(_) => return None,
        CorrelationError::Twice(inputs) => {
            let span = of_pair(inputs).unwrap_or(whole);
            CorrelatedTwice {
                one: name(inputs[0]),
                other: name(inputs[1]),
                span,
            }
            .diagnostic()
        }
        CorrelationError::Impossible { pair, range } => ImpossibleCorrelation {
            names: pair.inputs.map(name),
            value: pair.correlation,
            range,
            span: of_pair(pair.inputs).unwrap_or(whole),
        }
        .diagnostic(),
    };
    checker.fail(diagnostic)
}
