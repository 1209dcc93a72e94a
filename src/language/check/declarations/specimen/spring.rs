//! The spring of a storey or of an element: the arguments that both have. In: the arguments. Out: a [`Spring`], with the model on the rig
//! if it is tested.

use crate::check::checker::{Checker, Context};
use crate::check::declarations::striker::MOST_UNCERTAIN;
use crate::check::expressions::choice::Chosen;
use crate::check::violations::TooUncertain;
use crate::check::wording::shown;
use crate::codes::{E409, E622, E668};
use psd_plan::schema::frames::storey;
use psd_plan::schema::{Field, FieldType};
use psd_plan::{Behaviour, Part, Scale};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::{Span, Spanned};
use psd_text::units::Dimension;

use super::behaviour::{self, Material, Written};
use super::scale::{StoreyOfAnotherScale, scale};

/// The words for one of a list.
pub const STOREY: &str = "storey";
pub const ELEMENT: &str = "element";

/// Relative difference up to which a stiffness equals that of its model: the last digits of a sum or a quotient.
const SAME: f64 = 1e-9;

/// Number of standard uncertainties up to which they agree, if the plan states one.
const WITHIN: f64 = 3.0;

#[derive(Violation)]
#[violation(E668, "{word} {number} is computed, but has `{field}`")]
#[help(
    "remove `{field}`: it is in the force of a virtual rig; the frame's own damping is the `damping_ratio` of the procedure"
)]
struct RigDampingOfComputed<'a> {
    word: &'a str,
    number: usize,
    field: &'a str,
    #[label("of a virtual rig")]
    span: Span,
    #[label("no rig carries the {word}")]
    part: Span,
}

/// The substructure of a storey.
fn part<'a>(checker: &mut Checker<'a>, chosen: &Chosen<'a>, context: Context) -> Option<Part> {
    if chosen.span(storey::PART).is_none() {
        return Some(Part::TESTED);
    }
    let word = checker.chosen_argument(chosen, storey::PART)?;
    if word.variant.name == storey::COMPUTED {
        return Some(Part::Computed);
    }
    let apart = match word.span(storey::APART) {
        Some(_) => checker.chosen_argument(&word, storey::APART)?.variant.name == "true",
        None => false,
    };
    let scale = scale(checker, &word, context)?;
    Some(Part::Tested { apart, scale })
}

#[derive(Violation)]
#[violation(E622, "storey {number} has no stiffness")]
#[help(
    "add `stiffness: 3 MN/m`, or `column_stiffness: 1.5 MN/m` for one of its two columns, or a `behaviour`"
)]
struct StoreyWithoutStiffness {
    number: usize,
    #[label("stiffness missing")]
    span: Span,
}

#[derive(Violation)]
#[violation(E622, "element {number} has no stiffness")]
#[help("add `stiffness: 3 MN/m`, or a `behaviour`")]
struct ElementWithoutStiffness {
    number: usize,
    #[label("stiffness missing")]
    span: Span,
}

/// A stiffness \[N/m\], by the name of its field, beside a model with a different initial stiffness \[N/m\].
struct StoreyBendsOtherwise<'a> {
    word: &'a str,
    number: usize,
    field: &'a str,
    stated: Spanned<f64>,
    model: Spanned<f64>,
}

impl Violation for StoreyBendsOtherwise<'_> {
    const CODE: Code = E409;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            word,
            number,
            field,
            stated,
            model,
        } = self;
        let (stated_at, model_at) = (stated.span, model.span);
        let (stated, initial) = (
            shown(stated.node, Dimension::STIFFNESS),
            shown(model.node, Dimension::STIFFNESS),
        );
        Diagnostic::new(
            Self::CODE,
            format!(
                "{word} {number}: stated stiffness {stated} differs from the \
     model's initial stiffness {initial}"
            ),
        )
        .at(stated_at, format!("stated stiffness: {stated}"))
        .at(
            model_at,
            format!("initial stiffness of the model: {initial}"),
        )
        .help(format!(
            "remove `{field}`, or set `stiffness_uncertainty` to a third of the difference or more"
        ))
    }
}

/// The spring of a storey or of an element, with the model on the rig if it is tested.
pub struct Spring {
    /// \[N/m\]
    pub stiffness: f64,
    pub stiffness_uncertainty: f64,
    pub behaviour: Behaviour,
    /// \[N·s/m\]
    pub damping: f64,
    /// \[N\]
    pub coulomb: f64,
    pub part: Part,
}

/// The position of a storey or element in its list, from 1.
#[derive(Clone, Copy)]
pub struct Place {
    pub word: &'static str,
    pub number: usize,
    pub at: Span,
}

/// The arguments that storeys and elements share. `stated` reads their stiffness: None from the behaviour.
pub fn spring<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    place: Place,
    context: Context,
    stated: impl FnOnce(&mut Checker<'a>) -> Option<Option<f64>>,
) -> Option<Spring> {
    let Place { word, number, at } = place;
    let stiffness_uncertainty =
        checker.constant_argument(chosen, storey::STIFFNESS_UNCERTAINTY, context);
    let stated = stated(checker);
    let behaviour = match chosen.find(storey::BEHAVIOUR) {
        Some((
            Field {
                ty: FieldType::Choice(variants),
                ..
            },
            Some(expr),
        )) => {
            let written = Written {
                field: storey::BEHAVIOUR,
                variants,
                expr,
                context,
                material: Material::default(),
            };
            behaviour::behaviour(checker, &written).map(Some)
        }
        _ => Some(None),
    };
    let damping = checker.constant_argument(chosen, storey::DAMPING, context);
    let coulomb = checker.constant_argument(chosen, storey::COULOMB, context);
    let part = part(checker, chosen, context);
    let (behaviour, damping, coulomb) = (behaviour?, damping?, coulomb?);
    let part = part?;
    let scale = part.scale();
    for (field, value) in [(storey::DAMPING, damping), (storey::COULOMB, coulomb)] {
        if part == Part::Computed && value != 0.0 {
            return checker.fail(RigDampingOfComputed {
                word,
                number,
                field,
                span: chosen.span(field).unwrap_or(at),
                part: chosen.span(storey::PART).unwrap_or(at),
            });
        }
    }
    let stiffness = match (stated?, &behaviour) {
        (Some(stiffness), _) => stiffness,
        (None, Some(behaviour)) => scale.stiffness_of_storey(behaviour.initial_stiffness()),
        (None, None) if word == ELEMENT => {
            return checker.fail(ElementWithoutStiffness { number, span: at });
        }
        (None, None) => return checker.fail(StoreyWithoutStiffness { number, span: at }),
    };
    let stiffness_uncertainty = stiffness_uncertainty?;
    let differs = |initial: f64| {
        let model = scale.stiffness_of_storey(initial);
        (stiffness - model).abs() > SAME * stiffness.max(model) + WITHIN * stiffness_uncertainty
    };
    if let Some(initial) = behaviour.as_ref().map(Behaviour::initial_stiffness)
        && differs(initial)
    {
        let given = [storey::STIFFNESS, storey::COLUMN_STIFFNESS]
            .into_iter()
            .find_map(|field| Some((field, chosen.span(field)?)));
        let (field, given) = given.unwrap_or((storey::STIFFNESS, at));
        let bends = chosen.span(storey::BEHAVIOUR).unwrap_or(at);
        let (stated, model) = (Spanned::new(stiffness, given), Spanned::new(initial, bends));
        if scale != Scale::FULL {
            return checker.fail(StoreyOfAnotherScale {
                word,
                number,
                stated,
                model,
                scale: Spanned::new(scale, chosen.span(storey::PART).unwrap_or(at)),
            });
        }
        return checker.fail(StoreyBendsOtherwise {
            word,
            number,
            field,
            stated,
            model,
        });
    }
    let behaviour = behaviour.unwrap_or(Behaviour::Elastic {
        stiffness: scale.stiffness_on_the_rig(stiffness),
    });
    not_too_uncertain(
        checker,
        TooUncertain {
            field: storey::STIFFNESS_UNCERTAINTY,
            uncertainty: stiffness_uncertainty,
            value: stiffness,
            dimension: Dimension::STIFFNESS,
            span: chosen.span(storey::STIFFNESS_UNCERTAINTY).unwrap_or(at),
        },
    )?;
    Some(Spring {
        stiffness,
        stiffness_uncertainty,
        behaviour,
        damping,
        coulomb,
        part,
    })
}

/// A stated uncertainty is at most a part of its value.
pub fn not_too_uncertain(checker: &mut Checker, stated: TooUncertain) -> Option<()> {
    if stated.uncertainty > MOST_UNCERTAIN * stated.value {
        return checker.fail(stated);
    }
    Some(())
}
