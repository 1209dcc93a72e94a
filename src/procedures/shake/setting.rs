//! The inputs of a base excitation, evaluated before its first time step. In: the plan, its frame and ground motion. Out: the time
//! steps of the frame, the scale of the ground motion, its energy.

use crate::procedures::stepping;
use crate::procedures::stepping::setting::{FrameSteps, Times};
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::run::stop::Stop;
use psd_physics::structure::ground::peak_velocity;
use psd_plan::formula::Formula;
use psd_plan::procedures::shake::block as schema;
use psd_plan::schema::methods;
use psd_plan::{Frame, Ground, Shake};

/// Everything known before the first step.
pub(crate) struct Setting {
    pub(crate) frame: FrameSteps,
    /// Factor on the record.
    pub(crate) scale: f64,
    /// ½ ιᵀMι v², v the largest velocity of the ground, J: the energy that its motion can put in.
    pub(crate) ground_energy: f64,
}

impl Setting {
    pub(crate) fn evaluate(
        plan: &Shake,
        frame: &Frame,
        ground: &Ground,
        inputs: &mut Inputs<'_>,
        session: &Session<'_>,
    ) -> Result<Self, Stop> {
        let properties = stepping::setting::properties(frame, &plan.damping, inputs)?;
        let critical = properties.critical_time_step();
        let time_step = stepping::setting::time_step(&plan.stepping, critical, inputs)?;
        stepping::setting::stable_on_frame(&plan.stepping, time_step, frame, &properties, session)?;
        let to_the_end = Formula::Constant(ground.duration());
        let duration = inputs.number(
            &methods::DURATION,
            plan.duration.as_ref().unwrap_or(&to_the_end),
        )?;
        let scale = inputs.number(&schema::SCALE, &plan.scale)?;
        let times = Times {
            time_step,
            critical_time_step: critical,
            duration,
        };
        let frame_steps = FrameSteps::evaluate(properties, &plan.stepping, times, inputs)?;
        let velocity = scale * peak_velocity(&ground.times, &ground.accelerations);
        let ground_energy = 0.5 * frame.total_mass() * velocity * velocity;
        Ok(Self {
            frame: frame_steps,
            scale,
            ground_energy,
        })
    }
}
