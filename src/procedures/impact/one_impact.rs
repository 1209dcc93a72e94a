//! One blow of a row of blows, whatever is struck: one degree of freedom, or one storey of a frame. In: the blow of the plan,
//! evaluated once; for each blow a velocity. Out: the blow as an impact of its own, and how its load is taken off. It decides
//! nothing about the next one.

use super::storey;
use super::uncertainty::ImpactUncertainty;
use crate::physics::impact::ImpactInput;
use crate::physics::structure::Unloading;
use crate::plan::{BlowOn, Escalate, Impact, Plan, StoreyImpact, Striker};
use crate::procedures::stepping::frame_uncertainty::FrameUncertainty;
use crate::procedures::{impact, unload};
use crate::record::{ImpactHistory, NamedResult};
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::run::stop::Stop;
use crate::units::Dimension;

/// What is struck again and again.
#[expect(clippy::large_enum_variant, reason = "one of it in an escalate")]
pub(crate) enum Struck<'a> {
    Specimen {
        plan: &'a Impact,
        setting: impact::run::Setting,
        doubts: ImpactUncertainty<'a>,
    },
    Storey {
        plan: &'a StoreyImpact,
        setting: storey::Setting,
        unloading: Unloading,
        doubts: FrameUncertainty<'a>,
    },
}

/// A blow, as far as it went.
pub(crate) struct Blown {
    pub history: ImpactHistory,
    pub results: Vec<NamedResult>,
    pub stop: Option<Stop>,
    /// Of its steps.
    pub steps: u64,
}

impl<'a> Struck<'a> {
    /// What is struck, and the velocity of each blow, m/s.
    pub(crate) fn evaluate<'record: 'a>(
        plan: &'a Escalate,
        whole: &'a Plan,
        inputs: &mut Inputs<'record>,
        session: &Session<'_>,
    ) -> Result<(Self, Vec<f64>), Stop> {
        let velocities = velocities(plan, inputs)?;
        // One time step for all blows: the fastest is the shortest under a contact of finite stiffness.
        let striker = &whole.strikers[plan.striker()];
        let velocity = velocities.iter().copied().fold(0.0, f64::max);
        let fastest = Striker {
            velocity,
            ..striker.clone()
        };
        match &plan.blow {
            BlowOn::Specimen(blow) => {
                let noise = session.guard.declared_noise();
                let setting = impact::run::Setting::evaluate(blow, &fastest, inputs, noise)?;
                let doubts = ImpactUncertainty::new(blow, whole, inputs, noise);
                Ok((
                    Self::Specimen {
                        plan: blow,
                        setting,
                        doubts,
                    },
                    velocities,
                ))
            }
            BlowOn::Storey(blow) => {
                // `check` has seen that the specimen is a frame.
                let frame = whole.specimens[blow.specimen]
                    .frame
                    .as_ref()
                    .ok_or_else(Stop::no_frame)?;
                let setting = storey::Setting::evaluate(blow, frame, &fastest, inputs, session)?;
                let unloading = unload::run::of_frame(frame)?;
                let doubts = FrameUncertainty::of_blow(blow, whole, inputs, session);
                Ok((
                    Self::Storey {
                        plan: blow,
                        setting,
                        unloading,
                        doubts,
                    },
                    velocities,
                ))
            }
        }
    }

    /// The time step of all blows, and the critical one, s.
    pub(crate) const fn time_steps(&self) -> (f64, f64) {
        match self {
            Self::Specimen { setting, .. } => (setting.input.time_step, setting.critical_time_step),
            Self::Storey { setting, .. } => {
                (setting.frame.time_step, setting.frame.critical_time_step)
            }
        }
    }

    /// ½ Ms v² of a blow, J.
    pub(crate) fn energy(&self, striker_velocity: f64) -> f64 {
        let body = match self {
            Self::Specimen { setting, .. } => setting.input,
            Self::Storey { setting, .. } => setting.body,
        };
        ImpactInput {
            striker_velocity,
            ..body
        }
        .striker_energy()
    }

    /// The blow number `index`, from 0; `before` steps of the procedure are done already.
    pub(crate) fn blow(
        &mut self,
        (index, striker_velocity): (usize, f64),
        before: u64,
        session: &mut Session<'_>,
    ) -> Blown {
        match self {
            Self::Specimen {
                plan,
                setting,
                doubts,
            } => {
                let setting = impact::run::Setting {
                    input: ImpactInput {
                        striker_velocity,
                        ..setting.input
                    },
                    ..*setting
                };
                let impact::run::Blown {
                    history,
                    results,
                    stop,
                } = impact::run::blow(plan, &setting, &doubts.of_blow(index), before, session);
                let steps = history.steps.last().map_or(0, |last| last.step);
                Blown {
                    history,
                    results,
                    stop,
                    steps,
                }
            }
            Self::Storey {
                plan,
                setting,
                doubts,
                ..
            } => {
                setting.strikes_at(striker_velocity);
                let storey::Blown {
                    history,
                    results,
                    stop,
                } = storey::blow(
                    plan,
                    setting,
                    &doubts.of_blow_number(index),
                    before,
                    session,
                );
                let steps = history.steps.last().map_or(0, |last| last.step);
                Blown {
                    history,
                    results,
                    stop,
                    steps,
                }
            }
        }
    }

    /// How its forces are expected to fall.
    pub(crate) fn unloading(&self) -> Unloading {
        match self {
            Self::Specimen { setting, .. } => Unloading::of_one(setting.input.stiffness),
            Self::Storey { unloading, .. } => unloading.clone(),
        }
    }
}

/// m/s, each above 0.
fn velocities(plan: &Escalate, inputs: &mut Inputs<'_>) -> Result<Vec<f64>, Stop> {
    let velocities = inputs.list("speeds", &plan.velocities)?;
    match velocities
        .iter()
        .copied()
        .find(|velocity| !(*velocity > 0.0 && velocity.is_finite()))
    {
        Some(value) => Err(Stop::BadInput {
            field: "speeds",
            value,
            dimension: Dimension::VELOCITY,
            wanted: "greater than 0".into(),
        }),
        None => Ok(velocities),
    }
}
