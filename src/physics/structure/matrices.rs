//! Mass, damping, stiffness and geometric stiffness of a structure. In: numbers, or bands. Out: loads of a ground motion. It integrates nothing.

use super::matrix::{Matrix as _, SymmetricBand, Vector};

/// M, C, K and G of a structure, of one order \[kg\], \[N·s/m\], \[N/m\]: M Ẍ + C Ẋ + R(X) − G X = F.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrices<V: Vector> {
    pub mass: V::Matrix,
    pub damping: V::Matrix,
    /// The initial one.
    pub stiffness: V::Matrix,
    /// G, the geometric stiffness of the weights; None without weights.
    pub gravity: Option<V::Matrix>,
}

impl<V: Vector> Matrices<V> {
    /// A stiffness of this structure under its weights, K − G.
    #[must_use]
    pub fn net(&self, stiffness: &V::Matrix) -> V::Matrix {
        let mut net = stiffness.clone();
        if let Some(gravity) = &self.gravity {
            net.add_scaled(gravity, -1.0);
        }
        net
    }
}

/// Those of a frame.
pub type FrameMatrices = Matrices<Vec<f64>>;

impl FrameMatrices {
    /// Degrees of freedom.
    #[must_use]
    pub const fn order(&self) -> usize {
        self.mass.order()
    }

    /// Load −M ι `ü_g` of a ground acceleration \[m/s²\] on displacements relative to the ground \[N\].
    pub fn ground_load(&self, acceleration: f64, load: &mut [f64]) {
        if self.mass.half_bandwidth() == 0 {
            for (load, mass) in load.iter_mut().zip(self.mass.band(0)) {
                *load = mass * -acceleration;
            }
            return;
        }
        SymmetricBand::row_sums(&self.mass, load);
        for load in load {
            *load *= -acceleration;
        }
    }
}
