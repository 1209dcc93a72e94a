//! How likely does a beam bend too far when impact speed and mass scatter? `cargo run -p psd-physics --example scattered_impacts`

use psd_physics::contact::Approaching;
use psd_physics::impact::batch::{self, Impact};
use psd_physics::impact::summary::Wanted;
use psd_physics::impact::{ImpactInput, Until};
use psd_physics::specimen::{Elastic, SpecimenModel};
use psd_physics::study::Confidence;
use psd_physics::study::distribution::{Distribution, Spread};
use psd_physics::study::inputs::{Source, StudyInputs};
use psd_physics::study::probability::Outcomes;
use psd_physics::study::sampling::Design;
use psd_physics::study::sensitivity::first_order;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let confidence = Confidence::new(0.95)?;
    let speed = Distribution::normal(1.0, Spread::Sd(0.05))?; // m/s
    let mass = Distribution::lognormal(1.0, Spread::Cv(0.1))?; // kg
    let sources = [speed, mass].map(Source::Distribution).to_vec();
    let inputs = StudyInputs::new(sources, &[], Design::Random, 1)?;

    let (mut values, mut drawn) = (Vec::new(), [Vec::new(), Vec::new()]);
    let mut impacts = Vec::new();
    for run in 0..10_000 {
        inputs.draw(run, &mut values);
        drawn[0].push(values[0]);
        drawn[1].push(values[1]);
        // A striker of 10 kg on a beam of 327.65 N/m, in steps of 1 ms.
        impacts.push(Impact {
            input: ImpactInput::rigid(
                327.65,
                Approaching {
                    mass: values[1],
                    striker_mass: 10.0,
                    velocity: values[0],
                    time_step: 1e-3,
                },
            ),
            specimen: SpecimenModel::Elastic(Elastic { stiffness: 327.65 }),
        });
    }

    let mut outcomes = Outcomes::default();
    let mut displacements = Vec::new();
    for result in batch::run(&impacts, Some(Until::StrikerStop), 3000, Wanted::ALL) {
        let displacement = result?.summary.max_displacement;
        if displacement > 0.18 {
            outcomes.failed += 1;
        } else {
            outcomes.passed += 1;
        }
        displacements.push(displacement);
    }
    let interval = outcomes.interval(confidence);
    println!(
        "bends more than 180 mm: {} of {}, probability {:.4} to {:.4} (95 %)",
        outcomes.failed,
        outcomes.runs(),
        interval.low,
        interval.high
    );
    for (name, values) in ["impact speed", "mass"].into_iter().zip(&drawn) {
        if let Some(index) = first_order::index(values, &displacements, confidence) {
            println!(
                "{name} explains {:.2} of the variance, {:.2} to {:.2}",
                index.value, index.interval.low, index.interval.high
            );
        }
    }
    Ok(())
}
