//! The frame of a specimen: `storeys = [storey(…), …]`, or the files of its matrices. In: a `specimen` block. Out: a
//! [`Frame`], worked out once.

use std::rc::Rc;

use super::behaviour::{self, Material, Written};
use super::matrix;
use super::striker::MOST_UNCERTAIN;
use crate::language::check::checker::{Checker, Place};
use crate::language::check::expressions::choice::Chosen;
use crate::language::check::messages::{frames as fault, values};
use crate::language::syntax::ast::ExprKind;
use crate::plan::{Behaviour, Frame, MOST_STOREYS, Storey};
use crate::schema::{Field, FieldType};
use crate::text::source::Span;
use crate::units::Dimension;

/// Fields that make a specimen a frame.
pub const FIELDS: [&str; 3] = ["storeys", "mass_matrix", "stiffness_matrix"];

/// A stiffness is that of its behaviour to so much of it: the last digits of a sum or a quotient.
const SAME: f64 = 1e-9;

/// And may be off by so many of its standard uncertainties, where the plan states one.
const WITHIN: f64 = 3.0;

/// Uncertainties of the matrices, and what they are of.
const MATRIX_UNCERTAINTIES: [&str; 2] = ["mass_matrix_uncertainty", "stiffness_matrix_uncertainty"];

/// Fields of a specimen of one degree of freedom, which a frame has none of.
const OF_ONE: [&str; 8] = [
    "mass",
    "mass_uncertainty",
    "length",
    "area",
    "density",
    "behaviour",
    "damping",
    "coulomb",
];

pub fn is_frame(checker: &Checker, block: usize) -> bool {
    FIELDS
        .iter()
        .any(|field| checker.given(block, field).is_some())
}

/// The frame; a fault in it is reported once, however often it is asked for.
pub fn frame(checker: &mut Checker, block: usize) -> Option<Rc<Frame>> {
    if let Some(known) = checker.frames.get(&block) {
        return known.clone();
    }
    // Until it is known it is none: a storey that reads its own frame's mass gets nothing.
    checker.frames.insert(block, None);
    let frame = said_once(checker, block).and_then(|()| match checker.given(block, "storeys") {
        Some(_) => storeys(checker, block).map(Frame::of_storeys),
        None => matrices(checker, block),
    });
    let frame = frame.map(Rc::new);
    checker.frames.insert(block, frame.clone());
    frame
}

/// A specimen is one thing: storeys, two matrices, or one degree of freedom.
fn said_once(checker: &mut Checker, block: usize) -> Option<()> {
    let storeys = checker.given(block, "storeys");
    let matrices = ["mass_matrix", "stiffness_matrix"].map(|field| checker.given(block, field));
    let first = storeys.or(matrices[0]).or(matrices[1])?.1;
    let of_matrices = MATRIX_UNCERTAINTIES.map(|field| checker.given(block, field));
    let beside_storeys = matrices
        .into_iter()
        .chain(of_matrices)
        .flatten()
        .filter(|_| storeys.is_some());
    let of_one = OF_ONE
        .iter()
        .filter_map(|field| checker.given(block, field));
    let other = beside_storeys
        .chain(of_one)
        .map(|(_, entry)| &entry.key)
        .next();
    if let Some(other) = other {
        return checker.fail(fault::specimen_twice(&first.key, other));
    }
    match (storeys, matrices) {
        (None, [Some((_, mass)), None]) => {
            checker.fail(fault::matrix_alone(&mass.key, "stiffness_matrix"))
        }
        (None, [None, Some((_, stiffness))]) => {
            checker.fail(fault::matrix_alone(&stiffness.key, "mass_matrix"))
        }
        _ => Some(()),
    }
}

/// Of one degree of freedom there are no matrices to be uncertain.
pub fn no_matrix_uncertainties(checker: &mut Checker, block: usize) -> Option<()> {
    for (field, matrix) in MATRIX_UNCERTAINTIES
        .into_iter()
        .zip(["mass_matrix", "stiffness_matrix"])
    {
        if let Some((_, entry)) = checker.given(block, field) {
            return checker.fail(fault::matrix_uncertainty_alone(&entry.key, matrix));
        }
    }
    Some(())
}

fn storeys(checker: &mut Checker, block: usize) -> Option<Vec<Storey>> {
    let (entry, written) = checker.given(block, "storeys")?;
    let place = checker.place(block, entry);
    let chosen = checker.choices(block, "storeys")?;
    let span = written.value.span;
    if chosen.is_empty() {
        return checker.fail(values::empty_list(span));
    }
    if chosen.len() > MOST_STOREYS {
        return checker.fail(fault::too_many_storeys(chosen.len(), MOST_STOREYS, span));
    }
    let at = |index: usize| match &written.value.kind {
        ExprKind::List { items, .. } => items.get(index).map_or(span, |item| item.span),
        _ => span,
    };
    let storeys: Vec<Option<Storey>> = chosen
        .iter()
        .enumerate()
        .map(|(index, chosen)| storey(checker, chosen, index + 1, at(index), place))
        .collect();
    storeys.into_iter().collect()
}

fn storey<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    number: usize,
    at: Span,
    place: Place,
) -> Option<Storey> {
    let mass = checker.constant_argument(chosen, "mass", place);
    let mass_uncertainty = checker.constant_argument(chosen, "mass_uncertainty", place);
    let stiffness_uncertainty = checker.constant_argument(chosen, "stiffness_uncertainty", place);
    let height = checker.optional_argument(chosen, "height", place);
    let total = checker.optional_argument(chosen, "stiffness", place);
    let column = checker.optional_argument(chosen, "column_stiffness", place);
    let behaviour = match chosen.find("behaviour") {
        Some((
            Field {
                ty: FieldType::Choice(variants),
                ..
            },
            Some(expr),
        )) => {
            let written = Written {
                field: "behaviour",
                variants,
                expr,
                place,
                material: Material::default(),
            };
            behaviour::behaviour(checker, &written).map(Some)
        }
        _ => Some(None),
    };
    let damping = checker.constant_argument(chosen, "damping", place);
    let coulomb = checker.constant_argument(chosen, "coulomb", place);
    let (mass, height, behaviour, damping, coulomb) =
        (mass?, height?, behaviour?, damping?, coulomb?);
    let stiffness = match (total?, column?, &behaviour) {
        (Some(_), Some(_), _) => {
            let again = chosen.span("column_stiffness").unwrap_or(at);
            return checker.fail(fault::storey_stiffness_twice(number, again));
        }
        (Some(stiffness), None, _) => stiffness,
        (None, Some(column), _) => 2.0 * column,
        (None, None, Some(behaviour)) => behaviour.initial_stiffness(),
        (None, None, None) => return checker.fail(fault::storey_without_stiffness(number, at)),
    };
    let (mass_uncertainty, stiffness_uncertainty) = (mass_uncertainty?, stiffness_uncertainty?);
    if let Some(initial) = behaviour.as_ref().map(Behaviour::initial_stiffness)
        && (stiffness - initial).abs()
            > SAME * stiffness.max(initial) + WITHIN * stiffness_uncertainty
    {
        let said = ["stiffness", "column_stiffness"]
            .into_iter()
            .find_map(|field| Some((field, chosen.span(field)?)));
        let (field, said) = said.unwrap_or(("stiffness", at));
        let bends = chosen.span("behaviour").unwrap_or(at);
        return checker.fail(fault::storey_bends_otherwise(
            number,
            (field, stiffness, said),
            (initial, bends),
        ));
    }
    let behaviour = behaviour.unwrap_or(Behaviour::Elastic { stiffness });
    let stated = [
        ("mass_uncertainty", mass_uncertainty, mass, Dimension::MASS),
        (
            "stiffness_uncertainty",
            stiffness_uncertainty,
            stiffness,
            Dimension::STIFFNESS,
        ),
    ];
    for (field, uncertainty, value, dimension) in stated {
        if uncertainty > MOST_UNCERTAIN * value {
            let at = chosen.span(field).unwrap_or(at);
            return checker.fail(values::too_uncertain(
                field,
                uncertainty,
                value,
                dimension,
                at,
            ));
        }
    }
    Some(Storey {
        mass,
        mass_uncertainty,
        stiffness,
        stiffness_uncertainty,
        height,
        behaviour,
        damping,
        coulomb,
    })
}

/// The frame that the files of its matrices give, with the files.
fn matrices(checker: &mut Checker, block: usize) -> Option<Frame> {
    let mass = matrix_of(checker, block, "mass_matrix");
    let stiffness = matrix_of(checker, block, "stiffness_matrix");
    let ((mass_file, mass), (stiffness_file, stiffness)) = (mass?, stiffness?);
    if mass.len() != stiffness.len() {
        let (_, written) = checker.given(block, "stiffness_matrix")?;
        let fault = fault::matrices_of_two_sizes(
            &stiffness_file,
            stiffness.len(),
            mass.len(),
            written.value.span,
        );
        return checker.fail(fault);
    }
    let matrix_uncertainty = MATRIX_UNCERTAINTIES.map(|field| checker.constant(block, field));
    let [Some(of_mass), Some(of_stiffness)] = matrix_uncertainty else {
        return None;
    };
    let files = Some([mass_file, stiffness_file]);
    Some(Frame {
        storeys: Vec::new(),
        mass,
        stiffness,
        files,
        matrix_uncertainty: [of_mass, of_stiffness],
    })
}

fn matrix_of(checker: &mut Checker, block: usize, field: &str) -> Option<(String, Vec<Vec<f64>>)> {
    let (_, written) = checker.given(block, field)?;
    let span = written.value.span;
    let name = checker.text_field(block, field)?;
    let file = checker.data_file(&name, span)?;
    match matrix::read(&file.text) {
        Ok(matrix) => Some((file.name, matrix)),
        Err(reason) => checker.fail(fault::bad_matrix(&file.name, &reason, span)),
    }
}
