//! A frame as a striker hits one of its floors: the striker beside the floors, and every step kept. In: what is known before the
//! first step. Out: the history and what it comes to. How the steps are gone on the rig is `frame_steps`'; the equations are
//! `mechanics`'.

use super::followed::Followed;
use super::frame_steps::{self, Balance, Stepped, not_stepped};
use super::session::Session;
use super::stop::Stop;
use super::storey_impact::Setting;
use super::storey_summary::{StoreySummary, of_floor};
use crate::mechanics::frame::FrameState;
use crate::mechanics::frame::impact::{FrameImpactInput, FrameImpactSolver};
use crate::mechanics::monitor::Tracking;
use crate::plan::{StoreyImpact, Until};
use crate::record::{FloorStep, ImpactStep, StoreyImpactHistory};
use crate::rig::Reading;

pub(super) struct Striking<'a> {
    pub(super) setting: &'a Setting,
    /// Steps of the procedure done before these.
    pub(super) before: u64,
    pub(super) history: StoreyImpactHistory,
    pub(super) summary: StoreySummary,
    pub(super) followed: Followed,
}

impl Striking<'_> {
    pub(super) fn run(&mut self, plan: &StoreyImpact, session: &mut Session<'_>) -> Result<(), Stop> {
        let Self { setting, before, history, summary, followed } = self;
        let unloaded = vec![0.0; setting.frame.properties.matrices.order()];
        frame_steps::run((&setting.frame, &plan.stepping), followed, session, |start| {
            let input = FrameImpactInput {
                frame: start.input(&setting.frame, &plan.stepping, &unloaded),
                struck: plan.struck,
                striker_mass: setting.striker.mass,
                striker_velocity: setting.striker.velocity,
                gap: setting.striker.gap,
                gravity: setting.striker.gravity,
                law: setting.law,
            };
            let solver = FrameImpactSolver::new(&input).map_err(|error| not_stepped(input.frame.time_step, &error))?;
            Ok(Struck { setting, before: *before, until: plan.until, solver, unloaded: &unloaded, history, summary })
        })
    }
}

/// The frame under way, with its striker.
struct Struck<'a> {
    setting: &'a Setting,
    before: u64,
    until: Until,
    solver: FrameImpactSolver,
    /// N
    unloaded: &'a [f64],
    history: &'a mut StoreyImpactHistory,
    summary: &'a mut StoreySummary,
}

impl Stepped for Struck<'_> {
    fn frame(&self) -> &FrameState {
        self.solver.frame()
    }

    fn predict(&mut self) -> &[f64] {
        self.solver.predict(self.unloaded)
    }

    fn predicted_velocity(&self, velocity: &mut [f64]) -> bool {
        self.solver.predicted_velocity(velocity)
    }

    fn taken<'a>(&'a self, read: &'a [f64]) -> &'a [f64] {
        self.solver.taken(read)
    }

    fn complete(&mut self, reading: &Reading) {
        self.solver.complete(&reading.displacement, &reading.force);
    }

    fn keep(&mut self, state: &FrameState, axes: &[Tracking], session: &Session<'_>) -> Balance {
        let floor = of_floor(state, self.solver.striker(), self.history.struck, self.setting.body.stiffness);
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
            tracking: Tracking::together(axes),
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
            tracking: axes.to_vec(),
        });
        Balance { error: floor.energies.error, input: floor.input }
    }

    fn is_struck(&self) -> bool {
        self.solver.striker().contact_force > 0.0
    }

    fn before(&self) -> u64 {
        self.before
    }

    fn over(&self) -> bool {
        self.solver.over(self.until)
    }
}
