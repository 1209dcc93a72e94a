//! Measurement uncertainty. In: a procedure as a pure function of its readings and inputs, and the
//! sources of their uncertainty. Out: contributions, standard uncertainties, coverage factors. It
//! knows no procedure, no rig and no run.

mod cost;
mod degrees;
pub mod engine;
mod instruments;
mod threads;

pub use crate::contribution::{Contribution, combined, combined_entries, share};
pub use crate::results::{Moved, sources_of};
pub use crate::source::{Refinement, Source};
pub use crate::time_step::StepInterval;
pub use degrees::{
    FEW, MOST_DRAWS, MeasurementUncertainty, measurement_uncertainties, measurement_uncertainty,
};
pub use instruments::{InstrumentUncertainty, NOISE};
