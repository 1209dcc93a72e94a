//! The results of a ground-motion test: peaks of every floor and storey, collected step by step. In: the ends of steps. Out: results in
//! the schema's order. It moves nothing.

use crate::procedures::frame::results::largest_forces;
use crate::procedures::stepping::tracking::TrackingSummary;
use psd_physics::integrator::state::FrameState;
use psd_physics::statistics::noisy_largest::NoisyLargest;
use psd_physics::structure::elements::{ElementReading, member_drifts};
use psd_physics::structure::{Modes, widen};
use psd_plan::procedures::shake::block as schema;
use psd_plan::record::NamedResult;
use psd_plan::schema::ResultKind;

/// Peaks over the computed displacements and the measured forces.
pub(crate) struct ShakeSummary {
    max_displacement: Vec<f64>,
    max_drift: Vec<f64>,
    drift: Vec<f64>,
    /// Of each element of a frame of matrices.
    element_force: Vec<NoisyLargest>,
    base_shear: NoisyLargest,
    /// Largest input or kinetic energy \[J\].
    largest_energy: f64,
    energy_error: f64,
    steps: u64,
}

impl ShakeSummary {
    /// `noise`: standard deviation of the measured base shear \[N\]; `of_elements`: of the measured force of each element.
    pub(crate) fn new(floors: usize, noise: f64, of_elements: &[f64]) -> Self {
        let members = if of_elements.is_empty() {
            floors
        } else {
            of_elements.len()
        };
        Self {
            max_displacement: vec![0.0; floors],
            max_drift: vec![0.0; members],
            drift: vec![0.0; members],
            element_force: NoisyLargest::of_each(of_elements),
            base_shear: NoisyLargest::new(noise),
            largest_energy: 0.0,
            energy_error: 0.0,
            steps: 0,
        }
    }

    /// Adds the end of a step.
    pub(crate) fn push(&mut self, state: &FrameState) {
        state.drifts(&mut self.drift);
        self.widen(&state.displacement, &state.elements, state.base_shear());
        let e = &state.energies;
        self.largest_energy = self
            .largest_energy
            .max((e.input + e.gravity).abs())
            .max(e.kinetic);
        self.energy_error = if e.error == 0.0 {
            0.0
        } else {
            e.error / self.largest_energy
        };
        self.steps = state.step;
    }

    /// Adds displacements of the floors \[m\] on the way to a target that was not reached, the elements there and the base shear \[N\].
    pub(crate) fn cut_off(
        &mut self,
        displacement: &[f64],
        elements: &[ElementReading],
        base_shear: f64,
    ) {
        member_drifts(displacement, elements, &mut self.drift);
        self.widen(displacement, elements, base_shear);
    }

    fn widen(&mut self, displacement: &[f64], elements: &[ElementReading], base_shear: f64) {
        widen(&mut self.max_displacement, displacement);
        widen(&mut self.max_drift, &self.drift);
        for (largest, element) in self.element_force.iter_mut().zip(elements) {
            largest.push(element.force.abs());
        }
        self.base_shear.push(base_shear.abs());
    }

    /// Drifts of the storeys, or deformations of the elements, at the end of the last step \[m\].
    pub(crate) fn drift(&self) -> &[f64] {
        &self.drift
    }

    /// Error of the energy balance, over the largest energy.
    pub(crate) const fn energy_error(&self) -> f64 {
        self.energy_error
    }

    /// \[J\]
    pub(crate) const fn largest_energy(&self) -> f64 {
        self.largest_energy
    }
}

/// In the order of the reference; a result that was not reached is missing.
pub(crate) fn results(
    modes: Option<&Modes>,
    summary: Option<&ShakeSummary>,
    followed: &TrackingSummary,
) -> Vec<NamedResult> {
    let list = |kind: ResultKind, read: fn(&ShakeSummary) -> &[f64]| {
        kind.found_list(summary.map(|summary| read(summary).to_vec()))
    };
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
    let steps = summary.map(|summary| summary.steps as f64);
    let mut results = vec![
        list(schema::MAX_DISPLACEMENT, |it| &it.max_displacement),
        list(schema::MAX_DRIFT, |it| &it.max_drift),
        list(schema::FINAL_DRIFT, |it| &it.drift),
        schema::PERIODS.found_list(modes.map(|modes| modes.periods.clone())),
        schema::MAX_BASE_SHEAR.found(summary.and_then(|summary| summary.base_shear.value())),
        schema::ENERGY_ERROR.found(summary.map(|summary| summary.energy_error)),
        schema::STEPS.found(steps),
    ];
    let forces = summary.and_then(|summary| largest_forces(&summary.element_force));
    results.extend(forces.map(|forces| schema::MAX_ELEMENT_FORCE.found_list(Some(forces))));
    results.extend(followed.of_all());
    results.extend(followed.of_each());
    results
}
