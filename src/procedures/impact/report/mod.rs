//! An impact as a report states it, on one degree of freedom or (`storey`) on a frame: the limits of its peak force, the integration, the energy balance, the
//! contact log. In: a plan and a record. Out: blocks.

pub(crate) mod contact_log;
pub(crate) mod storey;

use crate::procedures::impact::contact;
use crate::procedures::stepping::{self, energy};
use crate::report::document::Block;
use crate::report::sections::results::actuators;
use crate::report::{Run, number};
use psd_plan::procedures::damping_sweep::block as damping_sweep;
use psd_plan::procedures::impact::block as schema;
use psd_plan::record::{ImpactHistory, ProcedureRecord};
use psd_plan::schema::procedures::tracking as tracking_schema;
use psd_plan::{Contact, Impact, Integrator, PointTarget};
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
    impact: &Impact,
    procedure: &ProcedureRecord,
    history: &ImpactHistory,
    body: &mut Vec<Block>,
) {
    if let Some(struck) = &history.frame {
        storey::report(run, impact, procedure, history, struck, body);
        return;
    }
    if let Some(point) = impact.point() {
        let sentences = force_note(run, impact, point, procedure, history);
        body.push(Block::paragraph(sentences.join(" ")));
    }
    body.push(method_note(impact, procedure, history));
    at_the_end(impact, procedure, history, body);
}

/// The energy balance and the contact log.
fn at_the_end(
    impact: &Impact,
    procedure: &ProcedureRecord,
    history: &ImpactHistory,
    body: &mut Vec<Block>,
) {
    energy_balance(contact::work(&impact.contact), history, body);
    contact_log::table(history, procedure.number(schema::CONTACTS.name), body);
}

/// The peak contact force and the impulse; None without a step.
fn peak_force(procedure: &ProcedureRecord, time_step: &str) -> Option<String> {
    let peak = procedure.number(schema::MAX_CONTACT_FORCE.name)?;
    let impulse = procedure.number(schema::IMPULSE.name)?;
    Some(format!(
        "Peak contact force {} with an impulse of {} at {time_step}.",
        number::text(peak, Dimension::FORCE),
        number::text(impulse, Dimension::IMPULSE)
    ))
}

/// The peak contact force with its impulse, time step and contact law.
fn force_note(
    run: &Run<'_>,
    impact: &Impact,
    point: &PointTarget,
    procedure: &ProcedureRecord,
    history: &ImpactHistory,
) -> Vec<String> {
    let step = number::text(history.time_step, Dimension::TIME);
    let critical = number::text(history.critical_time_step, Dimension::TIME);
    let force = peak_force(procedure, &format!("a time step of {step}"));
    let mut sentences = vec![
        format!("Contact law: {}.", impact.contact.title()),
        force.unwrap_or_else(|| format!("Time step {step}.")),
        format!("Critical time step (Melo et al. 2006, eq. 7) {critical}."),
    ];
    sentences.extend(contact::note(&impact.contact).map(str::to_owned));
    sentences.extend(implied_restitution(run, procedure, impact, point));
    sentences.extend(damping_range(run, procedure, point));
    sentences
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
    let mass = mass.or_else(|| point.mass.constant())?;
    let striker = run.plan.strikers.get(impact.striker)?.mass;
    let implied = contact::implied_restitution(&impact.contact, striker, mass)?;
    Some(format!(
        "It implies {implied} (Ms striker mass, M equivalent mass of the structure)."
    ))
}

/// The integration and the tracking.
fn method_note(impact: &Impact, procedure: &ProcedureRecord, history: &ImpactHistory) -> Block {
    let mut sentences = vec![integrator(impact)];
    sentences.extend(actuators::motion(
        impact.stepping.i_modification,
        impact.stepping.mode,
    ));
    sentences.extend(tracking(history, procedure));
    Block::paragraph(sentences.join(" "))
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

/// The energy of the damping in the balance; omitted without damping.
const DAMPING: &str = "damping, ∫CẊ dX";

/// The balance of the striker's energy at the end of the run.
fn energy_balance(contact_work: &'static str, history: &ImpactHistory, body: &mut Vec<Block>) {
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
