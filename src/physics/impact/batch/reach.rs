//! How far an impact reaches: the ranges that limits of a rig bound. In: the ends of its steps. Out: numbers.

#![allow(
    clippy::inline_always,
    reason = "a part of its caller, which is compiled for several vector units"
)]

use crate::impact::summary::{RunningResults, StepEnd};
use crate::number::{Number, numbers};

/// Ranges over the steps of an impact on an ideal rig, step 0 included.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    /// Smallest and largest X \[m\].
    pub displacement: [f64; 2],
    /// Smallest and largest R \[N\].
    pub restoring_force: [f64; 2],
    /// Largest |change of X| in a step \[m\].
    pub increment: f64,
}

numbers! {
    /// The reach so far, beside the largest displacement.
    pub(super) struct RunningReach {
        least_displacement,
        least_force,
        largest_force,
        largest_increment,
    }
}

impl RunningReach {
    /// At rest at X = 0.
    pub const START: Self = Self {
        least_displacement: 0.0,
        least_force: 0.0,
        largest_force: 0.0,
        largest_increment: 0.0,
    };

    pub fn finish(&self, results: &RunningResults) -> Reach {
        Reach {
            displacement: [self.least_displacement, results.max_displacement],
            restoring_force: [self.least_force, self.largest_force],
            increment: self.largest_increment,
        }
    }
}

impl<N: Number> RunningReach<N> {
    /// Adds the end of a step that began at the displacement `before`.
    #[inline(always)]
    pub fn add(&mut self, before: N, end: &StepEnd<N>) {
        let increment = (end.displacement - before).abs();
        self.least_displacement = self.least_displacement.smaller(end.displacement);
        self.least_force = self.least_force.smaller(end.restoring_force);
        self.largest_force = self.largest_force.larger(end.restoring_force);
        self.largest_increment = self.largest_increment.larger(increment);
    }
}
