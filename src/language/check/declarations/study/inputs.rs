//! `vary = [impact_speed ~ normal(sd: 0.05 m/s), beam.mass]`: the inputs of a study with their distributions. In: the list. Out: a
//! [`Variation`], in which the columns of one file are next to each other.

use crate::check::checker::{Checker, Context};
use crate::check::violations::VariesNothing;
use crate::codes::{E208, E304, E405};
use crate::syntax::ast::{BinaryOperator, Expr, ExprKind};
use psd_physics::study::distribution::{Distribution, Spread};
use psd_physics::study::inputs::{InputError, Source, StudyInputs};
use psd_physics::study::sampling::sobol::MOST_INPUTS;
use psd_physics::study::sampling::{Design, DesignError};
use psd_plan::schema::study as schema;
use psd_plan::study::{Measured, REPLICATES, Sampling, Variation};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

use super::target::{Target, target};
use super::varied::{Law, Varied, source_of};
use super::{correlation, distribution, ends, items, sampling, seed, spaced};

#[derive(Violation)]
#[violation(E208, "`{name}` is varied twice")]
#[help("remove one of them")]
struct VariedTwice<'a> {
    name: &'a str,
    #[label("varied again")]
    span: Span,
    #[label("first varied here")]
    first: Span,
}

#[derive(Violation)]
#[violation(E405, "{found} inputs: a Sobol' study has at most {most}")]
#[help("write `sampling = random`, which takes any number of inputs")]
struct TooManyInputs {
    found: usize,
    most: usize,
    #[label("{found} inputs")]
    span: Span,
}

/// The inputs of a field, with their correlations and points. `stepped`: the intensity of a fragility, which is not varied as well.
pub(super) fn variation(
    checker: &mut Checker,
    block: usize,
    field: &'static str,
    stepped: Option<&Target>,
) -> Option<Variation> {
    let sampling = sampling(checker, block);
    let seed = seed(checker, block);
    let head = checker.scope.blocks[block].block.head;
    let (entry, written) = checker.field(block, field)?;
    let context = checker.context_of(block, entry);
    let list = items(&written.value);
    if list.is_empty() {
        return checker.fail(VariesNothing { head });
    }
    let mut named: Vec<(String, Span)> = stepped
        .iter()
        .map(|target| (target.name.clone(), target.span))
        .collect();
    let read: Vec<Option<Varied>> = list
        .iter()
        .map(|item| {
            let varied = varied(checker, item, context)?;
            let (name, span) = (&varied.target.name, varied.target.span);
            if let Some((_, first)) = named.iter().find(|(before, _)| before == name) {
                return checker.fail(VariedTwice {
                    name,
                    span,
                    first: *first,
                });
            }
            named.push((name.clone(), span));
            Some(varied)
        })
        .collect();
    let varied = grouped(read.into_iter().collect::<Option<Vec<_>>>()?);
    let sources = sources(&varied);
    let correlations = correlation::correlations(checker, block, &varied)?;
    let (sampling, seed) = (sampling?, seed?);
    let pairs: Vec<_> = correlations.iter().map(|pair| pair.node).collect();
    match StudyInputs::new(sources.clone(), &pairs, design(sampling), seed) {
        Ok(_) => {}
        Err(InputError::Correlation(reason)) => {
            return correlation::refused(checker, reason, &correlations, &varied);
        }
        Err(InputError::Design(DesignError::TooManyInputs { inputs })) => {
            let span = written.value.span;
            return checker.fail(TooManyInputs {
                found: inputs,
                most: MOST_INPUTS,
                span,
            });
        }
        // Lists, tables and numbers of runs were checked before.
        Err(_) => return checker.fail(VariesNothing { head }),
    }
    ends::note(checker, &varied);
    let measured = varied.iter().enumerate().filter_map(|(input, one)| {
        let Law::Measured(result) = one.law else {
            return None;
        };
        Some(Measured {
            input,
            source: source_of(&varied, input),
            result,
        })
    });
    Some(Variation {
        measured: measured.collect(),
        inputs: varied
            .iter()
            .map(|varied| varied.target.input(varied.text.clone()))
            .collect(),
        sources,
        correlations: pairs,
        sampling,
        seed,
    })
}

/// A design of any size: only the number of inputs is checked here.
const fn design(sampling: Sampling) -> Design {
    match sampling {
        Sampling::Random | Sampling::Subset => Design::Random,
        Sampling::LatinHypercube => Design::LatinHypercube { runs: 1 },
        Sampling::Sobol => Design::Sobol {
            replicates: REPLICATES,
        },
    }
}

/// The columns of one file behind the first of them; the order is kept otherwise.
fn grouped(varied: Vec<Varied>) -> Vec<Varied> {
    let mut groups: Vec<Vec<Varied>> = Vec::new();
    for one in varied {
        let file = one.law.file().map(str::to_owned);
        let same =
            |group: &&mut Vec<Varied>| file.is_some() && group[0].law.file() == file.as_deref();
        match groups.iter_mut().find(same) {
            Some(group) => group.push(one),
            None => groups.push(vec![one]),
        }
    }
    groups.into_iter().flatten().collect()
}

/// One source for each distribution, one for each file.
fn sources(varied: &[Varied]) -> Vec<Source> {
    let mut sources = Vec::new();
    let mut before: Option<&str> = None;
    for one in varied {
        match &one.law {
            Law::Distribution(distribution, _) => {
                sources.push(Source::Distribution(*distribution));
            }
            // Until a run gives its value and uncertainty.
            Law::Measured(_) => sources.push(Source::Distribution(
                Distribution::normal(1.0, Spread::Sd(1.0)).expect("a standard deviation above 0"),
            )),
            Law::Column { file, values } => match sources.last_mut() {
                Some(Source::Rows(rows)) if before == Some(file) => {
                    rows.iter_mut()
                        .zip(values)
                        .for_each(|(row, value): (&mut Vec<f64>, _)| row.push(*value));
                }
                _ => sources.push(Source::Rows(
                    values.iter().map(|value| vec![*value]).collect(),
                )),
            },
        }
        before = one.law.file();
    }
    sources
}

#[derive(Violation)]
#[violation(E304, "`{text}` is not a distribution")]
#[help("write one, such as `normal(cv: 2 %)` or `uniform(0.9 .. 1.1)`")]
struct DistributionWanted<'a> {
    text: &'a str,
    #[label("not a distribution")]
    span: Span,
}

fn varied<'a>(checker: &mut Checker<'a>, item: &'a Expr, context: Context) -> Option<Varied<'a>> {
    if let ExprKind::Binary {
        operator,
        left,
        right,
    } = &item.kind
        && operator.node == BinaryOperator::DrawnFrom
    {
        let target = target(checker, left);
        let chosen = match &right.kind {
            ExprKind::Name(_) | ExprKind::Call { .. } => {
                checker.chosen(schema::VARY.name, schema::DISTRIBUTIONS, right)
            }
            ExprKind::Faulty => None,
            _ => checker.fail(DistributionWanted {
                text: checker.text(right.span),
                span: right.span,
            }),
        };
        let (target, chosen) = (target?, chosen?);
        let law = distribution::law(checker, &chosen, &target, right.span, context)?;
        let mut text = spaced(checker.text(right.span));
        if target.is_record() && chosen.variant.name == schema::ANY {
            // The report names the files behind the numbers.
            let files = distribution::files(checker, &target)?;
            text = format!("{text} of {}", files.join(", "));
        }
        return Some(Varied {
            target,
            law,
            text,
            span: item.span,
        });
    }
    let target = target(checker, item)?;
    let law = distribution::measured(checker, &target, item.span)?;
    Some(Varied {
        target,
        law,
        text: distribution::MEASURED.to_owned(),
        span: item.span,
    })
}
