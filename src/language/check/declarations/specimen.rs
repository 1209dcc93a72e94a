//! `specimen NAME { … }`: equivalent mass and behaviour.

use super::behaviour::{self, Material, Written};
use super::frame;
use super::limits::CheckedLimits;
use super::striker::uncertainty;
use crate::language::check::checker::Checker;
use crate::language::check::messages::{frames, names as fault, specimens};
use crate::language::syntax::ast::{Expr, ExprKind};
use crate::physics::structure::portal_limit::mechanism_limit;
use crate::plan::formula::{Formula, Function, Stated};
use crate::plan::{Behaviour, Interval, Mechanism, Specimen, Storey};
use crate::schema::{FieldType, Kind};
use crate::text::source::Span;
use crate::uncertainty::Source;

/// Standard, of the mass that an impact takes from its specimen, kg.
pub fn mass_uncertainty(checker: &mut Checker, block: usize) -> Option<f64> {
    if frame::is_frame(checker, block) {
        return frame::frame(checker, block).map(|frame| frame.total_mass_uncertainty());
    }
    checker.constant(block, "mass_uncertainty")
}

/// A specimen whose entries are all right; None where a fault was reported.
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
    if checker.misspelt(block, &["mass", "density", "area", "length"])
        || faulty_portal(checker, block)
    {
        // What is misspelt or wrong is said already.
    } else if mass.is_none()
        && names_portal(checker, block)
        && checker.given(block, "length").is_none()
    {
        checker
            .faults
            .push(specimens::portal_without_mass(name, head));
    } else if mass.is_none() && !any_given(checker, block) {
        checker.faults.push(fault::missing_field(
            declared.kind,
            name,
            head,
            "mass",
            "mass = 0.73 kg",
        ));
    } else if mass.is_none()
        && checker.given(block, "mass").is_none()
        && let Some(missing) = ["density", "area", "length"]
            .into_iter()
            .find(|field| checker.given(block, field).is_none())
    {
        checker
            .faults
            .push(fault::mass_incomplete(name, head, missing));
    }
    beam_says_its_mass(checker, block, mass);
    // Each number is looked at, also those that the mass does not need, so that all faults are seen at once.
    for field in ["length", "area", "density"] {
        checker.quantity(block, field);
    }
    // A real specimen bends as it does; a virtual one without a behaviour is said already.
    let behaviour = match checker.given(block, "behaviour") {
        None if checker.real_rig.is_some() => Some(None),
        _ => behaviour(checker, block, head).map(Some),
    };
    let (damping, coulomb) = (
        checker.constant(block, "damping"),
        checker.constant(block, "coulomb"),
    );
    let mass_uncertainty = uncertainty(checker, block, "mass_uncertainty", mass);
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

/// A `beam` has ends, and q·A·L/2 is made for two supports: which of its masses is meant the plan says. Recorded plans meant that one.
fn beam_says_its_mass(checker: &mut Checker, block: usize, half: Option<f64>) {
    let declared = &checker.scope.blocks[block];
    let beam = |written: &Expr| behaviour::names(written, "beam");
    let named = checker
        .given(block, "behaviour")
        .is_some_and(|(_, entry)| beam(&entry.value));
    let (Some(half), Some(name)) = (half.filter(|_| named && !checker.recorded), declared.name)
    else {
        return;
    };
    if checker.given(block, "mass").is_some() {
        return;
    }
    let masses = behaviour(checker, block, declared.block.head)
        .and_then(|behaviour| behaviour.equivalent_masses());
    checker.faults.push(specimens::beam_without_mass(
        &name.node,
        declared.block.head,
        half,
        masses.map(|masses| masses.elastic),
    ));
}

fn any_given(checker: &Checker, block: usize) -> bool {
    ["mass", "density", "area", "length"]
        .into_iter()
        .any(|field| checker.given(block, field).is_some())
}

/// `mass`, else what a portal's geometry gives, else q·A·L/2, the equivalent mass at midspan (Melo et al. 2006, Fig. 5).
fn mass(checker: &mut Checker, block: usize) -> Option<f64> {
    if checker.given(block, "mass").is_some() {
        return checker.constant(block, "mass");
    }
    if let Some(elastic) = mass_of_portal(checker, block) {
        return Some(elastic);
    }
    let (density, area, length) = (
        checker.constant(block, "density")?,
        checker.constant(block, "area")?,
        checker.constant(block, "length")?,
    );
    Some(density * area * length / 2.0)
}

/// By its elastic deflection, kg. One that weighs nothing where its load moves it has none.
fn mass_of_portal(checker: &mut Checker, block: usize) -> Option<f64> {
    if !names_portal(checker, block) {
        return None;
    }
    let at = checker.scope.blocks[block].block.head;
    let masses = behaviour(checker, block, at)?.equivalent_masses()?;
    Some(masses.elastic).filter(|elastic| *elastic > 0.0)
}

/// Whether a specimen without a mass of its own is a portal.
fn names_portal(checker: &Checker, block: usize) -> bool {
    checker.given(block, "mass").is_none()
        && checker
            .given(block, "behaviour")
            .is_some_and(|(_, entry)| behaviour::names(&entry.value, "portal"))
}

fn faulty_portal(checker: &mut Checker, block: usize) -> bool {
    let at = checker.scope.blocks[block].block.head;
    names_portal(checker, block) && behaviour(checker, block, at).is_none()
}

/// How the plan comes to the mass: its formula where it writes one, and that of the geometry where it gives no mass.
fn mass_from(checker: &mut Checker, block: usize) -> Option<String> {
    match checker.given(block, "mass") {
        Some((_, entry)) if matches!(entry.value.kind, ExprKind::Number { .. }) => None,
        Some((_, entry)) => Some(checker.text(entry.value.span).to_owned()),
        None if mass_of_portal(checker, block).is_some() => Some("elastic_mass".to_owned()),
        None => Some("density * area * length / 2".to_owned()),
    }
}

/// q·A, kg/m.
fn mass_per_length(checker: &mut Checker, block: usize) -> Option<f64> {
    Some(checker.constant(block, "density")? * checker.constant(block, "area")?)
}

/// q·A·L, kg.
fn own_mass(checker: &mut Checker, block: usize) -> Option<f64> {
    let (density, area, length) = (
        checker.constant(block, "density")?,
        checker.constant(block, "area")?,
        checker.constant(block, "length")?,
    );
    Some(density * area * length)
}

/// `beam.mass` and its like, with what is uncertain of them.
pub fn exported(
    checker: &mut Checker,
    block: usize,
    name: &str,
    asked_at: Span,
) -> Option<Formula> {
    let value = export(checker, block, name, asked_at)?;
    let specimen = checker.scope.place_in_kind(block);
    if name != "mass" {
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
    let uncertainty = checker.constant(block, "mass_uncertainty")?;
    Some(
        Stated {
            source: Source::SpecimenMass(specimen),
            value,
            uncertainty,
        }
        .formula(),
    )
}

/// The value of `beam.mass`, `beam.stiffness` or another; None where the specimen has a fault that is reported in its place.
pub fn export(checker: &mut Checker, block: usize, name: &str, asked_at: Span) -> Option<f64> {
    let declared = &checker.scope.blocks[block];
    if frame::is_frame(checker, block) {
        return match name {
            "mass" => frame::frame(checker, block).map(|frame| frame.total_mass()),
            _ => checker.fail(frames::no_one_of_its_kind(declared.name, name, asked_at)),
        };
    }
    if name == "mass" {
        return mass(checker, block);
    }
    // Known only of a behaviour; that a virtual specimen lacks it is said already.
    if checker.real_rig.is_some() && checker.given(block, "behaviour").is_none() {
        return checker.fail(fault::property_without_behaviour(
            declared.name,
            name,
            asked_at,
        ));
    }
    let behaviour = behaviour(checker, block, asked_at)?;
    let (value, reason) = match (name, &behaviour) {
        ("stiffness", _) => (behaviour.initial_stiffness(), ""),
        ("capacity", _) => (behaviour.capacity(), "its force has no bound"),
        ("elastic_mass" | "plastic_mass" | "lumped_mass", _) => {
            let masses = behaviour.equivalent_masses();
            let value = masses.and_then(|masses| match name {
                "elastic_mass" => Some(masses.elastic),
                "lumped_mass" => Some(masses.lumped),
                _ => masses.plastic,
            });
            (
                value.unwrap_or(f64::INFINITY),
                "its geometry does not give it",
            )
        }
        ("mechanism_limit", _) => {
            let limit = behaviour.portal().and_then(mechanism_limit);
            (
                limit.unwrap_or(f64::INFINITY),
                "it is no `portal` under one load whose members have a mass",
            )
        }
        (_, Behaviour::Portal(portal)) => {
            let mechanism = Mechanism::ALL
                .into_iter()
                .find(|mechanism| name.starts_with(mechanism.name()))?;
            (
                portal.collapse_load(mechanism),
                "its loads do no work on that mechanism",
            )
        }
        _ => (f64::INFINITY, "it is no `portal`"),
    };
    if value.is_finite() {
        Some(value)
    } else {
        checker.fail(specimens::no_such_property(
            declared.name,
            name,
            reason,
            asked_at,
        ))
    }
}

/// The behaviour; a fault in it is reported once, however often it is asked for.
pub fn behaviour(checker: &mut Checker, block: usize, asked_at: Span) -> Option<Behaviour> {
    let known = checker.faults.len();
    let stated = |checker: &Checker, fields: &[&str]| {
        fields
            .iter()
            .all(|field| checker.given(block, field).is_some())
    };
    let own_mass = stated(checker, &["density", "area", "length"])
        .then(|| own_mass(checker, block))
        .flatten();
    let mass_per_length = stated(checker, &["density", "area"])
        .then(|| mass_per_length(checker, block))
        .flatten();
    let material = Material {
        mass_per_length,
        own_mass,
    };
    let behaviour = checker.within_entry(block, "behaviour", asked_at, |checker, expr, place| {
        let FieldType::Choice(variants) = checker.scope.blocks[block].kind.field("behaviour")?.ty
        else {
            return None;
        };
        behaviour::behaviour(
            checker,
            &Written {
                field: "behaviour",
                variants,
                expr,
                place,
                material,
            },
        )
    });
    checker.drop_repeated(known, block);
    behaviour
}

/// Warns where the limits let a specimen go beyond the points of its table.
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
        if let Some((_, entry)) = checker.given(block, "behaviour") {
            behaviour::tables_named(&entry.value, &mut named);
        }
        // Behind a spring or beside one the specimen's displacement is not the table's.
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
            checker.faults.push(specimens::table_too_short(
                &table.file,
                reach,
                allowed,
                *named_at,
                limit_at,
            ));
        }
    }
}
