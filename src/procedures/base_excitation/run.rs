//! `shake` (Melo et al. 2006, eqs. 1 and 1a, Figs. 1 and 2): a frame on moving ground, an actuator and a load cell for each
//! floor. In: a frame, a ground motion, a time step, each held against what can be integrated. Out: every step and what follows
//! from them. The steps themselves are `shaking`'s.

use super::results::{ShakeSummary, results};
use super::setting::Setting;
use super::steps::Shaking;
use super::uncertainty;
use crate::plan::{Plan, Shake};
use crate::procedures::stepping;
use crate::procedures::stepping::frame_uncertainty::FrameUncertainty;
use crate::procedures::stepping::remarks::unbalanced;
use crate::procedures::stepping::tracking_summary::Followed;
use crate::record::{History, ShakeHistory};
use crate::run::Performed;
use crate::run::inputs::Inputs;
use crate::run::session::{Session, of_base_shear};
use crate::run::stop::Stop;

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
        || Err(Stop::no_frame()),
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
        let doubts = FrameUncertainty::of_shake(plan, whole, inputs, session);
        stop = session.evaluate_uncertainty(|tick| {
            uncertainty::propagate(
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
