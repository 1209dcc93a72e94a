//! Relaxation: models in closed form, and their fits to measured holds. In: force increments or
//! readings over time. Out: relaxed forces, or parameters with standard errors. It knows no rig.

pub mod hold;
pub mod law;
pub mod logarithmic;
pub mod maxwell;
pub mod relaxation_state;
pub mod superposition;
pub mod time_constant;
