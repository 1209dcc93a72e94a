//! Pairs of the grammar → expressions. A Pratt parser handles the precedence below ranges: `+ -`, `* /`, unary `-`, `^`
//! (to the right), then `.` and `[0]`.

use std::sync::LazyLock;

use pest::{
    iterators::Pair,
    pratt_parser::{Assoc, Op, PrattParser},
};

use super::{
    ast::{Argument, BinaryOperator, Expr, ExprKind, UnitToken},
    grammar::Rule,
    limits,
    lower::{Lowering, unescape},
    messages,
};
use psd_text::source::{Span, Spanned};

static PRATT: LazyLock<PrattParser<Rule>> = LazyLock::new(|| {
    PrattParser::new()
        .op(Op::infix(Rule::plus, Assoc::Left) | Op::infix(Rule::minus, Assoc::Left))
        .op(Op::infix(Rule::times, Assoc::Left) | Op::infix(Rule::divided, Assoc::Left))
        .op(Op::prefix(Rule::negate))
        .op(Op::infix(Rule::power, Assoc::Right))
        .op(Op::postfix(Rule::field) | Op::postfix(Rule::index))
});

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

impl Lowering {
    fn operator(&self, pair: &Pair<'_, Rule>) -> Spanned<BinaryOperator> {
        Spanned::new(operator(pair.as_str()), self.span(pair))
    }

    /// `depth` counts the operators and brackets around this expression.
    #[must_use]
    pub fn expression(&self, pair: Pair<'_, Rule>, depth: usize) -> Expr {
        let span = self.span(&pair);
        let mut parts = pair.into_inner();
        let depth = depth + parts.clone().count() / 2 + 1;
        if depth > limits::OPERATORS {
            return self.too_many(span);
        }
        let Some(first) = parts.next() else {
            return Self::faulty(span);
        };
        let mut result = self.comparison(first, depth);
        while let (Some(and), Some(right)) = (parts.next(), parts.next()) {
            result = binary(self.operator(&and), result, self.comparison(right, depth));
        }
        result
    }

    fn too_many(&self, span: Span) -> Expr {
        self.error(messages::too_many_operators(span, limits::OPERATORS));
        Self::faulty(span)
    }

    fn comparison(&self, pair: Pair<'_, Rule>, depth: usize) -> Expr {
        let span = self.span(&pair);
        let mut parts = pair.into_inner();
        let Some(first) = parts.next() else {
            return Self::faulty(span);
        };
        if first.as_rule() == Rule::stepped {
            return self.stepped(first, depth);
        }
        let value = self.range(first, depth);
        let Some(sign) = parts.next() else {
            return value;
        };
        let Some(next) = parts.next() else {
            return value;
        };
        if sign.as_rule() == Rule::compare {
            return binary(self.operator(&sign), value, self.range(next, depth));
        }
        let tolerance = self.sum(next, depth);
        let Some(target) = parts.find(|part| part.as_rule() == Rule::sum) else {
            return value;
        };
        let target = self.sum(target, depth);
        let span = value.span.to(target.span);
        let (value, tolerance, target) = (Box::new(value), Box::new(tolerance), Box::new(target));
        Expr {
            span,
            kind: ExprKind::Within {
                value,
                tolerance,
                target,
            },
        }
    }

    /// `hammer.velocity in 0.4 .. 1.6 step 0.1 m/s`
    fn stepped(&self, pair: Pair<'_, Rule>, depth: usize) -> Expr {
        let whole = self.span(&pair);
        let (mut input, mut values) = (None, None);
        for part in pair.into_inner() {
            match (part.as_rule(), input.take()) {
                (Rule::variable, _) => {
                    let span = self.span(&part);
                    let kind = ExprKind::Name(part.as_str().to_owned());
                    input = Some(Expr { span, kind });
                }
                (Rule::field, Some(base)) => input = Some(self.postfix(base, part, depth)),
                (Rule::range, kept) => {
                    values = Some(self.range(part, depth));
                    input = kept;
                }
                (_, kept) => input = kept,
            }
        }
        let (Some(input), Some(values)) = (input, values) else {
            return Self::faulty(whole);
        };
        let span = input.span.to(values.span);
        let (input, values) = (Box::new(input), Box::new(values));
        let kind = ExprKind::Stepped { input, values };
        Expr { span, kind }
    }

    #[must_use]
    pub fn range(&self, pair: Pair<'_, Rule>, depth: usize) -> Expr {
        let span = self.span(&pair);
        let mut sums = pair
            .into_inner()
            .filter(|part| part.as_rule() == Rule::sum)
            .map(|part| self.sum(part, depth));
        let Some(start) = sums.next() else {
            return Self::faulty(span);
        };
        let Some(end) = sums.next() else { return start };
        let step = sums.next();
        let span = start.span.to(step.as_ref().unwrap_or(&end).span);
        Expr {
            span,
            kind: ExprKind::Range {
                start: Box::new(start),
                end: Box::new(end),
                step: step.map(Box::new),
            },
        }
    }

    fn sum(&self, pair: Pair<'_, Rule>, depth: usize) -> Expr {
        let span = self.span(&pair);
        let parts = pair.into_inner();
        let is_operand = |rule| {
            matches!(
                rule,
                Rule::quantity | Rule::text | Rule::list | Rule::parenthesised | Rule::named
            )
        };
        let depth = depth
            + parts
                .clone()
                .filter(|part| !is_operand(part.as_rule()))
                .count();
        if depth > limits::OPERATORS {
            return self.too_many(span);
        }
        PRATT
            .map_primary(|operand| self.operand(operand, depth))
            .map_prefix(|minus, value| Expr {
                span: self.span(&minus).to(value.span),
                kind: ExprKind::Negate(Box::new(value)),
            })
            .map_postfix(|base, postfix| self.postfix(base, postfix, depth))
            .map_infix(|left, sign, right| binary(self.operator(&sign), left, right))
            .parse(parts)
    }

    fn postfix(&self, base: Expr, pair: Pair<'_, Rule>, depth: usize) -> Expr {
        let mut span = base.span;
        let (mut name, mut arguments, mut index) = (None, None, None);
        for part in pair.into_inner() {
            span = span.to(self.span(&part));
            match part.as_rule() {
                Rule::name => name = Some(self.ident(&part)),
                Rule::arguments => arguments = Some(self.arguments(part, depth)),
                Rule::expression => index = Some(self.expression(part, depth)),
                _ => {}
            }
        }
        let base = Box::new(base);
        let kind = match (name, arguments, index) {
            (Some(name), None, _) => ExprKind::Field { base, name },
            (Some(name), Some(arguments), _) => ExprKind::Member {
                base,
                name,
                arguments,
            },
            (None, _, Some(index)) => ExprKind::Index {
                base,
                index: Box::new(index),
            },
            (None, _, None) => ExprKind::Faulty,
        };
        Expr { span, kind }
    }

    fn operand(&self, pair: Pair<'_, Rule>, depth: usize) -> Expr {
        let span = self.span(&pair);
        match pair.as_rule() {
            Rule::quantity => self.quantity(pair),
            Rule::text => Expr {
                span,
                kind: ExprKind::Text(unescape(pair.as_str())),
            },
            Rule::list => self.list(pair, depth),
            Rule::named => self.named(pair, depth),
            Rule::parenthesised => {
                let inner = pair
                    .into_inner()
                    .find(|part| part.as_rule() == Rule::expression);
                let kind = inner.map_or(ExprKind::Faulty, |inner| {
                    ExprKind::Parenthesised(Box::new(self.expression(inner, depth)))
                });
                Expr { span, kind }
            }
            _ => Self::faulty(span),
        }
    }

    fn quantity(&self, pair: Pair<'_, Rule>) -> Expr {
        let mut parts = pair.into_inner();
        let number = parts
            .next()
            .map(|number| (number.as_str().to_owned(), self.span(&number)));
        let Some((text, start)) = number else {
            return Self::faulty(Span::new(self.file, self.base, self.base));
        };
        let unit: Option<UnitToken> = parts.next().map(|unit| self.ident(&unit));
        let span = unit.as_ref().map_or(start, |unit| start.to(unit.span));
        // `tokens` has rejected a number that is not finite before the grammar is applied.
        let value = text.parse().unwrap_or(f64::NAN);
        Expr {
            span,
            kind: ExprKind::Number { value, text, unit },
        }
    }

    fn list(&self, pair: Pair<'_, Rule>, depth: usize) -> Expr {
        let mut span: Option<Span> = None;
        let mut items = Vec::new();
        let mut unit = None;
        let whole = self.span(&pair);
        for part in pair.into_inner() {
            let here = self.span(&part);
            match part.as_rule() {
                Rule::expression => items.push(self.expression(part, depth)),
                Rule::unit => {
                    unit = Some(self.ident(&part));
                    span = span.map(|span| span.to(here));
                }
                Rule::open_bracket | Rule::close_bracket => {
                    span = Some(span.map_or(here, |span| span.to(here)));
                }
                _ => {}
            }
        }
        Expr {
            span: span.unwrap_or(whole),
            kind: ExprKind::List { items, unit },
        }
    }

    fn named(&self, pair: Pair<'_, Rule>, depth: usize) -> Expr {
        let whole = self.span(&pair);
        let mut parts = pair.into_inner();
        let Some(name) = parts.next() else {
            return Self::faulty(whole);
        };
        let name = self.ident(&name);
        let Some(list) = parts.next() else {
            return Expr {
                span: name.span,
                kind: ExprKind::Name(name.node),
            };
        };
        let span = name.span.to(self.span(&list));
        let arguments = self.arguments(list, depth);
        Expr {
            span,
            kind: ExprKind::Call { name, arguments },
        }
    }

    fn arguments(&self, list: Pair<'_, Rule>, depth: usize) -> Vec<Argument> {
        let span = self.span(&list);
        let mut arguments: Vec<Argument> = Vec::new();
        for part in list
            .into_inner()
            .filter(|part| part.as_rule() == Rule::argument)
        {
            let mut argument_name = None;
            let mut value = None;
            for part in part.into_inner() {
                match part.as_rule() {
                    Rule::argument_name => argument_name = Some(self.ident(&part)),
                    Rule::expression => value = Some(self.expression(part, depth)),
                    _ => {}
                }
            }
            let value = value.unwrap_or_else(|| Self::faulty(span));
            if argument_name.is_none() && arguments.iter().any(|before| before.name.is_some()) {
                self.error(messages::positional_after_named(value.span));
                continue;
            }
            arguments.push(Argument {
                name: argument_name,
                value,
            });
        }
        arguments
    }
}
