//! Numbers, lists and ranges: units looked up, ranges expanded.

#![expect(
    clippy::cast_precision_loss,
    reason = "a list has at most 100,000 entries"
)]

use crate::check::checker::{Checker, Context, Shape, Typed, literal};
use std::sync::LazyLock;

use crate::check::scope::Meaning;
use crate::check::violations::{AbsoluteTemperature, EmptyList, ExponentTooLarge, Mismatched};
use crate::check::wording::one_of;
use crate::codes::{E204, E305, E402, E403, E405};
use crate::syntax::ast::{Expr, ExprKind, UnitToken};
use psd_plan::formula::Formula;
use psd_plan::schema::constant;
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::unit::{STANDARD_GRAVITY, UNITS, UnitError};
use psd_text::units::{Dimension, Unit, display, unit};

/// Most entries of a list, written one by one or as a range.
pub const MOST_ENTRIES: usize = 100_000;

/// Parts of a range, each a checked number.
pub struct RangeParts {
    pub start: Typed,
    pub end: Typed,
    pub step: Option<Typed>,
}

#[derive(Violation)]
#[violation(E204, "`{name}` is a name of the plan, not a unit")]
#[help("write spaces around the operator: `{corrected}`")]
struct NameGluedToUnit<'a> {
    name: &'a str,
    #[label("read as part of the unit")]
    span: Span,
    corrected: &'a str,
}

#[derive(Violation)]
#[violation(E204, "`{name}` is a name of the plan, not a unit")]
#[help("write `{corrected}`")]
struct ValueAfterNumber<'a> {
    name: &'a str,
    #[label("a number and a name")]
    span: Span,
    corrected: &'a str,
}

/// Units that psd does not know, with their size in a unit that it knows.
const CONVERTED: &[(&str, f64, &str)] = &[
    ("mph", 0.447_04, "m/s"),
    ("kgf", STANDARD_GRAVITY, "N"),
    ("bar", 1e5, "Pa"),
];

/// Units as words.
const SPELT_OUT: &[(&str, &str)] = &[
    ("percent pct", "%"),
    ("meter metre meters metres", "m"),
    ("millimeter millimetre millimeters millimetres", "mm"),
    ("micron microns", "um"),
    ("gram grams", "g"),
    ("kilogram kilograms kgs", "kg"),
    ("tonne tonnes ton tons", "t"),
    ("sec secs second seconds", "s"),
    ("msec millisecond milliseconds", "ms"),
    ("minute minutes mins", "min"),
    ("hour hours hr hrs", "h"),
    ("newton newtons", "N"),
    ("kilonewton kilonewtons", "kN"),
    ("pascal pascals", "Pa"),
    ("joule joules", "J"),
    ("hertz cps", "Hz"),
    ("inch inches", "in"),
    ("foot feet", "ft"),
    ("lbs pound pounds", "lb"),
    ("degree degrees", "deg"),
    ("radian radians", "rad"),
    ("kelvin", "K"),
    ("C celsius centigrade", "degC"),
    ("mps", "m/s"),
    ("kph kmh", "km/h"),
];

/// `kN*m` for `kNm`.
fn unit_product(name: &str) -> Option<String> {
    // `KN` is a force in the wrong case.
    let dimension = |part: &str| {
        let dimension = psd_text::units::unit::lookup(part)?.dimension;
        (dimension != Dimension::TEMPERATURE).then_some(dimension)
    };
    // `mmm` is a typing error, and not an area.
    let product = |(one, other): &(&str, &str)| {
        dimension(one)
            .zip(dimension(other))
            .is_some_and(|(one, other)| one != other)
    };
    let (first, second) = (1..name.len())
        .filter_map(|at| name.split_at_checked(at))
        .find(product)?;
    Some(format!("{first}*{second}"))
}

/// The prefixes that are usual with a unit in tests of structures. Only such units are suggested: a slip of the keyboard must not become
/// a number that is a billion times too small, as `mPa` for `mpa`.
const USUAL_PREFIXES: &[(&str, &[&str])] = &[
    ("m", &["u", "m", "c", "k"]),
    ("g", &["m", "k"]),
    ("s", &["u", "m"]),
    ("N", &["k", "M"]),
    ("Pa", &["k", "M", "G"]),
    ("J", &["m", "k"]),
    ("Hz", &["k"]),
];

/// The units that are suggested.
static USUAL: LazyLock<Vec<String>> = LazyLock::new(|| {
    let plain = UNITS.iter().map(|unit| unit.symbol.to_owned());
    let prefixed = USUAL_PREFIXES.iter().flat_map(|(symbol, prefixes)| {
        prefixes
            .iter()
            .map(move |prefix| format!("{prefix}{symbol}"))
    });
    plain.chain(prefixed).collect()
});

/// `mm^2` for `mm2`.
fn power(name: &str) -> Option<String> {
    let unit = name.trim_end_matches(|digit: char| digit.is_ascii_digit());
    let exponent = &name[unit.len()..];
    let known = psd_text::units::unit::lookup(unit).is_some();
    (known && !exponent.is_empty()).then(|| format!("{unit}^{exponent}"))
}

/// The unit that was meant.
fn meant(name: &str) -> Option<String> {
    let among = |words: &str| words.split(' ').any(|word| word.eq_ignore_ascii_case(name));
    let spelt_out = SPELT_OUT.iter().find(|(words, _)| among(words));
    spelt_out
        .map(|(_, unit)| (*unit).to_owned())
        .or_else(|| power(name))
        .or_else(|| unit_product(name))
        .or_else(|| {
            USUAL
                .iter()
                .find(|unit| unit.eq_ignore_ascii_case(name))
                .cloned()
        })
        .or_else(|| {
            psd_text::suggest::nearest(name, USUAL.iter().map(String::as_str)).map(str::to_owned)
        })
}

/// `number`: the number before the unit, if nothing but this unit is behind it.
struct UnknownUnit<'a> {
    name: &'a str,
    number: Option<f64>,
    span: Span,
}

impl Violation for UnknownUnit<'_> {
    const CODE: Code = E204;

    fn diagnostic(self) -> Diagnostic {
        let Self { name, number, span } = self;
        let converted = CONVERTED.iter().find(|(unit, ..)| *unit == name);
        let help = match (converted, meant(name)) {
            (Some((_, factor, unit)), _) => {
                let count = number.unwrap_or(1.0);
                let size = display::significant(count * factor, 4);
                format!("write it in `{unit}`: {count} {name} is `{size} {unit}`")
            }
            (None, Some(near)) => format!("did you mean `{near}`?"),
            (None, None) => format!(
                "known units: {}; SI units can have prefixes",
                one_of(UNITS.iter().map(|unit| unit.symbol))
            ),
        };
        Diagnostic::new(Self::CODE, format!("unknown unit `{name}`"))
            .at(span, "unknown unit")
            .help(help)
    }
}

#[derive(Violation)]
#[violation(E305, "invalid exponent `{text}` in a unit")]
#[help("write it as in `mm^2` or `N/m^1.5`")]
struct UnitExponent<'a> {
    text: &'a str,
    #[label("not a simple fraction")]
    span: Span,
}

struct TooManyEntries {
    span: Span,
    found: f64,
    most: usize,
}

impl Violation for TooManyEntries {
    const CODE: Code = E405;

    fn diagnostic(self) -> Diagnostic {
        let Self { span, found, most } = self;
        let found = if found < 1e12 {
            found.to_string()
        } else {
            format!("about {found:.0e}")
        };
        Diagnostic::new(
            Self::CODE,
            format!("too many entries in a list: {found} (at most {most})"),
        )
        .at(span, "too many")
        .help("write a larger step")
    }
}

#[derive(Violation)]
#[violation(E402, "this range requires a step")]
#[help("add one, as in `{text} step …`")]
struct RangeWithoutStep<'a> {
    #[label("list required")]
    span: Span,
    text: &'a str,
}

#[derive(Violation)]
#[violation(E403, "both ends and the step of a range must be known before the run")]
#[help("write numbers, or a `let` or `param` of numbers")]
struct RangeNotConstant {
    #[label("known only after the run")]
    span: Span,
}

struct StepLeadsAway<'a> {
    span: Span,
    text: &'a str,
    zero: bool,
}

impl Violation for StepLeadsAway<'_> {
    const CODE: Code = E402;

    fn diagnostic(self) -> Diagnostic {
        let Self { span, text, zero } = self;
        let help = match text.strip_prefix('-') {
            _ if zero => "a step must not be zero".to_owned(),
            Some(size) => format!("write `step {}`: this range increases", size.trim_start()),
            None => format!("write `step -{text}`: this range decreases"),
        };
        Diagnostic::new(
            Self::CODE,
            "the step does not lead from the start to the end",
        )
        .at(span, format!("`{text}` never reaches the end"))
        .help(help)
    }
}

struct StepDoesNotDivide {
    range: Span,
    step: Span,
    length: f64,
    count: f64,
    dimension: Dimension,
}

impl Violation for StepDoesNotDivide {
    const CODE: Code = E402;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            range,
            step,
            length,
            count,
            dimension,
        } = self;
        // Only sizes with few digits: a third of 1 mm is not suggested.
        let size = |steps: &f64| {
            let size = length / steps;
            let short = display::plain(size, dimension, 6);
            (short == display::plain(size, dimension, 14)).then_some(short)
        };
        let whole = |offset: u32| count.floor() + f64::from(offset);
        let larger = (0..1000)
            .map(|less| count.floor() - f64::from(less))
            .take_while(|steps| *steps >= 1.0)
            .find_map(|it| size(&it));
        let smaller = (1..1000).map(whole).find_map(|it| size(&it));
        let nearest = match (smaller, larger) {
            (Some(smaller), Some(larger)) => format!("write `step {smaller}` or `step {larger}`"),
            (Some(one), None) | (None, Some(one)) => format!("write `step {one}`"),
            (None, None) => {
                "change an end of the range by the remainder, or write another step".to_owned()
            }
        };
        Diagnostic::new(Self::CODE, "the step does not divide the range")
            .at(step, "remainder at the end")
            .at(range, "both ends are part of the range")
            .help(nearest)
    }
}

impl<'a> Checker<'a> {
    /// A number with its unit, in SI.
    pub fn number(&mut self, value: f64, unit: Option<&UnitToken>, span: Span) -> Option<Typed> {
        let Some(token) = unit else {
            return Some(Typed {
                bare: true,
                ..Typed::number(Formula::Constant(value), Dimension::NUMBER, span)
            });
        };
        let unit = self.unit(token, span)?;
        let formula = Formula::Constant(scaled(value, unit.factor) + unit.zero);
        Some(Typed {
            percent: token.node == "%",
            absolute: unit.zero != 0.0,
            ..Typed::number(formula, unit.dimension, span)
        })
    }

    /// `number`: the number before the unit, with the unit.
    fn unit(&mut self, token: &UnitToken, number: Span) -> Option<Unit> {
        let at = |start: usize, length: usize| {
            let start = token.span.start as usize + start;
            Span::new(token.span.file, start, start + length)
        };
        match unit::parse(&token.node) {
            Ok(unit) => Some(unit),
            // `2 kg*ratio`: the spaces around `*` are missing.
            Err(UnitError::Unknown { name, start }) if start > 0 && self.is_named(&name) => {
                let number = if number.start <= token.span.start {
                    number
                } else {
                    token.span
                };
                let before = self.text(Span {
                    end: token.span.end,
                    ..number
                });
                let (head, tail) = before.split_at(before.len() - (token.node.len() - start));
                let (head, operator) = head.split_at(head.len() - 1);
                let corrected = format!("{head} {operator} {tail}");
                self.fail(NameGluedToUnit {
                    name: &name,
                    span: at(start, name.len()),
                    corrected: &corrected,
                })
            }
            // `2 critical`: the operator is missing.
            Err(UnitError::Unknown { name, start: 0 })
                if number.start < token.span.start && self.is_value(&name) =>
            {
                let before = self.text(Span {
                    end: token.span.start,
                    ..number
                });
                let value = token.node.replace('*', " * ").replace('/', " / ");
                let corrected = format!("{} * {value}", before.trim_end());
                self.fail(ValueAfterNumber {
                    name: &name,
                    span: Span {
                        start: number.start,
                        ..token.span
                    },
                    corrected: &corrected,
                })
            }
            Err(UnitError::Unknown { name, start }) => {
                let alone = name == token.node && number.start <= token.span.start;
                let before = Span {
                    end: token.span.start,
                    ..number
                };
                let value = self.text(before).trim().parse().ok();
                let value = value.filter(|_| alone);
                self.fail(UnknownUnit {
                    name: &name,
                    number: value,
                    span: at(start, name.len()),
                })
            }
            Err(UnitError::Exponent { text, start }) => self.fail(UnitExponent {
                text: &text,
                span: at(start, text.len()),
            }),
            Err(UnitError::Absolute { name, start }) => {
                self.fail(AbsoluteTemperature::in_a_unit(at(start, name.len())))
            }
            Err(UnitError::TooLarge) => self.fail(ExponentTooLarge { span: token.span }),
        }
    }

    /// Whether a number of the plan has this name, and no unit has it in other languages.
    fn is_value(&self, name: &str) -> bool {
        let unit = CONVERTED.iter().any(|(unit, ..)| *unit == name)
            || SPELT_OUT
                .iter()
                .any(|(words, _)| words.split(' ').any(|word| word == name));
        let block = matches!(self.scope.meaning(name), Some(Meaning::Block(_)));
        !unit && !block && (name == "critical" || constant(name).is_some() || self.is_named(name))
    }

    /// Whether a value, a block or a field has this name.
    fn is_named(&self, name: &str) -> bool {
        let mut fields = self
            .scope
            .blocks
            .iter()
            .flat_map(|declared| &declared.block.fields);
        self.scope.meaning(name).is_some() || fields.any(|entry| entry.key.node == name)
    }

    /// A list, or a range with a step, as its entries.
    pub fn list(&mut self, expr: &'a Expr, context: Context) -> Option<Typed> {
        match &expr.kind {
            ExprKind::List { items, unit } => {
                self.entries(items, unit.as_ref(), expr.span, context)
            }
            _ => self.written_out(expr, None, context),
        }
    }

    fn entries(
        &mut self,
        items: &'a [Expr],
        unit: Option<&'a UnitToken>,
        span: Span,
        context: Context,
    ) -> Option<Typed> {
        if let Some(token) = unit {
            self.unit(token, token.span)?;
        }
        let checked: Vec<Option<Typed>> = items
            .iter()
            .map(|item| match &item.kind {
                ExprKind::Range { .. } => self.written_out(item, unit, context),
                _ => self.with_unit(item, unit, context),
            })
            .collect();
        let checked: Vec<Typed> = checked.into_iter().collect::<Option<_>>()?;
        let Some(first) = checked.first() else {
            return self.fail(EmptyList { span });
        };
        if let Some(other) = checked
            .iter()
            .find(|other| other.dimension != first.dimension)
        {
            return self.fail(Mismatched {
                operator: "[ ]",
                left: first,
                right: other,
            });
        }
        let absolute = checked.iter().any(|part| part.absolute);
        let (dimension, bare, percent) = (
            first.dimension,
            checked.iter().all(|part| part.bare),
            first.percent,
        );
        let parts: Vec<Formula> = checked.iter().flat_map(Typed::parts).collect();
        if parts.len() > MOST_ENTRIES {
            return self.fail(TooManyEntries {
                span,
                found: parts.len() as f64,
                most: MOST_ENTRIES,
            });
        }
        Some(Typed {
            formula: Formula::List(parts),
            shape: Shape::List,
            dimension,
            span,
            bare,
            percent,
            absolute,
        })
    }

    /// One number; a bare one takes `unit`.
    fn with_unit(
        &mut self,
        expr: &'a Expr,
        unit: Option<&UnitToken>,
        context: Context,
    ) -> Option<Typed> {
        let bare = literal(expr)
            .filter(|number| matches!(&number.kind, ExprKind::Number { unit: None, .. }));
        let typed = self.single(expr, context)?;
        match (unit, bare, typed.constant()) {
            (Some(token), Some(_), Some(value)) => {
                let number = self.number(value, Some(token), expr.span)?;
                Some(Typed {
                    span: expr.span,
                    ..number
                })
            }
            _ => Some(typed),
        }
    }

    /// Start, end and step of a range; bare numbers take the last unit, or `unit` if there is none.
    pub fn range_parts(
        &mut self,
        expr: &'a Expr,
        unit: Option<&'a UnitToken>,
        context: Context,
    ) -> Option<RangeParts> {
        let ExprKind::Range { start, end, step } = &expr.kind else {
            return None;
        };
        let last = unit_of(step.as_deref().unwrap_or(end)).or(unit);
        let start_value = self.with_unit(start, last, context);
        let end_value = self.with_unit(end, last, context);
        let step_value = match step {
            Some(step) => Some(self.with_unit(step, last, context)?),
            None => None,
        };
        let (start_value, end_value) = (start_value?, end_value?);
        if let Some(step) = step_value.as_ref().filter(|step| step.absolute) {
            return self.fail(AbsoluteTemperature::of_step(step.span));
        }
        for other in [Some(&end_value), step_value.as_ref()]
            .into_iter()
            .flatten()
        {
            if other.dimension != start_value.dimension {
                return self.fail(Mismatched {
                    operator: "..",
                    left: &start_value,
                    right: other,
                });
            }
        }
        Some(RangeParts {
            start: start_value,
            end: end_value,
            step: step_value,
        })
    }

    /// The entries of a range: start + i·step, both ends included.
    fn written_out(
        &mut self,
        expr: &'a Expr,
        unit: Option<&'a UnitToken>,
        context: Context,
    ) -> Option<Typed> {
        let parts = self.range_parts(expr, unit, context)?;
        let Some(step) = &parts.step else {
            return self.fail(RangeWithoutStep {
                span: expr.span,
                text: self.text(expr.span),
            });
        };
        let known = (
            parts.start.constant(),
            parts.end.constant(),
            step.constant(),
        );
        let (Some(start), Some(end), Some(size)) = known else {
            return self.fail(RangeNotConstant { span: expr.span });
        };
        let count = (end - start) / size;
        if size == 0.0 || count < 0.0 {
            return self.fail(StepLeadsAway {
                span: step.span,
                text: self.text(step.span),
                zero: size == 0.0,
            });
        }
        // The range must be a multiple of the step, to 1e-9 of the number of steps.
        if (count - count.round()).abs() > 1e-9 * count.abs().max(1.0) {
            return self.fail(StepDoesNotDivide {
                range: expr.span,
                step: step.span,
                length: end - start,
                count,
                dimension: parts.start.dimension,
            });
        }
        let count = count.round();
        if count + 1.0 > MOST_ENTRIES as f64 {
            return self.fail(TooManyEntries {
                span: expr.span,
                found: count + 1.0,
                most: MOST_ENTRIES,
            });
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 0 and 100,000"
        )]
        let count = count as usize;
        let at = |i: usize| {
            if i == count {
                end
            } else {
                start + i as f64 * size
            }
        };
        let entries = (0..=count).map(|i| Formula::Constant(at(i))).collect();
        let bare = parts.start.bare && parts.end.bare && step.bare;
        let dimension = parts.start.dimension;
        Some(Typed {
            formula: Formula::List(entries),
            shape: Shape::List,
            dimension,
            span: expr.span,
            bare,
            percent: false,
            absolute: parts.start.absolute,
        })
    }
}

/// The unit at the end of a literal.
fn unit_of(expr: &Expr) -> Option<&UnitToken> {
    literal(expr).and_then(|number| {
        if let ExprKind::Number { unit, .. } = &number.kind {
            unit.as_ref()
        } else {
            None
        }
    })
}

/// `value · factor`, by division where the factor is the reciprocal of a whole number: 51 mm is then exactly 0.051.
pub fn scaled(value: f64, factor: f64) -> f64 {
    let inverse = (1.0 / factor).round();
    if factor < 1.0 && inverse < 1e15 && ((inverse * factor) - 1.0).abs() < 4.0 * f64::EPSILON {
        value / inverse
    } else {
        value * factor
    }
}
