//! Uncertainties compared with closed forms, Monte Carlo trials and repeated virtual runs.

pub(crate) mod below_range;
pub(crate) mod continuous;
pub(crate) mod cycle_quantization;
pub(crate) mod degrees;
pub(crate) mod expected_scatter;
pub(crate) mod frame;
pub(crate) mod hold_quantization;
pub(crate) mod impact;
pub(crate) mod last_blow;
pub(crate) mod matrices;
pub(crate) mod path_matrix;
pub(crate) mod quantization;
pub(crate) mod rest;
pub(crate) mod time_step;
