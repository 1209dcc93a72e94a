//! Structures with many degrees of freedom: M Ẍ + C Ẋ + R = F(t), under loads or ground motion, F =
//! −M ι `ü_g` (Melo et al. 2006, eqs. 1 and 1a). In: matrices, loads, measured forces. Out:
//! targets, motion and energy, relative to the ground.
//!
//! A step never costs n³: matrices are banded, and a factorisation is kept until a stiffness
//! changes.

mod band;
mod damping;
mod factor;
mod modes;
mod storeys;
mod unloading;
mod unloading_path;

pub use super::integrator::solver::{FrameError, FrameInput, FrameSolver, FrameState};
pub use super::integrator::step_form::FrameMatrices;
pub use super::integrator::tangents::Tangents;
pub use super::structure::energies::FrameEnergies;
pub use band::{RowsError, SymmetricBand};
pub use damping::{Damping, DampingError, damping_matrix, rayleigh_coefficients};
pub use factor::{BandFactor, NotPositiveDefinite};
pub use modes::{Modes, ModesError, modes};
pub(super) use storeys::set_storeys;
pub use storeys::{drifts, floor_forces, shears, storey_stiffness, storeys_of};
pub use unloading::{Loaded, Unloading};
pub use unloading_path::UnloadingPath;
