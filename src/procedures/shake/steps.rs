//! The steps of a frame on moving ground: the ground as a load, and every step kept. In: the setting before the first step. Out: the
//! history and its summary. `step_loop` takes the steps on the rig; the equations are in `physics`.

use super::results::ShakeSummary;
use super::setting::Setting;
use crate::procedures::frame::results::drifted_to;
use crate::procedures::stepping::end_of_step::{AxesState, Balance, EndOfStep};
use crate::procedures::stepping::operator_stability_watch::StifferSprings;
use crate::procedures::stepping::setting::{Start, not_stepped};
use crate::procedures::stepping::step_loop::{self, Stepped};
use crate::procedures::stepping::tracking::TrackingSummary;
use crate::run::session::Session;
use crate::run::stop::Stop;
use psd_physics::integrator::solver::FrameSolver;
use psd_physics::structure::elements::ElementReading;
use psd_physics::structure::ground::{acceleration_at, next_acceleration};
use psd_physics::structure::matrix::copy;
use psd_physics::tracking::monitor::Tracking;
use psd_plan::record::{FloorMotion, ShakeHistory, ShakeStep};
use psd_plan::{Ground, Shake};
use psd_rig::Reading;

pub(crate) struct Shaking<'a> {
    pub(crate) setting: &'a Setting,
    pub(crate) history: ShakeHistory,
    pub(crate) summary: ShakeSummary,
    pub(crate) followed: TrackingSummary,
}

impl Shaking<'_> {
    pub(crate) fn run(
        &mut self,
        plan: &Shake,
        ground: &Ground,
        session: &mut Session<'_>,
    ) -> Result<(), Stop> {
        let Self {
            setting,
            history,
            summary,
            followed,
        } = self;
        let matrices = &setting.frame.properties.matrices;
        step_loop::run(
            &setting.frame.steps,
            &plan.stepping,
            followed,
            session,
            |start| {
                let mut load = vec![0.0; matrices.order()];
                matrices.ground_load(setting.ground_at(ground, 0), &mut load);
                let input = start.input(&setting.frame, &plan.stepping, &load);
                let mut solver = FrameSolver::new(&input)
                    .map_err(|error| not_stepped(setting.frame.steps.time_step, &error))?;
                solver.measured_at_start(&start.reading.displacement);
                let stiffer = StifferSprings::of_storeys(
                    &setting.frame.properties,
                    &plan.stepping,
                    setting.frame.steps.time_step,
                    start,
                );
                Ok((
                    Shaken {
                        setting,
                        ground,
                        solver,
                        load,
                        passed: 0,
                        until: plan.until,
                        history,
                        summary,
                    },
                    stiffer,
                ))
            },
        )
    }
}

impl Setting {
    /// Applied ground acceleration at the end of a step \[m/s²\].
    fn ground_at(&self, ground: &Ground, step: u64) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
        let time = step as f64 * self.frame.steps.time_step;
        self.scale * acceleration_at(&ground.times, &ground.accelerations, time)
    }
}

/// The frame during the run.
struct Shaken<'a> {
    setting: &'a Setting,
    ground: &'a Ground,
    solver: FrameSolver,
    /// Load of the present step \[N\].
    load: Vec<f64>,
    /// Samples of the ground motion that are passed.
    passed: usize,
    /// The drift that ends the run \[m\].
    until: Option<f64>,
    history: &'a mut ShakeHistory,
    summary: &'a mut ShakeSummary,
}

impl EndOfStep for Shaken<'_> {
    fn axes(&self) -> AxesState<'_> {
        AxesState::of(self.solver.state())
    }

    fn sum_up(&mut self) -> Balance {
        let state = self.solver.state();
        self.summary.push(state);
        // The input energy is 0 at the start: until it is larger, the reference is the energy that the ground motion can put in.
        let input = self
            .summary
            .largest_energy()
            .max(self.setting.ground_energy);
        Balance {
            error: state.energies.error,
            input,
        }
    }

    fn keep(&mut self, axes: &[Tracking], wall_time: f64) {
        let state = self.solver.state();
        self.history.steps.push(ShakeStep {
            step: state.step,
            wall_time,
            ground_acceleration: self.setting.ground_at(self.ground, state.step),
            floors: FloorMotion::of_state(state, axes),
            energies: state.energies,
        });
    }

    fn is_struck(&self) -> bool {
        false
    }
}

impl Stepped for Shaken<'_> {
    fn predict(&mut self, target: &mut [f64]) {
        let Self {
            setting,
            ground,
            solver,
            load,
            passed,
            ..
        } = self;
        #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
        let time = (solver.state().step + 1) as f64 * setting.frame.steps.time_step;
        let ground_acceleration =
            setting.scale * next_acceleration(&ground.times, &ground.accelerations, time, passed);
        let matrices = &setting.frame.properties.matrices;
        matrices.ground_load(ground_acceleration, load);
        copy(self.solver.predict(&self.load), target);
    }

    fn predicted_velocity(&mut self, velocity: &mut [f64]) -> bool {
        self.solver.predicted_velocity(velocity);
        false
    }

    fn effective_force_at_start(&self, start: &Start) -> Vec<f64> {
        self.solver.effective_force_at(
            &start.commanded,
            &start.reading.displacement,
            &start.reading.force,
        )
    }

    fn effective_force(&self, force: &mut [f64]) {
        force.copy_from_slice(self.solver.effective_force());
    }

    fn read_elements(&mut self, elements: &[ElementReading]) {
        self.solver.read_elements(elements);
    }

    fn complete(&mut self, reading: &Reading) {
        self.solver.complete(&reading.displacement, &reading.force);
    }

    fn cut_off(&mut self, target: &[f64], reading: &Reading, time_step: f64, wall_time: f64) {
        let Some(last) = self.history.steps.last() else {
            return;
        };
        let time = last.floors.time + time_step;
        let gravity_force = self.solver.gravity_force(&reading.displacement);
        let sum = |forces: &[f64]| forces.iter().sum::<f64>();
        let base_shear = sum(&reading.force) - sum(&gravity_force);
        let step = ShakeStep {
            step: last.step + 1,
            wall_time,
            ground_acceleration: self.setting.ground_at(self.ground, last.step + 1),
            floors: last.floors.cut_off(
                time,
                target,
                &reading.displacement,
                &reading.force,
                gravity_force,
                &self.solver.state().elements,
            ),
            energies: last.energies,
        };
        self.history.steps.push(step);
        let elements = &self.solver.state().elements;
        self.summary
            .cut_off(&reading.displacement, elements, base_shear);
    }

    fn over(&self) -> bool {
        let until = self.until;
        until.is_some_and(|limit| drifted_to(self.summary.drift(), limit).is_some())
    }
}
