//! `specimen NAME { … }`: equivalent mass and restoring-force model.

mod backbone;
mod beam;
pub mod behaviour;
mod elements;
pub mod frame;
mod matrix;
mod portal;
mod scale;
mod spring;
mod table_file;

use std::rc::Rc;

use crate::check::checker::Checker;
use crate::check::violations::MissingField;
use crate::check::wording::shown;
use crate::codes::{E206, E209, E628, E634, W715};
use crate::syntax::ast::{Expr, ExprKind, Ident};
use behaviour::{Material, Written};
use psd_physics::structure::portal::limit::mechanism_limit;
use psd_plan::formula::{Formula, Function, Stated};
use psd_plan::schema::{FieldType, Kind, specimen as fields};
use psd_plan::uncertainty::Source;
use psd_plan::{Behaviour, Interval, Mechanism, Specimen, Storey};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;

use super::limits::CheckedLimits;
use super::striker::uncertainty;

/// Standard uncertainty of the mass that an impact takes from its specimen \[kg\].
pub fn mass_uncertainty(checker: &mut Checker, block: usize) -> Option<f64> {
    if frame::is_frame(checker, block) {
        return frame::frame(checker, block).map(|frame| frame.total_mass_uncertainty());
    }
    checker.constant(block, fields::MASS_UNCERTAINTY.name)
}

/// Neither a mass nor a weight that moves with the load.
#[derive(Violation)]
#[violation(
    E209,
    "specimen `{name}` has no mass: no moving part of its portal has one",
    name = name.map_or("", |name| name.node.as_str())
)]
#[help(
    "add the mass of the members, such as `mass_per_length: 12 kg/m` in `portal(…)`, or a line such as `mass = 25 kg`"
)]
struct PortalWithoutMass<'a> {
    name: Option<&'a Ident>,
    #[label("`mass` is missing")]
    head: Span,
}

#[derive(Violation)]
#[violation(
    E209,
    "mass of specimen `{name}` unknown: {missing} missing",
    name = name.map_or("", |name| name.node.as_str())
)]
#[help("add `{missing}`, or the `mass` itself: density * area * length / 2 is the mass")]
struct MassIncomplete<'a> {
    name: Option<&'a Ident>,
    #[label("`{missing}` is missing")]
    head: Span,
    missing: &'a str,
}

/// A specimen whose entries are all valid; None where an error was reported.
pub fn specimen(checker: &mut Checker, block: usize) -> Option<Specimen> {
    let declared = &checker.scope.blocks[block];
    let (name, head) = (declared.name, declared.block.head);
    if frame::is_frame(checker, block) {
        let frame = frame::frame(checker, block)?;
        let mass_uncertainty = frame.total_mass_uncertainty();
        let (mass, frame) = (frame.total_mass(), Some((*frame).clone()));
        return Some(Specimen {
            mass_uncertainty,
            frame,
            ..Specimen::new(&name?.node, mass, None)
        });
    }
    let no_matrices = frame::no_matrix_uncertainties(checker, block);
    let mass = mass(checker, block);
    if checker.misspelt(
        block,
        &[
            fields::MASS.name,
            fields::DENSITY.name,
            fields::AREA.name,
            fields::LENGTH.name,
        ],
    ) || invalid_portal(checker, block)
    {
        // A misspelt or invalid entry has its own diagnostic.
    } else if mass.is_none()
        && names_portal(checker, block)
        && checker.field(block, fields::LENGTH.name).is_none()
    {
        checker.report(PortalWithoutMass { name, head });
    } else if mass.is_none() && !any_given(checker, block) {
        checker.report(MissingField {
            kind: declared.kind,
            name,
            head,
            field: fields::MASS.name,
            example: "mass = 0.73 kg",
        });
    } else if mass.is_none()
        && checker.field(block, fields::MASS.name).is_none()
        && let Some(missing) = [fields::DENSITY.name, fields::AREA.name, fields::LENGTH.name]
            .into_iter()
            .find(|field| checker.field(block, field).is_none())
    {
        checker.report(MassIncomplete {
            name,
            head,
            missing,
        });
    }
    beam_has_mass(checker, block, mass);
    // Every number is evaluated, also those without effect on the mass, so that all errors are reported in one pass.
    for field in [fields::LENGTH.name, fields::AREA.name, fields::DENSITY.name] {
        checker.quantity(block, field);
    }
    // A real specimen needs no model; a missing model of a virtual one has a separate diagnostic.
    let behaviour = match checker.field(block, fields::BEHAVIOUR.name) {
        None if checker.real_rig.is_some() => Some(None),
        _ => behaviour(checker, block, head).map(|behaviour| Some((*behaviour).clone())),
    };
    let (damping, coulomb) = (
        checker.constant(block, fields::DAMPING.name),
        checker.constant(block, fields::COULOMB.name),
    );
    let mass_uncertainty = uncertainty(checker, block, fields::MASS_UNCERTAINTY.name, mass);
    no_matrices?;
    Some(Specimen {
        name: name?.node.clone(),
        mass: mass?,
        mass_from: mass_from(checker, block),
        mass_uncertainty: mass_uncertainty?,
        frame: None,
        behaviour: behaviour?,
        damping: damping?,
        coulomb: coulomb?,
    })
}

/// `half` is q·A·L/2, `elastic` the mass from its own ends \[kg\]; None where the beam is only a part of its model.
struct BeamWithoutMass<'a> {
    name: &'a str,
    head: Span,
    half: f64,
    elastic: Option<f64>,
}

impl Violation for BeamWithoutMass<'_> {
    const CODE: Code = E209;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            name,
            head,
            half,
            elastic,
        } = self;
        let kg = |mass| shown(mass, Dimension::MASS);
        let half = format!(
            "`mass = density * area * length / 2`, {}, which is for a beam on two supports",
            kg(half)
        );
        let help = match elastic {
            Some(elastic) => format!(
                "write `mass = {name}.elastic_mass`, {}, from its ends, or {half}",
                kg(elastic)
            ),
            None => format!("write the moving mass, as in `mass = 0.9 kg`, or {half}"),
        };
        Diagnostic::new(
        Self::CODE,
        format!(
            "specimen `{name}` requires the field `mass`, which depends on the ends of its `beam`"
        ),
    )
    .at(head, "`mass` is missing")
    .help(help)
    }
}

/// A `beam` has ends, and q·A·L/2 applies to two supports: the plan must state which of its masses applies.
fn beam_has_mass(checker: &mut Checker, block: usize, half: Option<f64>) {
    let declared = &checker.scope.blocks[block];
    let beam = |written: &Expr| behaviour::names(written, "beam");
    let named = checker
        .field(block, fields::BEHAVIOUR.name)
        .is_some_and(|(_, entry)| beam(&entry.value));
    let (Some(half), Some(name)) = (half.filter(|_| named), declared.name) else {
        return;
    };
    if checker.field(block, fields::MASS.name).is_some() {
        return;
    }
    let masses = behaviour(checker, block, declared.block.head)
        .and_then(|behaviour| behaviour.equivalent_masses());
    checker.report(BeamWithoutMass {
        name: &name.node,
        head: declared.block.head,
        half,
        elastic: masses.map(|masses| masses.elastic),
    });
}

fn any_given(checker: &Checker, block: usize) -> bool {
    [
        fields::MASS.name,
        fields::DENSITY.name,
        fields::AREA.name,
        fields::LENGTH.name,
    ]
    .into_iter()
    .any(|field| checker.field(block, field).is_some())
}

/// `mass`, else the mass from a portal's geometry, else q·A·L/2, the equivalent mass at midspan (Melo et al. 2006, Fig. 5).
fn mass(checker: &mut Checker, block: usize) -> Option<f64> {
    if checker.field(block, fields::MASS.name).is_some() {
        return checker.constant(block, fields::MASS.name);
    }
    if let Some(elastic) = mass_of_portal(checker, block) {
        return Some(elastic);
    }
    let (density, area, length) = (
        checker.constant(block, fields::DENSITY.name)?,
        checker.constant(block, fields::AREA.name)?,
        checker.constant(block, fields::LENGTH.name)?,
    );
    Some(density * area * length / 2.0)
}

/// Equivalent mass by the elastic deflection \[kg\]. A portal without a mass at the point of its load has none.
fn mass_of_portal(checker: &mut Checker, block: usize) -> Option<f64> {
    if !names_portal(checker, block) {
        return None;
    }
    let at = checker.scope.blocks[block].block.head;
    let masses = behaviour(checker, block, at)?.equivalent_masses()?;
    Some(masses.elastic).filter(|elastic| *elastic > 0.0)
}

/// Whether a specimen without a stated mass is a portal.
fn names_portal(checker: &Checker, block: usize) -> bool {
    checker.field(block, fields::MASS.name).is_none()
        && checker
            .field(block, fields::BEHAVIOUR.name)
            .is_some_and(|(_, entry)| behaviour::names(&entry.value, "portal"))
}

fn invalid_portal(checker: &mut Checker, block: usize) -> bool {
    let at = checker.scope.blocks[block].block.head;
    names_portal(checker, block) && behaviour(checker, block, at).is_none()
}

/// The expression that gives the mass: as it is written, or that of the geometry where no mass is stated.
fn mass_from(checker: &mut Checker, block: usize) -> Option<String> {
    match checker.field(block, fields::MASS.name) {
        Some((_, entry)) if matches!(entry.value.kind, ExprKind::Number { .. }) => None,
        Some((_, entry)) if checker.overrides.contains_key(&entry.value.span) => None,
        Some((_, entry)) => Some(checker.text(entry.value.span).to_owned()),
        None if mass_of_portal(checker, block).is_some() => Some("elastic_mass".to_owned()),
        None => Some("density * area * length / 2".to_owned()),
    }
}

/// q·A \[kg/m\].
fn mass_per_length(checker: &mut Checker, block: usize) -> Option<f64> {
    Some(
        checker.constant(block, fields::DENSITY.name)?
            * checker.constant(block, fields::AREA.name)?,
    )
}

/// q·A·L \[kg\].
fn own_mass(checker: &mut Checker, block: usize) -> Option<f64> {
    let (density, area, length) = (
        checker.constant(block, fields::DENSITY.name)?,
        checker.constant(block, fields::AREA.name)?,
        checker.constant(block, fields::LENGTH.name)?,
    );
    Some(density * area * length)
}

/// `beam.mass` and similar values, with their uncertainty contributions.
pub fn exported(
    checker: &mut Checker,
    block: usize,
    name: &str,
    requested_at: Span,
) -> Option<Formula> {
    let value = export(checker, block, name, requested_at)?;
    let specimen = checker.scope.index_in_kind(block);
    if name != fields::MASS.name {
        return Some(Formula::Constant(value));
    }
    if frame::is_frame(checker, block) {
        let frame = frame::frame(checker, block)?;
        if frame.storeys.is_empty() {
            let source = Source::MassMatrix(specimen);
            return Some(
                Stated {
                    source,
                    value,
                    uncertainty: frame.matrix_uncertainty[0] * value,
                }
                .formula(),
            );
        }
        let of_storey = |(storey, it): (usize, &Storey)| {
            let source = Source::StoreyMass { specimen, storey };
            Stated {
                source,
                value: it.mass,
                uncertainty: it.mass_uncertainty,
            }
            .formula()
        };
        let uncertain = frame
            .storeys
            .iter()
            .any(|storey| storey.mass_uncertainty > 0.0);
        let masses = || frame.storeys.iter().enumerate().map(of_storey).collect();
        return Some(if uncertain {
            Formula::Call(Function::Sum, masses())
        } else {
            Formula::Constant(value)
        });
    }
    let uncertainty = checker.constant(block, fields::MASS_UNCERTAINTY.name)?;
    Some(
        Stated {
            source: Source::SpecimenMass(specimen),
            value,
            uncertainty,
        }
        .formula(),
    )
}

#[derive(Violation)]
#[violation(
    E628,
    "`{name}` is a frame: it has no single `{property}`",
    name = name.map_or("the frame", |name| name.node.as_str())
)]
#[help("declare the value of one storey with `let`, and read that")]
struct NoOneOfItsKind<'a> {
    name: Option<&'a Ident>,
    property: &'a str,
    #[label("several storeys")]
    span: Span,
}

#[derive(Violation)]
#[violation(
    E206,
    "specimen `{name}` has no `{property}` without a `behaviour`",
    name = name.map_or("", |name| name.node.as_str())
)]
#[help(
    "read the result of a `stiffness ramp`, such as `k0.stiffness`, or add the expected `behaviour`"
)]
struct PropertyWithoutBehaviour<'a> {
    name: Option<&'a Ident>,
    property: &'a str,
    #[label("unknown before the run")]
    span: Span,
}

#[derive(Violation)]
#[violation(
    E634,
    "specimen `{name}` has no `{property}`: {reason}",
    name = name.map_or("", |name| name.node.as_str())
)]
#[help("{}", help)]
struct NoSuchProperty<'a> {
    name: Option<&'a Ident>,
    property: &'a str,
    reason: &'a str,
    help: &'static str,
    #[label("not available")]
    span: Span,
}

/// The value of `beam.mass`, `beam.stiffness` or another; None where the specimen has an error that is reported there.
pub fn export(checker: &mut Checker, block: usize, name: &str, requested_at: Span) -> Option<f64> {
    let declared = &checker.scope.blocks[block];
    if frame::is_frame(checker, block) {
        return match name {
            _ if name == fields::MASS.name => {
                frame::frame(checker, block).map(|frame| frame.total_mass())
            }
            _ => checker.fail(NoOneOfItsKind {
                name: declared.name,
                property: name,
                span: requested_at,
            }),
        };
    }
    if name == fields::MASS.name {
        return mass(checker, block);
    }
    // MeasurementUncertainty only with a model; a missing model of a virtual specimen has a separate diagnostic.
    if checker.real_rig.is_some() && checker.field(block, fields::BEHAVIOUR.name).is_none() {
        return checker.fail(PropertyWithoutBehaviour {
            name: declared.name,
            property: name,
            span: requested_at,
        });
    }
    let behaviour = behaviour(checker, block, requested_at)?;
    let (value, reason) = match (name, &*behaviour) {
        ("stiffness", _) => (behaviour.initial_stiffness(), ""),
        ("capacity", _) => (behaviour.capacity(), "its force is unbounded"),
        ("elastic_mass" | "plastic_mass" | "lumped_mass", _) => {
            let masses = behaviour.equivalent_masses();
            let value = masses.and_then(|masses| match name {
                "elastic_mass" => Some(masses.elastic),
                "lumped_mass" => Some(masses.lumped),
                _ => masses.plastic,
            });
            (
                value.unwrap_or(f64::INFINITY),
                "its geometry does not determine it",
            )
        }
        ("mechanism_limit", _) => {
            let limit = behaviour.portal().and_then(mechanism_limit);
            (
                limit.unwrap_or(f64::INFINITY),
                "it is not a `portal` under one load with member masses",
            )
        }
        (_, Behaviour::Portal(portal)) => {
            let mechanism = Mechanism::ALL
                .into_iter()
                .find(|mechanism| name.starts_with(mechanism.name()))?;
            (
                portal.collapse_load(mechanism),
                "its loads do no work on this mechanism",
            )
        }
        _ => (f64::INFINITY, "it is not a `portal`"),
    };
    if value.is_finite() {
        Some(value)
    } else {
        checker.fail(NoSuchProperty {
            name: declared.name,
            property: name,
            reason,
            help: help_without(name, &behaviour),
            span: requested_at,
        })
    }
}

/// A way to a property that this behaviour does not have.
fn help_without(name: &str, behaviour: &Behaviour) -> &'static str {
    let is_mass = ["elastic_mass", "plastic_mass", "lumped_mass"].contains(&name);
    match behaviour {
        _ if name == "capacity" => {
            "remove it, or use a behaviour with a largest force, such as `portal`"
        }
        Behaviour::Portal(_) if is_mass => {
            "add `mass_per_length` to the `portal`, or `area` and `density` to the specimen"
        }
        Behaviour::Portal(_) => "remove it, or give the `portal` other `loads`",
        _ if name == "plastic_mass" => "write the mass as a number, or use a `portal`",
        Behaviour::Beam(_) if is_mass => "add `area` and `density` to the specimen",
        _ if is_mass => "write the mass as a number, or use a `beam` or a `portal`",
        _ => "remove it, or use a `portal`",
    }
}

/// The model; an error in it is reported once, however often it is requested.
pub fn behaviour(checker: &mut Checker, block: usize, requested_at: Span) -> Option<Rc<Behaviour>> {
    checker.once_in(
        |checker| &mut checker.behaviours,
        block,
        |checker| new_behaviour(checker, block, requested_at).map(Rc::new),
    )
}

fn new_behaviour(checker: &mut Checker, block: usize, requested_at: Span) -> Option<Behaviour> {
    let stated = |checker: &Checker, fields: &[&str]| {
        fields
            .iter()
            .all(|field| checker.field(block, field).is_some())
    };
    let own_mass = stated(
        checker,
        &[fields::DENSITY.name, fields::AREA.name, fields::LENGTH.name],
    )
    .then(|| own_mass(checker, block))
    .flatten();
    let mass_per_length = stated(checker, &[fields::DENSITY.name, fields::AREA.name])
        .then(|| mass_per_length(checker, block))
        .flatten();
    let material = Material {
        mass_per_length,
        own_mass,
    };
    checker.within_entry(
        block,
        fields::BEHAVIOUR.name,
        requested_at,
        |checker, expr, context| {
            let FieldType::Choice(variants) = checker.scope.blocks[block]
                .kind
                .field(fields::BEHAVIOUR.name)?
                .ty
            else {
                return None;
            };
            behaviour::behaviour(
                checker,
                &Written {
                    field: fields::BEHAVIOUR.name,
                    variants,
                    expr,
                    context,
                    material,
                },
            )
        },
    )
}

/// Limits that let the specimen exceed its table.
struct TableTooShort<'a> {
    file: &'a str,
    table: Interval,
    limit: Interval,
    named_at: Span,
    limit_at: Span,
}

impl Violation for TableTooShort<'_> {
    const CODE: Code = W715;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            file,
            table,
            limit,
            named_at,
            limit_at,
        } = self;
        let range = |interval: Interval| {
            format!(
                "{} .. {}",
                shown(interval.low, Dimension::LENGTH),
                shown(interval.high, Dimension::LENGTH)
            )
        };
        Diagnostic::new(
            Self::CODE,
            format!("the limits exceed the points of `{file}`: the last force is used beyond them"),
        )
        .at(named_at, format!("points over {}", range(table)))
        .at(limit_at, format!("allows {}", range(limit)))
        .help("narrow the limits to the measured range, or measure further")
    }
}

/// Warns if the limits allow a specimen to exceed the points of its table.
pub fn warn_of_short_tables(
    checker: &mut Checker,
    specimens: &[Option<Specimen>],
    limits: &CheckedLimits,
) {
    let Some(limit_at) = limits.displacement_at else {
        return;
    };
    let blocks: Vec<usize> = checker
        .scope
        .of_kind(Kind::Specimen)
        .map(|(index, _)| index)
        .collect();
    for (block, specimen) in blocks.into_iter().zip(specimens) {
        let Some(behaviour) = specimen
            .as_ref()
            .and_then(|specimen| specimen.behaviour.as_ref())
        else {
            continue;
        };
        let mut named = Vec::new();
        if let Some((_, entry)) = checker.field(block, fields::BEHAVIOUR.name) {
            behaviour::tables_named(&entry.value, &mut named);
        }
        // In series or in parallel with a spring the displacement of the specimen is not that of the table.
        let table = match behaviour {
            Behaviour::Rate { of, .. }
            | Behaviour::Maxwell { of, .. }
            | Behaviour::Logarithmic { of, .. } => of,
            other => other,
        };
        let (Behaviour::Table(table), [named_at]) = (table, named.as_slice()) else {
            continue;
        };
        let (Some([low, _]), Some([high, _])) = (table.points.first(), table.points.last()) else {
            continue;
        };
        let reach = Interval {
            low: *low,
            high: *high,
        };
        let allowed = limits.limits.displacement;
        if allowed.low < reach.low || allowed.high > reach.high {
            checker.report(TableTooShort {
                file: &table.file,
                table: reach,
                limit: allowed,
                named_at: *named_at,
                limit_at,
            });
        }
    }
}
