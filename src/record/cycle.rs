//! What a `cycle` records: every reading, and what each cycle came to.

use crate::mechanics::cyclic::Loop;

/// One reading of a cycle: the mean of the samples at a target, or one on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycleStep {
    pub step: u64,
    /// Rig time, s.
    pub wall_time: f64,
    /// From 1; 0 is where the first begins.
    pub cycle: u64,
    /// Asked for, m.
    pub amplitude: f64,
    /// m
    pub command: f64,
    /// Mean of the samples, m.
    pub displacement: f64,
    /// Mean of the samples, N.
    pub restoring_force: f64,
    /// Standard deviation of the samples, N; 0 for one sample.
    pub force_scatter: f64,
    /// First reading after settling less the mean at the end of the pause, N.
    pub relaxation: f64,
    /// ∫R dX from the first reading on, J.
    pub energy: f64,
}

/// One whole cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WholeCycle {
    /// From 1.
    pub cycle: u64,
    /// Asked for, m.
    pub amplitude: f64,
    /// Which of the cycles at this amplitude, from 1.
    pub repeat: u32,
    /// As measured.
    pub found: Loop,
    /// The points at the ends of the loop, (m, N): the leftmost and the rightmost.
    pub ends: [(f64, f64); 2],
}

#[derive(Clone, Debug, Default)]
pub struct CycleHistory {
    /// The first is where the cycles begin.
    pub steps: Vec<CycleStep>,
    pub cycles: Vec<WholeCycle>,
}
