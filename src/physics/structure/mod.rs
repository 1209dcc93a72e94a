//! Structures: their matrices, beams, portals and frames, modes, damping, energies, unloading. In: dimensions and material. Out:
//! stiffness, mass, loads. It integrates nothing.
//!
//! A structure has one degree of freedom or many: M Ẍ + C Ẋ + R = F(t), under loads or ground motion, F = −M ι `ü_g` (Melo et al. 2006,
//! eqs. 1 and 1a). A step never costs n³: matrices are banded, and a factorisation is kept until a stiffness changes.

pub mod assemblies;
pub mod beam;
pub mod cell_damping;
mod damping;
pub mod elements;
pub mod energies;
pub mod frame;
pub mod frame_properties;
pub mod ground;
mod matrices;
pub mod matrix;
mod modes;
pub mod portal;
pub mod section;
mod shear_building;
pub mod substructures;
mod unloading;

pub use damping::{Damping, DampingError, damping_matrix, rayleigh_coefficients};
pub use energies::FrameEnergies;
pub use matrices::{FrameMatrices, Matrices};
pub use matrix::{BandFactor, NotPositiveDefinite, RowsError, SymmetricBand};
pub use modes::{Modes, ModesError, modes};
pub use shear_building::{drifts, floor_forces, shears, storey_stiffness, storeys_of, widen};
pub(crate) use shear_building::{drifts_to, set_storeys};
pub use unloading::{Loaded, Unloading, UnloadingPath};
