//! An impact on one storey of a frame: the striker is computed, the frame is on the rig, an actuator and a load cell for each
//! floor. Each step: predict, command, settle, pause, read, feed back; or, continuous, the floors follow smooth paths together
//! (`gliding`) and are read as they pass their targets. In: a frame, a striker, a contact law, a time step.
//! Out: every step and what follows from them. The equations are `mechanics`'; this file only lets them meet the rig.

use super::Performed;
use super::axes::{Monitors, Told, report, together};
use super::gliding::{Gliding, Passing};
use super::impact::{law, remark};
use super::frame_doubts::FrameDoubts;
use super::inputs::Inputs;
use super::session::Session;
use super::stepping::{self, FrameSteps};
use super::stiffer::StifferStoreys;
use super::stop::Stop;
use super::storey_doubts;
use super::storey_summary::{StoreySummary, of_floor, results};
use super::triggers::Triggers;
use super::watch::Watch;
use crate::formula::NoResults;
use crate::mechanics::contact::ContactLaw;
use crate::mechanics::frame::impact::{FrameImpactInput, FrameImpactSolver, StrikerState};
use crate::mechanics::frame::{Damping, FrameInput, FrameState};
use crate::mechanics::frame_properties::{Approach, FrameProperties};
use crate::mechanics::impact::ImpactInput;
use crate::mechanics::monitor::Tracking;
use crate::mechanics::structure::Structure;
use crate::plan::{Contact, Frame, Mode, Plan, StoreyImpact, Striker, step_count};
use crate::quantity::Dimension;
use crate::record::{FloorStep, History, ImpactHistory, ImpactStep, StoreyImpactHistory};
use crate::rig::Reading;

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
        time_step: setting.map_or(0.0, |setting| setting.frame.time_step),
        critical_time_step: setting.map_or(0.0, |setting| setting.frame.critical_time_step),
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
                results: results(None, None, &history),
                history: History::StoreyImpact(history),
                stop: Some(stop),
            };
        }
    };
    history.modes = Some(setting.frame.properties.modes.clone());
    history.damping_ratios = setting.frame.properties.damping_ratios();
    let summary = StoreySummary::new(&setting.body, setting.frame.properties.matrices.order());
    let mut striking = Striking { setting: &setting, history, summary, watch: Watch::default() };
    let mut stop = striking.run(plan, session).err();
    let Striking { history, summary, watch, .. } = striking;
    let summary = (!history.floors.is_empty()).then_some(summary);
    if let (Some(summary), None) = (&summary, &stop) {
        remark(&summary.blow(), plan.until, session);
    }
    let mut results = results(summary.as_ref(), watch.worst, &history);
    if let (Some(frame), Some(summary), None) = (frame, &summary, &stop) {
        let doubts = FrameDoubts {
            whole,
            specimen: plan.specimen,
            frame,
            damping: &plan.damping,
            damping_uncertainty: plan.damping_uncertainty,
            stepping: &plan.stepping,
            results: inputs.results(),
            procedure: inputs.procedure(),
            noise: session.guard.declared_noise(),
        };
        let mut tick = |done, of| session.study(done, of);
        let found = storey_doubts::propagate(&doubts, plan, &setting, &history, &summary.blow(), &mut results, &mut tick);
        stop = session.told_of(found);
    }
    Performed { results, history: History::StoreyImpact(history), stop }
}

/// Where each floor is to pass in this step, and how fast.
fn foretold(solver: &mut FrameImpactSolver, unloaded: &[f64]) -> Vec<Passing> {
    let places = solver.predict(unloaded).to_vec();
    let mut velocities = vec![0.0; places.len()];
    let struck = solver.predicted_velocity(&mut velocities);
    places.into_iter().zip(velocities).map(|(place, velocity)| Passing { place, velocity, struck }).collect()
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
    let time_step = impact.stepping.time_step.evaluate(&NoResults, Some(critical)).ok()?.value;
    Some(step_count(impact.duration.constant()?, time_step))
}

/// Everything known before the first step.
pub(super) struct Setting {
    pub(super) frame: FrameSteps,
    pub(super) law: ContactLaw,
    pub(super) striker: Striker,
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
        let properties = stepping::properties(frame, &plan.damping, inputs)?;
        let law = law(&plan.contact, inputs)?;
        let hertz = if let ContactLaw::Hertz { stiffness, .. } = law { Some(stiffness) } else { None };
        let critical = properties.critical_on_impact(plan.struck, &Approach::of(striker, hertz));
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
        Ok(Self { frame: steps, law, striker: striker.clone(), body })
    }
}

struct Striking<'a> {
    setting: &'a Setting,
    history: StoreyImpactHistory,
    summary: StoreySummary,
    watch: Watch,
}

impl Striking<'_> {
    fn run(&mut self, plan: &StoreyImpact, session: &mut Session<'_>) -> Result<(), Stop> {
        let FrameSteps { properties, time_step, steps, pause, .. } = &self.setting.frame;
        let stepping = &plan.stepping;
        let mut triggers = Triggers::new(&stepping.inspect);
        // X starts where the actuators were sent to, and R₀ is read there once, before the first step.
        let start = session.guard.commanded().to_vec();
        let reading = session.guard.read()?;
        let unloaded = vec![0.0; properties.matrices.order()];
        let mut solver = self.solver(plan, &start, &reading, &unloaded)?;
        let mut monitors = Monitors::new(&start, &reading);
        let mut stiffer =
            StifferStoreys::new(&properties.matrices, stepping.integrator, *time_step, session.guard.declared_noise(), &reading);
        let mut gliding = match stepping.mode {
            Mode::Continuous { time_scale } => Some(Gliding::from_rest(&start, time_scale, *time_step)),
            Mode::StepAndPause => None,
        };
        let mut at_rest = solver.frame().clone();
        at_rest.measured_displacement.clone_from(&reading.displacement);
        self.take(&at_rest, solver.striker(), vec![Tracking::default(); start.len()], session);
        for _ in 1..=*steps {
            let reading = if let Some(gliding) = &mut gliding {
                gliding.step(|| foretold(&mut solver, &unloaded), session)?
            } else {
                session.guard.move_to(solver.predict(&unloaded), None)?;
                session.guard.pause(*pause)?;
                session.guard.read()?
            };
            if gliding.is_none() {
                stiffer.take(&reading, session);
            }
            solver.complete(&reading.displacement, &reading.force);
            let (state, striker) = (solver.frame(), solver.striker());
            let tracking = monitors.take(&state.target, &reading, solver.taken(&reading.force));
            let told = self.take(state, striker, tracking, session);
            self.watch.judge(told.tracking_energy_error, session);
            session.guard.check_energy_error(told.energy_error)?;
            session.guard.check_tracking(told.tracking_energy_error, told.tracking.nrms_error)?;
            session.step_done(&report(state, &told))?;
            let (step, time, base_shear) = (state.step, state.time, state.restoring_force.iter().sum());
            if solver.over(plan.until) {
                break;
            }
            if let Some(reason) = triggers.after(step, time, base_shear) {
                session.inspect(&reason)?;
            }
        }
        gliding.map_or(Ok(()), |gliding| gliding.brake(session))
    }

    fn solver(&self, plan: &StoreyImpact, start: &[f64], reading: &Reading, unloaded: &[f64]) -> Result<FrameImpactSolver, Stop> {
        let Setting { frame: FrameSteps { properties, tangents, time_step, .. }, law, striker, body } = self.setting;
        let input = FrameImpactInput {
            frame: FrameInput {
                matrices: &properties.matrices,
                operator_stiffness: &properties.matrices.stiffness,
                integrator: plan.stepping.integrator,
                i_modification: plan.stepping.i_modification,
                tangents: *tangents,
                time_step: *time_step,
                initial_displacement: start,
                initial_restoring_force: &reading.force,
                initial_load: unloaded,
                force_noise: body.force_noise,
                resolution: body.resolution,
            },
            struck: plan.struck,
            striker_mass: striker.mass,
            striker_velocity: striker.velocity,
            gap: striker.gap,
            gravity: striker.gravity,
            law: *law,
        };
        FrameImpactSolver::new(&input).map_err(|error| Stop::BadInput {
            field: "time_step",
            value: *time_step,
            wanted: format!("one that can be stepped: {error}").into(),
        })
    }

    /// Keeps a step; gives its errors over the energy of the striker.
    fn take(&mut self, state: &FrameState, striker: &StrikerState, axes: Vec<Tracking>, session: &Session<'_>) -> Told {
        let tracking = together(&axes);
        let floor = of_floor(state, striker, self.history.struck, self.setting.body.stiffness);
        self.summary.push(state, &floor);
        self.history.blow.steps.push(ImpactStep {
            step: floor.step,
            time: floor.time,
            wall_time: session.guard.time(),
            state: floor.state,
            command: floor.target,
            computed: floor.displacement,
            displacement: floor.measured_displacement,
            velocity: floor.velocity,
            acceleration: floor.acceleration,
            restoring_force: floor.restoring_force,
            contact_force: floor.contact_force,
            striker_displacement: floor.striker_displacement,
            striker_velocity: floor.striker_velocity,
            tangent_stiffness: floor.tangent_stiffness,
            indentation: floor.indentation,
            energies: floor.energies,
            tracking,
        });
        self.history.floors.push(FloorStep {
            time: state.time,
            command: state.target.clone(),
            displacement: state.measured_displacement.clone(),
            computed: state.displacement.clone(),
            velocity: state.velocity.clone(),
            acceleration: state.acceleration.clone(),
            restoring_force: state.restoring_force.clone(),
            storey_energy: self.summary.storey_energy().to_vec(),
            tracking: axes,
        });
        let input = self.setting.body.striker_energy();
        Told {
            energy_error: if floor.energies.error == 0.0 { 0.0 } else { floor.energies.error / input },
            tracking,
            tracking_energy_error: tracking.share_of(input),
        }
    }
}
