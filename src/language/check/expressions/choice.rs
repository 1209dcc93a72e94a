//! Words and variants: `rigid`, `limit(1500 N)`, `[every(20), force_drop(10 %)]`. In: an expression and the variants of a
//! field. Out: a [`Chosen`], with its arguments in SI.

use crate::check::checker::{Checker, Context, Typed};
use crate::check::violations::{NeedsTheRun, OutOfRange};
use crate::check::wording::{all_of, one_of, suggestion};
use crate::codes::{E205, E208, E213, E304};
use crate::syntax::ast::{Argument, Expr, ExprKind};
use psd_plan::Interval;
use psd_plan::formula::Formula;
use psd_plan::schema::{Field, FieldType, Presence, Variant};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
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

struct ChoiceWanted<'a> {
    field: &'a str,
    variants: &'a [Variant],
    span: Span,
    text: &'a str,
}

impl Violation for ChoiceWanted<'_> {
    const CODE: Code = E304;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            field,
            variants,
            span,
            text,
        } = self;
        let known = one_of(variants.iter().map(|variant| variant.name));
        Diagnostic::new(
            Self::CODE,
            format!("`{field}` requires one of its options, found `{text}`"),
        )
        .at(span, "unknown option")
        .help(
            match variants
                .iter()
                .find(|variant| variant.name == text.trim_matches('"'))
            {
                Some(meant) => format!("write it without quotes: `{}`", meant.name),
                None => format!("write one of its options: {known}"),
            },
        )
    }
}

struct UnknownVariant<'a> {
    field: &'a str,
    name: &'a str,
    span: Span,
    variants: &'a [Variant],
}

impl Violation for UnknownVariant<'_> {
    const CODE: Code = E205;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            field,
            name,
            span,
            variants,
        } = self;
        let known = variants.iter().map(|variant| variant.name);
        Diagnostic::new(Self::CODE, format!("`{field}` has no option `{name}`"))
            .at(span, "unknown option")
            .help(suggestion(name, known))
    }
}

struct UnknownArgument<'a> {
    variant: &'a Variant,
    name: Option<&'a str>,
    span: Span,
}

impl Violation for UnknownArgument<'_> {
    const CODE: Code = E213;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            variant,
            name,
            span,
        } = self;
        let known: Vec<&str> = variant
            .arguments
            .iter()
            .map(|argument| argument.name)
            .collect();
        let (message, help) = match name {
            Some(name) => (
                format!("`{}` has no argument `{name}`", variant.name),
                suggestion(name, known),
            ),
            None if known.is_empty() => (
                format!("`{}` takes no arguments", variant.name),
                format!("write `{}` alone", variant.name),
            ),
            None => {
                let (arguments, they) = if known.len() == 1 {
                    ("one argument".to_owned(), "it is")
                } else {
                    (format!("{} arguments", known.len()), "they are")
                };
                (
                    format!("`{}` takes at most {arguments}", variant.name),
                    format!("{they} {}", all_of(known)),
                )
            }
        };
        Diagnostic::new(Self::CODE, message)
            .at(span, "unknown argument")
            .help(help)
    }
}

#[derive(Violation)]
#[violation(E208, "argument `{name}` given twice")]
#[help("remove one of them")]
struct ArgumentTwice<'a> {
    name: &'a str,
    #[label("given again")]
    span: Span,
    #[label("first given here")]
    first: Span,
}

/// The form of a missing argument: the whole call where it is short, `within(displacement: 0.01 mm, force_rate: 5 N/s)`,
/// else the argument alone.
fn argument_help(variant: &Variant, missing: &Field) -> String {
    let required: Vec<&Field> = variant
        .arguments
        .iter()
        .filter(|argument| argument.presence == Presence::Required)
        .collect();
    let written = |argument: &Field| {
        let named = argument.example.starts_with(&format!("{}:", argument.name));
        if named || required.len() == 1 {
            argument.example.to_owned()
        } else {
            format!("{}: {}", argument.name, argument.example)
        }
    };
    if required.len() > 2 {
        return format!("add it in the parentheses, as in `{}`", written(missing));
    }
    let arguments: Vec<String> = required.iter().map(|argument| written(argument)).collect();
    format!(
        "write it as in `{}({})`",
        variant.name,
        arguments.join(", ")
    )
}

#[derive(Violation)]
#[violation(E213, "`{}` requires the argument `{}`", variant.name, field.name)]
#[help("{}", argument_help(variant, field))]
struct MissingArgument<'a> {
    variant: &'a Variant,
    field: &'a Field,
    #[label("`{}` is missing", field.name)]
    span: Span,
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
                return self.fail(ChoiceWanted {
                    field,
                    variants,
                    span: written.span,
                    text: self.text(written.span),
                });
            }
        };
        let Some(variant) = variants.iter().find(|variant| variant.name == name) else {
            return self.fail(UnknownVariant {
                field,
                name,
                span,
                variants,
            });
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
                self.report(UnknownArgument {
                    variant,
                    name: argument.name.as_ref().map(|name| name.node.as_str()),
                    span: at,
                });
                faulty = true;
                continue;
            };
            if let Some(first) = assigned[position].replace(&argument.value) {
                let at = argument
                    .name
                    .as_ref()
                    .map_or(argument.value.span, |name| name.span);
                self.report(ArgumentTwice {
                    name: variant.arguments[position].name,
                    span: at,
                    first: first.span,
                });
                faulty = true;
            }
        }
        if faulty {
            return None;
        }
        for (field, given) in variant.arguments.iter().zip(&assigned) {
            if given.is_none() && field.presence == Presence::Required {
                self.report(MissingArgument {
                    variant,
                    field,
                    span,
                });
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
            self.report(NeedsTheRun {
                span: written.span,
                text: self.text(written.span),
            });
        }
        value
    }
}

#[derive(Violation)]
#[violation(E304, "`{}` requires a range, found one value", field.name)]
#[help("write both ends, as in `{}`", field.example)]
struct RangeWantedBy<'a> {
    field: &'a Field,
    #[label("not a range")]
    span: Span,
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
            self.report(NeedsTheRun {
                span: written.span,
                text: self.text(written.span),
            });
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
                _ => self.fail(RangeWantedBy {
                    field,
                    span: written.span,
                }),
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
            Some((end, at)) => self.fail(OutOfRange {
                field,
                dimension,
                value: end,
                text: self.text(at),
                span: at,
            }),
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
