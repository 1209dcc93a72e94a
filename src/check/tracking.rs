//! What an actuator of a virtual rig that lags or falls short would do to a run, foretold before it (W719). In: procedures that
//! integrate, what they test, the rig. Out: warnings, and the forecast for whoever explains a plan.

use super::checker::Checker;
use super::faults::methods as fault;
use super::impact::time_step_before_the_run;
use crate::formula::{Formula, NoResults};
use crate::mechanics::approach::Approach;
use crate::mechanics::contact::ContactLaw;
use crate::mechanics::following::{Manner, Pace};
use crate::mechanics::forecast::{self, Foretold, Scope};
use crate::mechanics::frame::impact::FrameImpactInput;
use crate::mechanics::frame::{FrameInput, Tangents, storeys_of};
use crate::mechanics::frame_properties::FrameProperties;
use crate::mechanics::ground::{acceleration_at, peak_velocity};
use crate::mechanics::impact::ImpactInput;
use crate::mechanics::monitor;
use crate::mechanics::structure::Structure;
use crate::plan::{
    BlowOn, Contact, Escalate, Frame, Impact, Limits, Link, Mode, Plan, ProcedureKind, Shake, Stepping, StoreyImpact, Striker,
    VIRTUAL_SPEED, VirtualLink, step_count,
};

/// What is foretold of a procedure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    pub foretold: Foretold,
    /// Δt, s
    pub time_step: f64,
    /// Of the specimen, or of the first mode of a frame, rad/s.
    pub omega: f64,
}

impl Forecast {
    /// The damping ratio that a motion at ω shows for being late by D: a force K·d(t − D) is K·d − KD·v, C = −KD and ζ = −ωD/2.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        -0.5 * self.omega * self.foretold.late
    }
}

/// Share of the input energy at which tracking holds a run.
fn bound(limits: &Limits) -> f64 {
    let limit = limits.tracking_energy_error;
    if limit.is_bounded() { limit.high } else { monitor::HOLD }
}

/// What is foretold of a procedure; None where nothing is missed, or not enough is known before the run.
#[must_use]
pub fn foretold(plan: &Plan, procedure: usize) -> Option<Forecast> {
    let Link::Virtual(link) = &plan.rig.link else { return None };
    match &plan.procedures.get(procedure)?.kind {
        ProcedureKind::Impact(impact) => of_impact(plan, impact, link),
        ProcedureKind::StoreyImpact(impact) => of_storey_impact(plan, impact, link),
        ProcedureKind::Shake(shake) => of_shake(plan, shake, link),
        ProcedureKind::Escalate(escalate) => of_escalate(plan, escalate, link),
        _ => None,
    }
}

/// How the rig follows the steps of a procedure on a specimen of this stiffness (N/m, of a frame the stiffest floor's); None where it
/// misses nothing.
fn scope(
    plan: &Plan,
    link: &VirtualLink,
    stepping: &Stepping,
    (time_step, duration): (f64, f64),
    stiffness: f64,
) -> Option<Scope> {
    let settle = &plan.rig.settle;
    // |dF/dt| = K·e/lag, less what drifts.
    let slow = (settle.force_rate - link.drift.abs()) * link.lag / stiffness;
    let pace = match stepping.mode {
        Mode::Continuous { time_scale } => Pace::Continuous { step: time_scale * time_step },
        Mode::StepAndPause => Pace::Paused {
            speed: Some(plan.limits.speed.high).filter(|speed| speed.is_finite()).unwrap_or(VIRTUAL_SPEED),
            band: settle.band,
            slow: if settle.force_rate > 0.0 { slow } else { f64::INFINITY },
            rest: stepping.pause.constant()? + if settle.band > 0.0 { settle.dwell } else { 0.0 },
        },
    };
    let manner = Manner { short: link.tracking, lag: link.lag, pace };
    let scope = Scope { manner, steps: step_count(duration, time_step), bound: bound(&plan.limits) };
    (!manner.is_exact()).then_some(scope)
}

fn of_impact(plan: &Plan, impact: &Impact, link: &VirtualLink) -> Option<Forecast> {
    let striker = plan.strikers.get(impact.striker)?;
    of_blows(plan, impact, striker, &[striker.velocity], link)
}

/// Blow by blow, each as on a specimen that none has struck: the worst of them, at the time in its own blow.
fn of_escalate(plan: &Plan, escalate: &Escalate, link: &VirtualLink) -> Option<Forecast> {
    let velocities = escalate.velocities.iter().map(Formula::constant).collect::<Option<Vec<f64>>>()?;
    let fastest = escalate.fastest(plan.strikers.get(escalate.striker())?);
    match &escalate.blow {
        BlowOn::Specimen(impact) => of_blows(plan, impact, &fastest, &velocities, link),
        BlowOn::Storey(impact) => of_storey_blows(plan, impact, &fastest, &velocities, link),
    }
}

/// With the time step that the blow of `striker` needs.
fn of_blows(plan: &Plan, impact: &Impact, striker: &Striker, velocities: &[f64], link: &VirtualLink) -> Option<Forecast> {
    let behaviour = plan.specimens.get(impact.specimen)?.behaviour.as_ref()?;
    // An earlier procedure's stiffness is near the specimen's own.
    let stiffness = impact.stiffness.constant().unwrap_or_else(|| behaviour.initial_stiffness());
    let time_step = time_step_before_the_run(impact, striker)?;
    let scope = scope(plan, link, &impact.stepping, (time_step, impact.duration.constant()?), behaviour.initial_stiffness())?;
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
    let foretold = worst(velocities, &scope, |velocity| {
        let input = ImpactInput { striker_velocity: velocity, ..input };
        Some(forecast::of_impact(&input, behaviour, impact.until, &scope))
    })?;
    Some(Forecast { foretold, time_step, omega: (stiffness / structure.mass).sqrt() })
}

/// The worst of the blows, as many from the first on as there are steps to look at.
fn worst(velocities: &[f64], scope: &Scope, foretold: impl Fn(f64) -> Option<Foretold>) -> Option<Foretold> {
    let blows = usize::try_from(forecast::MOST_STEPS.div_ceil(scope.steps.max(1))).unwrap_or(usize::MAX);
    let each = velocities.iter().take(blows).filter_map(|velocity| foretold(*velocity));
    each.max_by(|one, other| one.share.abs().total_cmp(&other.share.abs()))
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

/// How much the force of a floor changes by displacements of all, at most, N/m.
fn stiffest(frame: &Frame) -> f64 {
    frame.stiffness.iter().map(|row| row.iter().map(|entry| entry.abs()).sum::<f64>()).fold(0.0, f64::max)
}

/// A frame at rest before its first step.
fn at_rest<'a>(
    properties: &'a FrameProperties,
    stepping: &Stepping,
    time_step: f64,
    (zero, load): (&'a [f64], &'a [f64]),
) -> Option<FrameInput<'a>> {
    let matrices = &properties.matrices;
    let largest_ratio = stepping.max_tangent_ratio.constant()?;
    Some(FrameInput {
        matrices,
        operator_stiffness: &matrices.stiffness,
        integrator: stepping.integrator,
        i_modification: stepping.i_modification,
        tangents: storeys_of(&matrices.stiffness).map_or(Tangents::Initial, |_| Tangents::Storeys { largest_ratio }),
        time_step,
        initial_displacement: zero,
        initial_restoring_force: zero,
        initial_load: load,
        force_noise: 0.0,
        resolution: 0.0,
    })
}

fn of_shake(plan: &Plan, shake: &Shake, link: &VirtualLink) -> Option<Forecast> {
    let frame = plan.specimens.get(shake.specimen)?.frame.as_ref()?;
    let ground = plan.grounds.get(shake.ground)?;
    let properties = FrameProperties::of(frame, &shake.damping.known()?).ok()?;
    let time_step = shake.stepping.time_step.evaluate(&NoResults, Some(properties.critical_time_step())).ok()?.value;
    let duration = shake.duration.as_ref().map_or(Some(ground.duration()), Formula::constant)?;
    let scope = scope(plan, link, &shake.stepping, (time_step, duration), stiffest(frame))?;
    let scale = shake.scale.constant()?;
    let ground_at = |time: f64| scale * acceleration_at(&ground.times, &ground.accelerations, time);
    let zero = vec![0.0; properties.matrices.order()];
    let mut load = zero.clone();
    properties.matrices.ground_load(ground_at(0.0), &mut load);
    let input = at_rest(&properties, &shake.stepping, time_step, (&zero, &load))?;
    let velocity = scale * peak_velocity(&ground.times, &ground.accelerations);
    let energy = 0.5 * frame.total_mass() * velocity * velocity;
    let foretold = forecast::of_frame(&input, frame, &ground_at, energy, &scope)?;
    Some(Forecast { foretold, time_step, omega: properties.modes.angular_frequency(0) })
}

fn of_storey_impact(plan: &Plan, impact: &StoreyImpact, link: &VirtualLink) -> Option<Forecast> {
    let striker = plan.strikers.get(impact.striker)?;
    of_storey_blows(plan, impact, striker, &[striker.velocity], link)
}

/// With the time step that the blow of `striker` needs.
fn of_storey_blows(
    plan: &Plan,
    impact: &StoreyImpact,
    striker: &Striker,
    velocities: &[f64],
    link: &VirtualLink,
) -> Option<Forecast> {
    let frame = plan.specimens.get(impact.specimen)?.frame.as_ref()?;
    let properties = FrameProperties::of(frame, &impact.damping.known()?).ok()?;
    let law = law(&impact.contact)?;
    let critical = properties.critical_on_impact(impact.struck, &Approach::of(striker, law.stiffness()));
    let time_step = impact.stepping.time_step.evaluate(&NoResults, Some(critical)).ok()?.value;
    let scope = scope(plan, link, &impact.stepping, (time_step, impact.duration.constant()?), stiffest(frame))?;
    let zero = vec![0.0; properties.matrices.order()];
    let input = FrameImpactInput {
        frame: at_rest(&properties, &impact.stepping, time_step, (&zero, &zero))?,
        struck: impact.struck,
        striker_mass: striker.mass,
        striker_velocity: striker.velocity,
        gap: striker.gap,
        gravity: striker.gravity,
        law,
    };
    let foretold = worst(velocities, &scope, |velocity| {
        let input = FrameImpactInput { striker_velocity: velocity, ..input };
        forecast::of_storey_impact(&input, frame, impact.until, &scope)
    })?;
    Some(Forecast { foretold, time_step, omega: properties.modes.angular_frequency(0) })
}

/// Says of every procedure that tracking would stop it. `blocks` are those of the plan's procedures, `rig` that of its rig.
pub fn warn(checker: &mut Checker, plan: &Plan, blocks: &[usize], rig: Option<usize>) {
    let Link::Virtual(link) = &plan.rig.link else { return };
    let Some(errs) = rig.and_then(|rig| checker.given(rig, "link")).map(|(_, entry)| entry.value.span) else { return };
    for (index, block) in blocks.iter().enumerate() {
        let Some(forecast) = foretold(plan, index) else { continue };
        let Foretold { share, passed: Some(time), late } = forecast.foretold else { continue };
        let procedure = &plan.procedures[index];
        let Some(stepping) = stepping_of(&procedure.kind) else { continue };
        let bound = bound(&plan.limits);
        let stops = fault::Stops {
            name: &procedure.name,
            share,
            bound,
            short: link.tracking,
            lag: link.lag,
            late,
            damping_ratio: forecast.damping_ratio(),
            time,
            remedy: remedy(stepping, link, &forecast, 0.8 * bound / share.abs()),
        };
        let head = checker.scope.blocks[*block].block.head;
        checker.faults.push(fault::tracking_stops(&stops, head, errs));
    }
}

/// What would bring the error down to this part of what it is: it goes with the delay.
fn remedy(stepping: &Stepping, link: &VirtualLink, forecast: &Forecast, part: f64) -> fault::Remedy {
    match stepping.mode {
        _ if stepping.i_modification => fault::Remedy::Corrected,
        _ if link.lag == 0.0 => fault::Remedy::Shorter(part * forecast.time_step),
        Mode::Continuous { time_scale } => fault::Remedy::Slower(time_scale / part),
        // What the lag leaves of a step dies away with its time constant.
        Mode::StepAndPause => fault::Remedy::Longer(-link.lag * part.ln()),
    }
}

const fn stepping_of(kind: &ProcedureKind) -> Option<&Stepping> {
    match kind {
        ProcedureKind::Impact(impact) => Some(&impact.stepping),
        ProcedureKind::StoreyImpact(impact) => Some(&impact.stepping),
        ProcedureKind::Shake(shake) => Some(&shake.stepping),
        ProcedureKind::Escalate(escalate) => Some(match &escalate.blow {
            BlowOn::Specimen(impact) => &impact.stepping,
            BlowOn::Storey(impact) => &impact.stepping,
        }),
        _ => None,
    }
}
