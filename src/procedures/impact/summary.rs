//! The summary of an impact, collected step by step: striker and struck degree of freedom, and for a frame the peaks of every floor and
//! storey. In: the ends of steps. Out: numbers. It moves nothing.

use crate::physics::contact::state::StepState;
use crate::physics::impact::summary::{ImpactSummary, SummaryBuilder};
use crate::physics::impact::{ImpactInput, ImpactState};
use crate::physics::integrator::state::State;
use crate::physics::statistics::noisy_largest::NoisyLargest;
use crate::physics::structure::matrix::Vector;
use crate::physics::structure::{drifts, shears, widen};
use crate::record::history::floors::drift_of;
use crate::rig::Reading;

/// An impact on one degree of freedom, or on one floor of a frame.
pub(crate) struct StruckSummary {
    impact: SummaryBuilder,
    floors: Option<FloorSummary>,
}

impl StruckSummary {
    /// On one degree of freedom.
    pub(crate) fn new(input: &ImpactInput) -> Self {
        Self {
            impact: SummaryBuilder::new(input),
            floors: None,
        }
    }

    /// On one floor; `body` is that floor with the striker, `noise` the standard deviation of the measured base shear \[N\].
    pub(crate) fn of_frame(body: &ImpactInput, floors: usize, noise: f64) -> Self {
        Self {
            impact: SummaryBuilder::new(body),
            floors: Some(FloorSummary::new(body, floors, noise)),
        }
    }

    /// Adds the end of a step.
    pub(crate) fn push<V: Vector>(&mut self, structure: &State<V>, state: &ImpactState) {
        self.impact.push(state);
        if let Some(floors) = &mut self.floors {
            floors.push(structure, state);
        }
    }

    /// Adds a reading on the way to a target that was not reached: the floors with the struck one, by this time \[s\].
    pub(crate) fn moved_to(&mut self, struck: usize, reading: &Reading, time: f64) {
        self.impact.moved_to(reading.displacement[struck], time);
        if let Some(floors) = &mut self.floors {
            floors.moved_to(reading);
        }
    }

    /// The summary of the struck degree of freedom.
    pub(crate) fn impact(&self) -> ImpactSummary {
        self.impact.clone().finish()
    }

    /// The summary of every floor; None for one degree of freedom.
    pub(crate) const fn floors(&self) -> Option<&FloorSummary> {
        self.floors.as_ref()
    }
}

/// Peaks over the computed displacements and the measured forces of all floors.
pub(crate) struct FloorSummary {
    time_step: f64,
    pub floor_displacement: Vec<f64>,
    pub max_drift: Vec<f64>,
    /// Storey drifts at the end of the last step \[m\]; their shears \[N\] follow from the effective forces of the recursion.
    pub drift: Vec<f64>,
    shear: Vec<f64>,
    storey_energy: Vec<f64>,
    base_shear: NoisyLargest,
    first_impact: u64,
    first_is_over: bool,
    striker_velocity: f64,
}

impl FloorSummary {
    fn new(body: &ImpactInput, floors: usize, noise: f64) -> Self {
        let nothing = || vec![0.0; floors];
        Self {
            time_step: body.time_step,
            floor_displacement: nothing(),
            max_drift: nothing(),
            drift: nothing(),
            shear: nothing(),
            storey_energy: nothing(),
            base_shear: NoisyLargest::new(noise),
            first_impact: 0,
            first_is_over: false,
            striker_velocity: body.striker_velocity,
        }
    }

    fn push<V: Vector>(&mut self, structure: &State<V>, state: &ImpactState) {
        let (mut drift, mut shear) = (vec![0.0; self.drift.len()], vec![0.0; self.drift.len()]);
        drifts(structure.displacement.as_slice(), &mut drift);
        shears(structure.force_at_computed.as_slice(), &mut shear);
        // Σ ½(V + V₁)Δδ over the storeys equals ½(R + R₁)ᵀΔX over the floors. Step 0 is the start.
        if structure.step > 0 {
            for storey in 0..drift.len() {
                let moved = drift[storey] - self.drift[storey];
                self.storey_energy[storey] += 0.5 * (self.shear[storey] + shear[storey]) * moved;
            }
        }
        (self.drift, self.shear) = (drift, shear);
        widen(
            &mut self.floor_displacement,
            structure.displacement.as_slice(),
        );
        widen(&mut self.max_drift, &self.drift);
        self.base_shear.push(
            structure
                .restoring_force
                .as_slice()
                .iter()
                .sum::<f64>()
                .abs(),
        );
        match state.state {
            StepState::Free => self.first_is_over |= self.first_impact > 0,
            _ if !self.first_is_over => self.first_impact += 1,
            _ => {}
        }
        self.striker_velocity = state.striker_velocity;
    }

    fn moved_to(&mut self, reading: &Reading) {
        widen(&mut self.floor_displacement, &reading.displacement);
        widen(&mut self.max_drift, &drift_of(&reading.displacement));
        self.base_shear
            .push(reading.force.iter().sum::<f64>().abs());
    }

    /// ∫ shear d(drift) of each storey so far \[J\].
    pub(crate) fn storey_energy(&self) -> &[f64] {
        &self.storey_energy
    }

    /// Simulated duration of the first contact \[s\]; None without contact.
    pub(crate) fn contact_duration(&self) -> Option<f64> {
        #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
        (self.first_impact > 0).then_some(self.first_impact as f64 * self.time_step)
    }

    /// Rebound speed of the striker \[m/s\]; None if it does not move back.
    pub(crate) fn rebound_velocity(&self) -> Option<f64> {
        Some(-self.striker_velocity).filter(|back| *back > 0.0)
    }

    /// Largest base shear \[N\].
    pub(crate) fn max_base_shear(&self) -> Option<f64> {
        self.base_shear.value()
    }
}
