//! What the tests of this folder share: one plain bench.

use super::{Bench, BenchSettings};
use crate::plan::{Behaviour, Interval};

/// 100 kN/m without noise, −1 … 10 mm, 10 mm/s; 0.01 N a count, 1000 counts at no force.
pub fn bench() -> Bench {
    Bench::new(BenchSettings {
        behaviour: Behaviour::Elastic { stiffness: 1e5 },
        damping: 0.0,
        noise: 0.0,
        resolution: 1e-6,
        newtons_per_count: -0.01,
        zero_count: 1000.0,
        seed: 1,
        limits: Interval { low: -0.001, high: 0.01 },
        top_speed: 0.01,
    })
}
