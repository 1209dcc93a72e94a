//! Relaxation: models in closed form, and the fit to measured dwells. In: force increments or
//! readings over time. Out: relaxed forces, or parameters with standard errors. It knows no rig.

pub mod fit;
#[cfg(test)]
mod fit_tests;
pub mod law;
pub mod logarithmic;
pub mod maxwell;
pub mod reached_fit;
#[cfg(test)]
mod reached_fit_tests;
pub mod state;
