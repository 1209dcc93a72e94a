//! Expressions: names resolved, units converted, dimensions inferred. In: an expression of the syntax tree and its
//! context. Out: a [`Typed`] formula in SI, or None where an error has been reported, here or earlier.

use crate::check::checker::{Checker, Context, Shape, Typed, literal};
use crate::check::declarations::specimen::frame;
use crate::check::messages::{studies, types as message, values};
use crate::syntax::ast::{BinaryOperator, Expr, ExprKind};
use psd_plan::ProcedureBlock;
use psd_plan::formula::{Formula, Operator};
use psd_plan::schema::{self, Kind};
use psd_text::source::Span;
use psd_text::units::{Dimension, Exponent};

impl<'a> Checker<'a> {
    /// The value of an expression.
    pub fn value(&mut self, expr: &'a Expr, context: Context) -> Option<Typed> {
        let mut typed = self.value_inner(expr, context)?;
        typed.span = expr.span;
        self.fold(typed)
    }

    /// The value of an expression that must be one number.
    pub fn single(&mut self, expr: &'a Expr, context: Context) -> Option<Typed> {
        let typed = self.value(expr, context)?;
        if typed.shape == Shape::List {
            return self.fail(message::list_for_number(expr.span));
        }
        Some(typed)
    }

    fn value_inner(&mut self, expr: &'a Expr, context: Context) -> Option<Typed> {
        match &expr.kind {
            ExprKind::Faulty => None,
            ExprKind::Number { value, unit, .. } => self.number(*value, unit.as_ref(), expr.span),
            ExprKind::Text(_) => self.fail(message::text_for_number(expr.span)),
            ExprKind::Name(name) => self.name(name, expr.span, context),
            ExprKind::Field { base, name } => self.field_of(base, name, expr.span, context),
            ExprKind::Parenthesised(inner) => self.value(inner, context),
            ExprKind::List { .. } | ExprKind::Range { .. } => self.list(expr, context),
            ExprKind::Call { name, arguments } => self.call(name, arguments, expr.span, context),
            ExprKind::Index { base, index } => self.index(base, index, context),
            ExprKind::Negate(inner) => {
                let inner = self.single(inner, context)?;
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
                    return self.fail(studies::distribution_misplaced(operator.span));
                }
                if is_logical(operator.node) {
                    return self.fail(message::condition_for_number(
                        expr.span,
                        operator.node.symbol(),
                    ));
                }
                let (left_value, right_value) =
                    (self.single(left, context), self.single(right, context));
                let (left_value, right_value) = (left_value?, right_value?);
                match operator.node {
                    BinaryOperator::Power => self.power(left_value, right_value, right),
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
            ExprKind::Within { .. } => {
                self.fail(message::condition_for_number(expr.span, "within"))
            }
            ExprKind::Member { .. } => self.fail(studies::probability_misplaced(expr.span)),
            ExprKind::Stepped { .. } => self.fail(studies::steps_misplaced(expr.span)),
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
            return self.fail(message::mismatched(symbol, &left, &right));
        }
        let (bare, percent) = (left.bare && right.bare, left.percent && right.percent);
        let formula = Formula::Binary(operator, Box::new(left.formula), Box::new(right.formula));
        Some(Typed {
            bare,
            percent,
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
        let dimension = match operator {
            Operator::Divide => left.dimension.over(right.dimension),
            _ => left.dimension.times(right.dimension),
        };
        let Some(dimension) = dimension else {
            return self.fail(message::exponent_too_large(span));
        };
        let bare = left.bare && right.bare;
        let formula = Formula::Binary(operator, Box::new(left.formula), Box::new(right.formula));
        Some(Typed {
            bare,
            ..Typed::number(formula, dimension, left.span)
        })
    }

    fn power(&mut self, base: Typed, exponent: Typed, written: &Expr) -> Option<Typed> {
        if exponent.dimension != Dimension::NUMBER {
            return self.fail(message::exponent_with_unit(&exponent));
        }
        let dimension = if base.dimension == Dimension::NUMBER {
            Dimension::NUMBER
        } else {
            let Some(value) = exponent.constant() else {
                return self.fail(message::exponent_not_constant(written.span, base.dimension));
            };
            let power =
                Exponent::from_decimal(value).and_then(|power| base.dimension.to_power(power));
            let Some(dimension) = power else {
                return self.fail(message::exponent_not_rational(written.span));
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
            return self.fail(message::index_of_number(base.span));
        }
        let index_in_list = at
            .constant()
            .filter(|at| at.fract() == 0.0 && (0.0..1e6).contains(at));
        let (Some(index_in_list), Dimension::NUMBER) = (index_in_list, at.dimension) else {
            return self.fail(message::index_not_whole(index.span));
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole and between 0 and a million"
        )]
        let index_in_list = index_in_list as usize;
        if let Formula::List(parts) = &list.formula {
            let Some(part) = parts.get(index_in_list) else {
                return self.fail(values::no_such_entry(
                    index.span,
                    index_in_list,
                    parts.len(),
                ));
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
            return self.fail(values::no_such_entry(index.span, index_in_list, length));
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
        let of_storey = [
            Some(kind),
            Some(schema::block(Kind::Procedure(ProcedureBlock::Impact))),
        ]
        .into_iter()
        .flatten();
        let mut of_storey = of_storey
            .filter_map(|kind| kind.result(reference.name))
            .take(1)
            .map(|result| result.of_storey);
        if kind.kind != Kind::Procedure(ProcedureBlock::Shake) && !of_storey.next().unwrap_or(false)
        {
            return None;
        }
        let specimen = self.tested(block)?;
        frame::frame(self, specimen).map(|frame| frame.degrees_of_freedom())
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
            None => self.fail(values::not_finite(typed.span)),
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
            message::missing_unit_of_entries(text, written.span, dimension, wanted_by)
        } else if typed.bare && dimension != Dimension::NUMBER {
            message::missing_unit(text, written.span, number, dimension, wanted_by)
        } else {
            let unit = literal(written).and_then(|expr| match &expr.kind {
                ExprKind::Number { unit, .. } => unit.as_ref().map(|unit| unit.node.as_str()),
                _ => None,
            });
            message::wrong_dimension(
                &message::WrittenValue {
                    text,
                    span: written.span,
                    number,
                    unit,
                    value: typed.constant(),
                },
                typed.dimension,
                dimension,
                wanted_by,
            )
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
