//! An impact on one storey of a frame: the striker is computed, the frame is on the rig, an actuator and a load cell for each
//! floor. In: a frame, a striker, a contact law, a time step, each held against what can be integrated. Out: every step and what
//! follows from them. The steps themselves are `impact_steps`'.

use super::run::{law, remark};
use super::steps::{ImpactSteps, Kept};
use super::summary::{FloorSummary, StruckSummary};
use crate::physics::contact::state::ContactLaw;
use crate::physics::impact::{FrameImpactSolver, ImpactInput, ImpactSetup};
use crate::physics::structure::frame_properties::FrameProperties;
use crate::plan::Structure;
use crate::plan::formula::ResultValue;
use crate::plan::{Frame, Plan, StoreyImpact, Striker};
use crate::procedures::impact;
use crate::procedures::results::result;
use crate::procedures::stepping;
use crate::procedures::stepping::frame_uncertainty::FrameUncertainty;
use crate::procedures::stepping::operator_stability_watch::StifferSprings;
use crate::procedures::stepping::run::FrameSteps;
use crate::procedures::stepping::start::not_stepped;
use crate::procedures::stepping::tracking_summary::Followed;
use crate::record::{FloorStep, History, ImpactHistory, ImpactStep, NamedResult, StruckFrame};
use crate::run::Performed;
use crate::run::inputs::Inputs;
use crate::run::session::{Session, of_base_shear};
use crate::run::stop::Stop;
use crate::units::Dimension;

pub(crate) fn perform(
    plan: &StoreyImpact,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    let striker = &whole.strikers[plan.striker];
    // `check` has seen that the specimen is a frame.
    let frame = whole.specimens[plan.specimen].frame.as_ref();
    let setting = frame
        .ok_or_else(Stop::no_frame)
        .and_then(|frame| Setting::evaluate(plan, frame, striker, inputs, session));
    match setting {
        Ok(setting) => {
            stepping::run::above_critical(
                setting.frame.time_step,
                setting.frame.critical_time_step,
                session,
            );
            let doubts = FrameUncertainty::of_blow(plan, whole, inputs, session);
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
        Err(stop) => {
            let history = history_of(plan, None, Vec::new(), Vec::new());
            Performed {
                results: results(None, &Followed::default(), &history),
                history: History::Impact(history),
                stop: Some(stop),
            }
        }
    }
}

/// One blow, as far as it went.
pub(crate) struct Blown {
    pub history: ImpactHistory,
    pub results: Vec<NamedResult>,
    pub stop: Option<Stop>,
}

/// The blow of a striker from where the floors are now; `before` steps of the procedure are done already.
pub(crate) fn blow(
    plan: &StoreyImpact,
    setting: &Setting,
    doubts: &FrameUncertainty<'_>,
    before: u64,
    session: &mut Session<'_>,
) -> Blown {
    let Setting { frame, body, .. } = setting;
    let matrices = &frame.properties.matrices;
    let unloaded = vec![0.0; matrices.order()];
    let mut kept = Kept::new(
        StruckSummary::of_frame(body, matrices.order(), of_base_shear(session)),
        frame.steps,
    );
    let order = ImpactSteps {
        stepping: &plan.stepping,
        pace: frame.pace(),
        until: plan.until,
        before,
    };
    let ran = order.run(&mut kept, session, |start| {
        let input = start.input(frame, &plan.stepping, &unloaded);
        let solver = FrameImpactSolver::on(
            &input,
            &ImpactSetup {
                struck: plan.struck,
                ..body.setup()
            },
        );
        let solver = solver.map_err(|error| not_stepped(frame.time_step, &error))?;
        Ok((
            solver,
            StifferSprings::of_storeys(matrices, &plan.stepping, frame.time_step, start),
        ))
    });
    let mut stop = ran.err();
    let Kept {
        steps,
        floors,
        summary,
        followed,
    } = kept;
    let summary = (!floors.is_empty()).then_some(summary);
    let history = history_of(plan, Some(setting), steps, floors);
    if let (Some(summary), None) = (&summary, &stop) {
        remark(&summary.impact(), plan.until, &setting.law, session);
    }
    let mut results = results(summary.as_ref(), &followed, &history);
    if let (Some(summary), None) = (&summary, &stop) {
        let recorded = history
            .frame
            .as_ref()
            .map_or(&[][..], |frame| &frame.floors);
        stop = session.evaluate_uncertainty(|tick| {
            super::storey_uncertainty::propagate(
                doubts,
                plan,
                setting,
                recorded,
                &summary.impact(),
                &mut results,
                tick,
            )
        });
    }
    Blown {
        history,
        results,
        stop,
    }
}

/// The steps done of a frame that is known before the first one, or is not.
fn history_of(
    plan: &StoreyImpact,
    setting: Option<&Setting>,
    steps: Vec<ImpactStep>,
    floors: Vec<FloorStep>,
) -> ImpactHistory {
    let properties = setting.map(|setting| &setting.frame.properties);
    let frame = StruckFrame {
        struck: plan.struck,
        floors,
        modes: properties.map(|properties| properties.modes.clone()),
        damping_ratios: properties
            .map(FrameProperties::damping_ratios)
            .unwrap_or_default(),
    };
    ImpactHistory {
        steps,
        frame: Some(frame),
        time_step: setting.map_or(0.0, |setting| setting.frame.time_step),
        critical_time_step: setting.map_or(0.0, |setting| setting.frame.critical_time_step),
    }
}

/// Everything known before the first step.
pub(crate) struct Setting {
    pub(crate) frame: FrameSteps,
    pub(crate) law: ContactLaw,
    pub(crate) striker: Striker,
    /// The struck floor and the striker as an impact on one degree of freedom has them.
    pub(crate) body: ImpactInput,
    /// Of the blow that the critical time step was found for, m/s.
    pub(crate) fastest: f64,
}

impl Setting {
    pub(crate) fn evaluate(
        plan: &StoreyImpact,
        frame: &Frame,
        striker: &Striker,
        inputs: &mut Inputs<'_>,
        session: &Session<'_>,
    ) -> Result<Self, Stop> {
        let properties = stepping::run::properties(frame, &plan.damping, inputs)?;
        let law = law(&plan.contact, inputs)?;
        let critical =
            properties.critical_on_impact(plan.struck, &striker.approach(law.stiffness()));
        let time_step = stepping::run::time_step(
            &plan.stepping,
            (frame, &properties),
            critical,
            inputs,
            session,
        )?;
        let duration = inputs.positive("duration", &plan.duration, Dimension::TIME)?;
        let steps = FrameSteps::new(
            properties,
            &plan.stepping,
            (time_step, critical, duration),
            inputs,
        )?;
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
        Ok(Self {
            frame: steps,
            law,
            striker: striker.clone(),
            body,
            fastest: striker.velocity,
        })
    }

    /// The same with a striker of another velocity, m/s.
    pub(crate) const fn strikes_at(&mut self, velocity: f64) {
        self.striker.velocity = velocity;
        self.body.striker_velocity = velocity;
    }
}

/// In the order of the reference; every number is missing if not even the start was read.
fn results(
    summary: Option<&StruckSummary>,
    followed: &Followed,
    history: &ImpactHistory,
) -> Vec<NamedResult> {
    let list = |name, dimension, values: Option<&[f64]>| match values {
        Some(values) => NamedResult {
            name,
            dimension,
            value: ResultValue::List(values.to_vec()),
            contributions: Vec::new(),
        },
        None => result(name, dimension, None),
    };
    let floors = summary.and_then(StruckSummary::floors);
    let modes = history
        .frame
        .as_ref()
        .and_then(|frame| frame.modes.as_ref());
    let impact = summary.map(StruckSummary::impact);
    let mut results = impact::run::results(impact.as_ref(), followed.worst(), history);
    results.extend([
        result(
            "contact_duration",
            Dimension::TIME,
            floors.and_then(FloorSummary::contact_duration),
        ),
        result(
            "rebound_velocity",
            Dimension::VELOCITY,
            floors.and_then(FloorSummary::rebound_velocity),
        ),
        list(
            "floor_displacement",
            Dimension::LENGTH,
            floors.map(|floors| floors.floor_displacement.as_slice()),
        ),
        list(
            "max_drift",
            Dimension::LENGTH,
            floors.map(|floors| floors.max_drift.as_slice()),
        ),
        list(
            "final_drift",
            Dimension::LENGTH,
            floors.map(|floors| floors.drift.as_slice()),
        ),
        list(
            "storey_energy",
            Dimension::ENERGY,
            floors.map(FloorSummary::storey_energy),
        ),
        result(
            "max_base_shear",
            Dimension::FORCE,
            floors.and_then(FloorSummary::max_base_shear),
        ),
        list(
            "periods",
            Dimension::TIME,
            modes.map(|modes| modes.periods.as_slice()),
        ),
    ]);
    results.extend(followed.of_each());
    results
}
