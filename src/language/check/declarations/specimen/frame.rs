//! The frame of a specimen: `storeys = [storey(…), …]`, or the files of its matrices. In: a `specimen` block. Out: a
//! [`Frame`], evaluated once.

use std::rc::Rc;

use crate::check::checker::{Checker, Context, Traced};
use crate::check::expressions::choice::Chosen;
use crate::check::violations::{EmptyList, TooUncertain};
use crate::check::wording::shown;
use crate::codes::{E405, E621, E622, E623, E668, E670};

use crate::syntax::ast::Ident;
use psd_plan::procedures::impact::block as impact;
use psd_plan::schema::frames::storey;
use psd_plan::schema::specimen as fields;
use psd_plan::{Frame, MOST_STOREYS, Part, Storey};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;
use psd_text::units::display::significant;

use super::elements::with_elements;
use super::matrix;
use super::scale::AnotherScaleInOneSpecimen;
use super::spring::{Place, STOREY, not_too_uncertain, spring};

/// Fields that make a specimen a frame.
pub const FIELDS: [&str; 4] = [
    fields::STOREYS.name,
    fields::MASS_MATRIX.name,
    fields::STIFFNESS_MATRIX.name,
    fields::ELEMENTS.name,
];

/// Uncertainties of the matrices, with the field that each belongs to.
const MATRIX_UNCERTAINTIES: [&str; 2] = [
    fields::MASS_MATRIX_UNCERTAINTY.name,
    fields::STIFFNESS_MATRIX_UNCERTAINTY.name,
];

/// Fields of a specimen of one degree of freedom, which a frame does not have.
const OF_ONE: [&str; 8] = [
    fields::MASS.name,
    fields::MASS_UNCERTAINTY.name,
    fields::LENGTH.name,
    fields::AREA.name,
    fields::DENSITY.name,
    fields::BEHAVIOUR.name,
    fields::DAMPING.name,
    fields::COULOMB.name,
];

pub fn is_frame(checker: &Checker, block: usize) -> bool {
    FIELDS
        .iter()
        .any(|field| checker.field(block, field).is_some())
}

/// The frame; an error in it is reported once, however often it is requested.
pub fn frame(checker: &mut Checker, block: usize) -> Option<Rc<Frame>> {
    checker.once_in(
        |checker| &mut checker.frames,
        block,
        |checker| {
            // There is no frame until it is known: a storey that reads the mass of its own frame gets no value.
            checker.frames.insert(block, Traced::unknown());
            report_once(checker, block)?;
            let frame = if checker.field(block, fields::STOREYS.name).is_some() {
                Frame::of_storeys(storeys(checker, block)?)
            } else {
                let frame = matrices(checker, block)?;
                with_elements(checker, block, frame)?
            };
            Some(Rc::new(frame))
        },
    )
}

struct SpecimenTwice<'a> {
    first: &'a Ident,
    other: &'a Ident,
}

impl Violation for SpecimenTwice<'_> {
    const CODE: Code = E623;

    fn diagnostic(self) -> Diagnostic {
        let Self { first, other } = self;
        Diagnostic::new(
            Self::CODE,
            format!(
                "structure given twice: by `{}` and by `{}`",
                first.node, other.node
            ),
        )
        .at(other.span, "given again")
        .at(first.span, "first given here")
        .help(format!("remove `{}`, or `{}`", other.node, first.node))
    }
}

struct MatrixAlone<'a> {
    given: &'a Ident,
    missing: &'a str,
}

impl Violation for MatrixAlone<'_> {
    const CODE: Code = E623;

    fn diagnostic(self) -> Diagnostic {
        let Self { given, missing } = self;
        Diagnostic::new(Self::CODE, format!("`{}` requires `{missing}`", given.node))
            .at(given.span, "one matrix only")
            .help(format!(
                "add a line `{missing} = \"{}.csv\"`",
                &missing[..1]
            ))
    }
}

/// A specimen is either storeys, or two matrices, or one degree of freedom.
fn report_once(checker: &mut Checker, block: usize) -> Option<()> {
    let storeys = checker.field(block, fields::STOREYS.name);
    let matrices = [fields::MASS_MATRIX.name, fields::STIFFNESS_MATRIX.name]
        .map(|field| checker.field(block, field));
    let elements = checker.field(block, fields::ELEMENTS.name);
    let first = storeys.or(matrices[0]).or(matrices[1]).or(elements)?.1;
    let of_matrices = MATRIX_UNCERTAINTIES.map(|field| checker.field(block, field));
    let beside_storeys = matrices
        .into_iter()
        .chain(of_matrices)
        .chain([elements])
        .flatten()
        .filter(|_| storeys.is_some());
    let of_one = OF_ONE
        .iter()
        .filter_map(|field| checker.field(block, field));
    let other = beside_storeys
        .chain(of_one)
        .map(|(_, entry)| &entry.key)
        .next();
    if let Some(other) = other {
        return checker.fail(SpecimenTwice {
            first: &first.key,
            other,
        });
    }
    match (storeys, matrices) {
        (None, [Some((_, mass)), None]) => checker.fail(MatrixAlone {
            given: &mass.key,
            missing: fields::STIFFNESS_MATRIX.name,
        }),
        (None, [None, Some((_, stiffness))]) => checker.fail(MatrixAlone {
            given: &stiffness.key,
            missing: fields::MASS_MATRIX.name,
        }),
        (None, [None, None]) => checker.fail(ElementsAlone {
            span: first.key.span,
        }),
        _ => Some(()),
    }
}

#[derive(Violation)]
#[violation(E623, "`elements` requires `mass_matrix` and `stiffness_matrix`")]
#[help("add the matrices of the computed part, or write the frame as `storeys`")]
struct ElementsAlone {
    #[label("matrices missing")]
    span: Span,
}

struct MatrixUncertaintyAlone<'a> {
    given: &'a Ident,
    matrix: &'a str,
}

impl Violation for MatrixUncertaintyAlone<'_> {
    const CODE: Code = E623;

    fn diagnostic(self) -> Diagnostic {
        let Self { given, matrix } = self;
        Diagnostic::new(Self::CODE, format!("`{}` requires `{matrix}`", given.node))
            .at(given.span, "matrix missing")
            .help(format!(
                "remove it, or read the frame's `{matrix}` from a file"
            ))
    }
}

/// A specimen of one degree of freedom has no matrices that could be uncertain.
pub fn no_matrix_uncertainties(checker: &mut Checker, block: usize) -> Option<()> {
    for (field, matrix) in MATRIX_UNCERTAINTIES
        .into_iter()
        .zip([fields::MASS_MATRIX.name, fields::STIFFNESS_MATRIX.name])
    {
        if let Some((_, entry)) = checker.field(block, field) {
            return checker.fail(MatrixUncertaintyAlone {
                given: &entry.key,
                matrix,
            });
        }
    }
    Some(())
}

#[derive(Violation)]
#[violation(E405, "too many storeys: {found} (at most {most})")]
#[help("combine storeys; each one requires an actuator")]
struct TooManyStoreys {
    found: usize,
    most: usize,
    #[label("too many")]
    span: Span,
}

fn storeys(checker: &mut Checker, block: usize) -> Option<Vec<Storey>> {
    let (entry, written) = checker.field(block, fields::STOREYS.name)?;
    let context = checker.context_of(block, entry);
    let chosen = checker.choices(block, fields::STOREYS.name)?;
    let span = written.value.span;
    if chosen.is_empty() {
        return checker.fail(EmptyList { span });
    }
    if chosen.len() > MOST_STOREYS {
        return checker.fail(TooManyStoreys {
            found: chosen.len(),
            most: MOST_STOREYS,
            span,
        });
    }
    let at = |index: usize| written.value.item_span(index);
    let storeys: Vec<Option<Storey>> = chosen
        .iter()
        .enumerate()
        .map(|(index, chosen)| storey(checker, chosen, index + 1, at(index), context))
        .collect();
    let storeys: Vec<Storey> = storeys.into_iter().collect::<Option<_>>()?;
    stands(checker, &chosen, &storeys, at)?;
    let mut below = Part::Computed;
    for (index, storey) in storeys.iter().enumerate() {
        let below = std::mem::replace(&mut below, storey.part);
        let Part::Tested { apart, scale } = storey.part else {
            continue;
        };
        let span = chosen[index].span(storey::PART).unwrap_or(at(index));
        match below {
            Part::Computed if apart => {
                return checker.fail(ApartFromNothing {
                    number: index + 1,
                    span,
                });
            }
            Part::Tested { scale: other, .. } if !apart && scale != other => {
                return checker.fail(AnotherScaleInOneSpecimen {
                    number: index + 1,
                    span,
                    below: chosen[index - 1]
                        .span(storey::PART)
                        .unwrap_or(at(index - 1)),
                });
            }
            _ => {}
        }
    }
    Some(storeys)
}

/// A storey that carries weight has a height, and stands under the weight: θ = P/(K h) < 1.
fn stands<'a>(
    checker: &mut Checker<'a>,
    chosen: &[Chosen<'a>],
    storeys: &[Storey],
    at: impl Fn(usize) -> Span,
) -> Option<()> {
    let loads = Frame::of_storeys(storeys.to_vec()).axial_loads();
    for (index, (load, own)) in loads.into_iter().zip(storeys).enumerate() {
        if load == 0.0 {
            continue;
        }
        let Some(height) = own.height else {
            let from = storeys.iter().rposition(|storey| storey.gravity > 0.0);
            let from = from.unwrap_or(index);
            return checker.fail(CarriesWithoutHeight {
                number: index + 1,
                span: at(index),
                weight: chosen[from].span(storey::GRAVITY).unwrap_or(at(from)),
            });
        };
        let coefficient = load / (own.stiffness * height);
        if coefficient >= 1.0 {
            let named = |field| chosen[index].span(field);
            return checker.fail(FallsUnderWeight {
                number: index + 1,
                coefficient,
                load,
                stiffness: own.stiffness,
                height,
                span: named(storey::HEIGHT).unwrap_or(at(index)),
            });
        }
    }
    Some(())
}

#[derive(Violation)]
#[violation(E670, "storey {number} carries weight, but has no `height`")]
#[help("add `height: 3 m` to the storey: P-Δ is the weight above times drift over height")]
struct CarriesWithoutHeight {
    number: usize,
    #[label("`height` is missing")]
    span: Span,
    #[label("weight above")]
    weight: Span,
}

/// A storey that is unstable at rest: P \[N\], K \[N/m\], h \[m\].
struct FallsUnderWeight {
    number: usize,
    coefficient: f64,
    load: f64,
    stiffness: f64,
    height: f64,
    span: Span,
}

impl Violation for FallsUnderWeight {
    const CODE: Code = E670;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            number,
            coefficient,
            load,
            stiffness,
            height,
            span,
        } = self;
        let message = format!(
            "storey {number} falls over under the weight above it: P/(K h) = {} (below 1 expected)",
            significant(coefficient, 3)
        );
        Diagnostic::new(Self::CODE, message)
            .at(
                span,
                format!(
                    "P = {}, K = {}, h = {}",
                    shown(load, Dimension::FORCE),
                    shown(stiffness, Dimension::STIFFNESS),
                    shown(height, Dimension::LENGTH)
                ),
            )
            .help("write a larger `stiffness` or `height`, or a smaller `gravity`: it is a force, the weight of one floor")
    }
}

#[derive(Violation)]
#[violation(E668, "storey {number} is `apart`, but the storey below is not tested")]
#[help("write `part: tested`: the storey is a separate specimen anyway")]
struct ApartFromNothing {
    number: usize,
    #[label("no effect")]
    span: Span,
}

#[derive(Violation)]
#[violation(E622, "storey {number} has two stiffnesses")]
#[help("keep `stiffness` (whole storey) or `column_stiffness` (one of its two columns)")]
struct StoreyStiffnessTwice {
    number: usize,
    #[label("given again")]
    span: Span,
}

fn storey<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    number: usize,
    at: Span,
    context: Context,
) -> Option<Storey> {
    let mass = checker.constant_argument(chosen, storey::MASS, context);
    let mass_uncertainty = checker.constant_argument(chosen, storey::MASS_UNCERTAINTY, context);
    let height = checker.optional_argument(chosen, storey::HEIGHT, context);
    let gravity = checker.constant_argument(chosen, storey::GRAVITY, context);
    let place = Place {
        word: STOREY,
        number,
        at,
    };
    let stated = |checker: &mut Checker<'a>| {
        let total = checker.optional_argument(chosen, storey::STIFFNESS, context);
        let column = checker.optional_argument(chosen, storey::COLUMN_STIFFNESS, context);
        match (total?, column?) {
            (Some(_), Some(_)) => {
                let span = chosen.span(storey::COLUMN_STIFFNESS).unwrap_or(at);
                checker.fail(StoreyStiffnessTwice { number, span })
            }
            (total, column) => Some(total.or(column.map(|column| 2.0 * column))),
        }
    };
    let spring = spring(checker, chosen, place, context, stated);
    let (mass, mass_uncertainty, height, gravity) = (mass?, mass_uncertainty?, height?, gravity?);
    let spring = spring?;
    not_too_uncertain(
        checker,
        TooUncertain {
            field: storey::MASS_UNCERTAINTY,
            uncertainty: mass_uncertainty,
            value: mass,
            dimension: Dimension::MASS,
            span: chosen.span(storey::MASS_UNCERTAINTY).unwrap_or(at),
        },
    )?;
    Some(Storey {
        mass,
        mass_uncertainty,
        stiffness: spring.stiffness,
        stiffness_uncertainty: spring.stiffness_uncertainty,
        height,
        gravity,
        behaviour: spring.behaviour,
        damping: spring.damping,
        coulomb: spring.coulomb,
        part: spring.part,
        axial_load: 0.0,
    })
}

#[derive(Violation)]
#[violation(
    E621,
    "matrix sizes differ: `{file}` has {stiffness} rows, the mass matrix has {mass}"
)]
#[help("write both matrices with one row and one column per floor")]
struct MatricesOfTwoSizes<'a> {
    file: &'a str,
    stiffness: usize,
    mass: usize,
    #[label("different size")]
    span: Span,
}

/// The frame from the files of its matrices, with the files.
fn matrices(checker: &mut Checker, block: usize) -> Option<Frame> {
    let mass = matrix_of(checker, block, fields::MASS_MATRIX.name);
    let stiffness = matrix_of(checker, block, fields::STIFFNESS_MATRIX.name);
    let ((mass_file, mass), (stiffness_file, stiffness)) = (mass?, stiffness?);
    if mass.len() != stiffness.len() {
        let (_, written) = checker.field(block, fields::STIFFNESS_MATRIX.name)?;
        let diagnostic = MatricesOfTwoSizes {
            file: &stiffness_file,
            stiffness: stiffness.len(),
            mass: mass.len(),
            span: written.value.span,
        }
        .diagnostic();
        return checker.fail(diagnostic);
    }
    let matrix_uncertainty = MATRIX_UNCERTAINTIES.map(|field| checker.constant(block, field));
    let [Some(of_mass), Some(of_stiffness)] = matrix_uncertainty else {
        return None;
    };
    Some(Frame {
        files: Some([mass_file, stiffness_file]),
        matrix_uncertainty: [of_mass, of_stiffness],
        ..Frame::of_matrices(mass, stiffness)
    })
}

#[derive(Violation)]
#[violation(E621, "cannot read `{file}` as a structural matrix: {reason}")]
#[help(
    "write one row per line, comma-separated; the matrix must be square, symmetric and positive definite"
)]
struct BadMatrix<'a> {
    file: &'a str,
    reason: &'a str,
    #[label("invalid matrix")]
    span: Span,
}

fn matrix_of(checker: &mut Checker, block: usize, field: &str) -> Option<(String, Vec<Vec<f64>>)> {
    let (_, written) = checker.field(block, field)?;
    let span = written.value.span;
    let name = checker.text_field(block, field)?;
    let file = checker.data_file(&name, span)?;
    // Beside elements K may be singular: a part that elements alone hold.
    let beside = field == fields::STIFFNESS_MATRIX.name
        && checker.field(block, fields::ELEMENTS.name).is_some();
    let read = if beside {
        matrix::read_symmetric(&file.text)
    } else {
        matrix::read(&file.text)
    };
    match read {
        Ok(matrix) => Some((file.name, matrix)),
        Err(reason) => checker.fail(BadMatrix {
            file: &file.name,
            reason: &reason,
            span,
        }),
    }
}

/// The frame of a block that strikes one storey; None if it strikes one degree of freedom, or a specimen that is not known.
pub fn struck_frame(checker: &mut Checker, block: usize) -> Option<(usize, Option<Rc<Frame>>)> {
    let specimen = checker
        .tested(block)
        .filter(|specimen| is_frame(checker, *specimen))?;
    let frame = frame(checker, specimen);
    let several = frame
        .as_ref()
        .is_none_or(|frame| frame.degrees_of_freedom() > 1);
    (several || checker.field(block, impact::STOREY.name).is_some()).then_some((specimen, frame))
}
