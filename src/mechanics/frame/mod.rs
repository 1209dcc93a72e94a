//! Many degrees of freedom: M Ẍ + C Ẋ + R = F(t), a frame under loads or on ground that moves, F = −M ι `ü_g` (Melo et al.
//! 2006, eqs. 1, 1a, Figs. 1, 2). In: matrices, loads, what a rig read. Out: targets for the rig, the motion, its energy.
//! Displacements are those against the ground. No rig, no plan text, no record of a ground motion.
//!
//! Nothing here costs n³ in a step: a shear building is tridiagonal, its matrices are bands, and a factor is kept until
//! a stiffness changes.

mod band;
mod damping;
mod energy;
mod factor;
mod hertz;
pub mod impact;
mod modes;
mod passage;
mod restitution;
mod schemes;
mod solver;
mod storeys;
mod sweeps;
mod tangents;
mod unloading;
mod unloading_path;

pub use band::{RowsError, SymmetricBand};
pub use damping::{Damping, DampingError, damping_matrix, rayleigh_coefficients};
pub use energy::FrameEnergies;
pub use factor::{BandFactor, NotPositiveDefinite};
pub use modes::{Modes, ModesError, modes};
pub use solver::{FrameError, FrameInput, FrameSolver, FrameState};
pub use storeys::{drifts, floor_forces, shears, storey_stiffness, storeys_of};
pub use tangents::Tangents;
pub use unloading::{Loaded, Unloading};
pub use unloading_path::UnloadingPath;

/// M, C and K of a frame, of one order: kg, N·s/m, N/m.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameMatrices {
    pub mass: SymmetricBand,
    pub damping: SymmetricBand,
    /// The initial one.
    pub stiffness: SymmetricBand,
}

impl FrameMatrices {
    /// Degrees of freedom.
    #[must_use]
    pub const fn order(&self) -> usize {
        self.mass.order()
    }

    /// −M ι `ü_g`, N: what a ground acceleration (m/s²) is to displacements against the ground.
    pub fn ground_load(&self, acceleration: f64, load: &mut [f64]) {
        if self.mass.half_bandwidth() == 0 {
            for (load, mass) in load.iter_mut().zip(self.mass.band(0)) {
                *load = mass * -acceleration;
            }
            return;
        }
        self.mass.row_sums(load);
        for load in load {
            *load *= -acceleration;
        }
    }
}
