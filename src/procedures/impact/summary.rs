//! The peaks of an impact, step by step; for a frame also those of every floor and storey. In: the ends of its steps. Out: a summary, from
//! which its results follow. It knows no result and no plan.

#![allow(
    clippy::inline_always,
    reason = "a part of the loop over the steps, which computes what its parts read"
)]

use psd_physics::contact::state::StepState;
use psd_physics::impact::summary::{ImpactEnding, ImpactSummary, SummaryBuilder};
use psd_physics::impact::{ImpactInput, ImpactState};
use psd_physics::integrator::state::State;
use psd_physics::statistics::noisy_largest::NoisyLargest;
use psd_physics::structure::elements::{ElementReading, member_drifts};
use psd_physics::structure::matrix::Vector;
use psd_physics::structure::widen;
use psd_plan::record::{FloorMotion, Floors as _, ImpactHistory, StillGrowing};
use psd_rig::Reading;

/// An impact on one degree of freedom, or on one floor of a frame.
pub(crate) struct StruckSummary {
    impact: SummaryBuilder,
    velocity: Growing,
    contact_force: Growing,
    floors: Option<FloorSummary>,
}

/// A largest value, step by step.
#[derive(Clone, Copy, Default)]
struct Growing {
    largest: f64,
    /// Whether the last value exceeds all values before it.
    is_last: bool,
}

impl Growing {
    #[inline(always)]
    fn push(&mut self, value: f64) {
        self.is_last = value > self.largest;
        self.largest = self.largest.max(value);
    }
}

impl StruckSummary {
    /// On one degree of freedom.
    pub(crate) fn new(input: &ImpactInput) -> Self {
        Self {
            impact: SummaryBuilder::new(input),
            velocity: Growing::default(),
            contact_force: Growing::default(),
            floors: None,
        }
    }

    /// On one floor; `body` is that floor with the striker, `noise` the standard deviation of the measured base shear \[N\], `of_elements`
    /// of the measured force of each element.
    pub(crate) fn of_frame(
        body: &ImpactInput,
        floors: usize,
        noise: f64,
        of_elements: &[f64],
    ) -> Self {
        Self {
            floors: Some(FloorSummary::new(body, floors, noise, of_elements)),
            ..Self::new(body)
        }
    }

    /// Adds the end of a step.
    #[inline(always)]
    pub(crate) fn push<V: Vector>(&mut self, structure: &State<V>, state: &ImpactState) {
        self.impact.push(state);
        self.velocity.push(state.velocity.abs());
        self.contact_force.push(state.contact_force);
        if let Some(floors) = &mut self.floors {
            floors.push(structure, state);
        }
    }

    /// How an impact with these steps ended; `impact` is the summary of the struck degree of freedom.
    pub(super) fn ending(&self, impact: &ImpactSummary, history: &ImpactHistory) -> ImpactEnding {
        let has_moved = history.steps.last().is_some_and(|last| last.step > 0);
        ImpactEnding {
            still_striking: has_moved && impact.stop_time.is_none(),
            touched: impact.max_contact_force > 0.0,
            still_rising: impact.still_rising,
            speeding_up: self.velocity.is_last,
            pushing_harder: self.contact_force.is_last,
        }
    }

    /// Sets what is still growing at the last step of a struck frame.
    pub(super) fn growing(&self, history: &mut ImpactHistory) {
        if let (Some(summary), Some(frame)) = (&self.floors, &mut history.frame)
            && let Some(last) = frame.floors.last()
        {
            frame.growing = summary.growing(&last.floors);
        }
    }

    /// Adds a reading on the way to a target that was not reached: the floors with the struck one, by this time \[s\], and the elements.
    /// `gravity_force` is G X there \[N\].
    pub(crate) fn moved_to(
        &mut self,
        struck: usize,
        reading: &Reading,
        elements: &[ElementReading],
        gravity_force: &[f64],
        time: f64,
    ) {
        self.impact.moved_to(reading.displacement[struck], time);
        if let Some(floors) = &mut self.floors {
            floors.moved_to(reading, elements, gravity_force);
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
    /// Storey drifts or deformations of elements at the end of the last step \[m\]; their shears \[N\] follow from the effective forces of the recursion.
    pub drift: Vec<f64>,
    shear: Vec<f64>,
    /// Drifts and shears of the present step.
    next_drift: Vec<f64>,
    next_shear: Vec<f64>,
    storey_energy: Vec<f64>,
    /// Of each element of a frame of matrices.
    pub element_force: Vec<NoisyLargest>,
    base_shear: NoisyLargest,
    /// The measured base shear \[N\].
    shear_force: Growing,
    first_impact: u64,
    first_is_over: bool,
    striker_velocity: f64,
}

impl FloorSummary {
    fn new(body: &ImpactInput, floors: usize, noise: f64, of_elements: &[f64]) -> Self {
        let members = if of_elements.is_empty() {
            floors
        } else {
            of_elements.len()
        };
        let nothing = || vec![0.0; members];
        Self {
            time_step: body.time_step,
            floor_displacement: vec![0.0; floors],
            max_drift: nothing(),
            drift: nothing(),
            shear: nothing(),
            next_drift: nothing(),
            next_shear: nothing(),
            storey_energy: nothing(),
            element_force: NoisyLargest::of_each(of_elements),
            base_shear: NoisyLargest::new(noise),
            shear_force: Growing::default(),
            first_impact: 0,
            first_is_over: false,
            striker_velocity: body.striker_velocity,
        }
    }

    fn push<V: Vector>(&mut self, structure: &State<V>, state: &ImpactState) {
        structure.drifts(&mut self.next_drift);
        structure.shears_at_computed(&mut self.next_shear);
        let (drift, shear) = (&self.next_drift, &self.next_shear);
        // Σ ½(V + V₁)Δδ over the storeys equals ½(R + R₁)ᵀΔX over the floors. Step 0 is the start.
        if structure.step > 0 {
            for storey in 0..drift.len() {
                let moved = drift[storey] - self.drift[storey];
                self.storey_energy[storey] += 0.5 * (self.shear[storey] + shear[storey]) * moved;
            }
        }
        std::mem::swap(&mut self.drift, &mut self.next_drift);
        std::mem::swap(&mut self.shear, &mut self.next_shear);
        widen(
            &mut self.floor_displacement,
            structure.displacement.as_slice(),
        );
        widen(&mut self.max_drift, &self.drift);
        self.read_forces(&structure.elements);
        let base_shear = structure.base_shear().abs();
        self.base_shear.push(base_shear);
        self.shear_force.push(base_shear);
        match state.state {
            StepState::Free => self.first_is_over |= self.first_impact > 0,
            _ if !self.first_is_over => self.first_impact += 1,
            _ => {}
        }
        self.striker_velocity = state.striker_velocity;
    }

    fn read_forces(&mut self, elements: &[ElementReading]) {
        for (largest, element) in self.element_force.iter_mut().zip(elements) {
            largest.push(element.force.abs());
        }
    }

    fn moved_to(&mut self, reading: &Reading, elements: &[ElementReading], gravity_force: &[f64]) {
        widen(&mut self.floor_displacement, &reading.displacement);
        member_drifts(&reading.displacement, elements, &mut self.next_drift);
        widen(&mut self.max_drift, &self.next_drift);
        self.read_forces(elements);
        let sum = |forces: &[f64]| forces.iter().sum::<f64>();
        self.base_shear
            .push((sum(&reading.force) - sum(gravity_force)).abs());
    }

    /// What was still growing at this last step.
    fn growing(&self, last: &FloorMotion) -> StillGrowing {
        let beyond = |values: &[f64], rates: &[f64], largest: &[f64]| {
            let entries = 0..values.len();
            let grows = |entry: &usize| {
                values[*entry] * rates[*entry] > 0.0 && values[*entry].abs() >= largest[*entry]
            };
            entries.filter(grows).collect()
        };
        StillGrowing {
            base_shear: self.shear_force.is_last,
            floors: beyond(&last.computed, &last.velocity, &self.floor_displacement),
            storeys: beyond(&last.drift(), &last.drift_velocity(), &self.max_drift),
        }
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
