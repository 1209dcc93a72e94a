//! Pairs of the grammar → expressions. An expression is a flat list of operands and of what joins them, in an order that the grammar has
//! checked. Precedence rises from `and` over comparisons, ranges, `+ -`, `* /`, unary `-` and `^` (to the right) to `.` and `[0]`.
//! A function returns None only for pairs that are not of the grammar.

use std::iter::Peekable;

use pest::iterators::{Pair, Pairs};

use super::{
    ast::{Argument, BinaryOperator, Expr, ExprKind, UnitToken},
    grammar::Rule,
    limits,
    lower::Lowering,
    messages,
};
use psd_text::source::{Span, Spanned};

/// The parts of one expression that are not read yet.
type Parts<'i> = Peekable<Pairs<'i, Rule>>;

/// The precedence of a unary minus.
const NEGATION: u8 = 3;

/// The precedence of an infix operator, and the lowest precedence of an operator within its right operand.
const fn precedence(operator: BinaryOperator) -> (u8, u8) {
    match operator {
        BinaryOperator::Multiply | BinaryOperator::Divide => (2, 3),
        BinaryOperator::Power => (4, 4),
        _ => (1, 2),
    }
}

/// What a sum consists of: everything between the words, comparisons and points that join sums.
const fn is_of_sum(rule: Rule) -> bool {
    is_operator(rule)
        || matches!(
            rule,
            Rule::number
                | Rule::unit
                | Rule::variable
                | Rule::arguments
                | Rule::text
                | Rule::list
                | Rule::parenthesised
        )
}

const fn is_operator(rule: Rule) -> bool {
    matches!(rule, Rule::infix | Rule::negate | Rule::field | Rule::index)
}

fn binary(operator: Spanned<BinaryOperator>, left: Expr, right: Expr) -> Expr {
    let span = left.span.to(right.span);
    Expr {
        span,
        kind: ExprKind::Binary {
            operator,
            left: Box::new(left),
            right: Box::new(right),
        },
    }
}

fn operator(text: &str) -> BinaryOperator {
    match text {
        "and" => BinaryOperator::And,
        "<" => BinaryOperator::Less,
        "<=" => BinaryOperator::LessEqual,
        ">" => BinaryOperator::Greater,
        ">=" => BinaryOperator::GreaterEqual,
        "==" => BinaryOperator::Equal,
        "!=" => BinaryOperator::NotEqual,
        "~" => BinaryOperator::DrawnFrom,
        "+" => BinaryOperator::Add,
        "-" => BinaryOperator::Subtract,
        "*" => BinaryOperator::Multiply,
        "/" => BinaryOperator::Divide,
        _ => BinaryOperator::Power,
    }
}

impl Lowering<'_> {
    fn operator(&self, pair: &Pair<'_, Rule>) -> Spanned<BinaryOperator> {
        Spanned::new(operator(self.written(pair)), self.span(pair))
    }

    /// `depth` counts the operators and brackets around this expression.
    #[must_use]
    pub fn expression(&self, pair: Pair<'_, Rule>, depth: usize) -> Option<Expr> {
        let span = self.span(&pair);
        let parts = pair.into_inner();
        let ands = parts
            .clone()
            .filter(|part| part.as_rule() == Rule::and_word);
        let depth = depth + ands.count() + 1;
        if depth > limits::OPERATORS {
            return Some(self.too_many(span));
        }
        let parts = &mut parts.peekable();
        let mut result = self.comparison(parts, depth)?;
        while let Some(and) = parts.next() {
            result = binary(self.operator(&and), result, self.comparison(parts, depth)?);
        }
        Some(result)
    }

    fn too_many(&self, span: Span) -> Expr {
        self.error(messages::too_many_operators(span, limits::OPERATORS));
        Self::faulty(span)
    }

    fn comparison(&self, parts: &mut Parts<'_>, depth: usize) -> Option<Expr> {
        let value = self.range(parts, depth)?;
        let compares = |part: &Pair<'_, Rule>| {
            matches!(
                part.as_rule(),
                Rule::compare | Rule::within_word | Rule::in_word
            )
        };
        let Some(sign) = parts.next_if(compares) else {
            return Some(value);
        };
        match sign.as_rule() {
            Rule::compare => {
                let right = self.range(parts, depth)?;
                Some(binary(self.operator(&sign), value, right))
            }
            // `hammer.velocity in 0.4 .. 1.6 step 0.1 m/s`
            Rule::in_word => {
                let values = self.range(parts, depth)?;
                let span = value.span.to(values.span);
                let (input, values) = (Box::new(value), Box::new(values));
                let kind = ExprKind::Stepped { input, values };
                Some(Expr { span, kind })
            }
            _ => {
                let tolerance = self.sum(parts, depth)?;
                parts.next_if(|part| part.as_rule() == Rule::of_word)?;
                let target = self.sum(parts, depth)?;
                let span = value.span.to(target.span);
                let kind = ExprKind::Within {
                    value: Box::new(value),
                    tolerance: Box::new(tolerance),
                    target: Box::new(target),
                };
                Some(Expr { span, kind })
            }
        }
    }

    pub fn range(&self, parts: &mut Parts<'_>, depth: usize) -> Option<Expr> {
        let start = self.sum(parts, depth)?;
        if parts.next_if(|part| part.as_rule() == Rule::dots).is_none() {
            return Some(start);
        }
        let end = self.sum(parts, depth)?;
        let mut span = start.span.to(end.span);
        let mut step = None;
        if parts
            .next_if(|part| part.as_rule() == Rule::step_word)
            .is_some()
        {
            let value = self.sum(parts, depth)?;
            span = span.to(value.span);
            step = Some(Box::new(value));
        }
        let kind = ExprKind::Range {
            start: Box::new(start),
            end: Box::new(end),
            step,
        };
        Some(Expr { span, kind })
    }

    fn sum(&self, parts: &mut Parts<'_>, depth: usize) -> Option<Expr> {
        let of_sum = parts.clone().take_while(|part| is_of_sum(part.as_rule()));
        let operators = of_sum.filter(|part| is_operator(part.as_rule()));
        let depth = depth + operators.count();
        if depth <= limits::OPERATORS {
            return self.joined(parts, 0, depth);
        }
        let mut span = self.span(parts.peek()?);
        while let Some(part) = parts.next_if(|part| is_of_sum(part.as_rule())) {
            span = span.to(self.span(&part));
        }
        Some(self.too_many(span))
    }

    /// Operands and the operators between them, as far as the precedence of these is at least `lowest`.
    fn joined(&self, parts: &mut Parts<'_>, lowest: u8, depth: usize) -> Option<Expr> {
        let mut left = match parts.next_if(|part| part.as_rule() == Rule::negate) {
            Some(minus) => {
                let value = self.joined(parts, NEGATION, depth)?;
                Expr {
                    span: self.span(&minus).to(value.span),
                    kind: ExprKind::Negate(Box::new(value)),
                }
            }
            None => self.operand(parts, depth)?,
        };
        let joins = |part: &Pair<'_, Rule>| {
            part.as_rule() == Rule::infix && precedence(operator(self.written(part))).0 >= lowest
        };
        while let Some(sign) = parts.next_if(joins) {
            let sign = self.operator(&sign);
            let right = self.joined(parts, precedence(sign.node).1, depth)?;
            left = binary(sign, left, right);
        }
        Some(left)
    }

    /// An operand and what is attached to it: its unit, its arguments, its fields and indices.
    fn operand(&self, parts: &mut Parts<'_>, depth: usize) -> Option<Expr> {
        let pair = parts.next()?;
        let mut result = match pair.as_rule() {
            Rule::number => self.quantity(&pair, parts),
            Rule::variable => self.named(&pair, parts, depth)?,
            Rule::text => {
                let text = self.text(&pair);
                Expr {
                    span: text.span,
                    kind: ExprKind::Text(text.node),
                }
            }
            Rule::list => self.list(pair, depth)?,
            Rule::parenthesised => {
                let span = self.span(&pair);
                let inner = self.expression(pair.into_inner().nth(1)?, depth)?;
                Expr {
                    span,
                    kind: ExprKind::Parenthesised(Box::new(inner)),
                }
            }
            _ => return None,
        };
        let attached = |part: &Pair<'_, Rule>| matches!(part.as_rule(), Rule::field | Rule::index);
        while let Some(part) = parts.next_if(attached) {
            result = if part.as_rule() == Rule::field {
                self.field(result, part, parts, depth)?
            } else {
                let span = result.span.to(self.span(&part));
                let index = self.expression(part.into_inner().nth(1)?, depth)?;
                let (base, index) = (Box::new(result), Box::new(index));
                let kind = ExprKind::Index { base, index };
                Expr { span, kind }
            };
        }
        Some(result)
    }

    fn quantity(&self, number: &Pair<'_, Rule>, parts: &mut Parts<'_>) -> Expr {
        let text = self.written(number).to_owned();
        let start = self.span(number);
        let unit = parts.next_if(|part| part.as_rule() == Rule::unit);
        let unit: Option<UnitToken> = unit.map(|unit| self.ident(&unit));
        let span = unit.as_ref().map_or(start, |unit| start.to(unit.span));
        // `tokens` has rejected a number that is not finite before the grammar is applied.
        let value = text.parse().unwrap_or(f64::NAN);
        Expr {
            span,
            kind: ExprKind::Number { value, text, unit },
        }
    }

    fn named(&self, name: &Pair<'_, Rule>, parts: &mut Parts<'_>, depth: usize) -> Option<Expr> {
        let name = self.ident(name);
        let Some(list) = parts.next_if(|part| part.as_rule() == Rule::arguments) else {
            return Some(Expr {
                span: name.span,
                kind: ExprKind::Name(name.node),
            });
        };
        let span = name.span.to(self.span(&list));
        let arguments = self.arguments(list, depth)?;
        let kind = ExprKind::Call { name, arguments };
        Some(Expr { span, kind })
    }

    /// `.name`, and its arguments where it has some.
    fn field(
        &self,
        base: Expr,
        field: Pair<'_, Rule>,
        parts: &mut Parts<'_>,
        depth: usize,
    ) -> Option<Expr> {
        let name = self.ident(&field.into_inner().nth(1)?);
        let span = base.span.to(name.span);
        let base = Box::new(base);
        let Some(list) = parts.next_if(|part| part.as_rule() == Rule::arguments) else {
            let kind = ExprKind::Field { base, name };
            return Some(Expr { span, kind });
        };
        let span = span.to(self.span(&list));
        let arguments = self.arguments(list, depth)?;
        let kind = ExprKind::Member {
            base,
            name,
            arguments,
        };
        Some(Expr { span, kind })
    }

    fn list(&self, pair: Pair<'_, Rule>, depth: usize) -> Option<Expr> {
        let span = self.span(&pair);
        let mut items = Vec::new();
        let mut unit = None;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::expression => items.push(self.expression(part, depth)?),
                Rule::unit => unit = Some(self.ident(&part)),
                _ => {}
            }
        }
        let kind = ExprKind::List { items, unit };
        Some(Expr { span, kind })
    }

    fn arguments(&self, list: Pair<'_, Rule>, depth: usize) -> Option<Vec<Argument>> {
        let mut arguments: Vec<Argument> = Vec::new();
        for part in list
            .into_inner()
            .filter(|part| part.as_rule() == Rule::argument)
        {
            let mut parts = part.into_inner();
            let mut last = parts.next()?;
            let mut name = None;
            if last.as_rule() == Rule::argument_name {
                name = Some(self.ident(&last));
                last = parts.nth(1)?;
            }
            let value = self.expression(last, depth)?;
            if name.is_none() && arguments.iter().any(|before| before.name.is_some()) {
                self.error(messages::positional_after_named(value.span));
                continue;
            }
            arguments.push(Argument { name, value });
        }
        Some(arguments)
    }
}
