//! What an impact on a storey leaves: that of the struck floor as of any impact, and the peaks of every floor and storey,
//! collected step by step. In: the ends of steps. Out: results in the schema's order. It drives nothing.

use super::followed::Followed;
use super::impact;
use super::results::result;
use crate::formula::ResultValue;
use crate::mechanics::contact::StepState;
use crate::mechanics::frame::{FrameState, drifts, shears};
pub(super) use crate::mechanics::frame_rerun::of_floor;
use crate::mechanics::impact::{ImpactInput, ImpactState};
use crate::mechanics::noisy_largest::NoisyLargest;
use crate::mechanics::summary::{ImpactSummary, SummaryBuilder};
use crate::quantity::Dimension;
use crate::record::{NamedResult, StoreyImpactHistory};

/// Peaks over the computed displacements and the measured forces.
pub(super) struct StoreySummary {
    blow: SummaryBuilder,
    time_step: f64,
    floor_displacement: Vec<f64>,
    max_drift: Vec<f64>,
    /// At the last step's end, m and N: of the force that the recursion takes.
    drift: Vec<f64>,
    shear: Vec<f64>,
    storey_energy: Vec<f64>,
    base_shear: NoisyLargest,
    first_blow: u64,
    first_is_over: bool,
    striker_velocity: f64,
}

impl StoreySummary {
    /// `body` is the struck floor with the striker; `noise` the standard deviation of the base shear as it is read, N.
    pub(super) fn new(body: &ImpactInput, floors: usize, noise: f64) -> Self {
        let nothing = || vec![0.0; floors];
        Self {
            blow: SummaryBuilder::new(body),
            time_step: body.time_step,
            floor_displacement: nothing(),
            max_drift: nothing(),
            drift: nothing(),
            shear: nothing(),
            storey_energy: nothing(),
            base_shear: NoisyLargest::new(noise),
            first_blow: 0,
            first_is_over: false,
            striker_velocity: body.striker_velocity,
        }
    }

    /// Takes the end of a step; `floor` is the struck one.
    pub(super) fn push(&mut self, state: &FrameState, floor: &ImpactState) {
        self.blow.push(floor);
        let (mut drift, mut shear) = (vec![0.0; self.drift.len()], vec![0.0; self.drift.len()]);
        drifts(&state.displacement, &mut drift);
        shears(&state.force_at_computed, &mut shear);
        // Σ ½(V + V₁)Δδ over the storeys is ½(R + R₁)ᵀΔX over the floors. Step 0 is where it begins.
        if state.step > 0 {
            for storey in 0..drift.len() {
                let moved = drift[storey] - self.drift[storey];
                self.storey_energy[storey] += 0.5 * (self.shear[storey] + shear[storey]) * moved;
            }
        }
        (self.drift, self.shear) = (drift, shear);
        let widen = |largest: &mut [f64], values: &[f64]| {
            for (largest, value) in largest.iter_mut().zip(values) {
                *largest = largest.max(value.abs());
            }
        };
        widen(&mut self.floor_displacement, &state.displacement);
        widen(&mut self.max_drift, &self.drift);
        self.base_shear.push(state.restoring_force.iter().sum::<f64>().abs());
        match floor.state {
            StepState::Free => self.first_is_over |= self.first_blow > 0,
            _ if !self.first_is_over => self.first_blow += 1,
            _ => {}
        }
        self.striker_velocity = floor.striker_velocity;
    }

    /// ∫ shear d(drift) of each storey so far, J.
    pub(super) fn storey_energy(&self) -> &[f64] {
        &self.storey_energy
    }

    /// What the struck floor came to.
    pub(super) fn blow(&self) -> ImpactSummary {
        self.blow.clone().finish()
    }

    /// Virtual time in contact from the first touch on, s; none where there was none.
    fn contact_duration(&self) -> Option<f64> {
        #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
        (self.first_blow > 0).then_some(self.first_blow as f64 * self.time_step)
    }
}

/// In the order of the reference; every number is missing if not even the start was read.
pub(super) fn results(summary: Option<&StoreySummary>, followed: &Followed, history: &StoreyImpactHistory) -> Vec<NamedResult> {
    let list = |name, dimension, values: Option<&Vec<f64>>| match values {
        Some(values) => NamedResult { name, dimension, value: ResultValue::List(values.clone()), contributions: Vec::new() },
        None => result(name, dimension, None),
    };
    let blow = summary.map(StoreySummary::blow);
    let back = summary.map(|summary| -summary.striker_velocity).filter(|back| *back > 0.0);
    let mut results = impact::results(blow.as_ref(), followed.worst(), &history.blow);
    results.extend([
        result("contact_duration", Dimension::TIME, summary.and_then(StoreySummary::contact_duration)),
        result("rebound_velocity", Dimension::VELOCITY, back),
        list("floor_displacement", Dimension::LENGTH, summary.map(|summary| &summary.floor_displacement)),
        list("max_drift", Dimension::LENGTH, summary.map(|summary| &summary.max_drift)),
        list("final_drift", Dimension::LENGTH, summary.map(|summary| &summary.drift)),
        list("storey_energy", Dimension::ENERGY, summary.map(|summary| &summary.storey_energy)),
        result("max_base_shear", Dimension::FORCE, summary.and_then(|summary| summary.base_shear.value())),
        list("periods", Dimension::TIME, history.modes.as_ref().map(|modes| &modes.periods)),
    ]);
    results.extend(followed.of_each());
    results
}
