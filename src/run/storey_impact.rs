//! An impact on one storey of a frame: the striker is computed, the frame is on the rig, an actuator and a load cell for each
//! floor. In: a frame, a striker, a contact law, a time step, each held against what can be integrated. Out: every step and what
//! follows from them. The steps themselves are `striking`'s.

use super::Performed;
use super::followed::Followed;
use super::frame_doubts::FrameDoubts;
use super::impact::{law, remark};
use super::inputs::Inputs;
use super::session::{Session, of_base_shear};
use super::stepping::{self, FrameSteps};
use super::stop::Stop;
use super::storey_doubts;
use super::storey_summary::{StoreySummary, results};
use super::striking::Striking;
use crate::mechanics::approach::Approach;
use crate::mechanics::contact::ContactLaw;
use crate::mechanics::frame_properties::FrameProperties;
use crate::mechanics::impact::ImpactInput;
use crate::mechanics::structure::Structure;
use crate::plan::{Frame, Plan, StoreyImpact, Striker};
use crate::quantity::Dimension;
use crate::record::{History, ImpactHistory, NamedResult, StoreyImpactHistory};

pub(super) fn perform(plan: &StoreyImpact, whole: &Plan, inputs: &mut Inputs<'_>, session: &mut Session<'_>) -> Performed {
    let striker = &whole.strikers[plan.striker];
    // `check` has seen that the specimen is a frame.
    let frame = whole.specimens[plan.specimen].frame.as_ref();
    let setting = frame.ok_or_else(no_frame).and_then(|frame| Setting::evaluate(plan, frame, striker, inputs, session));
    match setting {
        Ok(setting) => {
            stepping::above_critical(setting.frame.time_step, setting.frame.critical_time_step, session);
            let doubts = FrameDoubts::of_blow(plan, whole, inputs, session);
            let Blown { history, results, stop } = blow(plan, &setting, &doubts, 0, session);
            Performed { results, history: History::StoreyImpact(history), stop }
        }
        Err(stop) => {
            let history = history_of(plan, None);
            Performed {
                results: results(None, &Followed::default(), &history),
                history: History::StoreyImpact(history),
                stop: Some(stop),
            }
        }
    }
}

pub(super) fn no_frame() -> Stop {
    Stop::BadInput { field: "specimen", value: 0.0, dimension: Dimension::NUMBER, wanted: "a frame of storeys".into() }
}

/// One blow, as far as it went.
pub(super) struct Blown {
    pub history: StoreyImpactHistory,
    pub results: Vec<NamedResult>,
    pub stop: Option<Stop>,
}

/// The blow of a striker from where the floors are now; `before` steps of the procedure are done already.
pub(super) fn blow(
    plan: &StoreyImpact,
    setting: &Setting,
    doubts: &FrameDoubts<'_>,
    before: u64,
    session: &mut Session<'_>,
) -> Blown {
    let history = history_of(plan, Some(setting));
    let summary = StoreySummary::new(&setting.body, setting.frame.properties.matrices.order(), of_base_shear(session));
    let mut striking = Striking { setting, before, history, summary, followed: Followed::default() };
    let mut stop = striking.run(plan, session).err();
    let Striking { history, summary, followed, .. } = striking;
    let summary = (!history.floors.is_empty()).then_some(summary);
    if let (Some(summary), None) = (&summary, &stop) {
        remark(&summary.blow(), plan.until, &setting.law, session);
    }
    let mut results = results(summary.as_ref(), &followed, &history);
    if let (Some(summary), None) = (&summary, &stop) {
        let mut tick = |done, of| session.study(done, of);
        let found = storey_doubts::propagate(doubts, plan, setting, &history, &summary.blow(), &mut results, &mut tick);
        stop = session.told_of(found);
    }
    Blown { history, results, stop }
}

/// Before its first step.
fn history_of(plan: &StoreyImpact, setting: Option<&Setting>) -> StoreyImpactHistory {
    let blow = ImpactHistory {
        steps: Vec::new(),
        time_step: setting.map_or(0.0, |setting| setting.frame.time_step),
        critical_time_step: setting.map_or(0.0, |setting| setting.frame.critical_time_step),
    };
    let properties = setting.map(|setting| &setting.frame.properties);
    StoreyImpactHistory {
        blow,
        floors: Vec::new(),
        struck: plan.struck,
        modes: properties.map(|properties| properties.modes.clone()),
        damping_ratios: properties.map(FrameProperties::damping_ratios).unwrap_or_default(),
    }
}

/// Everything known before the first step.
pub(super) struct Setting {
    pub(super) frame: FrameSteps,
    pub(super) law: ContactLaw,
    pub(super) striker: Striker,
    /// The struck floor and the striker as an impact on one degree of freedom has them.
    pub(super) body: ImpactInput,
    /// Of the blow that the critical time step was found for, m/s.
    pub(super) fastest: f64,
}

impl Setting {
    pub(super) fn evaluate(
        plan: &StoreyImpact,
        frame: &Frame,
        striker: &Striker,
        inputs: &mut Inputs<'_>,
        session: &Session<'_>,
    ) -> Result<Self, Stop> {
        let properties = stepping::properties(frame, &plan.damping, inputs)?;
        let law = law(&plan.contact, inputs)?;
        let critical = properties.critical_on_impact(plan.struck, &Approach::of(striker, law.stiffness()));
        let time_step = stepping::time_step(&plan.stepping, (frame, &properties), critical, inputs, session)?;
        let duration = inputs.positive("duration", &plan.duration, Dimension::TIME)?;
        let steps = FrameSteps::new(properties, &plan.stepping, (time_step, critical, duration), inputs)?;
        let noise = session.guard.declared_noise();
        let stiffness = frame.stiffness[plan.struck][plan.struck];
        let body = Structure {
            mass: steps.properties.struck_mass(plan.struck),
            damping: 0.0,
            stiffness,
            operator_stiffness: stiffness,
            law,
            time_step,
            max_tangent_ratio: steps.max_tangent_ratio,
            force_noise: noise.force,
            resolution: noise.resolution,
        };
        let body = body.struck_by(striker, &plan.stepping);
        Ok(Self { frame: steps, law, striker: striker.clone(), body, fastest: striker.velocity })
    }

    /// The same with a striker of another velocity, m/s.
    pub(super) const fn strikes_at(&mut self, velocity: f64) {
        self.striker.velocity = velocity;
        self.body.striker_velocity = velocity;
    }
}
