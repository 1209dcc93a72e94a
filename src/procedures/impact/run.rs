//! `impact` (Melo et al. 2006, sec. 5 steps 3–8, eqs. 2–7): the striker is computed, the structure is on the rig, one degree of freedom
//! or a frame with an actuator and a load cell for each floor. Each step: predict, command, settle, pause, read, feed back. In: an
//! impact of the plan. Out: every step, and the results that follow from them. The equations are in `physics`; this file only connects
//! them with the rig.

use super::results::{observe, results};
use super::setting::{Setting, StruckStructure};
use super::steps::{ImpactSteps, Kept};
use super::summary::StruckSummary;
use super::uncertainty::ImpactUncertainty;
use super::uncertainty::storey::{self, StoreyRecord};
use crate::physics::impact::{FrameImpactSolver, ImpactSetup, ImpactSolver};
use crate::physics::structure::frame_properties::FrameProperties;
use crate::plan::{Impact, ImpactTarget, Plan, StoreyTarget};
use crate::procedures::common::perturbed_inputs::UncertainRun;
use crate::procedures::stepping::frame_uncertainty::FrameUncertainty;
use crate::procedures::stepping::operator_stability_watch::StifferSprings;
use crate::procedures::stepping::run::{FrameSteps, above_critical};
use crate::procedures::stepping::start::{Start, not_stepped};
use crate::procedures::stepping::tracking::tracking_summary::Followed;
use crate::record::{FloorStep, History, ImpactHistory, ImpactStep, NamedResult, StruckFrame};
use crate::run::Performed;
use crate::run::inputs::Inputs;
use crate::run::session::{Session, of_base_shear};
use crate::run::stop::Stop;

pub(crate) fn perform(
    plan: &Impact,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    let striker = &whole.strikers[plan.striker];
    let setting = match Setting::evaluate(plan, whole, striker, inputs, session) {
        Ok(setting) => setting,
        Err(stop) => {
            let history = history_of(plan, None, Vec::new(), Vec::new());
            return Performed {
                results: results(None, &Followed::default(), &history),
                history: History::Impact(history),
                stop: Some(stop),
            };
        }
    };
    above_critical(setting.steps(), session);
    let uncertainty = UncertaintyInputs::new(plan, whole, inputs, session);
    let ImpactRun {
        history,
        results,
        stop,
    } = strike(plan, &setting, &uncertainty, 0, session);
    Performed {
        results,
        history: History::Impact(history),
        stop,
    }
}

/// The uncertain inputs of an impact.
#[derive(Clone, Copy)]
pub(crate) enum UncertaintyInputs<'a> {
    Point(ImpactUncertainty<'a>),
    Storey(FrameUncertainty<'a>),
}

impl<'a> UncertaintyInputs<'a> {
    pub(crate) fn new(
        plan: &'a Impact,
        whole: &'a Plan,
        inputs: &Inputs<'a>,
        session: &Session<'_>,
    ) -> Self {
        let run = UncertainRun::new(whole, inputs, session.guard.declared_noise());
        match &plan.target {
            ImpactTarget::Point(point) => Self::Point(ImpactUncertainty { run, plan, point }),
            ImpactTarget::Storey(storey) => Self::Storey(FrameUncertainty::new(
                run,
                plan.specimen,
                &storey.damping,
                storey.damping_uncertainty,
                &plan.stepping,
            )),
        }
    }

    /// Those of impact number `index` of a series, from 0.
    pub(crate) fn of_impact(mut self, index: usize) -> Self {
        let run = match &mut self {
            Self::Point(ImpactUncertainty { run, .. })
            | Self::Storey(FrameUncertainty { run, .. }) => run,
        };
        *run = run.of_impact(index);
        self
    }
}

/// One impact, as far as it went.
pub(crate) struct ImpactRun {
    pub history: ImpactHistory,
    pub results: Vec<NamedResult>,
    pub stop: Option<Stop>,
}

/// The impact of a striker from the present position of the rig; `before` steps of the procedure are done already.
pub(crate) fn strike(
    plan: &Impact,
    setting: &Setting,
    uncertainty: &UncertaintyInputs<'_>,
    before: u64,
    session: &mut Session<'_>,
) -> ImpactRun {
    let Setting { input, .. } = setting;
    let summary = match setting.frame() {
        None => StruckSummary::new(input),
        Some(frame) => StruckSummary::of_frame(input, frame.order(), of_base_shear(session)),
    };
    let mut kept = Kept::new(summary, setting.steps().count);
    let order = ImpactSteps {
        stepping: &plan.stepping,
        steps: setting.steps(),
        until: plan.until,
        before,
    };
    let ran = match (&plan.target, &setting.structure) {
        (ImpactTarget::Storey(target), StruckStructure::Storey(frame)) => {
            order.run(&mut kept, session, |start| {
                on_storey(plan, target, setting, frame, start)
            })
        }
        _ => order.run(&mut kept, session, |start| on_point(plan, setting, start)),
    };
    let mut stop = ran.err();
    let Kept {
        steps,
        floors,
        summary,
        followed,
    } = kept;
    let summary = (!steps.is_empty()).then_some(summary);
    let history = history_of(plan, Some(setting), steps, floors);
    if let (Some(summary), None) = (&summary, &stop) {
        observe(&summary.impact(), plan.until, &input.law, session);
    }
    let mut results = results(summary.as_ref(), &followed, &history);
    if let (Some(summary), None) = (&summary, &stop) {
        let summary = summary.impact();
        stop = session.evaluate_uncertainty(&mut results, |results, progress| {
            match (uncertainty, &history.frame) {
                (UncertaintyInputs::Storey(storey), Some(frame)) => storey::propagate(
                    storey,
                    plan,
                    StoreyRecord {
                        setting,
                        floors: &frame.floors,
                        summary: &summary,
                    },
                    results,
                    progress,
                ),
                (UncertaintyInputs::Point(point), _) => {
                    point.propagate(setting, &history.steps, &summary, results, progress)
                }
                (UncertaintyInputs::Storey(_), None) => Ok(()),
            }
        });
    }
    ImpactRun {
        history,
        results,
        stop,
    }
}

fn on_point(
    plan: &Impact,
    setting: &Setting,
    start: &Start,
) -> Result<(ImpactSolver<f64>, StifferSprings), Stop> {
    let input = &setting.input;
    let solver = ImpactSolver::new(input, start.commanded[0], start.reading.force[0])
        .map_err(|error| not_stepped(input.time_step, &error))?;
    Ok((
        solver,
        StifferSprings::of_specimen(input, &plan.stepping, start),
    ))
}

fn on_storey(
    plan: &Impact,
    target: &StoreyTarget,
    setting: &Setting,
    frame: &FrameSteps,
    start: &Start,
) -> Result<(FrameImpactSolver, StifferSprings), Stop> {
    let unloaded = vec![0.0; frame.order()];
    let input = start.input(frame, &plan.stepping, &unloaded);
    let setup = ImpactSetup {
        struck: target.storey,
        ..setting.input.setup()
    };
    let time_step = frame.steps.time_step;
    let solver =
        FrameImpactSolver::on(&input, &setup).map_err(|error| not_stepped(time_step, &error))?;
    let matrices = &frame.properties.matrices;
    Ok((
        solver,
        StifferSprings::of_storeys(matrices, &plan.stepping, time_step, start),
    ))
}

/// The steps done; without a setting, no step was.
fn history_of(
    plan: &Impact,
    setting: Option<&Setting>,
    steps: Vec<ImpactStep>,
    floors: Vec<FloorStep>,
) -> ImpactHistory {
    let properties = setting
        .and_then(Setting::frame)
        .map(|frame| &frame.properties);
    let frame = plan.storey().map(|target| StruckFrame {
        struck: target.storey,
        floors,
        modes: properties.map(|properties| properties.modes.clone()),
        damping_ratios: properties
            .map(FrameProperties::damping_ratios)
            .unwrap_or_default(),
    });
    let planned = setting.map(Setting::steps);
    ImpactHistory {
        steps,
        frame,
        time_step: planned.map_or(0.0, |planned| planned.time_step),
        critical_time_step: planned.map_or(0.0, |planned| planned.critical_time_step),
    }
}
