//! An impact on one storey of a frame: the striker is computed, the frame is on the rig, an actuator and a load cell for each
//! floor. In: a frame, a striker, a contact law, a time step, each held against what can be integrated. Out: every step and what
//! follows from them. The steps themselves are `striking`'s.

use super::Performed;
use super::followed::Followed;
use super::impact::{law, remark};
use super::inputs::Inputs;
use super::session::Session;
use super::shake::{damping, steps_in};
use super::stop::Stop;
use super::storey_summary::{StoreySummary, results};
use super::striking::Striking;
use crate::formula::NoResults;
use crate::mechanics::contact::ContactLaw;
use crate::mechanics::frame::{Damping, Tangents, storeys_of};
use crate::mechanics::frame_properties::{Approach, FrameProperties};
use crate::mechanics::impact::ImpactInput;
use crate::plan::{Contact, Frame, MOST_STEPS, Plan, StoreyImpact, Striker};
use crate::quantity::Dimension;
use crate::quantity::display::stated;
use crate::record::{History, ImpactHistory, StoreyImpactHistory};

pub(super) fn perform(plan: &StoreyImpact, whole: &Plan, inputs: &mut Inputs<'_>, session: &mut Session<'_>) -> Performed {
    let striker = &whole.strikers[plan.striker];
    // `check` has seen that the specimen is a frame.
    let frame = whole.specimens[plan.specimen].frame.as_ref();
    let setting = frame.map_or_else(
        || Err(Stop::BadInput { field: "specimen", value: 0.0, wanted: "a frame of storeys".into() }),
        |frame| Setting::evaluate(plan, frame, striker, inputs, session),
    );
    let blow = |setting: Option<&Setting>| ImpactHistory {
        steps: Vec::new(),
        time_step: setting.map_or(0.0, |setting| setting.time_step),
        critical_time_step: setting.map_or(0.0, |setting| setting.critical_time_step),
    };
    let mut history = StoreyImpactHistory {
        blow: blow(setting.as_ref().ok()),
        floors: Vec::new(),
        struck: plan.struck,
        modes: None,
        damping_ratios: Vec::new(),
    };
    let setting = match setting {
        Ok(setting) => setting,
        Err(stop) => {
            return Performed {
                results: results(None, &Followed::default(), &history),
                history: History::StoreyImpact(history),
                stop: Some(stop),
            };
        }
    };
    history.modes = Some(setting.properties.modes.clone());
    history.damping_ratios = setting.properties.damping_ratios();
    let summary = StoreySummary::new(&setting.body, setting.properties.matrices.order());
    let mut striking = Striking { setting: &setting, history, summary, followed: Followed::default() };
    let stop = striking.run(plan, session).err();
    let Striking { history, summary, followed, .. } = striking;
    let summary = (!history.floors.is_empty()).then_some(summary);
    if let (Some(summary), None) = (&summary, &stop) {
        remark(&summary.blow(), plan.until, session);
    }
    Performed { results: results(summary.as_ref(), &followed, &history), history: History::StoreyImpact(history), stop }
}

/// Steps of an impact on a storey, where the plan alone tells.
pub(super) fn steps(impact: &StoreyImpact, plan: &Plan) -> Option<u64> {
    let frame = plan.specimens.get(impact.specimen)?.frame.as_ref()?;
    let properties = FrameProperties::of(frame, &Damping::None).ok()?;
    let hertz = match &impact.contact {
        Contact::Hertz { stiffness, .. } => Some(stiffness.constant()?),
        _ => None,
    };
    let approach = Approach::of(plan.strikers.get(impact.striker)?, hertz);
    let critical = properties.critical_on_impact(impact.struck, &approach);
    let time_step = impact.time_step.evaluate(&NoResults, Some(critical)).ok()?.value;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a bound for display, saturating")]
    Some(steps_in(impact.duration.constant()?, time_step) as u64)
}

/// Everything known before the first step.
pub(super) struct Setting {
    pub(super) properties: FrameProperties,
    pub(super) tangents: Tangents,
    pub(super) law: ContactLaw,
    pub(super) striker: Striker,
    /// s
    pub(super) time_step: f64,
    /// s
    pub(super) critical_time_step: f64,
    pub(super) steps: u64,
    /// s
    pub(super) pause: f64,
    /// The struck floor and the striker as an impact on one degree of freedom has them.
    pub(super) body: ImpactInput,
}

impl Setting {
    fn evaluate(
        plan: &StoreyImpact,
        frame: &Frame,
        striker: &Striker,
        inputs: &mut Inputs<'_>,
        session: &Session<'_>,
    ) -> Result<Self, Stop> {
        let (damping, ratio) = damping(&plan.damping, inputs)?;
        let unmet = |reason: String| Stop::BadInput { field: "damping_ratio", value: ratio, wanted: reason.into() };
        let properties = FrameProperties::of(frame, &damping).map_err(|reason| unmet(format!("other: {reason}")))?;
        let law = law(&plan.contact, inputs)?;
        let hertz = if let ContactLaw::Hertz { stiffness, .. } = law { Some(stiffness) } else { None };
        let critical = properties.critical_on_impact(plan.struck, &Approach::of(striker, hertz));
        let time_step = inputs.positive_estimate("time_step", &plan.time_step, Dimension::TIME, Some(critical))?.value;
        let limit = properties.longest_stable_step(plan.integrator, Some(frame).filter(|_| session.reckoned()));
        if time_step > limit && !plan.allow_unstable {
            let wanted =
                format!("at most {}, the stability limit of `{}`", stated(limit, Dimension::TIME), plan.integrator.name());
            return Err(Stop::BadInput { field: "time_step", value: time_step, wanted: wanted.into() });
        }
        let duration = inputs.positive("duration", &plan.duration, Dimension::TIME)?;
        let pause = inputs.not_negative("pause", &plan.pause, Dimension::TIME)?;
        let largest_ratio = inputs.positive("max_tangent_ratio", &plan.max_tangent_ratio, Dimension::NUMBER)?;
        let steps = steps_in(duration, time_step);
        #[expect(clippy::cast_precision_loss, reason = "at most MOST_STOREYS")]
        let floors = frame.degrees_of_freedom() as f64;
        if steps * floors > MOST_STEPS {
            let wanted = format!("long enough for at most {} steps", MOST_STEPS / floors);
            return Err(Stop::BadInput { field: "time_step", value: time_step, wanted: wanted.into() });
        }
        let tangents = match storeys_of(&properties.matrices.stiffness) {
            Some(_) => Tangents::Storeys { largest_ratio },
            None => Tangents::Initial,
        };
        let noise = session.guard.declared_noise();
        let stiffness = frame.stiffness[plan.struck][plan.struck];
        let body = ImpactInput {
            mass: properties.struck_mass(plan.struck),
            damping: 0.0,
            stiffness,
            striker_mass: striker.mass,
            striker_velocity: striker.velocity,
            gap: striker.gap,
            gravity: striker.gravity,
            time_step,
            max_tangent_ratio: largest_ratio,
            law,
            integrator: plan.integrator,
            operator_stiffness: stiffness,
            i_modification: plan.i_modification,
            force_noise: noise.force,
            resolution: noise.resolution,
        };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 1 and MOST_STEPS")]
        let steps = steps as u64;
        let striker = striker.clone();
        Ok(Self { properties, tangents, law, striker, time_step, critical_time_step: critical, steps, pause, body })
    }
}
