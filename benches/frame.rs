//! Cost of a step of a shear building of n storeys with Rayleigh damping under a ground motion. The step includes specimen and
//! energy balance. Items are steps. The goals for n = 10, 100, 1000 are multiples of OpenSees: 60, 80 and 100 elastic, and 30,
//! 25 and 25 bilinear.

use std::hint::black_box;

use divan::Bencher;
use divan::counter::ItemsCount;
use psd_physics::integrator::input::FrameInput;
use psd_physics::integrator::solver::FrameSolver;
use psd_physics::integrator::tangents::Tangents;
use psd_physics::specimen::{Bilinear, BilinearCurve, Elastic, RestoringForce};
use psd_physics::statistics::DeclaredNoise;
use psd_physics::structure::{
    FrameMatrices, SymmetricBand, drifts, floor_forces, storey_stiffness,
};
use psd_plan::Integrator;

const STOREYS: [usize; 5] = [1, 2, 10, 100, 1000];
const STIFFNESS: f64 = 2e6;
const TANGENT: Integrator = Integrator::Tangent;
const SECANTS: Tangents = Tangents::Storeys { largest_ratio: 2.0 };

fn main() {
    divan::main();
}

/// Storeys of 1500 kg and 2 MN/m, C = 0.5 M + 0.0005 K.
fn building(storeys: usize) -> FrameMatrices {
    let mass = SymmetricBand::diagonal(&vec![1500.0; storeys]);
    let stiffness = storey_stiffness(&vec![STIFFNESS; storeys]);
    let mut damping = SymmetricBand::zero(storeys, 0);
    damping.add(&mass, 0.5);
    damping.add(&stiffness, 5e-4);
    black_box(FrameMatrices {
        mass,
        damping,
        stiffness,
    })
}

/// The run continues from one measurement to the next: 10 m/s² at 2 Hz, steps of 2 ms.
fn steps<S: RestoringForce + Copy>(
    bencher: Bencher,
    storeys: usize,
    integrator: Integrator,
    tangents: Tangents,
    storey: S,
) {
    let matrices = building(storeys);
    let zero = vec![0.0; storeys];
    let input = FrameInput {
        matrices: &matrices,
        operator_stiffness: &matrices.stiffness,
        integrator,
        i_modification: false,
        tangents,
        time_step: 2e-3,
        initial_displacement: &zero,
        initial_restoring_force: &zero,
        initial_load: &zero,
        noise: DeclaredNoise::NONE,
    };
    let mut solver = FrameSolver::new(&input).expect("a building");
    let mut specimen = vec![storey; storeys];
    let (mut load, mut drift, mut force) = (zero.clone(), zero.clone(), zero.clone());
    let (mut shear, mut target) = (zero.clone(), zero.clone());
    let count = u32::try_from(100_000 / (storeys + 100)).expect("small");
    let mut done = 0_u32;
    bencher.counter(ItemsCount::new(count)).bench_local(|| {
        for _ in 0..count {
            done += 1;
            matrices.ground_load(10.0 * (f64::from(done) * 0.025).sin(), &mut load);
            target.copy_from_slice(solver.predict(&load));
            drifts(&target, &mut drift);
            for ((shear, drift), storey) in shear.iter_mut().zip(&drift).zip(&mut specimen) {
                *shear = storey.move_to(*drift);
            }
            floor_forces(&shear, &mut force);
            solver.complete(&target, &force);
        }
        solver.state().displacement[0]
    });
}

#[divan::bench(args = STOREYS)]
fn elastic(bencher: Bencher, storeys: usize) {
    steps(
        bencher,
        storeys,
        TANGENT,
        Tangents::Initial,
        Elastic {
            stiffness: STIFFNESS,
        },
    );
}

#[divan::bench(args = STOREYS)]
fn elastic_followed(bencher: Bencher, storeys: usize) {
    steps(
        bencher,
        storeys,
        TANGENT,
        SECANTS,
        Elastic {
            stiffness: STIFFNESS,
        },
    );
}

/// Yields at a storey drift of 10 mm.
#[divan::bench(args = STOREYS)]
fn bilinear(bencher: Bencher, storeys: usize) {
    steps(
        bencher,
        storeys,
        TANGENT,
        SECANTS,
        Bilinear::new(BilinearCurve {
            stiffness: STIFFNESS,
            yield_force: 2e4,
            post_yield_ratio: 0.05,
        }),
    );
}

#[divan::bench(args = STOREYS)]
fn explicit(bencher: Bencher, storeys: usize) {
    steps(
        bencher,
        storeys,
        Integrator::Explicit,
        Tangents::Initial,
        Elastic {
            stiffness: STIFFNESS,
        },
    );
}

#[divan::bench(args = STOREYS)]
fn alpha_os(bencher: Bencher, storeys: usize) {
    steps(
        bencher,
        storeys,
        Integrator::AlphaOs { alpha: -0.05 },
        Tangents::Initial,
        Elastic {
            stiffness: STIFFNESS,
        },
    );
}
