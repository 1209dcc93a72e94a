//! The state of a structure at the end of a step. In: nothing. Out: a plain record. It integrates nothing.

use super::step_form::Moment;
use crate::structure::FrameEnergies;

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
    /// Force of the recursion at X \[N\]: the reading, as corrected by the I-modification and α-OS.
    pub force_at_computed: V,
    /// F at the end of the step \[N\].
    pub load: V,
    /// `k_t` of each storey for the next step \[N/m\]; empty for a frame without storey tangents.
    pub storey_stiffness: V,
    pub energies: FrameEnergies,
}

/// The state of a frame, one entry per degree of freedom.
pub type FrameState = State<Vec<f64>>;

impl<V> State<V> {
    #[inline]
    pub(crate) const fn moment(&self) -> Moment<'_, V> {
        Moment {
            displacement: &self.displacement,
            velocity: &self.velocity,
            acceleration: &self.acceleration,
            force: &self.force_at_computed,
            load: &self.load,
        }
    }
}
