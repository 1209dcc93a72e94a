//! Random choices of a case. In: a seed. Out: the same choices for the same seed.

use rand::RngExt as _;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng as _;

pub(super) struct Draw(Pcg64);

impl Draw {
    pub(super) fn of_seed(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    pub(super) fn chance(&mut self, probability: f64) -> bool {
        self.0.random::<f64>() < probability
    }

    /// From `low` up to below `high`.
    pub(super) fn between(&mut self, low: u32, high: u32) -> u32 {
        self.0.random_range(low..high)
    }

    /// From 0 up to below `count`.
    pub(super) fn below(&mut self, count: usize) -> usize {
        self.0.random_range(0..count)
    }

    /// Mostly none, seldom two.
    pub(super) fn few(&mut self) -> u32 {
        [0, 0, 0, 1, 1, 2][self.below(6)]
    }

    pub(super) fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }
}
