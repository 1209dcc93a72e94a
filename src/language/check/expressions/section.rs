//! Cross-sections: `rectangle(width: 60 mm, depth: 12 mm).area`, or `bar.area` after `let bar = rectangle(…)`. In: a shape as it is
//! written. Out: one of its numbers in SI. The formulas are in `physics/structure/section.rs`.

use crate::check::checker::{Checker, Context, Typed};
use crate::check::scope::Meaning;
use crate::check::wording::suggestion;
use crate::codes::{E206, E304, E401};
use crate::syntax::ast::{Expr, ExprKind, Ident};
use psd_physics::structure::section::{self, Profile, Section};
use psd_plan::formula::Formula;
use psd_plan::schema::Variant;
use psd_plan::schema::sections::{self as schema, SECTIONS};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

#[derive(Violation)]
#[violation(E304, "`{text}` is a section, not a number")]
#[help("read one of its values, as in `{text}.{}`", schema::SECOND_MOMENT.name)]
struct SectionForNumber<'a> {
    text: &'a str,
    #[label("a section")]
    span: Span,
}

#[derive(Violation)]
#[violation(E206, "a section has no value `{member}`")]
#[help("{}", suggestion(member, schema::VALUES.iter().map(|value| value.name)))]
struct NoValueOfSection<'a> {
    member: &'a str,
    #[label("unknown value")]
    span: Span,
}

#[derive(Violation)]
#[violation(E401, "the parts of this section are larger than the whole")]
#[help("{help}")]
struct ImpossibleSection {
    help: String,
    #[label("no such section")]
    span: Span,
}

/// The shape of a call.
pub fn shape(name: &str) -> Option<&'static Variant> {
    SECTIONS.iter().find(|variant| variant.name == name)
}

impl<'a> Checker<'a> {
    /// The section that an expression is: a shape, or the name of a `let` with one. None if it is something else.
    pub fn section_of(&self, expr: &'a Expr) -> Option<&'a Expr> {
        let is_shape = |expr: &Expr| matches!(&expr.kind, ExprKind::Call { name, .. } if shape(&name.node).is_some());
        match &expr.kind {
            ExprKind::Parenthesised(inner) => self.section_of(inner),
            ExprKind::Name(name) => match self.scope.meaning(name)? {
                Meaning::Value(index) => {
                    let declared = &self.scope.values[index];
                    let section = declared.keyword == "let" && is_shape(declared.value);
                    section.then_some(declared.value)
                }
                _ => None,
            },
            _ => is_shape(expr).then_some(expr),
        }
    }

    /// Whether a `let` names a section.
    pub fn is_section(&self, index: usize) -> bool {
        let declared = &self.scope.values[index];
        declared.keyword == "let" && self.section_of(declared.value).is_some()
    }

    pub fn section_for_number(&mut self, span: Span) -> Option<Typed> {
        let text = self.text(span);
        self.fail(SectionForNumber { text, span })
    }

    /// `bar.area`; `written` is the shape.
    pub fn value_of_section(
        &mut self,
        written: &'a Expr,
        member: &Ident,
        span: Span,
        context: Context,
    ) -> Option<Typed> {
        let Some(value) = schema::VALUES
            .iter()
            .find(|value| value.name == member.node)
        else {
            return self.fail(NoValueOfSection {
                member: &member.node,
                span: member.span,
            });
        };
        let section = self.section(written, context)?;
        let number = match value.name {
            name if name == schema::AREA.name => section.area,
            name if name == schema::SECOND_MOMENT.name => section.second_moment,
            _ => section.plastic_modulus,
        };
        Some(Typed::number(
            Formula::Constant(number),
            value.dimension,
            span,
        ))
    }

    /// A shape with its dimensions, each of which is known before the run. It is evaluated once, wherever it is read.
    pub fn section(&mut self, written: &'a Expr, context: Context) -> Option<Section> {
        self.once_in(
            |checker| &mut checker.sections,
            written.span,
            |checker| checker.new_section(written, context),
        )
    }

    fn new_section(&mut self, written: &'a Expr, context: Context) -> Option<Section> {
        let ExprKind::Call { name, arguments } = &written.kind else {
            return None;
        };
        let variant = shape(&name.node)?;
        let chosen = self.arguments_of(variant, arguments, written.span)?;
        let numbers: Vec<Option<f64>> = variant
            .arguments
            .iter()
            .map(|argument| self.constant_argument(&chosen, argument.name, context))
            .collect();
        let numbers: Vec<f64> = numbers.into_iter().collect::<Option<_>>()?;
        let (section, fits, help) = match *numbers.as_slice() {
            [width, depth, flange_thickness, web_thickness] => (
                section::i_section(Profile {
                    width,
                    depth,
                    flange_thickness,
                    web_thickness,
                }),
                2.0 * flange_thickness <= depth && web_thickness <= width,
                format!(
                    "write a `{}` of at most half the depth, and a `{}` of at most the width",
                    schema::FLANGE_THICKNESS.name,
                    schema::WEB_THICKNESS.name
                ),
            ),
            [diameter, thickness] if variant.name == "pipe" => (
                section::pipe(diameter, thickness),
                2.0 * thickness <= diameter,
                format!(
                    "write a `{}` of at most half the diameter",
                    schema::THICKNESS.name
                ),
            ),
            [width, depth] => (section::rectangle(width, depth), true, String::new()),
            _ => return None,
        };
        if !fits {
            return self.fail(ImpossibleSection {
                help,
                span: written.span,
            });
        }
        Some(section)
    }
}
