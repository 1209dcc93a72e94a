//! Numbers, lists and ranges: units looked up, ranges expanded.

#![expect(
    clippy::cast_precision_loss,
    reason = "a list has at most 100,000 entries"
)]

use crate::check::checker::{Checker, Context, Shape, Typed, literal};
use crate::check::messages::{names, types as message, values};
use crate::syntax::ast::{Expr, ExprKind, UnitToken};
use psd_plan::formula::Formula;
use psd_text::source::Span;
use psd_text::units::unit;
use psd_text::units::unit::UnitError;
use psd_text::units::{Dimension, Unit};

/// Most entries of a list, written one by one or as a range.
pub const MOST_ENTRIES: usize = 100_000;

/// Parts of a range, each a checked number.
pub struct RangeParts {
    pub start: Typed,
    pub end: Typed,
    pub step: Option<Typed>,
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
        let formula = Formula::Constant(scaled(value, unit.factor));
        Some(Typed {
            percent: token.node == "%",
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
                self.fail(names::name_glued_to_unit(
                    &name,
                    at(start, name.len()),
                    &corrected,
                ))
            }
            Err(UnitError::Unknown { name, start }) => {
                let alone = name == token.node && number.start <= token.span.start;
                let before = Span {
                    end: token.span.start,
                    ..number
                };
                let value = self.text(before).trim().parse().ok();
                let value = value.filter(|_| alone);
                self.fail(names::unknown_unit(&name, value, at(start, name.len())))
            }
            Err(UnitError::Exponent { text, start }) => {
                self.fail(message::unit_exponent(&text, at(start, text.len())))
            }
            Err(UnitError::TooLarge) => self.fail(message::exponent_too_large(token.span)),
        }
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
            return self.fail(values::empty_list(span));
        };
        if let Some(other) = checked
            .iter()
            .find(|other| other.dimension != first.dimension)
        {
            return self.fail(message::mismatched("[ ]", first, other));
        }
        let (dimension, bare, percent) = (
            first.dimension,
            checked.iter().all(|part| part.bare),
            first.percent,
        );
        let parts: Vec<Formula> = checked.iter().flat_map(Typed::parts).collect();
        if parts.len() > MOST_ENTRIES {
            return self.fail(values::too_many_entries(
                span,
                parts.len() as f64,
                MOST_ENTRIES,
            ));
        }
        Some(Typed {
            formula: Formula::List(parts),
            shape: Shape::List,
            dimension,
            span,
            bare,
            percent,
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
        for other in [Some(&end_value), step_value.as_ref()]
            .into_iter()
            .flatten()
        {
            if other.dimension != start_value.dimension {
                return self.fail(message::mismatched("..", &start_value, other));
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
            return self.fail(values::range_without_step(expr.span, self.text(expr.span)));
        };
        let known = (
            parts.start.constant(),
            parts.end.constant(),
            step.constant(),
        );
        let (Some(start), Some(end), Some(size)) = known else {
            return self.fail(values::range_not_constant(expr.span));
        };
        let count = (end - start) / size;
        if size == 0.0 || count < 0.0 {
            return self.fail(values::step_leads_away(
                step.span,
                self.text(step.span),
                size == 0.0,
            ));
        }
        // The range must be a multiple of the step, to 1e-9 of the number of steps.
        if (count - count.round()).abs() > 1e-9 * count.abs().max(1.0) {
            return self.fail(values::step_does_not_divide(
                expr.span,
                step.span,
                end - start,
                count,
                parts.start.dimension,
            ));
        }
        let count = count.round();
        if count + 1.0 > MOST_ENTRIES as f64 {
            return self.fail(values::too_many_entries(
                expr.span,
                count + 1.0,
                MOST_ENTRIES,
            ));
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
