//! Expressions: names resolved, units converted, dimensions inferred. In: an expression of the syntax tree and its
//! context. Out: a [`Typed`] formula in SI, or None where an error has been reported, here or earlier.

use crate::check::checker::{Checker, Context, Shape, Typed, literal};
use crate::check::declarations::specimen::frame;
use crate::check::violations::{
    AbsoluteTemperature, DistributionMisplaced, ExponentTooLarge, ListForNumber, Mismatched,
    NoSuchEntry, NotFinite, ProbabilityMisplaced, StepsMisplaced,
};
use crate::check::wording::{article, example, shown};
use crate::codes::{E301, E302, E304, E305};
use crate::syntax::ast::{BinaryOperator, Expr, ExprKind};
use psd_plan::ProcedureBlock;
use psd_plan::formula::{Formula, Operator};
use psd_plan::schema::{self, Kind};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::unit::{self, PREFIXES, STANDARD_GRAVITY, UNITS};
use psd_text::units::{Dimension, Exponent};

/// Bytes of the stack that one operator, with all between it and the next one, never needs.
const STACK_LEFT: usize = 256 << 10;
/// Bytes that are added where less is left.
const STACK_ADDED: usize = 2 << 20;

#[derive(Violation)]
#[violation(E304, "expected a number, found a string")]
#[help("write the number without quotes")]
struct TextForNumber {
    #[label("a string")]
    span: Span,
}

#[derive(Violation)]
#[violation(E304, "`{operator}` does not give a number")]
#[help("write conditions in `require` only; join two of them with `and`")]
struct ConditionForNumber<'a> {
    #[label("a condition")]
    span: Span,
    operator: &'a str,
}

/// `corrected`: the power times the unit that its exponent has, if the exponent is one number.
struct ExponentWithUnit<'a> {
    exponent: &'a Typed,
    corrected: Option<String>,
    whole: Span,
}

impl Violation for ExponentWithUnit<'_> {
    const CODE: Code = E305;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            exponent,
            corrected,
            whole,
        } = self;
        let found = article(exponent.dimension);
        let (span, help) = match corrected {
            Some(corrected) => (
                whole,
                format!("write `{corrected}`: a unit belongs to the number before it"),
            ),
            None => (
                exponent.span,
                "write a number without a unit, as in `x^2`".to_owned(),
            ),
        };
        Diagnostic::new(
            Self::CODE,
            format!("an exponent must be a number, found {found}"),
        )
        .at(span, format!("the exponent is {found}"))
        .help(help)
    }
}

#[derive(Violation)]
#[violation(E305, "the exponent of {} must be known before the run", article(base))]
#[help("write a number, as in `x^2`")]
struct ExponentNotConstant {
    #[label("known only after the run")]
    span: Span,
    base: Dimension,
}

#[derive(Violation)]
#[violation(E305, "the exponent of a quantity must be a simple fraction")]
#[help("write it as in `x^1.5` or `x^(1 / 3)`")]
struct ExponentNotRational {
    #[label("not a fraction with a denominator up to 12")]
    span: Span,
}

#[derive(Violation)]
#[violation(E304, "a number has no entries")]
#[help("remove the index")]
struct IndexOfNumber {
    #[label("one number")]
    span: Span,
}

#[derive(Violation)]
#[violation(E304, "a list index must be a whole number from 0")]
#[help("write it as in `list[0]`")]
struct IndexNotWhole {
    #[label("invalid index")]
    span: Span,
}

/// `entries`: a list or range, whose unit is written once, at its end.
struct MissingUnitOfEntries<'a> {
    entries: &'a str,
    span: Span,
    wanted: Dimension,
    wanted_by: &'a str,
}

impl Violation for MissingUnitOfEntries<'_> {
    const CODE: Code = E302;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            entries,
            span,
            wanted,
            wanted_by,
        } = self;
        let unit = wanted.usual_unit();
        let fits = entries.len() <= 48 && !entries.contains('\n');
        let help = if fits {
            format!("write the unit after the last number or the `]`: `{entries} {unit}`")
        } else {
            format!("write the unit after the last number or the `]`, as in `[1, 2, 5] {unit}`")
        };
        Diagnostic::new(
            Self::CODE,
            format!(
                "`{wanted_by}` requires {}, found numbers without a unit",
                article(wanted)
            ),
        )
        .at(span, "no unit")
        .help(help)
    }
}

#[derive(Violation)]
#[violation(
    E302,
    "`{wanted_by}` requires {}, found a number without a unit",
    article(wanted)
)]
#[help("{}", with_unit(text, number, wanted))]
struct MissingUnit<'a> {
    text: &'a str,
    #[label("`{text}` has no unit")]
    span: Span,
    number: Option<&'a str>,
    wanted: Dimension,
    wanted_by: &'a str,
}

fn with_unit(text: &str, number: Option<&str>, wanted: Dimension) -> String {
    match (number, wanted) {
        (Some(number), Dimension::ANGLE) => format!("write `{number} deg`, or `{number} rad`"),
        (None, Dimension::ANGLE) => format!("write `({text}) * 1 rad`, if it is in radians"),
        _ => format!("write the unit, such as `{}`", example(number, wanted)),
    }
}

/// `kN/m` for `kN`, where `N/m` is required: the suggestion must not be a thousandth of the intended value.
fn of_the_same_size(written: &str, wanted: &str) -> Option<String> {
    let first = |unit: &str| unit.find(['*', '/', '^']).unwrap_or(unit.len());
    let parts = |name: &str| {
        let whole = UNITS
            .iter()
            .find(|unit| unit.symbol == name)
            .map(|unit| ("", unit.symbol));
        let symbols = UNITS
            .iter()
            .filter(|unit| unit.prefixes)
            .map(|unit| unit.symbol);
        let prefixed =
            symbols.flat_map(|symbol| PREFIXES.iter().map(move |(prefix, _)| (*prefix, symbol)));
        whole.or_else(|| {
            prefixed
                .into_iter()
                .find(|(prefix, symbol)| format!("{prefix}{symbol}") == name)
        })
    };
    let (prefix, symbol) = parts(&written[..first(written)])?;
    let (head, rest) = wanted.split_at(first(wanted));
    parts(head)
        .filter(|(_, base)| *base == symbol)
        .map(|_| format!("{prefix}{symbol}{rest}"))
}

/// An expression as written; for a literal its number and its unit.
struct WrittenValue<'t> {
    text: &'t str,
    span: Span,
    number: Option<&'t str>,
    unit: Option<&'t str>,
    /// In SI units, if it is known before the run.
    value: Option<f64>,
    /// `107 kg / 100` for `107 / 100 kg`: the unit is that of the divisor.
    unit_of_dividend: Option<String>,
}

/// The quotient of two numbers with the unit of the divisor at the dividend, if that unit has the dimension.
fn unit_of_dividend(written: &Expr, wanted: Dimension) -> Option<String> {
    let ExprKind::Binary {
        operator,
        left,
        right,
    } = &written.kind
    else {
        return None;
    };
    let (
        ExprKind::Number {
            text, unit: None, ..
        },
        ExprKind::Number {
            text: divisor,
            unit: Some(unit),
            ..
        },
    ) = (&left.kind, &right.kind)
    else {
        return None;
    };
    let dimension = unit::parse(&unit.node).ok()?.dimension;
    let fits = operator.node == BinaryOperator::Divide && dimension == wanted;
    fits.then(|| format!("{text} {} / {divisor}", unit.node))
}

/// The mass of a weight, or the weight of a mass: what to write instead of `text`, which has the other dimension and this value in SI
/// units.
fn by_gravity(text: &str, value: f64, found: Dimension, wanted: Dimension) -> Option<String> {
    match (found, wanted) {
        (Dimension::FORCE, Dimension::MASS) => {
            let mass = shown(value / STANDARD_GRAVITY, wanted);
            Some(format!("write `{mass}`, the mass of a weight of {text}"))
        }
        (Dimension::MASS, Dimension::FORCE) => {
            let weight = shown(value * STANDARD_GRAVITY, wanted);
            Some(format!("write `{weight}`, the weight of {text}"))
        }
        _ => None,
    }
}

struct WrongDimension<'a> {
    written: &'a WrittenValue<'a>,
    found: Dimension,
    wanted: Dimension,
    wanted_by: &'a str,
}

impl Violation for WrongDimension<'_> {
    const CODE: Code = E301;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            written,
            found,
            wanted,
            wanted_by,
        } = self;
        let WrittenValue {
            text,
            span,
            number,
            unit,
            value,
            ref unit_of_dividend,
        } = *written;
        let weighed = number.and(value);
        let weighed = weighed.and_then(|value| by_gravity(text, value, found, wanted));
        let moved = unit_of_dividend
            .as_ref()
            .map(|quotient| format!("write `{quotient}`: a unit belongs to the number before it"));
        let certain = weighed.or(moved);
        let help = match (number, wanted) {
            _ if certain.is_some() => certain.unwrap_or_default(),
            (Some(number), Dimension::ACCELERATION) if text == format!("{number} g") => {
                format!(
                    "write `{number} gn` for a multiple of standard gravity (9.80665 m/s^2); `g` is the gram"
                )
            }
            (Some(_), Dimension::DAMPING) if found == Dimension::NUMBER => {
                format!(
                    "write a damping coefficient, such as `2 * {text} * sqrt(k * m)`; an impact also takes `damping_ratio = {text}`"
                )
            }
            (Some(number), _) => {
                // The number is kept with a unit of the same size only: beside another one it is a guess.
                let fits = unit
                    .and_then(|unit| of_the_same_size(unit, &wanted.usual_unit()))
                    .map(|unit| format!("{number} {unit}"));
                format!(
                    "write {}, such as `{}`",
                    article(wanted),
                    fits.unwrap_or_else(|| example(None, wanted))
                )
            }
            (None, Dimension::ANGLE) if found == Dimension::NUMBER => {
                with_unit(text, number, wanted)
            }
            (None, Dimension::NUMBER) => format!(
                "divide `{text}` by {}, so that a number remains",
                article(found)
            ),
            (None, _) => {
                format!(
                    "change `{text}` so that it gives {}, with the unit `{}`",
                    article(wanted),
                    wanted.usual_unit()
                )
            }
        };
        Diagnostic::new(
            Self::CODE,
            format!(
                "`{wanted_by}` requires {}, found {}",
                article(wanted),
                article(found)
            ),
        )
        .at(span, format!("this is {}", article(found)))
        .help(help)
    }
}

impl<'a> Checker<'a> {
    /// The value of an expression. The stack grows as deep as names and operators lead: a name leads to the expression of its value.
    pub fn value(&mut self, expr: &'a Expr, context: Context) -> Option<Typed> {
        let mut typed =
            stacker::maybe_grow(STACK_LEFT, STACK_ADDED, || self.value_inner(expr, context))?;
        typed.span = expr.span;
        self.fold(typed)
    }

    /// The value of an expression that must be one number.
    pub fn single(&mut self, expr: &'a Expr, context: Context) -> Option<Typed> {
        let typed = self.value(expr, context)?;
        if typed.shape == Shape::List {
            return self.fail(ListForNumber { span: expr.span });
        }
        Some(typed)
    }

    fn value_inner(&mut self, expr: &'a Expr, context: Context) -> Option<Typed> {
        match &expr.kind {
            ExprKind::Faulty => None,
            ExprKind::Number { value, unit, .. } => self.number(*value, unit.as_ref(), expr.span),
            ExprKind::Text(_) => self.fail(TextForNumber { span: expr.span }),
            ExprKind::Name(name) => self.name(name, expr.span, context),
            ExprKind::Field { base, name } => self.field_of(base, name, expr.span, context),
            ExprKind::Parenthesised(inner) => self.value(inner, context),
            ExprKind::List { .. } | ExprKind::Range { .. } => self.list(expr, context),
            ExprKind::Call { name, arguments } => self.call(name, arguments, expr.span, context),
            ExprKind::Index { base, index } => self.index(base, index, context),
            ExprKind::Negate(inner) => {
                // `-5 degC` is 268.15 K.
                if let ExprKind::Number { value, unit, .. } = &inner.kind {
                    return self.number(-value, unit.as_ref(), expr.span);
                }
                let inner = self.single(inner, context)?;
                if inner.absolute {
                    return self.fail(AbsoluteTemperature::of_product(expr.span));
                }
                Some(Typed {
                    formula: Formula::Negate(Box::new(inner.formula.clone())),
                    ..inner
                })
            }
            ExprKind::Binary {
                operator,
                left,
                right,
            } => {
                if operator.node == BinaryOperator::DrawnFrom {
                    return self.fail(DistributionMisplaced {
                        span: operator.span,
                    });
                }
                if is_logical(operator.node) {
                    return self.fail(ConditionForNumber {
                        span: expr.span,
                        operator: operator.node.symbol(),
                    });
                }
                let (left_value, right_value) =
                    (self.single(left, context), self.single(right, context));
                let (left_value, right_value) = (left_value?, right_value?);
                match operator.node {
                    BinaryOperator::Power => self.power(left_value, right_value, left, right),
                    BinaryOperator::Add => self.sum(Operator::Add, "+", left_value, right_value),
                    BinaryOperator::Subtract => {
                        self.sum(Operator::Subtract, "-", left_value, right_value)
                    }
                    BinaryOperator::Divide => {
                        self.product(Operator::Divide, left_value, right_value, expr.span)
                    }
                    _ => self.product(Operator::Multiply, left_value, right_value, expr.span),
                }
            }
            ExprKind::Within { .. } => self.fail(ConditionForNumber {
                span: expr.span,
                operator: "within",
            }),
            ExprKind::Member { .. } => self.fail(ProbabilityMisplaced { span: expr.span }),
            ExprKind::Stepped { .. } => self.fail(StepsMisplaced { span: expr.span }),
        }
    }

    fn sum(
        &mut self,
        operator: Operator,
        symbol: &str,
        left: Typed,
        right: Typed,
    ) -> Option<Typed> {
        if left.dimension != right.dimension {
            return self.fail(Mismatched {
                operator: symbol,
                left: &left,
                right: &right,
            });
        }
        let absolute = match (operator, left.absolute, right.absolute) {
            (Operator::Add, true, true) => {
                return self.fail(AbsoluteTemperature::of_sum(left.span.to(right.span)));
            }
            (Operator::Subtract, false, true) => {
                return self.fail(AbsoluteTemperature::of_difference(right.span));
            }
            (_, left, right) => left != right,
        };
        let (bare, percent) = (left.bare && right.bare, left.percent && right.percent);
        let formula = Formula::Binary(operator, Box::new(left.formula), Box::new(right.formula));
        Some(Typed {
            bare,
            percent,
            absolute,
            ..Typed::number(formula, left.dimension, left.span)
        })
    }

    fn product(
        &mut self,
        operator: Operator,
        left: Typed,
        right: Typed,
        span: Span,
    ) -> Option<Typed> {
        if left.absolute || right.absolute {
            let side = if left.absolute { &left } else { &right };
            return self.fail(AbsoluteTemperature::of_product(side.span));
        }
        let dimension = match operator {
            Operator::Divide => left.dimension.over(right.dimension),
            _ => left.dimension.times(right.dimension),
        };
        let Some(dimension) = dimension else {
            return self.fail(ExponentTooLarge { span });
        };
        let bare = left.bare && right.bare;
        let formula = Formula::Binary(operator, Box::new(left.formula), Box::new(right.formula));
        Some(Typed {
            bare,
            ..Typed::number(formula, dimension, left.span)
        })
    }

    fn power(
        &mut self,
        base: Typed,
        exponent: Typed,
        base_written: &Expr,
        written: &Expr,
    ) -> Option<Typed> {
        if base.absolute {
            return self.fail(AbsoluteTemperature::of_product(base.span));
        }
        if exponent.dimension != Dimension::NUMBER {
            let corrected = match &written.kind {
                ExprKind::Number {
                    text,
                    unit: Some(unit),
                    ..
                } => Some(format!(
                    "{}^{text} * 1 {}",
                    self.text(base_written.span),
                    unit.node
                )),
                _ => None,
            };
            return self.fail(ExponentWithUnit {
                exponent: &exponent,
                corrected,
                whole: base_written.span.to(written.span),
            });
        }
        let dimension = if base.dimension == Dimension::NUMBER {
            Dimension::NUMBER
        } else {
            let Some(value) = exponent.constant() else {
                return self.fail(ExponentNotConstant {
                    span: written.span,
                    base: base.dimension,
                });
            };
            let power =
                Exponent::from_decimal(value).and_then(|power| base.dimension.to_power(power));
            let Some(dimension) = power else {
                return self.fail(ExponentNotRational { span: written.span });
            };
            dimension
        };
        let bare = base.bare;
        let formula = Formula::Binary(
            Operator::Power,
            Box::new(base.formula),
            Box::new(exponent.formula),
        );
        Some(Typed {
            bare,
            ..Typed::number(formula, dimension, base.span)
        })
    }

    fn index(&mut self, base: &'a Expr, index: &'a Expr, context: Context) -> Option<Typed> {
        let (list, at) = (self.value(base, context), self.single(index, context));
        let (list, at) = (list?, at?);
        if list.shape == Shape::Number {
            return self.fail(IndexOfNumber { span: base.span });
        }
        let index_in_list = at
            .constant()
            .filter(|at| at.fract() == 0.0 && (0.0..1e6).contains(at));
        let (Some(index_in_list), Dimension::NUMBER) = (index_in_list, at.dimension) else {
            return self.fail(IndexNotWhole { span: index.span });
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole and between 0 and a million"
        )]
        let index_in_list = index_in_list as usize;
        if let Formula::List(parts) = &list.formula {
            let Some(part) = parts.get(index_in_list) else {
                return self.fail(NoSuchEntry {
                    span: index.span,
                    entry: index_in_list,
                    length: parts.len(),
                });
            };
            return Some(Typed {
                shape: Shape::Number,
                formula: part.clone(),
                ..list
            });
        }
        if let Some(length) = self.length_of(&list.formula)
            && index_in_list >= length
        {
            return self.fail(NoSuchEntry {
                span: index.span,
                entry: index_in_list,
                length,
            });
        }
        if let Some(reference) = list.formula.as_result() {
            self.list_entries_read
                .push((reference, index_in_list, index.span));
        }
        Some(Typed {
            shape: Shape::Number,
            formula: Formula::Index(Box::new(list.formula.clone()), index_in_list),
            ..list
        })
    }

    /// Length of a list of results, where the plan alone determines it: a frame has one entry for each storey.
    fn length_of(&mut self, list: &Formula) -> Option<usize> {
        let reference = list.as_result()?;
        let block = self.procedure(reference.procedure)?;
        let kind = self.scope.blocks[block].kind;
        // A condition on an impact reads the results of that impact.
        let impact = schema::block(Kind::Procedure(ProcedureBlock::Impact));
        let result = kind
            .result(reference.name)
            .or_else(|| impact.result(reference.name))?;
        if kind.kind != Kind::Procedure(ProcedureBlock::Shake) && !result.of_storey {
            return None;
        }
        let specimen = self.tested(block)?;
        let frame = frame::frame(self, specimen)?;
        Some(if result.of_each_member && frame.has_elements() {
            frame.elements.len()
        } else {
            frame.degrees_of_freedom()
        })
    }

    /// Folds a number that is known before the run into a constant; one that is not finite is an error.
    fn fold(&mut self, typed: Typed) -> Option<Typed> {
        if typed.shape == Shape::List
            || matches!(typed.formula, Formula::Constant(_))
            || typed.is_late()
        {
            return Some(typed);
        }
        match typed.constant() {
            // A number with an uncertainty keeps its formula.
            Some(_) if typed.formula.is_uncertain() => Some(typed),
            Some(value) => Some(Typed {
                formula: Formula::Constant(value),
                ..typed
            }),
            None => self.fail(NotFinite { span: typed.span }),
        }
    }

    /// Checks the dimension of a value; `wanted_by` is the field or argument.
    pub fn expect(
        &mut self,
        typed: Typed,
        dimension: Dimension,
        wanted_by: &str,
        written: &Expr,
    ) -> Option<Typed> {
        if typed.dimension == dimension {
            return Some(typed);
        }
        let number = literal(written).and_then(|expr| {
            if let ExprKind::Number { text, .. } = &expr.kind {
                Some(text.as_str())
            } else {
                None
            }
        });
        let text = self.text(written.span);
        let entries = matches!(written.kind, ExprKind::List { .. } | ExprKind::Range { .. });
        let diagnostic = if typed.bare && entries && dimension != Dimension::NUMBER {
            MissingUnitOfEntries {
                entries: text,
                span: written.span,
                wanted: dimension,
                wanted_by,
            }
            .diagnostic()
        } else if typed.bare && dimension != Dimension::NUMBER {
            MissingUnit {
                text,
                span: written.span,
                number,
                wanted: dimension,
                wanted_by,
            }
            .diagnostic()
        } else {
            let unit = literal(written).and_then(|expr| match &expr.kind {
                ExprKind::Number { unit, .. } => unit.as_ref().map(|unit| unit.node.as_str()),
                _ => None,
            });
            WrongDimension {
                written: &WrittenValue {
                    text,
                    span: written.span,
                    number,
                    unit,
                    value: typed.constant(),
                    unit_of_dividend: unit_of_dividend(written, dimension),
                },
                found: typed.dimension,
                wanted: dimension,
                wanted_by,
            }
            .diagnostic()
        };
        self.fail(diagnostic)
    }
}

const fn is_logical(operator: BinaryOperator) -> bool {
    use BinaryOperator::{And, Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    matches!(
        operator,
        And | Less | LessEqual | Greater | GreaterEqual | Equal | NotEqual
    )
}
