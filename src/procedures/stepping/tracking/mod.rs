//! The tracking errors of the actuators: their delay before a run, their energy in it. In: the rig of a plan, or the tracking of every
//! step. Out: delays, observations and results. It moves nothing.

pub(crate) mod delay;
pub(crate) mod remarks;
pub(crate) mod tracking_summary;
