//! The delay of a virtual rig that lags or falls short, to first order, and the warning where it would add much energy to a test
//! (W719). In: procedures that integrate, the rig. Out: delays and warnings. It runs nothing: a simulation on the lagging rig shows the rest.

use crate::language::check::checker::Checker;
use crate::language::check::messages::methods as message;
use crate::physics::structure::frame_properties::FrameProperties;
use crate::physics::tracking::monitor;
use crate::plan::formula::NoResults;
use crate::plan::{
    Contact, Frame, Impact, ImpactTarget, Link, Mode, Plan, PointTarget, ProcedureKind,
    ShakeDamping, Stepping, StoreyTarget, Striker, VirtualLink,
};
use crate::procedures;
use crate::procedures::impact::check::judge::time_step_before_the_run;

/// Delay of the actuators of a procedure.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Delay {
    /// D, simulated time \[s\].
    late: f64,
    /// Δt \[s\]
    time_step: f64,
    /// Natural circular frequency of the specimen, or of the first mode of a frame \[rad/s\].
    omega: f64,
}

impl Delay {
    /// Apparent damping ratio of a motion at ω with a delay D: a force K·d(t − D) is K·d − KD·v, so that C = −KD and ζ = −ωD/2.
    fn damping_ratio(self) -> f64 {
        -0.5 * self.omega * self.late
    }

    /// Energy that it adds to a vibration in one cycle, over that of the vibration: −4πζ.
    fn energy(self) -> f64 {
        -4.0 * std::f64::consts::PI * self.damping_ratio()
    }
}

/// Delay of the actuators of a rig to first order, in simulated time \[s\]: the fraction t of each increment is missed, which is Δt·t/(1 − t), and
/// of a lag τ the part that remains after a pause, or in continuous mode τ over the time scale.
#[must_use]
pub fn late(plan: &Plan, stepping: &Stepping, time_step: f64) -> f64 {
    let Link::Virtual(VirtualLink {
        tracking: short,
        lag,
        ..
    }) = plan.rig.link
    else {
        return 0.0;
    };
    if short >= 1.0 {
        return f64::INFINITY;
    }
    let of_lag = match stepping.mode {
        _ if lag <= 0.0 => 0.0,
        Mode::Continuous { time_scale } => lag / time_scale,
        // The rig settles into its band first.
        Mode::StepAndPause if plan.rig.settle.band > 0.0 => 0.0,
        Mode::StepAndPause => {
            let left = (-stepping.pause.constant().unwrap_or(0.0) / lag).exp();
            if left < 1.0 {
                time_step * left / (1.0 - left)
            } else {
                f64::INFINITY
            }
        }
    };
    (short * time_step + of_lag) / (1.0 - short)
}

/// None without a delay, or where too little is known before the run.
fn of_procedure(plan: &Plan, procedure: usize) -> Option<Delay> {
    let found = match &plan.procedures.get(procedure)?.kind {
        ProcedureKind::Impact(impact) => {
            of_impact(plan, impact, plan.strikers.get(impact.striker)?)
        }
        ProcedureKind::Escalate(series) => {
            let impact = &series.impact;
            let fastest = series.fastest(plan.strikers.get(impact.striker)?);
            of_impact(plan, impact, &fastest)
        }
        ProcedureKind::Shake(shake) => {
            let of_frame = |properties: &FrameProperties| Some(properties.critical_time_step());
            of_frame_in_steps(
                plan,
                shake.specimen,
                &shake.damping,
                &shake.stepping,
                of_frame,
            )
        }
        _ => None,
    };
    found.filter(|delay| delay.late > 0.0)
}

fn of_impact(plan: &Plan, impact: &Impact, striker: &Striker) -> Option<Delay> {
    match &impact.target {
        ImpactTarget::Point(point) => on_point(plan, impact, point, striker),
        ImpactTarget::Storey(storey) => on_storey(plan, impact, storey, striker),
    }
}

fn on_point(plan: &Plan, impact: &Impact, point: &PointTarget, striker: &Striker) -> Option<Delay> {
    let behaviour = plan.specimens.get(impact.specimen)?.behaviour.as_ref()?;
    // The stiffness from an earlier procedure is near the specimen's own.
    let stiffness = point
        .stiffness
        .constant()
        .unwrap_or_else(|| behaviour.initial_stiffness());
    let time_step = time_step_before_the_run(impact, striker)?;
    let late = late(plan, &impact.stepping, time_step);
    Some(Delay {
        late,
        time_step,
        omega: (stiffness / point.mass.constant()?).sqrt(),
    })
}

fn on_storey(
    plan: &Plan,
    impact: &Impact,
    target: &StoreyTarget,
    striker: &Striker,
) -> Option<Delay> {
    let stiffness = match &impact.contact {
        Contact::Hertz { stiffness, .. } => Some(stiffness.constant()?),
        _ => None,
    };
    of_frame_in_steps(
        plan,
        impact.specimen,
        &target.damping,
        &impact.stepping,
        |properties| {
            Some(properties.critical_on_impact(target.storey, &striker.approach(stiffness)))
        },
    )
}

fn of_frame_in_steps(
    plan: &Plan,
    specimen: usize,
    damping: &ShakeDamping,
    stepping: &Stepping,
    critical: impl Fn(&FrameProperties) -> Option<f64>,
) -> Option<Delay> {
    let frame: &Frame = plan.specimens.get(specimen)?.frame.as_ref()?;
    let properties = FrameProperties::of(frame, &damping.known()?).ok()?;
    let time_step = stepping
        .time_step
        .evaluate(&NoResults, critical(&properties))
        .ok()?
        .value;
    Some(Delay {
        late: late(plan, stepping, time_step),
        time_step,
        omega: properties.modes.angular_frequency(0),
    })
}

/// Warns of every procedure in which one cycle absorbs as much energy as the limit on tracking allows. `blocks` are those of the plan's
/// procedures, `rig` is that of its rig.
pub fn warn(checker: &mut Checker, plan: &Plan, blocks: &[usize], rig: Option<usize>) {
    let Link::Virtual(link) = &plan.rig.link else {
        return;
    };
    let Some(errs) = rig
        .and_then(|rig| checker.field(rig, "link"))
        .map(|(_, entry)| entry.value.span)
    else {
        return;
    };
    let limit = plan.limits.tracking_energy_error;
    let bound = if limit.is_bounded() {
        limit.high
    } else {
        monitor::HOLD
    };
    for (index, block) in blocks.iter().enumerate() {
        let Some(delay) = of_procedure(plan, index).filter(|delay| delay.energy() > bound) else {
            continue;
        };
        let procedure = &plan.procedures[index];
        let Some(stepping) = procedures::facts_of(&procedure.kind)
            .stepping
            .filter(|stepping| !stepping.i_modification)
        else {
            continue;
        };
        let late = message::Late {
            name: &procedure.name,
            energy: delay.energy(),
            bound,
            short: link.tracking,
            lag: link.lag,
            delay: delay.late,
            damping_ratio: delay.damping_ratio(),
            remedy: remedy(stepping, link, delay, 0.8 * bound / delay.energy()),
        };
        let head = checker.scope.blocks[*block].block.head;
        checker
            .diagnostics
            .push(message::tracking_is_late(&late, head, errs));
    }
}

/// A change that would reduce the delay to this fraction.
fn remedy(stepping: &Stepping, link: &VirtualLink, delay: Delay, part: f64) -> message::Remedy {
    match stepping.mode {
        _ if link.lag == 0.0 => message::Remedy::Shorter(part * delay.time_step),
        Mode::Continuous { time_scale } => message::Remedy::Slower(time_scale / part),
        // The rest of the lag after a step decays with its time constant.
        Mode::StepAndPause => message::Remedy::Longer(-link.lag * part.ln()),
    }
}
