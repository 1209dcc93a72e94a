//! `normal(sd: 0.05 m/s)`, `uniform(a .. b)`, `from("file.csv", column: "K")`: the distribution of one input. In: the option as written and
//! the input. Out: a [`Law`] in SI.

use super::arguments::{number, range};
use super::samples;
use super::target::Target;
use super::varied::Law;
use crate::check::checker::{Checker, Context};
use crate::check::expressions::choice::Chosen;
use crate::check::expressions::overrides::InputLocation;
use crate::check::messages::{inputs, studies as message};
use psd_physics::study::distribution::{Distribution, DistributionError, Spread};
use psd_plan::Interval;
use psd_plan::schema::study as schema;
use psd_plan::schema::{Field, Kind, ground, specimen, striker};
use psd_text::diagnostic::Diagnostic;
use psd_text::source::Span;

/// The word of the distribution by the stated uncertainty.
pub(super) const MEASURED: &str = "measured";

/// The stated arguments of a distribution, SI.
struct Stated {
    limits: Option<Interval>,
    spread: Option<Spread>,
    mean: f64,
    mode: f64,
    between: Option<Interval>,
}

/// The distribution `chosen` of an input; `span`: the whole of it.
pub(super) fn law<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    target: &Target,
    span: Span,
    context: Context,
) -> Option<Law> {
    let name = chosen.variant.name;
    if name == MEASURED {
        return measured(checker, target, span);
    }
    match (name == schema::ANY, target.is_record()) {
        (true, true) => return records(checker, target),
        (true, false) => return checker.fail(inputs::not_a_record(&target.name, span)),
        (false, true) if chosen.variant.argument(schema::FILE.name).is_none() => {
            return checker.fail(inputs::record_drawn(&target.name, span));
        }
        (false, _) => {}
    }
    if chosen.variant.argument(schema::FILE.name).is_some() {
        return samples::column(checker, chosen, target);
    }
    if let Some(diagnostic) = mean_first(checker, chosen, span) {
        return checker.fail(diagnostic);
    }
    let stated = stated(checker, chosen, target, context)?;
    if let (Some(Spread::Cv(cv)), Some(at)) = (stated.spread, given(chosen, schema::CV.name))
        && cv > 1.0
        && !checker.text(at).contains('%')
    {
        let diagnostic = message::scatter::cv_without_percent(checker.text(at), cv, at);
        checker.diagnostics.push(diagnostic);
    }
    let has_mean = !target.nominal.is_nan()
        || [schema::LIMITS, schema::MEAN]
            .iter()
            .any(|field| given(chosen, field.name).is_some());
    if !has_mean {
        return checker.fail(inputs::mean_of_a_result(&target.name, span));
    }
    let missing = |checker: &mut Checker| {
        let limits = chosen.variant.argument(schema::LIMITS.name).is_some();
        checker.fail(message::scatter_missing(name, limits, span))
    };
    let mut reach = None;
    let made = match (name, stated.limits, stated.spread) {
        ("uniform", Some(limits), None) => {
            reach = Some(limits);
            Distribution::uniform(limits.low, limits.high)
        }
        ("triangular", Some(limits), None) => {
            reach = Some(limits);
            Distribution::triangular(&(limits.low..=limits.high), stated.mode)
        }
        (_, _, None) => return missing(checker),
        (_, _, Some(spread)) => spread.sd(stated.mean).and_then(|sd| match name {
            "uniform" => {
                reach = Some(around(stated.mean, 3.0_f64.sqrt() * sd));
                Distribution::uniform_around(stated.mean, spread)
            }
            "triangular" => {
                // The variance of a symmetric one of half-width h is h²/6.
                let ends = around(stated.mean, 6.0_f64.sqrt() * sd);
                reach = Some(ends);
                Distribution::triangular(&(ends.low..=ends.high), stated.mean)
            }
            "lognormal" => Distribution::lognormal(stated.mean, spread),
            "weibull" => Distribution::weibull(stated.mean, spread),
            "gumbel" => Distribution::gumbel(stated.mean, spread),
            "normal" => Distribution::normal(stated.mean, spread),
            _ => unreachable!("the schema has no distribution `{name}`"),
        }),
    };
    let made = match (made, stated.between) {
        (Ok(made), Some(between)) => {
            reach = Some(reach.map_or(between, |ends| Interval {
                low: ends.low.max(between.low),
                high: ends.high.min(between.high),
            }));
            made.truncated(between.low, between.high)
        }
        (made, _) => made,
    };
    refused(checker, made, target, span).map(|made| Law::Distribution(made, reach))
}

/// `normal(0.8 m/s, 0.05 m/s)`, as other programs read it: mean and standard deviation.
fn mean_first(checker: &Checker, chosen: &Chosen, span: Span) -> Option<Diagnostic> {
    let arguments = chosen.variant.arguments;
    let order = [schema::SD.name, schema::CV.name];
    if chosen.unnamed < 2 || !arguments.iter().map(|field| field.name).take(2).eq(order) {
        return None;
    }
    let [mean, sd] = order.map(|name| given(chosen, name).map(|at| checker.text(at)));
    Some(message::scatter::mean_first(
        chosen.variant.name,
        mean?,
        sd?,
        span,
    ))
}

const fn around(mean: f64, half: f64) -> Interval {
    Interval {
        low: mean - half,
        high: mean + half,
    }
}

fn refused(
    checker: &mut Checker,
    made: Result<Distribution, DistributionError>,
    target: &Target,
    span: Span,
) -> Option<Distribution> {
    match made {
        Ok(made) => Some(made),
        Err(reason) => checker.fail(message::bad_distribution(
            &target.name,
            reason,
            target.dimension,
            span,
        )),
    }
}

/// The arguments that a distribution has, all of them read so that every error is reported.
fn stated<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    target: &Target,
    context: Context,
) -> Option<Stated> {
    let dimension = target.dimension;
    let limits = range(checker, chosen, schema::LIMITS, dimension);
    let between = range(checker, chosen, schema::BETWEEN, dimension);
    let sd = number(checker, chosen, schema::SD, dimension);
    let mean = number(checker, chosen, schema::MEAN, dimension);
    let mode = number(checker, chosen, schema::MODE, dimension);
    let cv = match chosen.find(schema::CV.name) {
        Some(_) => checker.optional_argument(chosen, schema::CV.name, context),
        None => Some(None),
    };
    let (limits, between, sd, mean, mode, cv) = (limits?, between?, sd?, mean?, mode?, cv?);
    let pairs = [
        (schema::SD.name, schema::CV.name),
        (schema::LIMITS.name, schema::SD.name),
        (schema::LIMITS.name, schema::CV.name),
        (schema::LIMITS.name, schema::MEAN.name),
        (schema::MODE.name, schema::SD.name),
        (schema::MODE.name, schema::CV.name),
    ];
    for (one, other) in pairs {
        let spans = (given(chosen, one), given(chosen, other));
        if let (Some(first), Some(second)) = spans {
            return checker.fail(message::stated_twice(one, other, [first, second]));
        }
    }
    Some(Stated {
        limits,
        spread: sd.map(Spread::Sd).or(cv.map(Spread::Cv)),
        mean: mean.unwrap_or(target.nominal),
        mode: mode.unwrap_or(target.nominal),
        between,
    })
}

/// The span of an argument, if the distribution has it and it is given.
fn given(chosen: &Chosen, name: &str) -> Option<Span> {
    chosen.find(name)?.1.map(|written| written.span)
}

/// Where a block states the standard uncertainty of one of its fields.
struct Uncertain {
    of: Kind,
    field: Field,
    uncertainty: Field,
    /// Whether it is relative to the value.
    relative: bool,
}

const UNCERTAIN: [Uncertain; 4] = [
    Uncertain {
        of: Kind::Specimen,
        field: specimen::MASS,
        uncertainty: specimen::MASS_UNCERTAINTY,
        relative: false,
    },
    Uncertain {
        of: Kind::Striker,
        field: striker::MASS,
        uncertainty: striker::MASS_UNCERTAINTY,
        relative: false,
    },
    Uncertain {
        of: Kind::Striker,
        field: striker::VELOCITY,
        uncertainty: striker::VELOCITY_UNCERTAINTY,
        relative: false,
    },
    Uncertain {
        of: Kind::Ground,
        field: ground::SCALE,
        uncertainty: ground::SCALE_UNCERTAINTY,
        relative: true,
    },
];

/// The files of a ground motion, in the order of their numbers.
pub(super) fn files(checker: &mut Checker, target: &Target) -> Option<Vec<String>> {
    match target.location {
        InputLocation::Field { block, .. } => checker.texts(block, ground::FILE.name),
        InputLocation::Parameter(_) | InputLocation::Result { .. } => None,
    }
}

/// The numbers of all records of a ground motion.
fn records(checker: &mut Checker, target: &Target) -> Option<Law> {
    let files = files(checker, target)?;
    Some(Law::Column {
        file: format!("the records of {}", target.name),
        values: (1_u32..).map(f64::from).take(files.len()).collect(),
    })
}

/// Normal, with the standard uncertainty that the block states for the field, or that a run gives the result.
pub(super) fn measured(checker: &mut Checker, target: &Target, span: Span) -> Option<Law> {
    if let Some(result) = target.result() {
        return Some(Law::Measured(result));
    }
    let InputLocation::Field { block, field, .. } = target.location else {
        return checker.fail(message::no_uncertainty(&target.name, None, span));
    };
    let kind = checker.scope.blocks[block].kind.kind;
    let of_block = target.name.matches('.').count() == 1;
    let stated = UNCERTAIN
        .iter()
        .find(|one| one.of == kind && one.field.name == field.name && of_block);
    let Some(stated) = stated else {
        return checker.fail(message::no_uncertainty(&target.name, None, span));
    };
    let name = stated.uncertainty.name;
    let uncertainty = checker.constant(block, name)?;
    if uncertainty == 0.0 {
        return checker.fail(message::no_uncertainty(&target.name, Some(name), span));
    }
    let spread = if stated.relative {
        Spread::Cv(uncertainty)
    } else {
        Spread::Sd(uncertainty)
    };
    let made = Distribution::normal(target.nominal, spread);
    refused(checker, made, target, span).map(|made| Law::Distribution(made, None))
}
