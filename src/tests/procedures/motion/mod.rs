//! Motion of the actuator: continuous tests, tracking errors, lag, stability of the operator.

pub(crate) mod continuous;
pub(crate) mod operator_stability;
pub(crate) mod sweep_lag;
pub(crate) mod tracking;
