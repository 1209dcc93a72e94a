//! Requirements that the plan alone decides: those that no run can meet (E667), and those that every run meets (W732 and W742). In: the
//! requirements, the procedures, the limits. Out: diagnostics. It knows no run.

use std::collections::BTreeMap;

use crate::check::checker::Checker;
use crate::check::wording::shown;
use crate::codes::{E667, W732, W742};
use crate::syntax::ast::{Expr, ExprKind};
use psd_physics::structure::assemblies::Assemblies;
use psd_plan::formula::{Formula, Function, ProcedureId, ResultPart, ResultReference};
use psd_plan::schema::{Kind, Possible};
use psd_plan::{
    Comparison, Condition, Interval, Limits, Procedure, ProcedureKind, Requirement, Test,
};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;

/// One end of an interval: the value, and whether it is excluded.
type End = (f64, bool);

/// An interval of values.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Values {
    low: End,
    high: End,
}

impl Values {
    const ALL: Self = Self {
        low: (f64::NEG_INFINITY, true),
        high: (f64::INFINITY, true),
    };

    const fn closed(low: f64, high: f64) -> Self {
        Self {
            low: (low, false),
            high: (high, false),
        }
    }

    fn is_empty(self) -> bool {
        let (low, high) = (self.low, self.high);
        low.0 > high.0 || (low.0 >= high.0 && (low.1 || high.1))
    }

    /// Whether `low` is the narrower one of two lower ends.
    fn narrows_low(low: End, other: End) -> bool {
        low.0 > other.0 || (low.0 >= other.0 && low.1 && !other.1)
    }

    /// Whether `high` is the narrower one of two upper ends.
    fn narrows_high(high: End, other: End) -> bool {
        high.0 < other.0 || (high.0 <= other.0 && high.1 && !other.1)
    }

    fn and(self, other: Self) -> Self {
        let low = Self::narrows_low(other.low, self.low);
        let high = Self::narrows_high(other.high, self.high);
        Self {
            low: if low { other.low } else { self.low },
            high: if high { other.high } else { self.high },
        }
    }

    fn contains(self, other: Self) -> bool {
        self.and(other) == other
    }
}

/// The values of the left side that meet a condition whose limit is known before the run. None if they are no interval.
fn allowed(test: &Test) -> Option<Values> {
    match test {
        Test::Compare { comparison, limit } => {
            let limit = limit.constant()?;
            let all = Values::ALL;
            Some(match comparison {
                Comparison::Less => Values {
                    high: (limit, true),
                    ..all
                },
                Comparison::LessEqual => Values {
                    high: (limit, false),
                    ..all
                },
                Comparison::Greater => Values {
                    low: (limit, true),
                    ..all
                },
                Comparison::GreaterEqual => Values {
                    low: (limit, false),
                    ..all
                },
                Comparison::Equal => Values::closed(limit, limit),
                Comparison::NotEqual => return None,
            })
        }
        Test::Within {
            target,
            tolerance,
            relative,
        } => {
            let (target, tolerance) = (target.constant()?, tolerance.constant()?);
            let width = if *relative {
                tolerance * target.abs()
            } else {
                tolerance
            };
            Some(Values::closed(target - width, target + width))
        }
    }
}

/// The result whose values a formula has: the result itself, an entry of a list, or the largest, smallest or mean one.
fn read(formula: &Formula) -> Option<ResultReference> {
    match formula {
        Formula::Result(reference) if reference.part == ResultPart::Value => Some(*reference),
        Formula::Index(list, _) => read(list),
        Formula::Call(Function::Max | Function::Min | Function::Mean, parts) => match &parts[..] {
            [list] => read(list),
            _ => None,
        },
        _ => None,
    }
}

/// Whether an expression names anything: a name may have another value in another run.
fn names_something(expr: &Expr) -> bool {
    let own = || {
        !matches!(
            expr.kind,
            ExprKind::Number { .. } | ExprKind::Text(_) | ExprKind::Faulty
        )
    };
    expr.operands()
        .map_or_else(own, |operands| operands.into_iter().any(names_something))
}

/// The conditions on one result so far: the values that meet all of them, and the conditions that give its ends.
struct Together {
    values: Values,
    low: Span,
    high: Span,
}

/// A requirement on numbers of the plan alone. `met`: whether they meet it.
fn without_result(condition: &str, met: bool, span: Span) -> Diagnostic {
    let (code, always) = if met {
        (W732, "always")
    } else {
        (E667, "never")
    };
    Diagnostic::new(
        code,
        format!("`{condition}` is {always} met: it reads no result"),
    )
    .at(span, "decided before the run")
    .help("compare a result with a limit, as in `hit.max_displacement < 45 mm`")
}

/// `other`: the requirement that excludes the one at `span`.
struct ContradictoryConditions {
    span: Span,
    other: Span,
}

impl Violation for ContradictoryConditions {
    const CODE: Code = E667;

    fn diagnostic(self) -> Diagnostic {
        let Self { span, other } = self;
        let diagnostic = Diagnostic::new(
            Self::CODE,
            "no run meets these conditions together: no value is within both",
        )
        .at(span, "excludes the other condition");
        let diagnostic = if other == span {
            diagnostic
        } else {
            diagnostic.at(other, "the other condition")
        };
        diagnostic.help("change one of the limits, or remove one of the conditions")
    }
}

/// Reports requirements that are decided before the run. `stays_positive`: whether a procedure
/// certainly moves the specimen to no negative displacement.
pub fn check(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    requirements: &[Requirement],
    limits: &Limits,
    stays_positive: fn(&ProcedureKind) -> bool,
) {
    let mut together: BTreeMap<(ProcedureId, &str), Together> = BTreeMap::new();
    for (index, requirement) in requirements.iter().enumerate() {
        let written = checker.scope.requirements[index].condition;
        let span = written.span;
        for condition in &requirement.conditions {
            if let Some(diagnostic) = exactly(condition, span) {
                checker.diagnostics.push(diagnostic);
                continue;
            }
            let Some(allowed) = allowed(&condition.test) else {
                continue;
            };
            if let Some(value) = condition.value.constant() {
                if !names_something(written) {
                    let met = allowed.contains(Values::closed(value, value));
                    checker
                        .diagnostics
                        .push(without_result(&condition.text, met, span));
                }
                continue;
            }
            let Some(found) = possible(checker, procedures, condition, limits, stays_positive)
            else {
                continue;
            };
            if let Some(diagnostic) = alone(condition, allowed, found, span) {
                checker.diagnostics.push(diagnostic);
                continue;
            }
            let Some(result) = condition
                .value
                .as_result()
                .filter(|it| it.part == ResultPart::Value)
            else {
                continue;
            };
            let all = Together {
                values: Values::ALL,
                low: span,
                high: span,
            };
            let before = together
                .entry((result.procedure, result.name))
                .or_insert(all);
            let both = before.values.and(allowed);
            if both.is_empty() {
                let against_low = allowed
                    .and(Values {
                        low: before.values.low,
                        ..Values::ALL
                    })
                    .is_empty();
                let other = if against_low { before.low } else { before.high };
                checker.report(ContradictoryConditions { span, other });
                continue;
            }
            if both.low != before.values.low {
                before.low = span;
            }
            if both.high != before.values.high {
                before.high = span;
            }
            before.values = both;
        }
    }
}

/// The values that the left side of a condition can have: at least 0, and at most by the limits. None if it is not one result.
fn possible(
    checker: &Checker,
    procedures: &[(usize, Option<Procedure>)],
    condition: &Condition,
    limits: &Limits,
    stays_positive: fn(&ProcedureKind) -> bool,
) -> Option<Found> {
    let reference = read(&condition.value)?;
    let (block, _) = procedures.get(reference.procedure.0)?;
    let result = checker.scope.blocks[*block].kind.result(reference.name)?;
    let zero = Values {
        low: (0.0, false),
        ..Values::ALL
    };
    // The limits of the axes do not bound floors that are above computed ones.
    let displacement = if tests_a_part(checker, procedures, reference.procedure) {
        Interval::ALL
    } else {
        limits.displacement
    };
    let before = &procedures[..reference.procedure.0];
    let starts_positive = || {
        before.iter().all(|(_, procedure)| {
            let kind = procedure.as_ref().map(|procedure| &procedure.kind);
            kind.is_some_and(stays_positive)
        })
    };
    Some(match result.possible {
        Possible::Any => Found {
            by_nature: Values::ALL,
            limit: f64::INFINITY,
        },
        Possible::NotNegative => Found {
            by_nature: zero,
            limit: f64::INFINITY,
        },
        Possible::PeakDisplacement => Found {
            by_nature: zero,
            limit: displacement.low.abs().max(displacement.high.abs()),
        },
        Possible::LargestDisplacement => Found {
            by_nature: if starts_positive() { zero } else { Values::ALL },
            limit: displacement.high,
        },
    })
}

/// Whether a procedure tests a frame of which the rig carries a part.
fn tests_a_part(
    checker: &Checker,
    procedures: &[(usize, Option<Procedure>)],
    procedure: ProcedureId,
) -> bool {
    let tested = || {
        let kind = &procedures.get(procedure.0)?.1.as_ref()?.kind;
        let (block, _) = checker
            .scope
            .of_kind(Kind::Specimen)
            .nth(kind.specimen()?)?;
        Assemblies::of(checker.frames.get(&block)?.value.as_deref()?)
    };
    tested().is_some()
}

/// A measured value compared with one exact number. `met`: whether every run meets it.
#[derive(Violation)]
#[violation(
    W742,
    "`{condition}` is {} met: it compares a measured value with one exact number",
    if met { "always" } else { "never" }
)]
#[help(
    "{}",
    if met {
        "write a limit with `<` or `>`".to_owned()
    } else {
        format!("write a tolerance, such as `{value} within 5 % of {limit}`, or a limit with `<` or `>`")
    }
)]
struct ExactNumber<'a> {
    condition: &'a str,
    met: bool,
    value: &'a str,
    limit: &'a str,
    #[label("an exact number")]
    span: Span,
}

/// A condition with `==` or `!=` on a result with a dimension. A count or a ratio can be exact.
fn exactly(condition: &Condition, span: Span) -> Option<Diagnostic> {
    let Test::Compare { comparison, .. } = &condition.test else {
        return None;
    };
    let (met, sign) = match comparison {
        Comparison::Equal => (false, "=="),
        Comparison::NotEqual => (true, "!="),
        _ => return None,
    };
    let result = read(&condition.value)?;
    let (left, right) = condition.text.split_once(sign)?;
    let (value, limit) = if left.contains(result.name) {
        (left, right)
    } else {
        (right, left)
    };
    (condition.dimension != Dimension::NUMBER).then(|| {
        ExactNumber {
            condition: &condition.text,
            met,
            value: value.trim(),
            limit: limit.trim(),
            span,
        }
        .diagnostic()
    })
}

/// The values that a result can have.
#[derive(Clone, Copy)]
struct Found {
    /// Whatever the limits.
    by_nature: Values,
    /// A run that exceeds this displacement \[m\] is stopped.
    limit: f64,
}

#[derive(Violation)]
#[violation(E667, "no run meets `{condition}`: this result is never below 0")]
#[help("write a limit that a run can meet")]
struct NeverNegative<'a> {
    condition: &'a str,
    #[label("never met")]
    span: Span,
}

/// `limit`: the largest displacement \[m\] that the limits allow.
#[derive(Violation)]
#[violation(
    E667,
    "no run meets `{condition}`: a run that exceeds {limit} is stopped",
    limit = shown(limit, Dimension::LENGTH)
)]
#[help(
    "write a value below {limit}, or widen `displacement` in `limits` if the rig and the specimen allow it",
    limit = shown(limit, Dimension::LENGTH)
)]
struct BeyondTheLimit<'a> {
    condition: &'a str,
    limit: f64,
    #[label("never met")]
    span: Span,
}

#[derive(Violation)]
#[violation(W732, "every run meets `{condition}`: this result is never below 0")]
#[help("write a limit that a run can miss, or remove the requirement")]
struct AlwaysMet<'a> {
    condition: &'a str,
    #[label("always met")]
    span: Span,
}

/// A condition that no run, or every run, meets. A run that a limit stops meets none.
fn alone(condition: &Condition, allowed: Values, found: Found, span: Span) -> Option<Diagnostic> {
    let limited = Values {
        high: (found.limit, false),
        ..Values::ALL
    };
    if allowed.and(found.by_nature).is_empty() {
        return Some(
            NeverNegative {
                condition: &condition.text,
                span,
            }
            .diagnostic(),
        );
    }
    if allowed.and(limited).is_empty() {
        let limit = found.limit;
        return Some(
            BeyondTheLimit {
                condition: &condition.text,
                limit,
                span,
            }
            .diagnostic(),
        );
    }
    let some = found.by_nature != Values::ALL;
    (some && allowed.contains(found.by_nature)).then(|| {
        AlwaysMet {
            condition: &condition.text,
            span,
        }
        .diagnostic()
    })
}
