//! How far an impact reaches: the ranges that limits of a rig bound, and the ends of what may still grow. In: the ends of its steps. Out:
//! numbers.

use crate::impact::{ImpactState, Sink};
use crate::integrator::state::State;

/// Ranges over the steps of an impact on an ideal rig, step 0 included, and its last step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    /// Smallest and largest X \[m\].
    pub displacement: [f64; 2],
    /// Smallest and largest R \[N\].
    pub restoring_force: [f64; 2],
    /// Largest |change of X| in a step \[m\].
    pub increment: f64,
    /// Ẋ at the last step \[m/s\].
    pub last_velocity: f64,
    /// F of the last step \[N\].
    pub last_contact_force: f64,
}

/// Collects the reach, step by step, from rest at X = 0.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ReachBuilder {
    pub reach: Reach,
    last: f64,
}

impl<V> Sink<V> for ReachBuilder {
    fn push(&mut self, _: &State<V>, state: &ImpactState, _: bool) {
        let reach = &mut self.reach;
        let widen = |range: &mut [f64; 2], value: f64| {
            range[0] = if value < range[0] { value } else { range[0] };
            range[1] = if value > range[1] { value } else { range[1] };
        };
        widen(&mut reach.displacement, state.displacement);
        widen(&mut reach.restoring_force, state.restoring_force);
        let increment = (state.displacement - self.last).abs();
        if increment > reach.increment {
            reach.increment = increment;
        }
        reach.last_velocity = state.velocity;
        reach.last_contact_force = state.contact_force;
        self.last = state.displacement;
    }
}
