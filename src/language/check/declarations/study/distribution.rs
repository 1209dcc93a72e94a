//! `normal(sd: 0.05 m/s)`, `uniform(a .. b)`, `from("file.csv", column: "K")`: the distribution of one input. In: the option as written and
//! the input. Out: a [`Law`] in SI.

use crate::check::checker::{Checker, Context};
use crate::check::expressions::choice::Chosen;
use crate::check::expressions::overrides::InputLocation;
use crate::check::wording::shown;
use crate::codes::{E656, E657, W733};
use psd_physics::study::distribution::{Distribution, DistributionError, Spread};
use psd_plan::Interval;
use psd_plan::schema::{Field, Kind, ground, specimen, striker, study as schema};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;
use psd_text::units::display::significant;

use super::arguments::{number, range};
use super::samples;
use super::target::Target;
use super::varied::Law;

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

#[derive(Violation)]
#[violation(E656, "`{name}` is not the number of a ground-motion record")]
#[help(
    "write `motion.record_number ~ any` for a `ground motion` with `record_number = 1`, or a distribution such as `normal(cv: 2 %)`"
)]
struct NotARecord<'a> {
    name: &'a str,
    #[label("draws one of several records")]
    span: Span,
}

#[derive(Violation)]
#[violation(E656, "`{name}` is the number of a record, not a measured value")]
#[help("write `{name} ~ any`: each record has the same probability")]
struct RecordDrawn<'a> {
    name: &'a str,
    #[label("gives numbers between records")]
    span: Span,
}

/// A coefficient of variation above 1 that is written without `%`.
struct CvWithoutPercent<'a> {
    text: &'a str,
    cv: f64,
    span: Span,
}

impl Violation for CvWithoutPercent<'_> {
    const CODE: Code = W733;

    fn diagnostic(self) -> Diagnostic {
        let Self { text, cv, span } = self;
        let percent = significant(100.0 * cv, 3);
        Diagnostic::new(
            Self::CODE,
            format!("the scatter exceeds the mean: `cv: {text}` is {percent} %"),
        )
        .at(span, format!("{percent} % of the mean"))
        .help(format!(
            "write `cv: {text} %`, or `cv: {percent} %` if it is meant"
        ))
    }
}

#[derive(Violation)]
#[violation(E657, "`{name}` is a result: the plan does not state its mean")]
#[help("write `{name} ~ measured`, or add `mean:` to the distribution")]
struct MeanOfAResult<'a> {
    name: &'a str,
    #[label("around which value?")]
    span: Span,
}

struct ScatterMissing<'a> {
    distribution: &'a str,
    limits: bool,
    span: Span,
}

impl Violation for ScatterMissing<'_> {
    const CODE: Code = E657;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            distribution,
            limits,
            span,
        } = self;
        let help = if limits {
            format!(
                "write `{distribution}(a .. b)`, or `{distribution}(cv: 2 %)` around the value of the plan"
            )
        } else {
            format!("write `{distribution}(sd: …)` or `{distribution}(cv: 2 %)`")
        };
        Diagnostic::new(
            Self::CODE,
            format!("`{distribution}` does not state the scatter"),
        )
        .at(span, "no scatter")
        .help(help)
    }
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
        (true, false) => {
            return checker.fail(NotARecord {
                name: &target.name,
                span,
            });
        }
        (false, true) if chosen.variant.argument(schema::FILE.name).is_none() => {
            return checker.fail(RecordDrawn {
                name: &target.name,
                span,
            });
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
        let diagnostic = CvWithoutPercent {
            text: checker.text(at),
            cv,
            span: at,
        }
        .diagnostic();
        checker.diagnostics.push(diagnostic);
    }
    let has_mean = !target.nominal.is_nan()
        || [schema::LIMITS, schema::MEAN]
            .iter()
            .any(|field| given(chosen, field.name).is_some());
    if !has_mean {
        return checker.fail(MeanOfAResult {
            name: &target.name,
            span,
        });
    }
    let missing = |checker: &mut Checker| {
        let limits = chosen.variant.argument(schema::LIMITS.name).is_some();
        checker.fail(ScatterMissing {
            distribution: name,
            limits,
            span,
        })
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

/// `mean` and `sd` as they are written, without names.
#[derive(Violation)]
#[violation(
    E657,
    "`{distribution}` has the standard deviation first if its arguments have no names"
)]
#[help("write `{distribution}(mean: {mean}, sd: {sd})`")]
struct MeanFirst<'a> {
    distribution: &'a str,
    mean: &'a str,
    sd: &'a str,
    #[label("two arguments without names")]
    span: Span,
}

/// `normal(0.8 m/s, 0.05 m/s)`, as other programs read it: mean and standard deviation.
fn mean_first(checker: &Checker, chosen: &Chosen, span: Span) -> Option<Diagnostic> {
    let arguments = chosen.variant.arguments;
    let order = [schema::SD.name, schema::CV.name];
    if chosen.unnamed < 2 || !arguments.iter().map(|field| field.name).take(2).eq(order) {
        return None;
    }
    let [mean, sd] = order.map(|name| given(chosen, name).map(|at| checker.text(at)));
    Some(
        MeanFirst {
            distribution: chosen.variant.name,
            mean: mean?,
            sd: sd?,
            span,
        }
        .diagnostic(),
    )
}

const fn around(mean: f64, half: f64) -> Interval {
    Interval {
        low: mean - half,
        high: mean + half,
    }
}

/// `name`: the input.
struct BadDistribution<'a> {
    name: &'a str,
    reason: DistributionError,
    dimension: Dimension,
    span: Span,
}

impl Violation for BadDistribution<'_> {
    const CODE: Code = E657;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            name,
            reason,
            dimension,
            span,
        } = self;
        let show = |value| shown(value, dimension);
        let (message, help) = match reason {
            DistributionError::NoSpread { mean: 0.0, .. } => (
                format!("`cv` is relative to the mean, and the mean of `{name}` is 0"),
                "write `sd:` instead".to_owned(),
            ),
            DistributionError::NoSpread { mean, sd } => (
                format!(
                    "`{name}`: mean {} with standard deviation {}",
                    show(mean),
                    show(sd)
                ),
                "write finite values, with a standard deviation above 0".to_owned(),
            ),
            DistributionError::NotPositive(mean) => (
                format!(
                    "this distribution has positive values only, and the mean of `{name}` is {}",
                    show(mean)
                ),
                "write `normal`, or a positive `mean:`".to_owned(),
            ),
            DistributionError::WeibullSpread { cv } => (
                format!(
                    "`{name}`: a Weibull distribution has a coefficient of variation from 0.1 % to 1000 %, here {} %",
                    significant(100.0 * cv, 3)
                ),
                "write a `cv` inside this range".to_owned(),
            ),
            DistributionError::Limits { low, high } => (
                format!(
                    "`{name}`: the limits {} and {} leave no values",
                    show(low),
                    show(high)
                ),
                "write the smaller limit first, and two different limits".to_owned(),
            ),
            DistributionError::Mode { low, mode, high } => (
                format!(
                    "the most probable value of `{name}`, {}, is outside {} .. {}",
                    show(mode),
                    show(low),
                    show(high)
                ),
                "write limits on both sides of it, or another `mode:`".to_owned(),
            ),
            DistributionError::NothingInside { low, high, mass } => (
                format!(
                    "`{name}` is almost never between {} and {}: probability {}",
                    show(low),
                    show(high),
                    significant(mass, 2)
                ),
                "write limits around the mean".to_owned(),
            ),
        };
        Diagnostic::new(Self::CODE, message)
            .at(span, "no such distribution")
            .help(help)
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
        Err(reason) => checker.fail(BadDistribution {
            name: &target.name,
            reason,
            dimension: target.dimension,
            span,
        }),
    }
}

/// Arguments that exclude each other.
struct ScatterStatedTwice<'a> {
    one: &'a str,
    other: &'a str,
    spans: [Span; 2],
}

impl Violation for ScatterStatedTwice<'_> {
    const CODE: Code = E657;

    fn diagnostic(self) -> Diagnostic {
        let Self { one, other, spans } = self;
        Diagnostic::new(
            Self::CODE,
            format!("`{one}` and `{other}` together state too much"),
        )
        .at(spans[1], "stated again")
        .at(spans[0], "first stated here")
        .help("remove one of them")
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
            return checker.fail(ScatterStatedTwice {
                one,
                other,
                spans: [first, second],
            });
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

/// `~ measured` of an input for which the plan states no uncertainty. `field`: the one that would state it.
struct NoUncertaintyStated<'a> {
    name: &'a str,
    field: Option<&'a str>,
    span: Span,
}

impl Violation for NoUncertaintyStated<'_> {
    const CODE: Code = E657;

    fn diagnostic(self) -> Diagnostic {
        let Self { name, field, span } = self;
        let help = field.map_or_else(
            || "write a distribution, such as `~ normal(cv: 2 %)`".to_owned(),
            |field| {
                format!("write `{field} = …` in the block, or a distribution: `~ normal(cv: 2 %)`")
            },
        );
        Diagnostic::new(
            Self::CODE,
            format!("the plan states no uncertainty of `{name}`"),
        )
        .at(span, "no distribution")
        .help(help)
    }
}

/// Normal, with the standard uncertainty that the block states for the field, or that a run gives the result.
pub(super) fn measured(checker: &mut Checker, target: &Target, span: Span) -> Option<Law> {
    if let Some(result) = target.result() {
        return Some(Law::Measured(result));
    }
    let InputLocation::Field { block, field, .. } = target.location else {
        return checker.fail(NoUncertaintyStated {
            name: &target.name,
            field: None,
            span,
        });
    };
    let kind = checker.scope.blocks[block].kind.kind;
    let of_block = target.name.matches('.').count() == 1;
    let stated = UNCERTAIN
        .iter()
        .find(|one| one.of == kind && one.field.name == field.name && of_block);
    let Some(stated) = stated else {
        return checker.fail(NoUncertaintyStated {
            name: &target.name,
            field: None,
            span,
        });
    };
    let name = stated.uncertainty.name;
    let uncertainty = checker.constant(block, name)?;
    if uncertainty == 0.0 {
        return checker.fail(NoUncertaintyStated {
            name: &target.name,
            field: Some(name),
            span,
        });
    }
    let spread = if stated.relative {
        Spread::Cv(uncertainty)
    } else {
        Spread::Sd(uncertainty)
    };
    let made = Distribution::normal(target.nominal, spread);
    refused(checker, made, target, span).map(|made| Law::Distribution(made, None))
}
