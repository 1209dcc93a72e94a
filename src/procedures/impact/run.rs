//! `impact` (Melo et al. 2006, sec. 5 steps 3–8, eqs. 2–7): the striker is computed, the structure is on the rig, one degree of freedom
//! or a frame with an actuator and a load cell for each floor. Each step: predict, command, settle, pause, read, feed back. In: an
//! impact of the plan. Out: every step, and the results that follow from them. The equations are in `physics`; this file only connects
//! them with the rig.

#![allow(
    clippy::inline_always,
    reason = "a part of the loop over the steps, which computes what its parts read"
)]

use super::results::{observe, results};
use super::setting::{Setting, StruckStructure};
use super::summary::StruckSummary;
use super::uncertainty::{RecordedRun, UncertaintyInputs};
use crate::procedures::frame::results::{drifted_to, observe_drift};
use crate::procedures::stepping::end_of_step::{AxesState, Balance, EndOfStep};
use crate::procedures::stepping::ideal_run::IdealRun;
use crate::procedures::stepping::operator_stability_watch::StifferSprings;
use crate::procedures::stepping::setting::{FrameSteps, Start, above_critical, not_stepped};
use crate::procedures::stepping::step_loop::{self, Stepped};
use crate::procedures::stepping::tracking::TrackingSummary;
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::run::stop::Stop;
use crate::run::{Keep, Performed};
use psd_physics::impact::summary::ImpactEnding;
use psd_physics::impact::{
    Caller, FrameImpactSolver, ImpactInput, ImpactSetup, ImpactSolver, ImpactState, steps_in_one_go,
};
use psd_physics::integrator::state::State;
use psd_physics::integrator::tangents::HasTangents;
use psd_physics::structure::elements::ElementReading;
use psd_physics::structure::frame_properties::FrameProperties;
use psd_physics::structure::matrix::copy;
use psd_physics::tracking::monitor::Tracking;
use psd_plan::record::{
    CollectedSteps, FloorMotion, FloorStep, History, ImpactConstants, ImpactHistory, ImpactStep,
    ImpactSteps, NamedResult, StillGrowing, StruckFrame,
};
use psd_plan::{Impact, ImpactTarget, Plan, StoreyTarget, Until};
use psd_rig::Reading;

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
            let history = history_of(plan, None, ImpactSteps::default(), Vec::new());
            return Performed {
                results: results(None, &TrackingSummary::default(), &history),
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
        Some(frame) => StruckSummary::of_frame(
            input,
            frame.order(),
            session.base_shear_noise(),
            &session.element_noise(),
        ),
    };
    let kept = match session.keep {
        Keep::Results => 0,
        Keep::Everything | Keep::Steps => setting.steps().count,
    };
    let constants = ImpactConstants {
        time_step: input.time_step,
        mass: input.mass,
        striker_mass: input.striker_mass,
    };
    let mut so_far = ImpactSoFar::new(summary, kept, constants);
    let ran = match (&plan.target, &setting.structure) {
        (ImpactTarget::Storey(target), StruckStructure::Storey(frame)) => {
            take_steps(plan, setting, before, &mut so_far, session, |start| {
                on_storey(plan, target, setting, frame, start)
            })
        }
        _ => take_steps(plan, setting, before, &mut so_far, session, |start| {
            on_point(plan, setting, start)
        }),
    };
    let mut stop = ran.err();
    let ImpactSoFar {
        steps,
        floors,
        summary,
        tracking,
    } = so_far;
    let summary = (!steps.is_empty()).then_some(summary);
    let mut history = history_of(plan, Some(setting), steps.finish(), floors);
    let impact = summary.as_ref().map(StruckSummary::impact);
    if let Some((summary, impact)) = summary.as_ref().zip(impact) {
        history.ending = summary.ending(&impact, &history);
        summary.growing(&mut history);
    }
    if let (Some(impact), None) = (&impact, &stop) {
        observe(impact, plan.until, &input.law, session);
        let floors = summary.as_ref().and_then(StruckSummary::floors);
        if let (Until::Drift(limit), Some(floors)) = (plan.until, floors)
            && let Some(member) = drifted_to(&floors.drift, limit)
        {
            observe_drift(member, limit, session);
        }
    }
    let mut results = results(summary.as_ref(), &tracking, &history);
    if let (Some(summary), None) = (impact, &stop) {
        let substructures = session.substructures_at_start();
        let recorded = RecordedRun {
            setting,
            history: &history,
            summary: &summary,
            substructures: substructures.as_ref(),
        };
        stop = session.evaluate_uncertainty(&mut results, |results, progress| {
            uncertainty.propagate(plan, recorded, results, progress)
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
    let stiffer = StifferSprings::of_storeys(&frame.properties, &plan.stepping, time_step, start);
    Ok((solver, stiffer))
}

/// The steps done; without a setting, no step was.
fn history_of(
    plan: &Impact,
    setting: Option<&Setting>,
    steps: ImpactSteps,
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
        growing: StillGrowing::default(),
    });
    let planned = setting.map(Setting::steps);
    ImpactHistory {
        steps,
        ending: ImpactEnding::default(),
        frame,
        time_step: planned.map_or(0.0, |planned| planned.time_step),
        critical_time_step: planned.map_or(0.0, |planned| planned.critical_time_step),
    }
}

/// The record of an impact in progress.
struct ImpactSoFar {
    /// The struck degree of freedom and the striker.
    steps: CollectedSteps,
    /// Every floor of a frame.
    floors: Vec<FloorStep>,
    summary: StruckSummary,
    tracking: TrackingSummary,
}

impl ImpactSoFar {
    /// Before the first step, of which `steps` are kept. Capacity is reserved for at most 100,000 of them: `duration` is often far beyond the end.
    fn new(summary: StruckSummary, steps: u64, constants: ImpactConstants) -> Self {
        let capacity = usize::try_from(steps + 1)
            .unwrap_or(usize::MAX)
            .min(100_000);
        Self {
            steps: CollectedSteps::with_capacity(capacity, constants),
            floors: Vec::new(),
            summary,
            tracking: TrackingSummary::default(),
        }
    }
}

/// All steps, with the solver that `begin` makes from the present position of the rig; `before` steps of the procedure are done already.
fn take_steps<V: HasTangents>(
    plan: &Impact,
    setting: &Setting,
    before: u64,
    so_far: &mut ImpactSoFar,
    session: &mut Session<'_>,
    begin: impl FnOnce(&Start) -> Result<(ImpactSolver<V>, StifferSprings), Stop>,
) -> Result<(), Stop> {
    let ImpactSoFar {
        steps,
        floors,
        summary,
        tracking,
    } = so_far;
    let until = plan.until;
    step_loop::run(
        setting.steps(),
        &plan.stepping,
        tracking,
        session,
        |start| {
            let (mut solver, stiffer) = begin(start)?;
            solver.measured_at_start(V::view_of(&start.reading.displacement));
            Ok((
                Struck {
                    solver,
                    input: &setting.input,
                    until,
                    kept: Kept {
                        before,
                        steps,
                        floors,
                        summary,
                    },
                },
                stiffer,
            ))
        },
    )
}

/// The structure in motion, with its striker.
struct Struck<'a, V: HasTangents> {
    solver: ImpactSolver<V>,
    input: &'a ImpactInput,
    until: Until,
    kept: Kept<'a>,
}

/// The steps of the structure and the striker so far.
struct Kept<'a> {
    before: u64,
    steps: &'a mut CollectedSteps,
    floors: &'a mut Vec<FloorStep>,
    summary: &'a mut StruckSummary,
}

/// The end of a step.
struct EndOfImpactStep<'a, 'kept, V> {
    structure: &'a State<V>,
    state: &'a ImpactState,
    kept: &'a mut Kept<'kept>,
}

impl<V: HasTangents> EndOfStep for EndOfImpactStep<'_, '_, V> {
    #[inline(always)]
    fn axes(&self) -> AxesState<'_> {
        AxesState::of(self.structure)
    }

    #[inline(always)]
    fn sum_up(&mut self) -> Balance {
        self.kept.summary.push(self.structure, self.state);
        Balance {
            error: self.state.energies.error,
            input: self.state.input,
        }
    }

    #[inline(always)]
    fn keep(&mut self, axes: &[Tracking], wall_time: f64) {
        let Self {
            structure,
            state,
            kept,
        } = self;
        kept.steps.push(&ImpactStep {
            step: state.step,
            time: state.time,
            wall_time,
            state: state.state,
            command: state.target,
            computed: state.displacement,
            displacement: state.measured_displacement,
            velocity: state.velocity,
            acceleration: state.acceleration,
            restoring_force: state.restoring_force,
            contact_force: state.contact_force,
            striker_displacement: state.striker_displacement,
            striker_velocity: state.striker_velocity,
            tangent_stiffness: state.tangent_stiffness,
            indentation: state.indentation,
            energies: state.energies,
            tracking: Tracking::together(axes),
        });
        if let Some(floors) = kept.summary.floors() {
            kept.floors.push(FloorStep {
                floors: FloorMotion::of_state(*structure, axes),
                storey_energy: floors.storey_energy().to_vec(),
            });
        }
    }

    #[inline(always)]
    fn is_struck(&self) -> bool {
        self.state.contact_force > 0.0
    }

    #[inline(always)]
    fn before(&self) -> u64 {
        self.kept.before
    }
}

/// Reads on an ideal rig, and ends the steps there.
struct IdealCaller<'a, 'kept, 'run, 'rig> {
    kept: &'a mut Kept<'kept>,
    run: &'a mut IdealRun<'run, 'rig>,
}

impl Caller for IdealCaller<'_, '_, '_, '_> {
    #[inline(always)]
    fn read(&mut self, [target, _]: [f64; 2]) -> Option<[f64; 2]> {
        self.run.target()[0] = target;
        let Reading {
            displacement,
            force,
            ..
        } = self.run.read()?;
        Some([displacement[0], force[0]])
    }

    #[inline(always)]
    fn end(&mut self, structure: &State<f64>, state: &ImpactState, _: bool) -> bool {
        self.run.end(&mut EndOfImpactStep {
            structure,
            state,
            kept: self.kept,
        })
    }
}

impl<'a, V: HasTangents> Struck<'a, V> {
    fn end(&mut self) -> EndOfImpactStep<'_, 'a, V> {
        EndOfImpactStep {
            structure: self.solver.structure(),
            state: self.solver.state(),
            kept: &mut self.kept,
        }
    }
}

impl<V: HasTangents> EndOfStep for Struck<'_, V> {
    fn axes(&self) -> AxesState<'_> {
        AxesState::of(self.solver.structure())
    }

    fn sum_up(&mut self) -> Balance {
        self.end().sum_up()
    }

    fn keep(&mut self, axes: &[Tracking], wall_time: f64) {
        self.end().keep(axes, wall_time);
    }

    fn is_struck(&self) -> bool {
        self.solver.state().contact_force > 0.0
    }

    fn before(&self) -> u64 {
        self.kept.before
    }
}

impl<V: HasTangents> Stepped for Struck<'_, V> {
    fn predict(&mut self, target: &mut [f64]) {
        copy(V::slice_of(&self.solver.predict()), target);
    }

    fn predicted_velocity(&mut self, velocity: &mut [f64]) -> bool {
        self.solver.predicted_velocity(velocity)
    }

    fn effective_force_at_start(&self, start: &Start) -> Vec<f64> {
        let Reading {
            displacement,
            force,
            ..
        } = &start.reading;
        let effective_force = self.solver.effective_force_at(
            V::view_of(&start.commanded),
            V::view_of(displacement),
            V::view_of(force),
        );
        effective_force.as_slice().to_vec()
    }

    fn effective_force(&self, force: &mut [f64]) {
        force.copy_from_slice(V::slice_of(&self.solver.effective_force()));
    }

    fn read_elements(&mut self, elements: &[ElementReading]) {
        self.solver.read_elements(elements);
    }

    fn complete(&mut self, reading: &Reading) {
        self.solver.complete(
            V::view_of(&reading.displacement),
            V::view_of(&reading.force),
        );
    }

    fn in_one_go(&mut self, count: u64, run: &mut IdealRun<'_, '_>) -> bool {
        let Self {
            solver,
            input,
            until,
            kept,
        } = self;
        let Some(solver) = solver.of_one_degree() else {
            return false;
        };
        let mut caller = IdealCaller { kept, run };
        let Some((structure, state)) =
            steps_in_one_go(input, solver, Some(*until), count, &mut caller)
        else {
            return false;
        };
        run.keep_last(&mut EndOfImpactStep {
            structure: &structure,
            state: &state,
            kept,
        });
        true
    }

    fn cut_off(&mut self, target: &[f64], reading: &Reading, time_step: f64, wall_time: f64) {
        let struck = self.solver.struck();
        let Some(last) = self.kept.steps.last() else {
            return;
        };
        let time = last.time + time_step;
        let step = ImpactStep {
            step: last.step + 1,
            time,
            wall_time,
            command: target[struck],
            computed: reading.displacement[struck],
            displacement: reading.displacement[struck],
            restoring_force: reading.force[struck],
            ..last
        };
        self.kept.steps.push(&step);
        let gravity_force = self.solver.gravity_force(V::view_of(&reading.displacement));
        let elements = &self.solver.structure().elements;
        self.kept
            .summary
            .moved_to(struck, reading, elements, &gravity_force, time);
        if let Some(last) = self.kept.floors.last() {
            let floors = last.floors.cut_off(
                time,
                target,
                &reading.displacement,
                &reading.force,
                gravity_force,
                elements,
            );
            let storey_energy = last.storey_energy.clone();
            self.kept.floors.push(FloorStep {
                floors,
                storey_energy,
            });
        }
    }

    fn over(&self) -> bool {
        self.solver.over(self.until)
    }
}
