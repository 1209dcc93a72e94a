//! The scale of a tested storey: `part: tested(scale: 1 / 2, represents: 2)`. In: the arguments of `tested`. Out: a [`Scale`], and the
//! violations of storeys whose numbers disagree through it.

use crate::check::checker::{Checker, Context};
use crate::check::expressions::choice::Chosen;
use crate::check::wording::shown;
use crate::codes::{E409, E668};
use crate::syntax::ast::ExprKind;
use psd_plan::Scale;
use psd_plan::schema::frames::storey;
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::{Span, Spanned};
use psd_text::units::Dimension;

/// Relative difference up to which two scales are the same.
const SAME: f64 = 1e-6;

/// The scale of a tested storey; full if none is written.
pub fn scale<'a>(
    checker: &mut Checker<'a>,
    tested: &Chosen<'a>,
    context: Context,
) -> Option<Scale> {
    let (field, written) = tested.find(storey::SCALE)?;
    let two = written.filter(|written| {
        let ExprKind::Call { name, .. } = &written.kind else {
            return false;
        };
        field
            .ty
            .variants()
            .iter()
            .any(|variant| variant.name == name.node)
    });
    let (displacement, force) = if let Some(written) = two {
        let two = checker.chosen(field.name, field.ty.variants(), written)?;
        let mut of = |name: &str| checker.constant_argument(&two, name, context);
        let (displacement, force) = (
            of(storey::SCALE_OF_DISPLACEMENTS),
            of(storey::SCALE_OF_FORCES),
        );
        (displacement?, force?)
    } else {
        let lengths = checker.constant_argument(tested, storey::SCALE, context)?;
        (lengths, lengths * lengths)
    };
    let represents = checker.constant_argument(tested, storey::REPRESENTS, context)?;
    Some(Scale {
        displacement,
        force,
        represents,
    })
}

#[derive(Violation)]
#[violation(
    E668,
    "storey {number} is one specimen with the storey below, but has another scale"
)]
#[help("write the same `scale` and `represents` in both, or `apart: true` for two specimens")]
pub struct AnotherScaleInOneSpecimen {
    pub number: usize,
    #[label("another scale")]
    pub span: Span,
    #[label("the same specimen")]
    pub below: Span,
}

/// A stated stiffness of a storey \[N/m\] beside a model with a different initial stiffness \[N/m\] on the rig.
pub struct StoreyOfAnotherScale {
    /// `storey` or `element`.
    pub word: &'static str,
    pub number: usize,
    pub stated: Spanned<f64>,
    pub model: Spanned<f64>,
    pub scale: Spanned<Scale>,
}

/// The changes of the plan with which a storey of `stated` \[N/m\] has a model of `model` \[N/m\] on the rig.
fn corrections(stated: f64, model: f64, scale: &Scale) -> Vec<String> {
    let Scale {
        displacement,
        force,
        represents,
    } = *scale;
    let near = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs();
    let number = |value: f64| shown(value, Dimension::NUMBER);
    let mut corrections = Vec::new();
    let exchanged = Scale {
        displacement: force,
        force: displacement,
        ..*scale
    };
    if near(force, displacement * displacement) {
        corrections.push(format!("`scale: {}`", number(represents * model / stated)));
    } else if near(exchanged.stiffness_on_the_rig(stated), model) {
        let (displacement, force) = (number(force), number(displacement));
        corrections.push(format!(
            "`scale: scale(displacement: {displacement}, force: {force})`"
        ));
    }
    let parts = force / displacement * stated / model;
    if parts.round() >= 1.0 && near(parts, parts.round()) {
        corrections.push(format!("`represents: {}`", parts.round()));
    }
    let on_the_rig = shown(scale.stiffness_on_the_rig(stated), Dimension::STIFFNESS);
    corrections.push(format!("a behaviour of {on_the_rig} on the rig"));
    corrections
}

impl Violation for StoreyOfAnotherScale {
    const CODE: Code = E409;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            word,
            number,
            stated,
            model,
            scale,
        } = self;
        let stiffness = |value: f64| shown(value, Dimension::STIFFNESS);
        let of_storey = stiffness(scale.node.stiffness_of_storey(model.node));
        let (of_stated, of_model) = (stiffness(stated.node), stiffness(model.node));
        let corrections = corrections(stated.node, model.node, &scale.node);
        Diagnostic::new(
            Self::CODE,
            format!(
                "{word} {number}: stated stiffness {of_stated} differs from that of its model, {of_model} on the rig or {of_storey} of \
     the {word}"
            ),
        )
        .at(stated.span, format!("stated stiffness: {of_stated}"))
        .at(model.span, format!("initial stiffness on the rig: {of_model}"))
        .at(scale.span, format!("of the {word}: {of_storey}"))
        .help(format!(
            "write {}; a scale is a length on the rig over that of the {word}",
            corrections.join(", or ")
        ))
    }
}
