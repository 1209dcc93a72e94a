//! `require "label" condition`: comparisons and `within`, one condition for each part joined with `and`.

use crate::check::checker::{Checker, Context, Reads, Typed};
use crate::check::violations::{DistributionMisplaced, Mismatched, StepsMisplaced};
use crate::codes::{E304, E401};
use crate::syntax::ast::{BinaryOperator, Expr, ExprKind};
use psd_plan::formula::Formula;
use psd_plan::procedures::escalate::block::WHILE;
use psd_plan::{Comparison, Condition, Requirement, Test};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;
use psd_text::units::Dimension;

const REQUIREMENT: Context = Context {
    entry: None,
    reads: Reads::All,
    critical: false,
};

/// For `A within TOLERANCE of B`: a tolerance must be positive.
#[derive(Violation)]
#[violation(E401, "the tolerance of `within` must be at least 0")]
#[help("write the absolute value")]
struct NegativeTolerance<'a> {
    #[label("`{text}` is negative")]
    span: Span,
    text: &'a str,
}

#[derive(Violation)]
#[violation(E304, "`{wanted_by}` requires a condition")]
#[help("compare it, as in `{text} < …`")]
struct ConditionWanted<'a> {
    wanted_by: &'a str,
    #[label("a value, not a condition")]
    span: Span,
    text: &'a str,
}

impl<'a> Checker<'a> {
    /// Every requirement; None if one has an error.
    pub fn requirements(&mut self) -> Option<Vec<Requirement>> {
        let checked: Vec<Option<Requirement>> = (0..self.scope.requirements.len())
            .map(|index| {
                let declared = &self.scope.requirements[index];
                let mut conditions = Vec::new();
                self.conditions(declared.condition, REQUIREMENT, &mut conditions);
                let conditions = conditions.into_iter().collect::<Option<Vec<Condition>>>()?;
                Some(Requirement {
                    label: declared.label.node.clone(),
                    conditions,
                })
            })
            .collect();
        checked.into_iter().collect()
    }

    /// The conditions of an expression, one for each part joined with `and`; None if one has an error.
    pub fn conditions_at(&mut self, expr: &'a Expr, context: Context) -> Option<Vec<Condition>> {
        let mut conditions = Vec::new();
        self.conditions(expr, context, &mut conditions);
        conditions.into_iter().collect()
    }

    fn conditions(&mut self, expr: &'a Expr, context: Context, into: &mut Vec<Option<Condition>>) {
        match &expr.kind {
            ExprKind::Parenthesised(inner) => self.conditions(inner, context, into),
            ExprKind::Binary {
                operator,
                left,
                right,
            } if operator.node == BinaryOperator::And => {
                self.conditions(left, context, into);
                self.conditions(right, context, into);
            }
            _ => {
                let condition = self.condition(expr, context);
                into.push(condition);
            }
        }
    }

    fn condition(&mut self, expr: &'a Expr, context: Context) -> Option<Condition> {
        let text = self
            .text(expr.span)
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        match &expr.kind {
            ExprKind::Faulty => None,
            ExprKind::Stepped { .. } => self.fail(StepsMisplaced { span: expr.span }),
            ExprKind::Binary { operator, .. } if operator.node == BinaryOperator::DrawnFrom => self
                .fail(DistributionMisplaced {
                    span: operator.span,
                }),
            ExprKind::Within {
                value,
                tolerance,
                target,
            } => {
                let (value, width, target) = (
                    self.single(value, context),
                    self.single(tolerance, context),
                    self.single(target, context),
                );
                let (value, width, target) = (value?, width?, target?);
                if value.dimension != target.dimension {
                    return self.fail(Mismatched {
                        operator: "within",
                        left: &value,
                        right: &target,
                    });
                }
                // `%` is relative to the target; a plain number beside a quantity would be a forgotten unit.
                let relative = width.percent
                    || (width.dimension == Dimension::NUMBER
                        && value.dimension != Dimension::NUMBER
                        && !width.bare);
                let width = if relative {
                    width
                } else {
                    self.expect(width, value.dimension, "within", tolerance)?
                };
                if width.formula.constant().is_some_and(|width| width < 0.0) {
                    return self.fail(NegativeTolerance {
                        span: tolerance.span,
                        text: self.text(tolerance.span),
                    });
                }
                let test = Test::Within {
                    target: target.formula,
                    tolerance: width.formula,
                    relative,
                };
                Some(Condition {
                    text,
                    value: value.formula,
                    test,
                    dimension: value.dimension,
                })
            }
            ExprKind::Binary {
                operator,
                left,
                right,
            } if comparison(operator.node).is_some() => {
                let comparison = comparison(operator.node)?;
                let (left, right) = (self.single(left, context), self.single(right, context));
                let (left, right) = (left?, right?);
                if left.dimension != right.dimension {
                    return self.fail(Mismatched {
                        operator: operator.node.symbol(),
                        left: &left,
                        right: &right,
                    });
                }
                let dimension = left.dimension;
                let (value, comparison, limit) = value_first(left, comparison, right);
                Some(Condition {
                    text,
                    value,
                    test: Test::Compare { comparison, limit },
                    dimension,
                })
            }
            _ => {
                let key = context.entry.map(|(block, entry)| {
                    self.scope.blocks[block].block.fields[entry]
                        .key
                        .node
                        .as_str()
                });
                let wanted_by = if matches!(context.reads, Reads::Impact(_)) {
                    WHILE.name
                } else {
                    key.unwrap_or("require")
                };
                self.fail(ConditionWanted {
                    wanted_by,
                    span: expr.span,
                    text: self.text(expr.span),
                })
            }
        }
    }
}

/// The measured value comes first: `8 mm >= hit.max_displacement` is `hit.max_displacement <= 8 mm`.
fn value_first(
    left: Typed,
    comparison: Comparison,
    right: Typed,
) -> (Formula, Comparison, Formula) {
    if left.is_late() || !right.is_late() {
        return (left.formula, comparison, right.formula);
    }
    let mirrored = match comparison {
        Comparison::Less => Comparison::Greater,
        Comparison::LessEqual => Comparison::GreaterEqual,
        Comparison::Greater => Comparison::Less,
        Comparison::GreaterEqual => Comparison::LessEqual,
        same => same,
    };
    (right.formula, mirrored, left.formula)
}

const fn comparison(operator: BinaryOperator) -> Option<Comparison> {
    Some(match operator {
        BinaryOperator::Less => Comparison::Less,
        BinaryOperator::LessEqual => Comparison::LessEqual,
        BinaryOperator::Greater => Comparison::Greater,
        BinaryOperator::GreaterEqual => Comparison::GreaterEqual,
        BinaryOperator::Equal => Comparison::Equal,
        BinaryOperator::NotEqual => Comparison::NotEqual,
        _ => return None,
    })
}
