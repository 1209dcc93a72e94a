//! Errors of `study` and `fragility`, and of requirements on their probabilities.

pub mod intensity;
pub mod rare;
pub mod scatter;

use super::{shown, suggestion};
use psd_physics::study::distribution::DistributionError;
use psd_plan::study::Sampling;
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;
use psd_text::units::Dimension;
use psd_text::units::display::significant;

pub fn varies_nothing(head: Span) -> Diagnostic {
    Diagnostic::new(Code::VariesNothing, "every run of this study is the same")
        .at(head, "varies nothing")
        .help("write at least one input, as in `vary = [beam.mass ~ normal(cv: 2 %)]`")
}

pub fn distribution_wanted(text: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::WrongType, format!("`{text}` is not a distribution"))
        .at(span, "not a distribution")
        .help("write one, such as `normal(cv: 2 %)` or `uniform(0.9 .. 1.1)`")
}

/// `~` outside a list of inputs.
pub fn distribution_misplaced(span: Span) -> Diagnostic {
    Diagnostic::new(Code::WrongType, "a distribution, but a number is required")
        .at(span, "`~` draws an input of a study")
        .help("write the number here, and vary it in a study: `vary = [mass ~ normal(cv: 2 %)]`")
}

/// `in` outside an intensity.
pub fn steps_misplaced(span: Span) -> Diagnostic {
    Diagnostic::new(Code::WrongType, "`in` gives the values of an intensity, which only a fragility has")
        .at(span, "not an intensity")
        .help("write the bounds of a parameter after `between`, two comparisons with `and`, or a tolerance with `within`")
}

/// `name`: the input.
pub fn bad_distribution(
    name: &str,
    reason: DistributionError,
    dimension: Dimension,
    span: Span,
) -> Diagnostic {
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
    Diagnostic::new(Code::BadDistribution, message)
        .at(span, "no such distribution")
        .help(help)
}

/// `sd: 5 %` of a quantity.
pub fn relative_deviation(text: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadDistribution,
        "`sd` has the unit of the input: a relative scatter is `cv`",
    )
    .at(span, "relative")
    .help(format!("write `cv: {text}`"))
}

/// Arguments that exclude each other.
pub fn stated_twice(one: &str, other: &str, spans: [Span; 2]) -> Diagnostic {
    Diagnostic::new(
        Code::BadDistribution,
        format!("`{one}` and `{other}` together state too much"),
    )
    .at(spans[1], "stated again")
    .at(spans[0], "first stated here")
    .help("remove one of them")
}

pub fn scatter_missing(distribution: &str, limits: bool, span: Span) -> Diagnostic {
    let help = if limits {
        format!(
            "write `{distribution}(a .. b)`, or `{distribution}(cv: 2 %)` around the value of the plan"
        )
    } else {
        format!("write `{distribution}(sd: …)` or `{distribution}(cv: 2 %)`")
    };
    Diagnostic::new(
        Code::BadDistribution,
        format!("`{distribution}` does not state the scatter"),
    )
    .at(span, "no scatter")
    .help(help)
}

/// `~ measured` of an input for which the plan states no uncertainty. `field`: the one that would state it.
pub fn no_uncertainty(name: &str, field: Option<&str>, span: Span) -> Diagnostic {
    let help = field.map_or_else(
        || "write a distribution, such as `~ normal(cv: 2 %)`".to_owned(),
        |field| format!("write `{field} = …` in the block, or a distribution: `~ normal(cv: 2 %)`"),
    );
    Diagnostic::new(
        Code::BadDistribution,
        format!("the plan states no uncertainty of `{name}`"),
    )
    .at(span, "no distribution")
    .help(help)
}

/// A file of measured values: the row, if one row has the error, with its text.
pub fn samples(
    file: &str,
    row: Option<(usize, String)>,
    reason: &str,
    help: &str,
    span: Span,
) -> Diagnostic {
    let message = match row {
        Some((line, text)) => format!("`{file}`, line {line}, `{text}`: {reason}"),
        None => format!("`{file}`: {reason}"),
    };
    Diagnostic::new(Code::SamplesFile, message)
        .at(span, "cannot be read as measured values")
        .help(help)
}

pub fn correlated_with_itself(name: &str, span: Span) -> Diagnostic {
    bad_correlation(
        format!("`{name}` is correlated with itself"),
        span,
        "write two different inputs",
    )
}

pub fn correlated_table(name: &str, span: Span) -> Diagnostic {
    bad_correlation(
        format!("`{name}` comes from a file, whose columns are drawn together"),
        span,
        "write both inputs as columns of one file, or as distributions",
    )
}

pub fn correlated_twice(one: &str, other: &str, span: Span) -> Diagnostic {
    bad_correlation(
        format!("the correlation of `{one}` and `{other}` is stated twice"),
        span,
        "remove one of them",
    )
}

pub fn correlation_out_of_range(value: f64, span: Span) -> Diagnostic {
    bad_correlation(
        format!("a rank correlation is between -1 and 1, both excluded, here {value}"),
        span,
        "write a value such as `0.6`; for a fixed ratio, calculate one input from the other with `let`",
    )
}

/// `range`: what the other correlations allow.
pub fn impossible_correlation(
    names: [&str; 2],
    value: f64,
    range: Option<[f64; 2]>,
    span: Span,
) -> Diagnostic {
    let [one, other] = names;
    let help = range.map_or_else(
        || "write smaller correlations".to_owned(),
        |[low, high]| {
            // Rounded inwards, so that both ends are possible.
            let (low, high) = ((low * 100.0).ceil() / 100.0, (high * 100.0).floor() / 100.0);
            format!("write a value from {low} to {high}, or change the others")
        },
    );
    bad_correlation(
        format!("`{one}` and `{other}` cannot have the rank correlation {value} beside the others"),
        span,
        &help,
    )
}

fn bad_correlation(message: String, span: Span, help: &str) -> Diagnostic {
    Diagnostic::new(Code::BadCorrelation, message)
        .at(span, "no such correlation")
        .help(help)
}

/// `name`: an input that is not varied.
pub fn not_varied(name: &str, span: Span, varied: &[&str]) -> Diagnostic {
    Diagnostic::new(
        Code::UnknownName,
        format!("this study does not vary `{name}`"),
    )
    .at(span, "not in `vary`")
    .help(suggestion(name, varied.iter().copied()))
}

pub fn cannot_grow(sampling: Span, until: Span) -> Diagnostic {
    Diagnostic::new(
        Code::CannotGrow,
        "a Latin hypercube has a fixed number of runs and cannot end by its results",
    )
    .at(until, "unknown number of runs")
    .at(sampling, "fixed number of runs")
    .help(format!(
        "write `runs = 10000` instead of `until`, or `sampling = {}`",
        Sampling::Random.name()
    ))
}

pub fn runs_and_until(runs: Span, until: Span) -> Diagnostic {
    Diagnostic::new(Code::CannotGrow, "the number of runs is stated twice")
        .at(until, "ends by its results")
        .at(runs, "ends after these runs")
        .help("remove `runs`; `at_most` of `until` limits the number of runs")
}

pub fn too_many_inputs(found: usize, most: usize, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::TooMany,
        format!("{found} inputs: a Sobol' study has at most {most}"),
    )
    .at(span, format!("{found} inputs"))
    .help("write `sampling = random`, which takes any number of inputs")
}

/// `until` without a requirement that could end the study. `rule`: its word.
pub fn nothing_to_decide(rule: &str, study: &str, any: bool, span: Span) -> Diagnostic {
    let (message, help) = if any {
        (
            "the plan has no requirement whose probability could end this study",
            "add a requirement on the results of a run, or write `runs = 10000`".to_owned(),
        )
    } else {
        (
            "no requirement is about a probability of this study",
            format!(
                "add one, such as `require \"rarely fails\" {study}.probability(fails: \"…\") < 2 %`, or write `runs = 10000`"
            ),
        )
    };
    Diagnostic::new(Code::NothingToDecide, message)
        .at(span, format!("`{rule}` never ends it"))
        .help(help)
}

/// `example`: what to write instead.
pub fn reads_no_result(text: &str, example: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NoResultRead,
        format!("`{text}` reads no result of a procedure"),
    )
    .at(span, "the same in every run")
    .help(format!("write a result of a procedure, as in `{example}`"))
}

pub fn one_exceedance(span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::WrongType,
        "an exceedance is one condition, without `and`",
    )
    .at(span, "several conditions")
    .help("write one `fragility` for each, or one condition of `max(a, b)`")
}

/// `exceeds` with a list, a list result or a result that is not a number.
pub fn number_wanted(text: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::WrongType,
        format!("`{text}` is a list: a study keeps one number for each run"),
    )
    .at(span, "a list")
    .help(format!("write `max({text})`, or one entry: `{text}[0]`"))
}

/// The wrong position of a probability of a study.
pub fn probability_misplaced(span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::ProbabilityMisplaced,
        "a study is evaluated after all runs: its probability is in a requirement only",
    )
    .at(span, "a probability of a study")
    .help("write it alone on one side of a requirement: `require \"…\" scatter.probability(fails: \"…\") < 2 %`")
}

/// `and`, `==`, `within`, two probabilities.
pub fn probability_compared(span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::ProbabilityMisplaced,
        "a probability is compared with one limit",
    )
    .at(span, "not such a comparison")
    .help("write `<`, `<=`, `>` or `>=` and a limit such as `2 %`; write one `require` for each")
}

pub fn no_such_member(study: &str, member: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::UnknownResult,
        format!("study `{study}` has no `{member}`"),
    )
    .at(span, "unknown")
    .help("write `probability(fails: \"…\")`, with the name of a requirement")
}

pub fn event_wanted(span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadArgument,
        "`probability` requires the name of one requirement",
    )
    .at(span, "of which event?")
    .help("write `probability(fails: \"…\")` or `probability(holds: \"…\")`")
}

pub fn unknown_requirement(label: &str, span: Span, known: &[&str]) -> Diagnostic {
    let help = match psd_text::suggest::nearest(label, known.iter().copied()) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None if known.is_empty() => "add a requirement on the results of a run".to_owned(),
        None => format!(
            "write one of: {}",
            known
                .iter()
                .take(10)
                .map(|name| format!("\"{name}\""))
                .collect::<Vec<_>>()
                .join(", ")
        ),
    };
    Diagnostic::new(
        Code::UnknownName,
        format!("no requirement is named \"{label}\""),
    )
    .at(span, "unknown requirement")
    .help(help)
}

/// A requirement that a study itself decides.
pub fn requirement_of_a_study(label: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::UnknownName,
        format!("\"{label}\" is itself a requirement on a study"),
    )
    .at(span, "not decided by a run")
    .help("write the name of a requirement on the results of a run")
}

pub fn impossible_limit(value: f64, text: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::OutOfRange,
        format!("a limit of a probability is between 0 and 1, both excluded, here {value}"),
    )
    .at(span, format!("`{text}` is always or never met"))
    .help("write a limit such as `2 %`")
}

pub fn too_few_runs(most: u64, limit: Span, fewest: u64, at: Option<Span>) -> Diagnostic {
    let diagnostic = Diagnostic::new(
        Code::TooFewRuns,
        format!(
            "{most} runs cannot show this limit, even if none is against it: that takes {fewest}"
        ),
    )
    .at(limit, "always undecided, or not met");
    let diagnostic = at.into_iter().fold(diagnostic, |diagnostic, span| {
        diagnostic.at(span, "too few runs")
    });
    diagnostic.help(format!(
        "write `runs = {}` or more, `until = decided(at_most: {})`, or `sampling = subset`",
        rounded_up(fewest),
        rounded_up(fewest.saturating_mul(10))
    ))
}

/// To one or two digits.
fn rounded_up(count: u64) -> u64 {
    let mut unit = 1_u64;
    while count / unit >= 100 {
        unit *= 10;
    }
    count.div_ceil(unit) * unit
}

pub fn on_a_real_rig(head: Span) -> Diagnostic {
    Diagnostic::new(
        Code::StudyOnRealRig,
        "a study is simulated: it cannot run on a real rig",
    )
    .at(head, "a real rig")
    .help("remove `--rig`, or name a virtual rig")
}

/// A value of a rig that moves a specimen.
pub fn of_a_real_rig(name: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::StudyOnRealRig,
        format!("`{name}` belongs to a real rig, and a study is simulated"),
    )
    .at(span, "no effect in a study")
    .help("remove it, or vary a field of a virtual rig")
}
