//! The input that several benches share.

use std::hint::black_box;

use psd_physics::contact::ContactLaw;
use psd_physics::impact::ImpactInput;
use psd_physics::specimen::Elastic;
use psd_physics::statistics::DeclaredNoise;
use psd_plan::Integrator;

pub const SPECIMEN: Elastic = Elastic { stiffness: 327.65 };
pub const STEPS: u64 = 100_000;

/// Example 1 of the paper with short steps.
pub fn example_1() -> ImpactInput {
    black_box(ImpactInput {
        mass: 1.0,
        damping: 0.0,
        stiffness: SPECIMEN.stiffness,
        striker_mass: 10.0,
        striker_velocity: 1.0,
        gap: 0.0,
        gravity: 0.0,
        time_step: 1e-6,
        max_tangent_ratio: 2.0,
        law: ContactLaw::Rigid,
        integrator: Integrator::Tangent,
        operator_stiffness: SPECIMEN.stiffness,
        i_modification: false,
        noise: DeclaredNoise::NONE,
    })
}
