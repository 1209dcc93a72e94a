//! `impact` (Melo et al. 2006, sec. 5 steps 3–8, eqs. 2–7): the striker is computed, the structure is on the rig. Each
//! step: predict, command, settle, pause, read, feed back. In: masses, stiffness, law, time step. Out: every step and
//! what follows from them. The equations are `mechanics`'; this file only lets them meet the rig.

use super::steps::{ImpactSteps, Kept};
use super::summary::StruckSummary;
use super::uncertainty::ImpactUncertainty;
use crate::physics::contact::contact_time_step::Approach;
use crate::physics::contact::state::ContactLaw;
use crate::physics::impact::summary::ImpactSummary;
use crate::physics::impact::{ImpactInput, ImpactSolver};
use crate::physics::integrator::stability::{Met, longest_stable_step};
use crate::plan::Structure;
use crate::plan::formula::Estimate;
use crate::plan::{Contact, Impact, MOST_STEPS, Plan, Striker, Until, step_count, steps_in};
use crate::procedures::results::result;
use crate::procedures::stepping::operator_stability_watch::StifferSprings;
use crate::procedures::stepping::pace::Pace;
use crate::procedures::stepping::remarks::unbalanced;
use crate::procedures::stepping::run::{above_critical, holds_a_step, stable};
use crate::procedures::stepping::start::not_stepped;
use crate::record::{EventKind, History, ImpactHistory, ImpactStep, NamedResult};
use crate::rig::DeclaredNoise;
use crate::run::Performed;
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::run::stop::Stop;
use crate::units::Dimension;
use crate::units::display::readable;

pub(crate) fn perform(
    plan: &Impact,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    let noise = session.guard.declared_noise();
    let (setting, stop) =
        match Setting::evaluate(plan, &whole.strikers[plan.striker], inputs, noise) {
            Ok(setting) => (Some(setting), None),
            Err(stop) => (None, Some(stop)),
        };
    let Some(setting) = setting else {
        let history = ImpactHistory {
            steps: Vec::new(),
            frame: None,
            time_step: 0.0,
            critical_time_step: 0.0,
        };
        return Performed {
            results: results(None, None, &history),
            history: History::Impact(history),
            stop,
        };
    };
    above_critical(setting.input.time_step, setting.critical_time_step, session);
    let doubts = ImpactUncertainty::new(plan, whole, inputs, noise);
    let Blown {
        history,
        results,
        stop,
    } = blow(plan, &setting, &doubts, 0, session);
    Performed {
        results,
        history: History::Impact(history),
        stop,
    }
}

/// One blow, as far as it went.
pub(crate) struct Blown {
    pub history: ImpactHistory,
    pub results: Vec<NamedResult>,
    pub stop: Option<Stop>,
}

/// The blow of a striker from where the rig is now; `before` steps of the procedure are done already.
pub(crate) fn blow(
    plan: &Impact,
    setting: &Setting,
    doubts: &ImpactUncertainty<'_>,
    before: u64,
    session: &mut Session<'_>,
) -> Blown {
    let Setting {
        input,
        steps,
        pause,
        ..
    } = setting;
    let mut kept = Kept::new(StruckSummary::new(input), *steps);
    let pace = Pace {
        time_step: input.time_step,
        steps: *steps,
        pause: *pause,
    };
    let order = ImpactSteps {
        stepping: &plan.stepping,
        pace,
        until: plan.until,
        before,
    };
    let ran = order.run(&mut kept, session, |start| {
        let solver = ImpactSolver::new(input, start.commanded[0], start.reading.force[0]);
        let solver = solver.map_err(|error| not_stepped(input.time_step, &error))?;
        Ok((
            solver,
            StifferSprings::of_specimen(input, &plan.stepping, start),
        ))
    });
    let mut stop = ran.err();
    let Kept {
        steps,
        summary,
        followed,
        ..
    } = kept;
    let summary = (!steps.is_empty()).then(|| summary.impact());
    let worst = followed.worst();
    if let (Some(summary), None) = (&summary, &stop) {
        remark(summary, plan.until, &setting.input.law, session);
    }
    let history = ImpactHistory {
        steps,
        frame: None,
        time_step: setting.input.time_step,
        critical_time_step: setting.critical_time_step,
    };
    let mut results = results(summary.as_ref(), worst, &history);
    if let (Some(summary), None) = (&summary, &stop) {
        stop = session.evaluate_uncertainty(|tick| {
            doubts.propagate(setting, &history.steps, summary, &mut results, tick)
        });
    }
    Blown {
        history,
        results,
        stop,
    }
}

/// Everything known before the first step.
#[derive(Clone, Copy)]
pub(crate) struct Setting {
    pub input: ImpactInput,
    /// What the critical time step was found for: of several blows the fastest.
    pub approach: Approach,
    /// Its striker before it falls, m/s.
    pub fastest: f64,
    /// s
    pub critical_time_step: f64,
    pub steps: u64,
    /// s
    pub pause: f64,
}

impl Setting {
    pub(crate) fn evaluate(
        plan: &Impact,
        striker: &Striker,
        inputs: &mut Inputs<'_>,
        noise: DeclaredNoise,
    ) -> Result<Self, Stop> {
        let mass = inputs.positive("mass", &plan.mass, Dimension::MASS)?;
        inputs.also_uncertain(plan.mass_uncertainty);
        let stiffness =
            inputs.positive_estimate("stiffness", &plan.stiffness, Dimension::STIFFNESS, None)?;
        let (stiffness, operator_stiffness) = (stiffness.value, high_end(stiffness));
        let damping = inputs.damping("damping", &plan.damping, Dimension::DAMPING)?;
        let law = law(&plan.contact, inputs)?;
        let approach = striker.approach(law.stiffness());
        let critical_time_step = approach.critical_time_step(mass, stiffness);
        let stepping = &plan.stepping;
        let critical = Some(critical_time_step);
        let time_step = inputs
            .positive_estimate("time_step", &stepping.time_step, Dimension::TIME, critical)?
            .value;
        let duration = inputs.positive("duration", &plan.duration, Dimension::TIME)?;
        let pause = inputs.not_negative("pause", &stepping.pause, Dimension::TIME)?;
        let max_tangent_ratio = inputs.positive(
            "max_tangent_ratio",
            &stepping.max_tangent_ratio,
            Dimension::NUMBER,
        )?;
        holds_a_step(time_step, duration)?;
        if steps_in(duration, time_step) > MOST_STEPS {
            return Err(Stop::BadInput {
                field: "time_step",
                value: time_step,
                dimension: Dimension::TIME,
                wanted: format!("long enough for at most {MOST_STEPS} steps").into(),
            });
        }
        // What `check` could not know yet: the stability limit by the stiffness of an earlier procedure.
        stable(
            stepping,
            time_step,
            longest_stable_step(
                stepping.integrator,
                &Met::one(mass, damping, stiffness, stiffness),
            ),
        )?;
        let structure = Structure {
            mass,
            damping,
            stiffness,
            operator_stiffness,
            law,
            time_step,
            max_tangent_ratio,
            force_noise: noise.force,
            resolution: noise.resolution,
        };
        let input = structure.struck_by(striker, stepping);
        Ok(Self {
            input,
            approach,
            fastest: striker.velocity,
            critical_time_step,
            steps: step_count(duration, time_step),
            pause,
        })
    }

    /// With more mass of the structure, kg.
    pub(crate) fn heavier(&mut self, mass: f64) {
        self.input.mass += mass;
        self.critical_time_step = self
            .approach
            .critical_time_step(self.input.mass, self.input.stiffness);
    }
}

/// `K_I`: the high end of the interval in which the stiffness lies (two standard uncertainties), for α-OS is stable only
/// as long as the specimen is not stiffer (physics, section 11; never a noisy secant).
fn high_end(stiffness: Estimate) -> f64 {
    stiffness.value + 2.0 * stiffness.uncertainty.unwrap_or(0.0)
}

pub(crate) fn law(contact: &Contact, inputs: &mut Inputs<'_>) -> Result<ContactLaw, Stop> {
    Ok(match contact {
        Contact::Rigid => ContactLaw::Rigid,
        Contact::Limit { force } => ContactLaw::Limit {
            force: inputs.positive("force_limit", force, Dimension::FORCE)?,
        },
        Contact::Restitution { coefficient } => {
            let coefficient = inputs.not_negative("restitution", coefficient, Dimension::NUMBER)?;
            if coefficient > 1.0 {
                return Err(Stop::BadInput {
                    field: "restitution",
                    value: coefficient,
                    dimension: Dimension::NUMBER,
                    wanted: "at most 1".into(),
                });
            }
            ContactLaw::Restitution { coefficient }
        }
        Contact::Hertz {
            stiffness,
            loss,
            force_limit,
        } => ContactLaw::Hertz {
            stiffness: inputs.positive(
                "contact_stiffness",
                stiffness,
                Dimension::HERTZ_STIFFNESS,
            )?,
            loss: inputs.not_negative("loss", loss, SECONDS_PER_METRE)?,
            force_limit: match force_limit {
                Some(force) => Some(inputs.positive("force_limit", force, Dimension::FORCE)?),
                None => None,
            },
        },
    })
}

/// Of the Hunt–Crossley loss factor.
const SECONDS_PER_METRE: Dimension = Dimension {
    length: crate::units::Exponent::whole(-1),
    mass: crate::units::Exponent::ZERO,
    time: crate::units::Exponent::whole(1),
};

/// What a reader of the results must know of how the run ended.
pub(crate) fn remark(
    summary: &ImpactSummary,
    until: Until,
    law: &ContactLaw,
    session: &mut Session<'_>,
) {
    if until == Until::StrikerStop && summary.stop_time.is_none() {
        session.remark("the striker did not stop within the duration".to_owned());
    }
    if summary.still_rising {
        let text =
            "the structure was still moving on at the end: its largest displacement is not a peak";
        session.remark(text.to_owned());
    }
    unbalanced(summary.energy_error, session);
    if let (ContactLaw::Limit { force }, true) = (law, summary.contacts > 0)
        && law.force_follows_the_step(summary.max_contact_force)
    {
        let limit = readable(*force, Dimension::FORCE);
        let text = format!(
            "the limit force {limit} was not reached: the largest contact force grows as the time step shrinks"
        );
        session.event(EventKind::Remark, text);
    }
    if summary.last_blow_cut {
        let text =
            "the striker stopped with a contact force in its last step: the last blow is cut";
        session.remark(text.to_owned());
    }
}

/// In the order of the reference, `worst` the largest share of the input that tracking made of the energy; every number is missing if not
/// even the start was read.
pub(crate) fn results(
    summary: Option<&ImpactSummary>,
    worst: Option<f64>,
    history: &ImpactHistory,
) -> Vec<NamedResult> {
    let of = |name, dimension, value: fn(&ImpactSummary) -> f64| {
        result(name, dimension, summary.map(value))
    };
    let ended = |name, dimension, value: fn(&ImpactStep) -> f64| {
        result(name, dimension, history.steps.last().map(value))
    };
    let known = |value: f64| (value > 0.0).then_some(value);
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
    let steps = history.steps.last().map(|last| last.step as f64);
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
    let contacts: fn(&ImpactSummary) -> f64 = |summary| summary.contacts as f64;
    vec![
        of("max_displacement", Dimension::LENGTH, |summary| {
            summary.max_displacement
        }),
        of("time_of_max_displacement", Dimension::TIME, |summary| {
            summary.time_of_max_displacement
        }),
        result(
            "stop_time",
            Dimension::TIME,
            summary.and_then(|summary| summary.stop_time),
        ),
        of("final_displacement", Dimension::LENGTH, |summary| {
            summary.final_displacement
        }),
        of("max_velocity", Dimension::VELOCITY, |summary| {
            summary.max_velocity
        }),
        of("max_contact_force", Dimension::FORCE, |summary| {
            summary.max_contact_force
        }),
        of("impulse", Dimension::IMPULSE, |summary| summary.impulse),
        of("contacts", Dimension::NUMBER, contacts),
        result(
            "restitution",
            Dimension::NUMBER,
            summary.and_then(|summary| summary.restitution),
        ),
        of("indentation", Dimension::LENGTH, |summary| {
            summary.indentation
        }),
        of("indentation_energy", Dimension::ENERGY, |summary| {
            summary.indentation_energy
        }),
        of("absorbed_energy", Dimension::ENERGY, |summary| {
            summary.absorbed_energy
        }),
        ended("restoring_energy", Dimension::ENERGY, |last| {
            last.energies.restoring
        }),
        ended("damping_energy", Dimension::ENERGY, |last| {
            last.energies.damping
        }),
        of("striker_energy", Dimension::ENERGY, |summary| {
            summary.striker_energy
        }),
        of("energy_error", Dimension::NUMBER, |summary| {
            summary.energy_error
        }),
        result("tracking_energy_error", Dimension::NUMBER, worst),
        ended("tracking_indicator", Dimension::AREA, |last| {
            last.tracking.indicator
        }),
        ended("nrms_error", Dimension::NUMBER, |last| {
            last.tracking.nrms_error
        }),
        ended("peak_error", Dimension::LENGTH, |last| {
            last.tracking.peak_error
        }),
        result("time_step", Dimension::TIME, known(history.time_step)),
        result(
            "critical_time_step",
            Dimension::TIME,
            known(history.critical_time_step),
        ),
        result("steps", Dimension::NUMBER, steps),
    ]
}
