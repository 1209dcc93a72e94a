//! The emulated rig for the tests of firmware: a spring, without noise and quantization.

use crate::emulator::{EmulatedRig, EmulatedRigSettings};
use psd_plan::{Behaviour, Interval};

/// 100 kN/m, −20 … 60 mm, 50 mm/s at most.
pub fn spring() -> EmulatedRig {
    EmulatedRig::new(EmulatedRigSettings {
        behaviour: Behaviour::Elastic { stiffness: 1e5 },
        damping: 0.0,
        noise: 0.0,
        resolution: 0.0,
        newtons_per_count: 0.01,
        zero_offset: 0.0,
        seed: 1,
        limits: Interval {
            low: -0.02,
            high: 0.06,
        },
        top_speed: 0.05,
    })
}
