//! Words and variants: `rigid`, `limit(1500 N)`, `[every(20), force_drop(10 %)]`. In: an expression and the variants of a
//! field. Out: a [`Chosen`], with its arguments in SI.

use crate::check::checker::{Checker, Context, Typed};
use crate::check::messages::values;
use crate::check::messages::{names as message, types};
use crate::syntax::ast::{Argument, Expr, ExprKind};
use psd_plan::Interval;
use psd_plan::formula::Formula;
use psd_plan::schema::{Field, FieldType, Presence, Variant};
use psd_text::source::Span;
use psd_text::units::Dimension;

/// A variant as it is written.
pub struct Chosen<'a> {
    pub variant: &'static Variant,
    /// The expression for each argument of the variant, in the schema's order.
    arguments: Vec<Option<&'a Expr>>,
    /// Further expressions for the last argument, if it accepts several.
    rest: Vec<&'a Expr>,
    /// Number of arguments without a name.
    pub unnamed: usize,
}

impl<'a> Checker<'a> {
    /// The variant that a field names. None if the field is omitted or has an error.
    pub fn choice(&mut self, block: usize, field: &str) -> Option<Chosen<'a>> {
        let (_, written) = self.field(block, field)?;
        let FieldType::Choice(variants) = self.scope.blocks[block].kind.field(field)?.ty else {
            return None;
        };
        self.chosen(field, variants, &written.value)
    }

    /// The word that a field names, or `default` if it is omitted.
    pub fn word(
        &mut self,
        block: usize,
        field: &str,
        default: &'static str,
    ) -> Option<&'static str> {
        if self.field(block, field).is_none() {
            return Some(default);
        }
        self.choice(block, field).map(|chosen| chosen.variant.name)
    }

    /// The variants that a field lists. None if the field is omitted or has an error.
    pub fn choices(&mut self, block: usize, field: &str) -> Option<Vec<Chosen<'a>>> {
        let (_, written) = self.field(block, field)?;
        let FieldType::Choices(variants) = self.scope.blocks[block].kind.field(field)?.ty else {
            return None;
        };
        match &written.value.kind {
            ExprKind::List { items, unit: None } => {
                let chosen: Vec<_> = items
                    .iter()
                    .map(|item| self.chosen(field, variants, item))
                    .collect();
                chosen.into_iter().collect()
            }
            _ => self
                .chosen(field, variants, &written.value)
                .map(|chosen| vec![chosen]),
        }
    }

    pub fn chosen(
        &mut self,
        field: &str,
        variants: &'static [Variant],
        written: &'a Expr,
    ) -> Option<Chosen<'a>> {
        let (name, span, arguments): (&str, Span, &'a [Argument]) = match &written.kind {
            ExprKind::Name(name) => (name, written.span, &[]),
            ExprKind::Call { name, arguments } => (&name.node, name.span, arguments),
            ExprKind::Parenthesised(inner) => return self.chosen(field, variants, inner),
            ExprKind::Faulty => return None,
            _ => {
                return self.fail(types::choice_wanted(
                    field,
                    variants,
                    written.span,
                    self.text(written.span),
                ));
            }
        };
        let Some(variant) = variants.iter().find(|variant| variant.name == name) else {
            return self.fail(message::unknown_variant(field, name, span, variants));
        };
        self.arguments_of(variant, arguments, written.span)
    }

    /// A variant whose arguments are written behind a name, as in `scatter.probability(fails: "…")`.
    pub fn arguments_of(
        &mut self,
        variant: &'static Variant,
        arguments: &'a [Argument],
        span: Span,
    ) -> Option<Chosen<'a>> {
        let (assigned, rest) = self.match_arguments(variant, arguments, span)?;
        Some(Chosen {
            variant,
            arguments: assigned,
            rest,
            unnamed: arguments
                .iter()
                .filter(|argument| argument.name.is_none())
                .count(),
        })
    }

    fn match_arguments(
        &mut self,
        variant: &'static Variant,
        arguments: &'a [Argument],
        span: Span,
    ) -> Option<(Vec<Option<&'a Expr>>, Vec<&'a Expr>)> {
        let mut assigned: Vec<Option<&'a Expr>> = vec![None; variant.arguments.len()];
        let mut rest = Vec::new();
        let takes_many = variant
            .arguments
            .last()
            .is_some_and(|last| matches!(last.ty, FieldType::Inners));
        let mut faulty = false;
        for (index, argument) in arguments.iter().enumerate() {
            if takes_many && argument.name.is_none() && index >= assigned.len() {
                rest.push(&argument.value);
                continue;
            }
            let position = match &argument.name {
                None => Some(index).filter(|index| *index < assigned.len()),
                Some(name) => variant
                    .arguments
                    .iter()
                    .position(|field| field.name == name.node),
            };
            let Some(position) = position else {
                let at = argument
                    .name
                    .as_ref()
                    .map_or(argument.value.span, |name| name.span);
                self.diagnostics.push(message::unknown_argument(
                    variant,
                    argument.name.as_ref().map(|name| name.node.as_str()),
                    at,
                ));
                faulty = true;
                continue;
            };
            if let Some(first) = assigned[position].replace(&argument.value) {
                let at = argument
                    .name
                    .as_ref()
                    .map_or(argument.value.span, |name| name.span);
                self.diagnostics.push(message::argument_twice(
                    variant.arguments[position].name,
                    at,
                    first.span,
                ));
                faulty = true;
            }
        }
        if faulty {
            return None;
        }
        for (field, given) in variant.arguments.iter().zip(&assigned) {
            if given.is_none() && field.presence == Presence::Required {
                self.diagnostics
                    .push(message::missing_argument(variant, field, span));
                faulty = true;
            }
        }
        (!faulty).then_some((assigned, rest))
    }

    /// A numeric argument, or its default. None if it has an error, or is omitted without a default.
    pub fn argument(
        &mut self,
        chosen: &Chosen<'a>,
        name: &str,
        context: Context,
    ) -> Option<Formula> {
        let (field, written) = chosen.find(name)?;
        match written {
            Some(written) => self
                .typed_field(field, written, context)
                .map(|typed| typed.formula),
            None => field.default_number().map(Formula::Constant),
        }
    }

    /// A numeric argument that is known before the run.
    pub fn constant_argument(
        &mut self,
        chosen: &Chosen<'a>,
        name: &str,
        context: Context,
    ) -> Option<f64> {
        let formula = self.argument(chosen, name, context)?;
        let value = formula.constant();
        if value.is_none()
            && let Some((_, Some(written))) = chosen.find(name)
        {
            self.diagnostics
                .push(values::needs_the_run(written.span, self.text(written.span)));
        }
        value
    }
}

/// Arguments other than one number. A required one always exists, because otherwise its variant had an error.
impl<'a> Checker<'a> {
    /// An optional argument, a number known before the run: `Some(None)` if it is omitted, None if it has an error.
    pub fn optional_argument(
        &mut self,
        chosen: &Chosen<'a>,
        name: &str,
        context: Context,
    ) -> Option<Option<f64>> {
        match chosen.find(name)? {
            (_, Some(_)) => self.constant_argument(chosen, name, context).map(Some),
            (_, None) => Some(None),
        }
    }

    /// An argument that is itself a word or variant.
    pub fn chosen_argument(&mut self, chosen: &Chosen<'a>, name: &str) -> Option<Chosen<'a>> {
        let (field, written) = chosen.find(name)?;
        let FieldType::Choice(variants) = field.ty else {
            return None;
        };
        self.chosen(field.name, variants, written?)
    }

    /// An argument that is a list of numbers known before the run, with its span.
    pub fn list_argument(
        &mut self,
        chosen: &Chosen<'a>,
        name: &str,
        context: Context,
    ) -> Option<Vec<f64>> {
        let (field, written) = chosen.find(name)?;
        let written = written?;
        let values: Option<Vec<f64>> = self
            .typed_field(field, written, context)?
            .parts()
            .iter()
            .map(Formula::constant)
            .collect();
        if values.is_none() {
            self.diagnostics
                .push(values::needs_the_run(written.span, self.text(written.span)));
        }
        values
    }

    /// An argument that is a string, with its span; `Some(None)` if it is omitted, None if it is not a string.
    pub fn text_argument(
        &mut self,
        chosen: &Chosen<'a>,
        name: &str,
    ) -> Option<Option<(String, Span)>> {
        let (field, written) = chosen.find(name)?;
        match written {
            Some(written) => self
                .text_value(field.name, written)
                .map(|text| Some((text, written.span))),
            None => Some(None),
        }
    }

    /// An argument that is a range, with both ends inside the field's own range.
    pub fn interval_argument(
        &mut self,
        chosen: &Chosen<'a>,
        name: &str,
        context: Context,
    ) -> Option<Interval> {
        let (field, written) = chosen.find(name)?;
        let (written, dimension) = (written?, field.dimension()?);
        let ExprKind::Range { start, end, .. } = &written.kind else {
            return match written.kind {
                ExprKind::Faulty => None,
                _ => self.fail(types::range_wanted_by(field, written.span)),
            };
        };
        let (interval, found) = self.interval(written, context)?;
        let typed = Typed {
            bare: found == Dimension::NUMBER && dimension != Dimension::NUMBER,
            ..Typed::number(Formula::Constant(interval.high), found, written.span)
        };
        self.expect(typed, dimension, field.name, written)?;
        let mut ends = [(interval.low, start.span), (interval.high, end.span)].into_iter();
        match ends.find(|(end, _)| !field.range.contains(*end)) {
            Some((end, at)) => self.fail(values::out_of_range(
                field,
                dimension,
                end,
                self.text(at),
                at,
            )),
            None => Some(interval),
        }
    }
}

impl<'a> Chosen<'a> {
    /// The span of an argument.
    pub fn span(&self, name: &str) -> Option<Span> {
        self.find(name)?.1.map(|written| written.span)
    }

    /// The expressions for an argument that takes several: one after another, or as a list.
    pub fn several(&self, name: &str) -> Vec<&'a Expr> {
        let first = self.find(name).and_then(|(_, written)| written);
        let items = first.into_iter().flat_map(|written| match &written.kind {
            ExprKind::List { items, unit: None } => items.iter().collect(),
            _ => vec![written],
        });
        items.chain(self.rest.iter().copied()).collect()
    }

    /// The argument of the schema, and the expression for it.
    pub fn find(&self, name: &str) -> Option<(&'static Field, Option<&'a Expr>)> {
        let index = self
            .variant
            .arguments
            .iter()
            .position(|field| field.name == name)?;
        Some((&self.variant.arguments[index], self.arguments[index]))
    }
}
