//! Pure numerics: integrator, contact, specimen models, identification, energy. SI throughout; no rig, no plan text.

pub mod approach;
pub mod backbone;
pub mod beam;
pub mod breaks;
pub mod contact;
pub mod cyclic;
pub mod damping;
pub mod energy;
pub mod extremes;
pub mod following;
pub mod forecast;
pub mod frame;
pub mod frame_path;
pub mod frame_properties;
pub mod frame_rerun;
pub mod ground;
pub mod growth;
pub mod identification;
pub mod impact;
pub mod integrator;
pub mod law;
pub mod logarithmic;
pub mod loop_sampling;
pub mod maxwell;
pub mod method;
pub mod monitor;
pub mod multilinear_fit;
pub mod noisy_largest;
pub mod path;
pub mod portal_limit;
pub mod portal_mass;
pub mod reached_fit;
#[cfg(test)]
mod reached_fit_tests;
pub mod recorded_path;
pub mod relaxation;
pub mod relaxation_law;
#[cfg(test)]
mod relaxation_tests;
pub mod relaxation_weights;
pub mod relaxing;
pub mod rerun;
pub mod rounding;
pub mod scheme;
pub mod self_test;
pub mod specimen;
pub mod split;
pub mod stability;
pub mod strokes;
pub mod structure;
pub mod student;
pub mod summary;
pub mod tangent;
#[cfg(test)]
pub(crate) mod testing;

pub use integrator::critical_time_step;
