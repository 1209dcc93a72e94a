//! The state of a structure at the end of a step. In: nothing. Out: a plain record. It integrates nothing.

use super::step_form::Moment;
use crate::structure::FrameEnergies;
use crate::structure::elements::{ElementReading, member_drifts};
use crate::structure::matrix::Vector;
use crate::structure::{drifts, drifts_to, shears};

/// The end of a step; step 0 is the start.
#[derive(Clone, Debug, PartialEq)]
pub struct State<V> {
    pub step: u64,
    /// \[s\]
    pub time: f64,
    /// Computed X \[m\].
    pub displacement: V,
    /// Imposed on the specimen \[m\]: X itself, under α-OS the predicted displacement d̃.
    pub target: V,
    /// \[m\]
    pub measured_displacement: V,
    /// Ẋ \[m/s\]
    pub velocity: V,
    /// Ẍ \[m/s²\]
    pub acceleration: V,
    /// Measured R \[N\].
    pub restoring_force: V,
    /// G X at the target \[N\]: the forces of P-Δ, which oppose R; empty without weights.
    pub gravity_force: V,
    /// Force of the recursion at X \[N\]: the reading, as corrected by the I-modification and α-OS.
    pub force_at_computed: V,
    /// F at the end of the step \[N\].
    pub load: V,
    /// `k_t` of each storey for the next step \[N/m\]; empty for a frame without storey tangents.
    pub storey_stiffness: V,
    /// The elements of a frame of matrices at the target; empty for any other structure.
    pub elements: Vec<ElementReading>,
    pub energies: FrameEnergies,
}

/// The state of a frame, one entry per degree of freedom.
pub type FrameState = State<Vec<f64>>;

impl<V: Vector> State<V> {
    /// Σ(R − G X) \[N\]: the measured base shear, net of P-Δ.
    #[must_use]
    pub fn base_shear(&self) -> f64 {
        let sum = |forces: &V| forces.as_slice().iter().sum::<f64>();
        sum(&self.restoring_force) - sum(&self.gravity_force)
    }

    /// Drifts that it has: of its storeys, or of its elements.
    #[must_use]
    pub fn members(&self) -> usize {
        if self.elements.is_empty() {
            self.displacement.as_slice().len()
        } else {
            self.elements.len()
        }
    }

    /// Computed drift of each storey, or deformation of each element \[m\].
    pub fn drifts(&self, drift: &mut [f64]) {
        member_drifts(self.displacement.as_slice(), &self.elements, drift);
    }

    /// Whether a drift or deformation is at least `limit` \[m\] in absolute value.
    #[must_use]
    pub(crate) fn drifts_to(&self, limit: f64) -> bool {
        if self.elements.is_empty() {
            return drifts_to(self.displacement.as_slice(), limit);
        }
        let mut elements = self.elements.iter();
        elements.any(|read| read.computed.abs() >= limit)
    }

    /// The rate of each drift or deformation \[m/s\].
    pub fn drift_velocities(&self, rate: &mut [f64]) {
        if self.elements.is_empty() {
            drifts(self.velocity.as_slice(), rate);
        }
        for (rate, element) in rate.iter_mut().zip(&self.elements) {
            *rate = element.velocity;
        }
    }

    /// Shear of each storey, or force of each element, at the computed displacements \[N\].
    pub fn shears_at_computed(&self, shear: &mut [f64]) {
        if self.elements.is_empty() {
            shears(self.force_at_computed.as_slice(), shear);
        }
        for (shear, element) in shear.iter_mut().zip(&self.elements) {
            *shear = element.force_at_computed;
        }
    }
}

impl<V> State<V> {
    /// `net`: R − G X at the computed displacement, with weights \[N\].
    #[inline]
    pub(crate) const fn moment<'a>(&'a self, net: Option<&'a V>) -> Moment<'a, V> {
        let force = match net {
            Some(net) => net,
            None => &self.force_at_computed,
        };
        Moment {
            displacement: &self.displacement,
            velocity: &self.velocity,
            acceleration: &self.acceleration,
            force,
            load: &self.load,
        }
    }
}
