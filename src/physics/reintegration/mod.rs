//! Re-integration of recorded runs along their measured force–displacement path, with one input
//! perturbed. In: a recorded run and the perturbed input. Out: the run that results. It knows no
//! source of uncertainty.

pub mod frame;
pub mod frame_path;
pub mod impact;
pub mod perturbation;
pub mod recorded_path;
