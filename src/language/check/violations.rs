//! Violations that several parts of the check find.

use crate::check::checker::Typed;
use crate::check::wording::{article, example, owner, shown, suggestion};
use crate::codes::{
    E203, E209, E213, E214, E301, E303, E304, E305, E306, E401, E403, E407, E501, E504, E602, E608,
    E610, E612, E614, E632, E635, E661, E662, E663, W728,
};
use crate::syntax::ast::Ident;
use psd_plan::schema::{BlockKind, Field, Kind, rig as schema};
use psd_plan::{Dialect, Interval};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::{Dimension, Quantity};

#[derive(Violation)]
#[violation(E501, "file `{path}` does not exist")]
#[help("write a path relative to the file that names it")]
pub struct FileMissing<'a> {
    pub path: &'a str,
    #[label("not found")]
    pub span: Span,
}

#[derive(Violation)]
#[violation(E504, "too many files: a plan can have at most {most}")]
#[help("combine related declarations in one file")]
pub struct TooManyFiles {
    pub most: usize,
    #[label("too many")]
    pub span: Span,
}

#[derive(Violation)]
#[violation(E304, "`{text}` is not the name of an input")]
#[help("write a `param` or a field, with its distribution: `beam.mass ~ normal(cv: 2 %)`")]
pub struct InputWanted<'a> {
    pub text: &'a str,
    #[label("not a name")]
    pub span: Span,
}

#[derive(Violation)]
#[violation(E209, "{} requires the field `{field}`", owner(kind, name))]
#[help("add a line such as `{example}`")]
pub struct MissingField<'a> {
    pub kind: &'a BlockKind,
    pub name: Option<&'a Ident>,
    #[label("`{field}` is missing")]
    pub head: Span,
    pub field: &'a str,
    pub example: &'a str,
}

pub struct UnknownBlockName<'a> {
    pub kind: Kind,
    pub name: &'a str,
    pub span: Span,
    pub known: &'a [&'a str],
}

impl Violation for UnknownBlockName<'_> {
    const CODE: Code = E203;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            kind,
            name,
            span,
            known,
        } = self;
        let block = psd_plan::schema::block(kind);
        let help = if known.is_empty() {
            format!("declare one, as in\n{}", block.example)
        } else {
            suggestion(name, known.iter().copied())
        };
        Diagnostic::new(Self::CODE, format!("unknown {} `{name}`", block.words()))
            .at(span, "unknown name")
            .help(help)
    }
}

#[derive(Violation)]
#[violation(E203, "unknown procedure `{name}`")]
#[help("{}", suggestion(name, known.iter().copied()))]
pub struct UnknownProcedure<'a> {
    pub name: &'a str,
    #[label("unknown name")]
    pub span: Span,
    pub known: &'a [&'a str],
}

pub struct UnknownParameter<'a> {
    pub name: &'a str,
    pub known: &'a [&'a str],
    /// A `let` of the plan has this name.
    pub calculated: bool,
}

impl Violation for UnknownParameter<'_> {
    const CODE: Code = E214;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            name,
            known,
            calculated,
        } = self;
        let help = if calculated {
            format!("write `param {name} = …` in the plan: a `let` cannot be set")
        } else if known.is_empty() {
            "remove `--set`; the plan has no `param`".to_owned()
        } else {
            suggestion(name, known.iter().copied())
        };
        Diagnostic::new(
            Self::CODE,
            format!("`--set {name}`: unknown parameter `{name}`"),
        )
        .help(help)
    }
}

pub struct DeviceCannotMove<'a> {
    pub field: &'a str,
    pub dialect: &'a Dialect,
    pub at: Span,
}

impl Violation for DeviceCannotMove<'_> {
    const CODE: Code = E608;

    fn diagnostic(self) -> Diagnostic {
        let Self { field, dialect, at } = self;
        let name = dialect.name();
        let help = match dialect {
            Dialect::Modbus(_) => {
                "add the `target` register, and `position` with its `length_unit`"
            }
            _ if field == schema::LINK.name => {
                "make this the `load_cell`, and name an `actuator` that moves"
            }
            _ => {
                "name a device that moves: `native`, `grbl`, `instron`, `mark10`, `modbus` or `nees`"
            }
        };
        Diagnostic::new(
            Self::CODE,
            format!("`{field}` must move the specimen, but a `{name}` device cannot"),
        )
        .at(at, "cannot move")
        .help(help)
    }
}

/// `own`: a load cell was named; otherwise the moving device was to measure the force too.
pub struct DeviceCannotMeasureForce<'a> {
    pub own: bool,
    pub field: &'a str,
    pub dialect: &'a Dialect,
    pub at: Span,
}

impl Violation for DeviceCannotMeasureForce<'_> {
    const CODE: Code = E608;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            own,
            field,
            dialect,
            at,
        } = self;
        let name = dialect.name();
        let help = match dialect {
            Dialect::Modbus(_) => {
                "add the `force` register with its `force_unit`, or another device that reads the force"
            }
            _ if own => {
                "name a device that reads the force, as in\nload_cell = serial(port: \"/dev/ttyUSB1\", dialect: indicator)"
            }
            _ if field == schema::LINK.name => {
                "make this the `actuator`, and add\nload_cell = serial(port: \"/dev/ttyUSB1\", dialect: indicator)"
            }
            _ => {
                "add a line such as\nload_cell = serial(port: \"/dev/ttyUSB1\", dialect: indicator)"
            }
        };
        let message = if own {
            format!("`load_cell` must read the force, but a `{name}` device cannot")
        } else {
            format!("no device reads the force: a `{name}` device only moves")
        };
        Diagnostic::new(Self::CODE, message)
            .at(at, "reads no force")
            .help(help)
    }
}

#[derive(Violation)]
#[violation(E614, "`{field}` requires `displacement_calibration`")]
#[help(
    "add `displacement_calibration = \"UKAS 4712\"`, or remove the date: `calibration_due` applies to both"
)]
pub struct DayOfNoCalibration<'a> {
    pub field: &'a str,
    #[label("no displacement calibration")]
    pub at: Span,
}

#[derive(Violation)]
#[violation(
    E610,
    "invalid `{field}`: the protocol requires a nonempty line of plain text"
)]
#[help("write the letters and digits that the device uses")]
pub struct BadLineText<'a> {
    pub field: &'a str,
    #[label("empty, or invalid characters")]
    pub span: Span,
}

#[derive(Violation)]
#[violation(E612, "`{}` is not a calendar date", day.escape_debug())]
#[help("write year, month and day, as in `\"2027-03-01\"`")]
pub struct NotADay<'a> {
    pub day: &'a str,
    #[label("invalid date")]
    pub span: Span,
}

/// Two arguments, one of which has no meaning without the other.
#[derive(Violation)]
#[violation(E632, "`{given}` requires `{missing}`")]
#[help("add `{missing}`, or remove `{given}`")]
pub struct MissingPartner<'a> {
    pub given: &'a str,
    pub missing: &'a str,
    #[label("`{missing}` is missing")]
    pub span: Span,
}

/// Exactly one of two forms is required; `takes` names the owner and both forms, `example` shows one.
pub struct OneFormOnly<'a> {
    pub takes: &'a str,
    pub example: &'a str,
    pub span: Span,
    pub given: usize,
}

impl Violation for OneFormOnly<'_> {
    const CODE: Code = E632;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            takes,
            example,
            span,
            given,
        } = self;
        let (label, help) = if given == 0 {
            (
                "neither is given",
                format!("add one of them, such as `{example}`"),
            )
        } else {
            ("both are given", "remove one of them".to_owned())
        };
        Diagnostic::new(Self::CODE, format!("{takes}, but not both"))
            .at(span, label)
            .help(help)
    }
}

#[derive(Violation)]
#[violation(E661, "every run of this study is the same")]
#[help("write at least one input, as in `vary = [beam.mass ~ normal(cv: 2 %)]`")]
pub struct VariesNothing {
    #[label("varies nothing")]
    pub head: Span,
}

/// `~` outside a list of inputs.
#[derive(Violation)]
#[violation(E304, "a distribution, but a number is required")]
#[help("write the number here, and vary it in a study: `vary = [mass ~ normal(cv: 2 %)]`")]
pub struct DistributionMisplaced {
    #[label("`~` draws an input of a study")]
    pub span: Span,
}

/// `in` outside an intensity.
#[derive(Violation)]
#[violation(
    E304,
    "`in` gives the values of an intensity, which only a fragility has"
)]
#[help(
    "write the bounds of a parameter after `between`, two comparisons with `and`, or a tolerance with `within`"
)]
pub struct StepsMisplaced {
    #[label("not an intensity")]
    pub span: Span,
}

/// `example`: what to write instead.
#[derive(Violation)]
#[violation(E662, "`{text}` reads no result of a procedure")]
#[help("write a result of a procedure, as in `{example}`")]
pub struct ReadsNoResult<'a> {
    pub text: &'a str,
    pub example: &'a str,
    #[label("the same in every run")]
    pub span: Span,
}

/// The wrong position of a probability of a study.
#[derive(Violation)]
#[violation(
    E663,
    "a study is evaluated after all runs: its probability is in a requirement only"
)]
#[help(
    "write it alone on one side of a requirement: `require \"…\" scatter.probability(fails: \"…\") < 2 %`"
)]
pub struct ProbabilityMisplaced {
    #[label("a probability of a study")]
    pub span: Span,
}

#[derive(Violation)]
#[violation(E213, "`probability` requires the name of one requirement")]
#[help("write `probability(fails: \"…\")` or `probability(holds: \"…\")`")]
pub struct EventWanted {
    #[label("of which event?")]
    pub span: Span,
}

/// A parameter is bound to a number of another dimension.
#[derive(Violation)]
#[violation(E301, "`{parameter}` requires {}, found {}", article(wanted), article(bound.dimension))]
#[help("write {} for `{parameter}`, not {}", article(wanted), bound.in_plan_syntax())]
pub struct WrongDimensionOfQuantity<'a> {
    pub bound: Quantity,
    pub wanted: Dimension,
    pub parameter: &'a str,
    #[label("this is {}", article(wanted))]
    pub declared_at: Span,
}

/// An operation that has no meaning for a temperature with `degC`.
#[derive(Violation)]
#[violation(E306, "{message}")]
#[help("{help}")]
pub struct AbsoluteTemperature {
    message: String,
    help: &'static str,
    #[label("an absolute temperature")]
    span: Span,
}

impl AbsoluteTemperature {
    fn new(message: impl Into<String>, help: &'static str, span: Span) -> Self {
        let message = message.into();
        Self {
            message,
            help,
            span,
        }
    }

    pub fn of_product(span: Span) -> Self {
        Self::new(
            "a temperature with `degC` cannot be multiplied, divided or raised to a power",
            "write the temperature in kelvin, as in `… K`, or subtract another one first",
            span,
        )
    }

    pub fn of_sum(span: Span) -> Self {
        Self::new(
            "two absolute temperatures have no sum",
            "write a difference in kelvin, as in `20 degC + … K`",
            span,
        )
    }

    pub fn of_difference(span: Span) -> Self {
        Self::new(
            "a temperature with `degC` is subtracted from another one with `degC` only",
            "write both temperatures with `degC`, or both in kelvin",
            span,
        )
    }

    pub fn of_function(function: &str, span: Span) -> Self {
        Self::new(
            format!("`{function}` has no value for a temperature with `degC`"),
            "write the temperature in kelvin, as in `… K`",
            span,
        )
    }

    pub fn of_step(span: Span) -> Self {
        Self::new(
            "a step is a difference of temperatures",
            "write `degC` at both ends and the step in kelvin: `10 degC .. 30 degC step … K`",
            span,
        )
    }

    pub fn of_deviation(span: Span) -> Self {
        Self::new(
            "a standard deviation is a difference of temperatures",
            "write it in kelvin, as in `… K`",
            span,
        )
    }

    pub fn in_a_unit(span: Span) -> Self {
        Self::new(
            "`degC` cannot be part of another unit",
            "write `K` instead of `degC`",
            span,
        )
    }
}

pub struct Mismatched<'a> {
    pub operator: &'a str,
    pub left: &'a Typed,
    pub right: &'a Typed,
}

impl Violation for Mismatched<'_> {
    const CODE: Code = E303;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            operator,
            left,
            right,
        } = self;
        let (one, other) = (article(left.dimension), article(right.dimension));
        let forgotten = left.bare != right.bare;
        let wanted = if left.bare && forgotten {
            right.dimension
        } else {
            left.dimension
        };
        let is = |side: &Typed, name: &str| {
            if side.bare && forgotten {
                "no unit".to_owned()
            } else {
                format!("this is {name}")
            }
        };
        let how = format!("{}, as in `{}`", article(wanted), example(None, wanted));
        let percent = [left, right].into_iter().find(|side| side.percent);
        let part = percent.filter(|_| left.dimension != right.dimension);
        let part = part.and_then(Typed::constant);
        let help = if let Some(part) = part {
            format!(
                "write the value of which this is a percentage: `{} % * …`",
                (1e6 * part).round() / 1e4
            )
        } else if forgotten {
            format!("add a unit to make the number {how}")
        } else {
            format!("write both sides as the same kind of quantity: {how}")
        };
        Diagnostic::new(
            Self::CODE,
            format!("`{operator}` cannot combine {one} and {other}"),
        )
        .at(left.span, is(left, &one))
        .at(right.span, is(right, &other))
        .help(help)
    }
}

#[derive(Violation)]
#[violation(E304, "expected one number, found a list")]
#[help("write one entry, as in `list[0]`, or a function, as in `max(list)`")]
pub struct ListForNumber {
    #[label("a list")]
    pub span: Span,
}

#[derive(Violation)]
#[violation(E305, "exponents of this unit are too large")]
#[help("write smaller powers")]
pub struct ExponentTooLarge {
    #[label("too large")]
    pub span: Span,
}

pub struct OutOfRange<'a> {
    pub field: &'a Field,
    pub dimension: Dimension,
    pub value: f64,
    pub text: &'a str,
    pub span: Span,
}

impl Violation for OutOfRange<'_> {
    const CODE: Code = E401;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            field,
            dimension,
            value,
            text,
            span,
        } = self;
        let allowed = field.range.in_words(dimension);
        let is = if dimension == Dimension::NUMBER {
            value.to_string()
        } else {
            shown(value, dimension)
        };
        let mirrored = text
            .strip_prefix('-')
            .map(str::trim_start)
            .filter(|_| -value > field.range.low && -value <= field.range.high);
        let help = mirrored.map_or_else(
            || format!("write a value that is {allowed}"),
            |size| format!("write its absolute value, `{size}`"),
        );
        // A literal is not repeated: "`-10 kg` is -10 kg".
        let side = if value > field.range.high {
            "too large"
        } else {
            "too small"
        };
        let label = if is == text {
            side.to_owned()
        } else {
            format!("`{text}` is {is}")
        };
        Diagnostic::new(Self::CODE, format!("`{}` must be {allowed}", field.name))
            .at(span, label)
            .help(help)
    }
}

/// `dimension` is that of the value, whose name begins the name of the field.
#[derive(Violation)]
#[violation(
    E635,
    "`{field}` exceeds a fifth of the `{of}`, {value}",
    value = shown(value, dimension),
    of = field.trim_end_matches("_uncertainty")
)]
#[help(
    "write the standard uncertainty: half of a 95 % coverage interval ±a, or a/√3 for a rectangular distribution"
)]
pub struct TooUncertain<'a> {
    pub field: &'a str,
    pub uncertainty: f64,
    pub value: f64,
    pub dimension: Dimension,
    #[label("standard uncertainty: {uncertainty}", uncertainty = shown(uncertainty, dimension))]
    pub span: Span,
}

#[derive(Violation)]
#[violation(E401, "`{field}` must not be 0")]
#[help("write the scale factor with its sign")]
pub struct ZeroFactor<'a> {
    pub field: &'a str,
    #[label("scale factor is zero")]
    pub span: Span,
}

#[derive(Violation)]
#[violation(E401, "the list has no entry {entry}: its length is {length}")]
#[help("write at most {}, the index of the last entry", length.saturating_sub(1))]
pub struct NoSuchEntry {
    #[label("past the end")]
    pub span: Span,
    pub entry: usize,
    pub length: usize,
}

#[derive(Violation)]
#[violation(E401, "a list must have at least one entry")]
#[help("write the entries, as in `[1, 2, 5] mm`")]
pub struct EmptyList {
    #[label("empty list")]
    pub span: Span,
}

#[derive(Violation)]
#[violation(E407, "the value is not a finite number")]
#[help("change the expression so that its value is finite")]
pub struct NotFinite {
    #[label("zero divisor, negative root or logarithm, or too large")]
    pub span: Span,
}

#[derive(Violation)]
#[violation(E403, "this must be known before the run")]
#[help("write a number, or a `let` or `param` of numbers")]
pub struct NeedsTheRun<'a> {
    #[label("`{text}` is known only during the run")]
    pub span: Span,
    pub text: &'a str,
}

/// An entry that has no effect here: the reason, and the remedy.
#[derive(Violation)]
#[violation(W728, "{}", message)]
#[help("{}", help.to_owned())]
pub struct NoEffect<'a> {
    pub message: String,
    #[label("{}", label.to_owned())]
    pub span: Span,
    pub label: &'a str,
    pub help: &'a str,
}

#[derive(Violation)]
#[violation(
    E602,
    "`{field}` has {value}, outside the limits {low} .. {high}",
    value = shown(value, dimension),
    low = shown(limit.low, dimension),
    high = shown(limit.high, dimension)
)]
#[help("stay within the limits, or widen them if the rig and the specimen allow it")]
pub struct BeyondLimits<'a> {
    pub field: &'a str,
    pub value: f64,
    pub dimension: Dimension,
    #[label("reaches {value}", value = shown(value, dimension))]
    pub span: Span,
    pub limit: Interval,
    #[label("limit")]
    pub limit_at: Span,
}
