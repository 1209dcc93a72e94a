//! Expressions: names resolved, units gone, dimensions inferred. In: an expression of the syntax tree and where it
//! stands. Out: a [`Typed`] formula in SI, or None where a fault has been reported (by this or by an earlier stage).

use crate::language::check::checker::{Checker, Place, Shape, Typed, literal};
use crate::language::check::declarations::frame;
use crate::language::check::messages::{types as fault, values};
use crate::language::syntax::ast::{BinaryOperator, Expr, ExprKind};
use crate::plan::formula::{Formula, Operator};
use crate::schema::{self, Kind};
use crate::text::source::Span;
use crate::units::{Dimension, Exponent};

impl<'a> Checker<'a> {
    /// The value of an expression.
    pub fn value(&mut self, expr: &'a Expr, place: Place) -> Option<Typed> {
        let mut typed = self.value_inner(expr, place)?;
        typed.span = expr.span;
        self.fold(typed)
    }

    /// The value of an expression that must be one number.
    pub fn single(&mut self, expr: &'a Expr, place: Place) -> Option<Typed> {
        let typed = self.value(expr, place)?;
        if typed.shape == Shape::List {
            return self.fail(fault::list_for_number(expr.span));
        }
        Some(typed)
    }

    fn value_inner(&mut self, expr: &'a Expr, place: Place) -> Option<Typed> {
        match &expr.kind {
            ExprKind::Faulty => None,
            ExprKind::Number { value, unit, .. } => self.number(*value, unit.as_ref(), expr.span),
            ExprKind::Text(_) => self.fail(fault::text_for_number(expr.span)),
            ExprKind::Name(name) => self.name(name, expr.span, place),
            ExprKind::Field { base, name } => self.field_of(base, name, expr.span, place),
            ExprKind::Parenthesised(inner) => self.value(inner, place),
            ExprKind::List { .. } | ExprKind::Range { .. } => self.list(expr, place),
            ExprKind::Call { name, arguments } => self.call(name, arguments, expr.span, place),
            ExprKind::Index { base, index } => self.index(base, index, place),
            ExprKind::Negate(inner) => {
                let inner = self.single(inner, place)?;
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
                if is_logical(operator.node) {
                    return self.fail(fault::condition_for_number(
                        expr.span,
                        operator.node.symbol(),
                    ));
                }
                let (left_value, right_value) =
                    (self.single(left, place), self.single(right, place));
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
            ExprKind::Within { .. } => self.fail(fault::condition_for_number(expr.span, "within")),
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
            return self.fail(fault::mismatched(symbol, &left, &right));
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
            return self.fail(fault::exponent_too_large(span));
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
            return self.fail(fault::exponent_with_unit(&exponent));
        }
        let dimension = if base.dimension == Dimension::NUMBER {
            Dimension::NUMBER
        } else {
            let Some(value) = exponent.constant() else {
                return self.fail(fault::exponent_not_constant(written.span, base.dimension));
            };
            let power =
                Exponent::from_decimal(value).and_then(|power| base.dimension.to_power(power));
            let Some(dimension) = power else {
                return self.fail(fault::exponent_not_rational(written.span));
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

    fn index(&mut self, base: &'a Expr, index: &'a Expr, place: Place) -> Option<Typed> {
        let (list, at) = (self.value(base, place), self.single(index, place));
        let (list, at) = (list?, at?);
        if list.shape == Shape::Number {
            return self.fail(fault::index_of_number(base.span));
        }
        let place_in_list = at
            .constant()
            .filter(|at| at.fract() == 0.0 && (0.0..1e6).contains(at));
        let (Some(place_in_list), Dimension::NUMBER) = (place_in_list, at.dimension) else {
            return self.fail(fault::index_not_whole(index.span));
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole and between 0 and a million"
        )]
        let place_in_list = place_in_list as usize;
        if let Formula::List(parts) = &list.formula {
            let Some(part) = parts.get(place_in_list) else {
                return self.fail(values::no_such_entry(
                    index.span,
                    place_in_list,
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
            && place_in_list >= length
        {
            return self.fail(values::no_such_entry(index.span, place_in_list, length));
        }
        if let Some(reference) = list.formula.as_result() {
            self.taken.push((reference, place_in_list, index.span));
        }
        Some(Typed {
            shape: Shape::Number,
            formula: Formula::Index(Box::new(list.formula.clone()), place_in_list),
            ..list
        })
    }

    /// Entries of a list that the run gives, where the plan tells: a frame has one for each storey.
    fn length_of(&mut self, list: &Formula) -> Option<usize> {
        let reference = list.as_result()?;
        let block = self.procedure(reference.procedure)?;
        let kind = self.scope.blocks[block].kind;
        // A condition on a blow reads the results of an impact.
        let of_storey = [Some(kind), Some(schema::block(Kind::Impact))]
            .into_iter()
            .flatten();
        let mut of_storey = of_storey
            .filter_map(|kind| kind.result(reference.name))
            .take(1)
            .map(|result| result.of_storey);
        if kind.kind != Kind::Shake && !of_storey.next().unwrap_or(false) {
            return None;
        }
        let specimen = self.tested(block)?;
        frame::frame(self, specimen).map(|frame| frame.degrees_of_freedom())
    }

    /// A number known before the run becomes a constant; one that is not finite is a fault.
    fn fold(&mut self, typed: Typed) -> Option<Typed> {
        if typed.shape == Shape::List
            || matches!(typed.formula, Formula::Constant(_))
            || typed.is_late()
        {
            return Some(typed);
        }
        match typed.constant() {
            // What is stated with an uncertainty is kept as it is made up.
            Some(_) if typed.formula.is_uncertain() => Some(typed),
            Some(value) => Some(Typed {
                formula: Formula::Constant(value),
                ..typed
            }),
            None => self.fail(values::not_finite(typed.span)),
        }
    }

    /// Holds a value against the dimension it must have; `wanted_by` is the field or argument.
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
        let fault = if typed.bare && entries && dimension != Dimension::NUMBER {
            fault::missing_unit_of_entries(text, written.span, dimension, wanted_by)
        } else if typed.bare && dimension != Dimension::NUMBER {
            fault::missing_unit(text, written.span, number, dimension, wanted_by)
        } else {
            let unit = literal(written).and_then(|expr| match &expr.kind {
                ExprKind::Number { unit, .. } => unit.as_ref().map(|unit| unit.node.as_str()),
                _ => None,
            });
            fault::wrong_dimension(
                text,
                written.span,
                (number, unit),
                (typed.dimension, dimension),
                wanted_by,
            )
        };
        self.fail(fault)
    }
}

const fn is_logical(operator: BinaryOperator) -> bool {
    use BinaryOperator::{And, Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    matches!(
        operator,
        And | Less | LessEqual | Greater | GreaterEqual | Equal | NotEqual
    )
}
