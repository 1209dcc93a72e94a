//! `shake` (Melo et al. 2006, eqs. 1 and 1a, Figs. 1 and 2): a frame on moving ground, an actuator and a load cell for each
//! floor. In: a frame, a ground motion, a time step, each held against what can be integrated. Out: every step and what follows
//! from them. The steps themselves are `shaking`'s.

use super::results::{ShakeSummary, results};
use super::steps::Shaking;
use crate::physics::frame::Damping;
use crate::physics::structure::ground::peak_velocity;
use crate::plan::formula::Formula;
use crate::plan::{Frame, Ground, Plan, Shake, ShakeDamping, rayleigh};
use crate::procedures::impact::run::unbalanced;
use crate::procedures::inputs::Inputs;
use crate::procedures::stepping;
use crate::procedures::stepping::run::FrameSteps;
use crate::procedures::stepping::tracking_summary::Followed;
use crate::record::{History, ShakeHistory};
use crate::run::Performed;
use crate::run::session::{Session, of_base_shear};
use crate::run::stop::Stop;
use crate::uncertainty::base_excitation;
use crate::uncertainty::frame::FrameDoubts;
use crate::units::Dimension;

pub(crate) fn perform(
    plan: &Shake,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    let ground = &whole.grounds[plan.ground];
    // `check` has seen that the specimen is a frame.
    let frame = whole.specimens[plan.specimen].frame.as_ref();
    let setting = frame.map_or_else(
        || {
            Err(Stop::BadInput {
                field: "specimen",
                value: 0.0,
                dimension: Dimension::NUMBER,
                wanted: "a frame of storeys".into(),
            })
        },
        |frame| Setting::evaluate(plan, frame, ground, inputs, session),
    );
    let setting = match setting {
        Ok(setting) => setting,
        Err(stop) => {
            return Performed {
                history: History::Shake(ShakeHistory::default()),
                results: results(None, None, &Followed::default()),
                stop: Some(stop),
            };
        }
    };
    stepping::run::above_critical(
        setting.frame.time_step,
        setting.frame.critical_time_step,
        session,
    );
    let history = ShakeHistory {
        steps: Vec::new(),
        damping_ratios: setting.frame.properties.damping_ratios(),
        modes: Some(setting.frame.properties.modes.clone()),
        time_step: setting.frame.time_step,
        critical_time_step: setting.frame.critical_time_step,
    };
    let mut shaking = Shaking {
        setting: &setting,
        history,
        summary: ShakeSummary::new(
            setting.frame.properties.matrices.order(),
            of_base_shear(session),
        ),
        followed: Followed::default(),
    };
    let mut stop = shaking.run(plan, ground, session).err();
    let summary = Some(&shaking.summary).filter(|_| !shaking.history.steps.is_empty());
    let mut results = results(shaking.history.modes.as_ref(), summary, &shaking.followed);
    if stop.is_none() {
        if summary.is_some() {
            unbalanced(shaking.summary.energy_error(), session);
        }
        let doubts = FrameDoubts::of_shake(plan, whole, inputs, session);
        stop = session.evaluate_uncertainty(|tick| {
            base_excitation::propagate(
                &doubts,
                plan,
                ground,
                &setting,
                &shaking.history,
                &mut results,
                tick,
            )
        });
    }
    Performed {
        results,
        history: History::Shake(shaking.history),
        stop,
    }
}

/// Everything known before the first step.
pub(crate) struct Setting {
    pub(crate) frame: FrameSteps,
    /// Factor on the record.
    pub(crate) scale: f64,
    /// ½ ιᵀMι v², v the largest velocity of the ground, J: what its motion can put in, before it has.
    pub(crate) ground_energy: f64,
}

impl Setting {
    fn evaluate(
        plan: &Shake,
        frame: &Frame,
        ground: &Ground,
        inputs: &mut Inputs<'_>,
        session: &Session<'_>,
    ) -> Result<Self, Stop> {
        let properties = stepping::run::properties(frame, &plan.damping, inputs)?;
        let critical = properties.critical_time_step();
        let time_step = stepping::run::time_step(
            &plan.stepping,
            (frame, &properties),
            critical,
            inputs,
            session,
        )?;
        let to_the_end = Formula::Constant(ground.duration());
        let duration = inputs.positive(
            "duration",
            plan.duration.as_ref().unwrap_or(&to_the_end),
            Dimension::TIME,
        )?;
        let scale = inputs.number("scale", &plan.scale, Dimension::NUMBER)?;
        let steps = FrameSteps::new(
            properties,
            &plan.stepping,
            (time_step, critical, duration),
            inputs,
        )?;
        let velocity = scale * peak_velocity(&ground.times, &ground.accelerations);
        let ground_energy = 0.5 * frame.total_mass() * velocity * velocity;
        Ok(Self {
            frame: steps,
            scale,
            ground_energy,
        })
    }
}

/// The damping, and a ratio of it for a message.
pub(crate) fn damping(
    plan: &ShakeDamping,
    inputs: &mut Inputs<'_>,
) -> Result<(Damping, f64), Stop> {
    let known = |ratio: f64| match ratio {
        ratio if (0.0..=1.0).contains(&ratio) => Ok(ratio),
        value => Err(Stop::BadInput {
            field: "damping_ratio",
            value,
            dimension: Dimension::NUMBER,
            wanted: "between 0 and 1".into(),
        }),
    };
    Ok(match plan {
        ShakeDamping::Rayleigh(ratio) => {
            let ratio = known(inputs.damping("damping_ratio", ratio, Dimension::NUMBER)?)?;
            (rayleigh(ratio), ratio)
        }
        ShakeDamping::Modal(ratios) => {
            let ratios = inputs.list("damping_ratio", ratios)?;
            let ratios = ratios
                .into_iter()
                .map(known)
                .collect::<Result<Vec<f64>, Stop>>()?;
            let first = ratios.first().copied().unwrap_or(0.0);
            (Damping::Modal(ratios), first)
        }
    })
}
