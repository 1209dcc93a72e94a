//! The parts that several procedures share: readings, results, uncertainties of fits, limits in charts. In: numbers of a procedure.
//! Out: the same for every procedure. No part knows a procedure.

pub(crate) mod calibrated_range;
pub(crate) mod dwell_readings;
pub(crate) mod fit_uncertainty;
pub(crate) mod limit_lines;
pub(crate) mod loop_sampling;
pub(crate) mod perturbed_inputs;
pub(crate) mod predicted;
pub(crate) mod reached;
pub(crate) mod results;
pub(crate) mod violations;
