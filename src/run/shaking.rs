//! The steps of a frame on moving ground. Step and pause: predict, command, settle, pause, read, feed back. Continuous: the
//! storeys follow smooth paths together (`gliding`), are read as they pass their targets, and the forces are corrected to them. In:
//! what is known before the first step, the rig behind its guard. Out: every step as it ended. The equations are
//! `mechanics`'; this file only lets them meet the rig.

use super::axes::{Monitors, Told, report, together};
use super::gliding::{Gliding, Passing};
use super::session::Session;
use super::shake::Setting;
use super::shake_results::ShakeSummary;
use super::stepping::FrameSteps;
use super::stiffer::StifferStoreys;
use super::stop::Stop;
use super::triggers::Triggers;
use super::watch::Watch;
use crate::mechanics::frame::{FrameInput, FrameSolver, FrameState};
use crate::mechanics::ground::acceleration_at;
use crate::mechanics::monitor::Tracking;
use crate::plan::{Ground, Mode, Shake};
use crate::record::{ShakeHistory, ShakeStep};

pub(super) struct Shaking<'a> {
    pub(super) setting: &'a Setting,
    pub(super) history: ShakeHistory,
    pub(super) summary: ShakeSummary,
    pub(super) watch: Watch,
}

impl Shaking<'_> {
    pub(super) fn run(&mut self, plan: &Shake, ground: &Ground, session: &mut Session<'_>) -> Result<(), Stop> {
        let Setting { frame: FrameSteps { properties, tangents, time_step, steps, pause, .. }, scale, .. } = self.setting;
        let stepping = &plan.stepping;
        let matrices = &properties.matrices;
        let ground_at = |time| scale * acceleration_at(&ground.times, &ground.accelerations, time);
        let mut triggers = Triggers::new(&stepping.inspect);
        // X starts where the actuators were sent to, and R₀ is read there once, before the first step.
        let start = session.guard.commanded().to_vec();
        let reading = session.guard.read()?;
        let mut load = vec![0.0; matrices.order()];
        matrices.ground_load(ground_at(0.0), &mut load);
        let noise = session.guard.declared_noise();
        let solver = FrameSolver::new(&FrameInput {
            matrices,
            operator_stiffness: &matrices.stiffness,
            integrator: stepping.integrator,
            i_modification: stepping.i_modification,
            tangents: *tangents,
            time_step: *time_step,
            initial_displacement: &start,
            initial_restoring_force: &reading.force,
            initial_load: &load,
            force_noise: noise.force,
            resolution: noise.resolution,
        });
        let mut solver = solver.map_err(|error| Stop::BadInput {
            field: "time_step",
            value: *time_step,
            wanted: format!("one that can be stepped: {error}").into(),
        })?;
        let mut monitors = Monitors::new(&start, &reading);
        let mut at_rest = solver.state().clone();
        at_rest.measured_displacement.clone_from(&reading.displacement);
        self.take(&at_rest, ground_at(0.0), Tracking::default(), session);
        let mut stiffer =
            StifferStoreys::new(matrices, stepping.integrator, *time_step, session.guard.declared_noise(), &reading);
        let mut gliding = match stepping.mode {
            Mode::Continuous { time_scale } => Some(Gliding::from_rest(&start, time_scale, *time_step)),
            Mode::StepAndPause => None,
        };
        for step in 1..=*steps {
            #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
            let acceleration = ground_at(step as f64 * time_step);
            matrices.ground_load(acceleration, &mut load);
            let reading = if let Some(gliding) = &mut gliding {
                gliding.step(|| foretold(&mut solver, &load), session)?
            } else {
                session.guard.move_to(solver.predict(&load), None)?;
                session.guard.pause(*pause)?;
                session.guard.read()?
            };
            if gliding.is_none() {
                stiffer.take(&reading, session);
            }
            solver.complete(&reading.displacement, &reading.force);
            let state = solver.state();
            let tracking = together(&monitors.take(&state.target, &reading, solver.taken(&reading.force)));
            let told = self.take(state, acceleration, tracking, session);
            self.watch.judge(told.tracking_energy_error, session);
            session.guard.check_energy_error(told.energy_error)?;
            session.guard.check_tracking(told.tracking_energy_error, tracking.nrms_error)?;
            session.step_done(&report(state, &told))?;
            let base_shear = state.restoring_force.iter().sum();
            if let Some(reason) = triggers.after(state.step, state.time, base_shear) {
                session.inspect(&reason)?;
            }
        }
        gliding.map_or(Ok(()), |gliding| gliding.brake(session))
    }

    /// Keeps a step; gives its errors over the energy of the test.
    fn take(&mut self, state: &FrameState, ground_acceleration: f64, tracking: Tracking, session: &Session<'_>) -> Told {
        self.history.steps.push(ShakeStep {
            step: state.step,
            time: state.time,
            wall_time: session.guard.time(),
            ground_acceleration,
            command: state.target.clone(),
            displacement: state.measured_displacement.clone(),
            computed: state.displacement.clone(),
            velocity: state.velocity.clone(),
            acceleration: state.acceleration.clone(),
            restoring_force: state.restoring_force.clone(),
            energies: state.energies,
            tracking,
        });
        self.summary.push(state);
        // An input that begins with nothing divides nothing: until it is larger, what the ground can put in counts.
        let energy = self.summary.largest_energy().max(self.setting.ground_energy);
        Told {
            energy_error: if state.energies.error == 0.0 { 0.0 } else { state.energies.error / energy },
            tracking,
            tracking_energy_error: tracking.share_of(energy),
        }
    }
}

/// Where each floor is to pass in this step, and how fast.
fn foretold(solver: &mut FrameSolver, load: &[f64]) -> Vec<Passing> {
    let places = solver.predict(load).to_vec();
    let mut velocities = vec![0.0; places.len()];
    solver.predicted_velocity(&mut velocities);
    let passing = |(place, velocity)| Passing { place, velocity, struck: false };
    places.into_iter().zip(velocities).map(passing).collect()
}
