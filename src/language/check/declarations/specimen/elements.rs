//! `elements = [element(…), …]` beside the matrices of a frame. In: a `specimen` block, its matrices. Out: the [`Frame`] with its elements.

use crate::check::checker::{Checker, Context};
use crate::check::expressions::choice::Chosen;
use crate::check::violations::EmptyList;
use crate::codes::{E405, E668, E671};
use psd_plan::schema::frames::{element, storey};
use psd_plan::schema::specimen as fields;
use psd_plan::{Element, Frame, MOST_STOREYS, Part};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

use super::matrix;
use super::spring::{ELEMENT, Place, Spring, spring};

#[derive(Violation)]
#[violation(E405, "too many elements: {found} (at most {most})")]
#[help(
    "combine elements that join the same degrees of freedom, or add linear ones to the stiffness matrix"
)]
struct TooManyElements {
    found: usize,
    most: usize,
    #[label("too many")]
    span: Span,
}

#[derive(Violation)]
#[violation(E671, "element {number} joins degree of freedom {degree} to itself")]
#[help("write different numbers in `from` and `to`; 0 is the ground")]
struct JoinsNothing {
    number: usize,
    degree: usize,
    #[label("the same as `from`")]
    to: Span,
    #[label("first end")]
    from: Span,
}

#[derive(Violation)]
#[violation(
    E671,
    "element {number} has its end at degree of freedom {degree}, but the matrices have {order}"
)]
#[help("write a number from 1 to {order}, or 0 for the ground")]
struct NoSuchDegree {
    number: usize,
    degree: usize,
    order: usize,
    #[label("no such row")]
    span: Span,
}

#[derive(Violation)]
#[violation(E671, "matrices and elements together are {reason}")]
#[help("add an element or a stiffness that holds every degree of freedom to the ground")]
struct FrameDoesNotStand<'a> {
    reason: &'a str,
    #[label("not held")]
    span: Span,
}

#[derive(Violation)]
#[violation(
    E668,
    "element {number} is `apart`, but every element is a separate specimen"
)]
#[help("remove `apart`")]
struct ElementApart {
    number: usize,
    #[label("no effect")]
    span: Span,
}

/// The frame with the elements of the block.
pub fn with_elements(checker: &mut Checker, block: usize, frame: Frame) -> Option<Frame> {
    let Some((entry, written)) = checker.field(block, fields::ELEMENTS.name) else {
        return Some(frame);
    };
    let context = checker.context_of(block, entry);
    let chosen = checker.choices(block, fields::ELEMENTS.name)?;
    let span = written.value.span;
    if chosen.is_empty() {
        return checker.fail(EmptyList { span });
    }
    if chosen.len() > MOST_STOREYS {
        return checker.fail(TooManyElements {
            found: chosen.len(),
            most: MOST_STOREYS,
            span,
        });
    }
    let at = |index: usize| written.value.item_span(index);
    let order = frame.degrees_of_freedom();
    let elements: Vec<Option<Element>> = chosen
        .iter()
        .enumerate()
        .map(|(index, chosen)| {
            let place = Place {
                word: ELEMENT,
                number: index + 1,
                at: at(index),
            };
            element(checker, chosen, place, order, context)
        })
        .collect();
    let elements = elements.into_iter().collect::<Option<_>>()?;
    let frame = frame.with_elements(elements);
    if let Err(reason) = matrix::positive_definite(&frame.stiffness) {
        let diagnostic = FrameDoesNotStand {
            reason: &reason,
            span,
        }
        .diagnostic();
        return checker.fail(diagnostic);
    }
    Some(frame)
}

fn element<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    place: Place,
    order: usize,
    context: Context,
) -> Option<Element> {
    let ends =
        [element::FROM, element::TO].map(|end| checker.constant_argument(chosen, end, context));
    let stated =
        |checker: &mut Checker<'a>| checker.optional_argument(chosen, storey::STIFFNESS, context);
    let spring = spring(checker, chosen, place, context, stated);
    let [Some(from), Some(to)] = ends else {
        return None;
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "counts from 0 to 64"
    )]
    let degrees = [from as usize, to as usize];
    let Place { number, at, .. } = place;
    let named = |field| chosen.span(field).unwrap_or(at);
    for (field, degree) in [element::FROM, element::TO].into_iter().zip(degrees) {
        if degree > order {
            return checker.fail(NoSuchDegree {
                number,
                degree,
                order,
                span: named(field),
            });
        }
    }
    if degrees[0] == degrees[1] {
        return checker.fail(JoinsNothing {
            number,
            degree: degrees[0],
            from: named(element::FROM),
            to: named(element::TO),
        });
    }
    let Spring {
        stiffness,
        stiffness_uncertainty,
        behaviour,
        damping,
        coulomb,
        part,
    } = spring?;
    if let Part::Tested { apart: true, .. } = part {
        let span = named(storey::PART);
        return checker.fail(ElementApart { number, span });
    }
    Some(Element {
        ends: degrees.map(|degree| degree.checked_sub(1)),
        stiffness,
        stiffness_uncertainty,
        behaviour,
        damping,
        coulomb,
        part,
    })
}
