//! The state of rig and structure before the first time step. In: the first reading, the frame of the plan. Out: the initial state of a
//! solver.

use crate::schema::methods;
use std::fmt::Display;

use super::run::FrameSteps;
use crate::physics::integrator::input::FrameInput;
use crate::plan::Stepping;
use crate::rig::{DeclaredNoise, Reading};
use crate::run::stop::Stop;
use crate::units::Dimension;

/// The state when the first step begins.
pub(crate) struct Start {
    /// Commanded positions of the actuators \[m\]: X starts there.
    pub commanded: Vec<f64>,
    /// One reading there: it contains R₀.
    pub reading: Reading,
    pub noise: DeclaredNoise,
}

impl Start {
    /// The initial state of a frame, with these loads on its floors \[N\].
    pub(crate) fn input<'a>(
        &'a self,
        frame: &'a FrameSteps,
        plan: &Stepping,
        load: &'a [f64],
    ) -> FrameInput<'a> {
        let matrices = &frame.properties.matrices;
        FrameInput {
            matrices,
            operator_stiffness: &matrices.stiffness,
            integrator: plan.integrator,
            i_modification: plan.i_modification,
            tangents: frame.tangents,
            time_step: frame.steps.time_step,
            initial_displacement: &self.commanded,
            initial_restoring_force: &self.reading.force,
            initial_load: load,
            noise: self.noise,
        }
    }
}

/// The input error of a structure that cannot be integrated with `time_step` \[s\].
pub(crate) fn not_stepped(time_step: f64, error: &impl Display) -> Stop {
    let wanted = format!("one that can be stepped: {error}");
    Stop::bad_input(methods::TIME_STEP.name, time_step, Dimension::TIME, wanted)
}
