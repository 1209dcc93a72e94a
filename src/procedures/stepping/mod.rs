//! Time stepping, shared by the procedures that integrate: its check, the step loop, continuous
//! motion, tracking. In: who computes the steps, and a rig behind the guard. Out: completed steps.
//! It knows no striker and no ground motion.

pub(crate) mod check;
mod continuous_motion;
pub(crate) mod end_of_step;
pub(crate) mod energy;
pub(crate) mod frame_uncertainty;
pub(crate) mod ideal_run;
pub(crate) mod operator_stability_watch;
pub(crate) mod predicted;
pub(crate) mod report;
pub(crate) mod self_tested;
pub(crate) mod setting;
pub(crate) mod step_loop;
pub(crate) mod tracking;
