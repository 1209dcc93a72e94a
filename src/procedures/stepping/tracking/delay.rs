//! The delay of the actuators of a simulated rig, to first order. In: the lag and the undershoot of the rig, the time steps of a
//! procedure. Out: delays in simulated time.

use crate::physics::structure::frame_properties::FrameProperties;
use crate::plan::formula::NoResults;
use crate::plan::{Frame, Link, Mode, Plan, ShakeDamping, Stepping, VirtualLink};
use crate::procedures::facts::Delay;

/// Delay of the actuators of a rig to first order, in simulated time \[s\]. An undershoot t of each increment gives Δt·t/(1 − t). A lag τ
/// gives the part that remains after a pause, or in continuous mode τ over the time scale.
pub(crate) fn late(plan: &Plan, stepping: &Stepping, time_step: f64) -> f64 {
    let Link::Virtual(VirtualLink {
        tracking: short,
        lag,
        ..
    }) = plan.rig.link
    else {
        return 0.0;
    };
    if short >= 1.0 {
        return f64::INFINITY;
    }
    let of_lag = match stepping.mode {
        _ if lag <= 0.0 => 0.0,
        Mode::Continuous { time_scale } => lag / time_scale,
        // The rig settles into its band first.
        Mode::StepAndPause if plan.rig.settle.band > 0.0 => 0.0,
        Mode::StepAndPause => {
            let left = (-stepping.pause.constant().unwrap_or(0.0) / lag).exp();
            if left < 1.0 {
                time_step * left / (1.0 - left)
            } else {
                f64::INFINITY
            }
        }
    };
    (short * time_step + of_lag) / (1.0 - short)
}

/// The delay of a frame, whose critical time step \[s\] is `critical`; None where not enough is known before the run.
pub(crate) fn of_frame(
    plan: &Plan,
    specimen: usize,
    damping: &ShakeDamping,
    stepping: &Stepping,
    critical: impl Fn(&FrameProperties) -> Option<f64>,
) -> Option<Delay> {
    let frame: &Frame = plan.specimens.get(specimen)?.frame.as_ref()?;
    let properties = FrameProperties::of(frame, &damping.known()?).ok()?;
    let time_step = stepping
        .time_step
        .evaluate(&NoResults, critical(&properties))
        .ok()?
        .value;
    Some(Delay {
        late: late(plan, stepping, time_step),
        time_step,
        omega: properties.modes.angular_frequency(0),
    })
}
