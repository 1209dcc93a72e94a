//! `shake` (Melo et al. 2006, eqs. 1 and 1a, Figs. 1 and 2): a frame under ground motion, with an actuator and a load cell for each
//! floor. In: a frame, a ground motion, a time step, each inside its domain. Out: every step, and the results that follow from them. The
//! steps themselves are in `steps`.

use super::results::{ShakeSummary, results};
use super::setting::Setting;
use super::steps::Shaking;
use super::uncertainty::{self, ShakeUncertainty};
use crate::procedures::common::perturbed_inputs::UncertainRun;
use crate::procedures::frame::results::{drifted_to, observe_drift};
use crate::procedures::stepping::energy::observe_imbalance;
use crate::procedures::stepping::frame_uncertainty::FrameUncertainty;
use crate::procedures::stepping::setting::{FrameSteps, above_critical, frame_of};
use crate::procedures::stepping::tracking::TrackingSummary;
use crate::run::Performed;
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use psd_plan::record::{History, ShakeHistory};
use psd_plan::{Plan, Shake};

pub(crate) fn perform(
    plan: &Shake,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    let ground = &whole.grounds[plan.ground];
    let setting = frame_of(whole, plan.specimen)
        .and_then(|frame| Setting::evaluate(plan, frame, ground, inputs, session));
    let setting = match setting {
        Ok(setting) => setting,
        Err(stop) => {
            return Performed {
                history: History::Shake(ShakeHistory::default()),
                results: results(None, None, &TrackingSummary::default()),
                stop: Some(stop),
            };
        }
    };
    let FrameSteps {
        properties, steps, ..
    } = &setting.frame;
    above_critical(steps, session);
    let history = ShakeHistory {
        steps: Vec::new(),
        damping_ratios: properties.damping_ratios(),
        modes: Some(properties.modes.clone()),
        time_step: steps.time_step,
        drift_reached: None,
        critical_time_step: steps.critical_time_step,
    };
    let mut shaking = Shaking {
        setting: &setting,
        history,
        summary: ShakeSummary::new(
            setting.frame.order(),
            session.base_shear_noise(),
            &session.element_noise(),
        ),
        followed: TrackingSummary::default(),
    };
    let mut stop = shaking.run(plan, ground, session).err();
    let reached = plan
        .until
        .and_then(|limit| Some((limit, drifted_to(shaking.summary.drift(), limit)?)));
    if let (Some((limit, member)), None) = (reached, &stop) {
        shaking.history.drift_reached = Some(member);
        observe_drift(member, limit, session);
    }
    let summary = Some(&shaking.summary).filter(|_| !shaking.history.steps.is_empty());
    let mut results = results(shaking.history.modes.as_ref(), summary, &shaking.followed);
    if stop.is_none() {
        if summary.is_some() {
            observe_imbalance(shaking.summary.energy_error(), session);
        }
        let uncertainty = FrameUncertainty::new(
            UncertainRun::new(whole, inputs, session.guard.declared_noise()),
            plan.specimen,
            &plan.damping,
            plan.damping_uncertainty,
            &plan.stepping,
        );
        let substructures = session.substructures_at_start();
        stop = session.evaluate_uncertainty(&mut results, |results, progress| {
            let shake = ShakeUncertainty {
                uncertainty: &uncertainty,
                plan,
                ground,
                setting: &setting,
                substructures: substructures.as_ref(),
            };
            uncertainty::propagate(shake, &shaking.history, results, progress)
        });
    }
    Performed {
        results,
        history: History::Shake(shaking.history),
        stop,
    }
}
