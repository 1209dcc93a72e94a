//! What the declared tracking of a virtual rig would do to a run, foretold before it (W719). In: procedures that integrate, what
//! they test, the rig. Out: warnings, and the forecast for whoever explains a plan.

use super::checker::Checker;
use super::faults::methods as fault;
use super::impact::time_step_before_the_run;
use crate::formula::{Formula, NoResults};
use crate::mechanics::contact::ContactLaw;
use crate::mechanics::forecast::{self, Foretold};
use crate::mechanics::frame::{FrameInput, Tangents, storeys_of};
use crate::mechanics::frame_properties::FrameProperties;
use crate::mechanics::ground::{acceleration_at, peak_velocity};
use crate::mechanics::monitor;
use crate::mechanics::structure::Structure;
use crate::plan::{Contact, Ground, Impact, Limits, Link, Plan, ProcedureKind, Shake, Specimen, step_count};

/// Share of the input energy at which tracking holds a run.
fn bound(limits: &Limits) -> f64 {
    let limit = limits.tracking_energy_error;
    if limit.is_bounded() { limit.high } else { monitor::HOLD }
}

/// What is foretold of a procedure, and its Δt (s); None where nothing is missed, or not enough is known before the run.
#[must_use]
pub fn foretold(plan: &Plan, procedure: usize) -> Option<(Foretold, f64)> {
    let Link::Virtual(link) = &plan.rig.link else { return None };
    let (missed, bound) = (link.tracking, bound(&plan.limits));
    if missed == 0.0 {
        return None;
    }
    match &plan.procedures.get(procedure)?.kind {
        ProcedureKind::Impact(impact) => of_impact(plan, impact, missed, bound),
        ProcedureKind::Shake(shake) => {
            of_shake(shake, plan.specimens.get(shake.specimen)?, plan.grounds.get(shake.ground)?, missed, bound)
        }
        _ => None,
    }
}

fn of_impact(plan: &Plan, impact: &Impact, missed: f64, bound: f64) -> Option<(Foretold, f64)> {
    let (specimen, striker) = (plan.specimens.get(impact.specimen)?, plan.strikers.get(impact.striker)?);
    let behaviour = specimen.behaviour.as_ref()?;
    // An earlier procedure's stiffness is near the specimen's own.
    let stiffness = impact.stiffness.constant().unwrap_or_else(|| behaviour.initial_stiffness());
    let time_step = time_step_before_the_run(impact)?;
    let structure = Structure {
        mass: impact.mass.constant()?,
        damping: impact.damping.constant().unwrap_or(0.0),
        stiffness,
        operator_stiffness: stiffness,
        law: law(&impact.contact)?,
        time_step,
        max_tangent_ratio: impact.stepping.max_tangent_ratio.constant()?,
        force_noise: 0.0,
        resolution: 0.0,
    };
    let input = structure.struck_by(striker, &impact.stepping);
    let steps = step_count(impact.duration.constant()?, time_step);
    Some((forecast::of_impact(&input, behaviour, (impact.until, steps), missed, bound), time_step))
}

fn law(contact: &Contact) -> Option<ContactLaw> {
    Some(match contact {
        Contact::Rigid => ContactLaw::Rigid,
        Contact::Limit { force } => ContactLaw::Limit { force: force.constant()? },
        Contact::Restitution { coefficient } => ContactLaw::Restitution { coefficient: coefficient.constant()? },
        Contact::Hertz { stiffness, loss, force_limit } => ContactLaw::Hertz {
            stiffness: stiffness.constant()?,
            loss: loss.constant()?,
            force_limit: force_limit.as_ref().map(|force| force.constant().ok_or(())).transpose().ok()?,
        },
    })
}

fn of_shake(shake: &Shake, specimen: &Specimen, ground: &Ground, missed: f64, bound: f64) -> Option<(Foretold, f64)> {
    let frame = specimen.frame.as_ref()?;
    let properties = FrameProperties::of(frame, &shake.damping.known()?).ok()?;
    let matrices = &properties.matrices;
    let time_step = shake.stepping.time_step.evaluate(&NoResults, Some(properties.critical_time_step())).ok()?.value;
    let scale = shake.scale.constant()?;
    let ground_at = |time: f64| scale * acceleration_at(&ground.times, &ground.accelerations, time);
    let zero = vec![0.0; matrices.order()];
    let mut load = zero.clone();
    matrices.ground_load(ground_at(0.0), &mut load);
    let largest_ratio = shake.stepping.max_tangent_ratio.constant()?;
    let input = FrameInput {
        matrices,
        operator_stiffness: &matrices.stiffness,
        integrator: shake.stepping.integrator,
        i_modification: shake.stepping.i_modification,
        tangents: storeys_of(&matrices.stiffness).map_or(Tangents::Initial, |_| Tangents::Storeys { largest_ratio }),
        time_step,
        initial_displacement: &zero,
        initial_restoring_force: &zero,
        initial_load: &load,
        force_noise: 0.0,
        resolution: 0.0,
    };
    let duration = shake.duration.as_ref().map_or(Some(ground.duration()), Formula::constant)?;
    let velocity = scale * peak_velocity(&ground.times, &ground.accelerations);
    let energy = 0.5 * frame.total_mass() * velocity * velocity;
    let foretold = forecast::of_frame(&input, frame, (&ground_at, step_count(duration, time_step)), energy, missed, bound)?;
    Some((foretold, time_step))
}

/// Says of every procedure that tracking would stop it. `blocks` are those of the plan's procedures, `rig` that of its rig.
pub fn warn(checker: &mut Checker, plan: &Plan, blocks: &[usize], rig: Option<usize>) {
    let Link::Virtual(link) = &plan.rig.link else { return };
    let Some(errs) = rig.and_then(|rig| checker.given(rig, "link")).map(|(_, entry)| entry.value.span) else { return };
    let (missed, bound) = (link.tracking, bound(&plan.limits));
    for (index, block) in blocks.iter().enumerate() {
        let Some((Foretold { share, passed: Some(time) }, time_step)) = foretold(plan, index) else { continue };
        let head = checker.scope.blocks[*block].block.head;
        let corrected = match &plan.procedures[index].kind {
            ProcedureKind::Impact(impact) => impact.stepping.i_modification,
            ProcedureKind::Shake(shake) => shake.stepping.i_modification,
            _ => false,
        };
        // The error goes with the delay, and that with the step.
        let shorter = (!corrected).then(|| 0.8 * time_step * bound / share.abs());
        let stops = fault::Stops { name: &plan.procedures[index].name, share, bound, missed, time, shorter };
        checker.faults.push(fault::tracking_stops(&stops, head, errs));
    }
}
