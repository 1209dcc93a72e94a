//! An impact on one degree of freedom, as a report states it: the limits of its peak force, the integration, the energy balance, the
//! contact log. In: a plan and a record. Out: blocks.

pub(crate) mod contact_log;
pub(crate) mod storey;

use crate::procedures;
use crate::procedures::impact::contact;
use crate::procedures::stepping::{self, energy};
use crate::report::document::Block;
use crate::report::sections::results::actuators;
use crate::report::{Run, number};
use psd_plan::procedures::damping_sweep::block as damping_sweep;
use psd_plan::procedures::impact::block as schema;
use psd_plan::record::{ImpactHistory, ProcedureRecord};
use psd_plan::schema::procedures::tracking as tracking_schema;
use psd_plan::{Contact, Impact, Integrator, PointTarget, ProcedureKind};
use psd_text::units::Dimension;

/// Results that have a budget even if no requirement reads any.
pub(crate) const BUDGET: &[&str] = &[schema::MAX_DISPLACEMENT.name, schema::ABSORBED_ENERGY.name];

/// The results that a reader looks for first.
pub(crate) fn headline(contact: &Contact) -> Vec<&'static str> {
    let of_contact = contact::headline(contact);
    let first = [schema::MAX_DISPLACEMENT.name, schema::ABSORBED_ENERGY.name];
    let last = [
        schema::STOP_TIME.name,
        schema::RESTITUTION.name,
        schema::MAX_VELOCITY.name,
    ];
    let unprinted = contact::unprinted(contact);
    let mut names = [&first[..], &of_contact, &last].concat();
    names.retain(|name| !unprinted.contains(name));
    names
}

/// Inputs, settings and counts of the method, and the tracking, which the text below the results states; the results that the
/// contact law does not have.
pub(crate) fn unprinted(contact: &Contact) -> Vec<&'static str> {
    let of_contact = contact::unprinted(contact);
    let of_method = [
        schema::CONTACTS.name,
        schema::STRIKER_ENERGY.name,
        schema::TIME_STEP.name,
        schema::CRITICAL_TIME_STEP.name,
        schema::STEPS.name,
    ];
    [&of_contact, &of_method[..], stepping::report::TRACKING].concat()
}

/// The energy of a damping that the plan states as zero.
pub(crate) fn undamped(point: &PointTarget) -> Vec<&'static str> {
    if point.damping.constant() == Some(0.0) {
        vec![schema::DAMPING_ENERGY.name]
    } else {
        Vec::new()
    }
}

/// The blocks below its results.
pub(crate) fn report(
    run: &Run<'_>,
    index: usize,
    procedure: &ProcedureRecord,
    history: &ImpactHistory,
    body: &mut Vec<Block>,
) {
    force_note(run, index, procedure, history, body);
    method_note(run, index, procedure, history, body);
    energy_balance(contact_work(run, index), history, body);
    contact_log::table(history, procedure.number(schema::CONTACTS.name), body);
}

/// The peak contact force with its impulse, time step and contact law.
fn force_note(
    run: &Run<'_>,
    index: usize,
    procedure: &ProcedureRecord,
    history: &ImpactHistory,
    body: &mut Vec<Block>,
) {
    let Some(ProcedureKind::Impact(impact)) =
        run.plan.procedures.get(index).map(|planned| &planned.kind)
    else {
        return;
    };
    let Some(point) = impact.point() else { return };
    let step = number::text(history.time_step, Dimension::TIME);
    let critical = number::text(history.critical_time_step, Dimension::TIME);
    let forces = match (
        procedure.number(schema::MAX_CONTACT_FORCE.name),
        procedure.number(schema::IMPULSE.name),
    ) {
        (Some(peak), Some(impulse)) => format!(
            "Peak contact force {} with an impulse of {} at a time step of {step}.",
            number::text(peak, Dimension::FORCE),
            number::text(impulse, Dimension::IMPULSE)
        ),
        _ => format!("Time step {step}."),
    };
    let mut sentences = vec![
        format!("Contact law: {}.", impact.contact.title()),
        forces,
        format!("Critical time step (Melo et al. 2006, eq. 7) {critical}."),
    ];
    if matches!(impact.contact, Contact::Rigid) {
        sentences.push(
            "Under the rigid law the contact force is inversely proportional to the time step. Only the impulse is a \
             property of the impact."
                .to_owned(),
        );
        sentences.extend(implied_restitution(run, procedure, impact, point));
    }
    sentences.extend(damping_range(run, procedure, point));
    body.push(Block::paragraph(sentences.join(" ")));
}

/// The extrapolation of the damping of a sweep beyond the velocities at which it was measured.
fn damping_range(run: &Run<'_>, procedure: &ProcedureRecord, point: &PointTarget) -> Vec<String> {
    let mut references = Vec::new();
    point.damping.collect_references(&mut references);
    let swept = references
        .iter()
        .filter_map(|reference| run.record.procedures.get(reference.procedure.0));
    let ranges = swept.filter_map(|sweep| {
        Some((
            &sweep.name,
            sweep.number(damping_sweep::MAX_VELOCITY.name)?,
            procedure.number(schema::MAX_VELOCITY.name)?,
        ))
    });
    let sentences = ranges.filter(|(_, _, used)| *used > 0.0).map(|(name, measured, used)| {
        format!(
            "The damping of {name} was measured up to {}, {}\u{a0}% of the largest velocity of the structure here ({}){}",
            number::text(measured, Dimension::VELOCITY),
            number::text(100.0 * measured / used, Dimension::NUMBER),
            number::text(used, Dimension::VELOCITY),
            if used > measured { ": this is an extrapolation." } else { "." }
        )
    });
    sentences.collect()
}

/// e = Ms/(Ms + 2M): the limit of the rigid law as the time step goes to zero.
fn implied_restitution(
    run: &Run<'_>,
    procedure: &ProcedureRecord,
    impact: &Impact,
    point: &PointTarget,
) -> Option<String> {
    let mass = procedure
        .inputs
        .iter()
        .find(|(name, ..)| *name == schema::MASS.name)
        .map(|(_, estimate, _)| estimate.value);
    let striker = run
        .plan
        .strikers
        .get(impact.striker)
        .map(|striker| striker.mass);
    let (mass, striker) = (mass.or_else(|| point.mass.constant())?, striker?);
    let restitution = striker / (striker + 2.0 * mass);
    Some(format!(
        "It implies a coefficient of restitution e = Ms/(Ms + 2M) = {} (Ms striker mass, M equivalent mass of the structure).",
        number::text(restitution, Dimension::NUMBER)
    ))
}

/// The integration and the tracking.
fn method_note(
    run: &Run<'_>,
    index: usize,
    procedure: &ProcedureRecord,
    history: &ImpactHistory,
    body: &mut Vec<Block>,
) {
    let Some(ProcedureKind::Impact(impact)) =
        run.plan.procedures.get(index).map(|planned| &planned.kind)
    else {
        return;
    };
    let mut sentences = vec![integrator(impact)];
    sentences.extend(actuators::motion(
        impact.stepping.i_modification,
        impact.stepping.mode,
    ));
    sentences.extend(tracking(history, procedure));
    body.push(Block::paragraph(sentences.join(" ")));
}

fn integrator(impact: &Impact) -> String {
    let unstable = if impact.stepping.allow_unstable {
        " The plan allows a time step beyond the stability limit."
    } else {
        ""
    };
    let named = match impact.stepping.integrator {
        Integrator::Tangent => {
            "constant average acceleration with the measured tangent stiffness (Melo et al. 2006, eqs. 2 to 6)"
        }
        Integrator::Explicit => "explicit Newmark, stable up to the period over π",
        Integrator::AlphaOs { alpha } => {
            let alpha = number::stated(alpha, Dimension::NUMBER);
            return format!(
                "Integrator: α-operator splitting, α = {alpha}, with the initial stiffness at the high end of its interval.{unstable}"
            );
        }
    };
    format!("Integrator: {named}.{unstable}")
}

/// The tracking errors; the energy is the result of that name, the largest over the impact.
fn tracking(history: &ImpactHistory, procedure: &ProcedureRecord) -> Option<String> {
    let last = history.steps.last()?;
    Some(actuators::tracking_error(
        last.tracking,
        procedure.number(tracking_schema::TRACKING_ENERGY_ERROR.name),
        "The actuator",
    ))
}

/// The energy that the contact took, as it is summed over the steps: from the forces at their ends, or within them.
pub(crate) fn contact_work(run: &Run<'_>, index: usize) -> &'static str {
    let planned = run.plan.procedures.get(index);
    match planned.and_then(|planned| procedures::facts_of(&planned.kind).contact) {
        Some(contact) if !contact.needs_tangent() => "contact, Σ F₁ΔXs − ½(F₀ + F₁)ΔX of each step",
        _ => "contact, ∫F d(Xs − X) within each step",
    }
}

/// The energy of the damping in the balance; omitted without damping.
const DAMPING: &str = "damping, ∫CẊ dX";

/// The balance of the striker's energy at the end of the run.
pub(crate) fn energy_balance(
    contact_work: &'static str,
    history: &ImpactHistory,
    body: &mut Vec<Block>,
) {
    let (Some(first), Some(last)) = (history.steps.first(), history.steps.last()) else {
        return;
    };
    let e = last.energies;
    let input = first.energies.striker + e.weight + e.gravity;
    let mut parts = vec![
        ("striker, kinetic", e.striker),
        ("structure, kinetic", e.structure),
        ("restoring force, ∫R dX", e.restoring),
        (DAMPING, e.damping),
        (contact_work, e.contact_loss),
        ("integration error", e.error),
    ];
    if e.damping == 0.0 {
        parts.retain(|(name, _)| *name != DAMPING);
    }
    let name = if e.weight == 0.0 && e.gravity == 0.0 {
        "input, ½MsV₀²"
    } else {
        "input, ½MsV₀² plus work of gravity"
    };
    body.push(energy::balance_table((name, input), &parts));
    if e.indentation > 0.0 {
        body.push(Block::note(format!(
            "Indentation energy F·Δδp = {}: an indicator, not part of the balance. It converges to the work lost in \
             the contact as the time step decreases.",
            number::text(e.indentation, Dimension::ENERGY)
        )));
    }
}
