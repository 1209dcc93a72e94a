//! Cost of a step: example 1 at 1 µs for 100,000 steps, bare, recorded, and step by step as with a rig; and a study of 10,000 impacts
//! with 3000 steps each. Items are steps.

mod common;

use common::{SPECIMEN, STEPS, example_1};
use divan::Bencher;
use divan::counter::ItemsCount;
use psd_physics::impact::batch::{self, Impact};
use psd_physics::impact::{ImpactInput, ImpactSolver, StepRow, Until, simulate};
use psd_physics::specimen::{RestoringForce, SpecimenModel};

fn main() {
    divan::main();
}

#[divan::bench]
fn bare(bencher: Bencher) {
    let input = example_1();
    bencher
        .counter(ItemsCount::new(STEPS))
        .bench_local(|| simulate(&input, &mut { SPECIMEN }, None, STEPS, &mut ()));
}

/// Into reused memory: it is allocated in the first run.
#[divan::bench]
fn recorded(bencher: Bencher) {
    let input = example_1();
    let mut rows: Vec<StepRow> = Vec::new();
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        rows.clear();
        simulate(&input, &mut { SPECIMEN }, None, STEPS, &mut rows)
    });
}

/// The caller supplies the reading.
#[divan::bench]
fn interactive(bencher: Bencher) {
    let input = example_1();
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        let mut specimen = SPECIMEN;
        let mut solver = ImpactSolver::new(&input, 0.0, specimen.move_to(0.0)).expect("an impact");
        for _ in 0..STEPS {
            let displacement = solver.predict();
            solver.complete(displacement, specimen.move_to(displacement));
        }
        *solver.state()
    });
}

/// Scattered impact speeds, in lanes.
#[divan::bench]
fn study(bencher: Bencher) {
    const RUNS: u32 = 10_000;
    const STEPS: u64 = 3000;
    let impacts: Vec<Impact> = (0..RUNS)
        .map(|run| Impact {
            input: ImpactInput {
                striker_velocity: 1.0 + 1e-5 * f64::from(run),
                time_step: 1e-4,
                ..example_1()
            },
            specimen: SpecimenModel::Elastic(SPECIMEN),
        })
        .collect();
    bencher
        .counter(ItemsCount::new(u64::from(RUNS) * STEPS))
        .bench_local(|| batch::run(&impacts, Some(Until::Duration), STEPS));
}
