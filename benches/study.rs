//! Runs of a study: bound and simulated, in batches and one by one, and the share of the binding. The goal is runs per second on one core.

use psd::check::binding::{Binder, BoundInputs};
use psd::check::{Options, ParsedPlan, no_files};
use psd::study::definition::Definition;
use psd::study::simulation::Simulation;
use psd_plan::Plan;

fn main() {
    divan::main();
}

const PLAN: &str = "param speed = 1 m/s\n\
    specimen beam { mass = 1 kg\nbehaviour = elastic(stiffness: 300 N/m) }\n\
    striker hammer { mass = 10 kg\nvelocity = speed }\n\
    impact hit { striker = hammer\nduration = 1 s\ntime_step = 2 ms }\n\
    study scatter { vary = [speed ~ normal(sd: 0.05 m/s), beam.mass ~ lognormal(cv: 2 %)] }\n\
    require \"stays in travel\" hit.max_displacement < 0.2 m\n";

fn checked(text: &str) -> (ParsedPlan, Plan, Definition) {
    let mut parsed = ParsedPlan::parse("study.psd", text, &no_files, &Options::default());
    let plan = parsed.check(&no_files).plan.expect("a sound plan");
    let study = Definition::of(&plan.studies, None, None).expect("one study");
    (parsed, plan, study)
}

/// Impacts of about 3000 steps of 0.1 ms, with or without a peak until the end of this duration.
fn of_3000_steps(bencher: divan::Bencher, duration: &str) {
    let text = PLAN
        .replace("duration = 1 s", duration)
        .replace("time_step = 2 ms", "time_step = 0.1 ms");
    let (parsed, plan, study) = checked(&text);
    let simulation = Simulation::new(&parsed, &plan, &study);
    let rows = simulation.block(0..1024);
    let missing = rows.iter().filter(|row| row.results[0].is_none()).count();
    println!("{missing} of 1024 runs have no peak");
    bencher
        .counter(divan::counter::ItemsCount::new(1024_u32))
        .bench_local(|| simulation.block(0..1024));
}

#[divan::bench]
fn all_with_a_peak(bencher: divan::Bencher) {
    of_3000_steps(bencher, "duration = 0.4 s");
}

#[divan::bench]
fn many_without_a_peak(bencher: divan::Bencher) {
    of_3000_steps(bencher, "duration = 0.2945 s");
}

#[divan::bench]
fn in_batches(bencher: divan::Bencher) {
    let (parsed, plan, study) = checked(PLAN);
    let simulation = Simulation::new(&parsed, &plan, &study);
    assert!(simulation.is_batched());
    bencher
        .counter(divan::counter::ItemsCount::new(1024_u32))
        .bench_local(|| simulation.block(0..1024));
}

#[divan::bench]
fn one_by_one(bencher: divan::Bencher) {
    let (parsed, plan, study) = checked(PLAN);
    let simulation = Simulation::new(&parsed, &plan, &study).one_by_one();
    bencher
        .counter(divan::counter::ItemsCount::new(64_u32))
        .bench_local(|| simulation.block(0..64));
}

#[divan::bench]
fn binding_alone(bencher: divan::Bencher) {
    let (parsed, _, study) = checked(PLAN);
    let inputs = study.inputs.iter();
    let inputs = BoundInputs::new(
        &parsed,
        inputs.map(|input| (input.name.as_str(), input.dimension)),
    );
    let mut binder = Binder::new(&parsed, &inputs);
    bencher.bench_local(|| binder.bind(&[1.1, 1.01]).is_ok());
}
