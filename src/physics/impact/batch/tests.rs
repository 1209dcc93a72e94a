//! Every number of every batched impact is that of the impact alone, bit for bit.

use super::*;
use crate::contact::Approaching;
use crate::specimen::Behaviour;
use crate::study::sampling::philox::{Philox, Purpose};

const STIFFNESS: f64 = 327.65;

/// Impact `run`, its inputs scattered: gaps, falling strikers, dampers, time steps, yielding and not.
fn impact(run: u64, law: ContactLaw, yields: bool) -> Impact {
    let stream = Philox::new(9);
    let between = |input: u32, low: f64, high: f64| {
        low + (high - low) * stream.uniform(Purpose::Value, run, input)
    };
    let sometimes = |input: u32, value: f64| {
        if run.is_multiple_of(3) {
            0.0
        } else {
            value * between(input, 0.5, 1.5)
        }
    };
    let stiffness = STIFFNESS * between(0, 0.8, 1.2);
    let behaviour = if yields {
        Behaviour::Bilinear {
            stiffness,
            yield_force: between(1, 5.0, 60.0),
            post_yield_ratio: between(2, 0.0, 0.3),
        }
    } else {
        Behaviour::Elastic { stiffness }
    };
    let law = match law {
        ContactLaw::Limit { force } => ContactLaw::Limit {
            force: force * between(3, 0.5, 1.5),
        },
        law => law,
    };
    let input = ImpactInput {
        damping: sometimes(4, 2.0),
        gap: sometimes(5, 1e-3),
        gravity: sometimes(6, 9.81),
        law,
        i_modification: run.is_multiple_of(2),
        ..ImpactInput::rigid(
            stiffness,
            Approaching {
                mass: between(7, 0.5, 2.0),
                striker_mass: between(8, 0.5, 20.0),
                velocity: between(9, 0.2, 2.0),
                time_step: between(10, 2e-4, 5e-3),
            },
        )
    };
    Impact {
        input,
        specimen: SpecimenModel::new(&behaviour),
    }
}

/// All numbers of a result as bits.
fn bits(
    Batched {
        summary,
        ending,
        reach,
    }: &Batched,
) -> Vec<Option<u64>> {
    let whole = |number: f64| Some(number.to_bits());
    let flag = |is: bool| Some(u64::from(is));
    vec![
        flag(ending.still_striking),
        flag(ending.touched),
        flag(ending.still_rising),
        flag(ending.speeding_up),
        flag(ending.pushing_harder),
        whole(reach.displacement[0]),
        whole(reach.displacement[1]),
        whole(reach.restoring_force[0]),
        whole(reach.restoring_force[1]),
        whole(reach.increment),
        whole(summary.max_displacement),
        whole(summary.time_of_max_displacement),
        summary.stop_time.map(f64::to_bits),
        whole(summary.final_displacement),
        whole(summary.max_velocity),
        whole(summary.max_contact_force),
        whole(summary.impulse),
        Some(summary.contacts),
        summary.restitution.map(f64::to_bits),
        whole(summary.indentation),
        whole(summary.indentation_energy),
        whole(summary.absorbed_energy),
        whole(summary.striker_energy),
        whole(summary.energy_error),
        flag(summary.still_rising),
        flag(summary.last_contact_cut),
    ]
}

fn compare(impacts: &[Impact], until: Option<Until>, steps: u64) {
    for (impact, batched) in impacts.iter().zip(run(impacts, until, steps, Wanted::ALL)) {
        let alone = impact.run(until, steps).unwrap();
        let batched = batched.unwrap();
        assert_eq!(
            bits(&batched),
            bits(&alone),
            "{impact:?}:\n{batched:?}\n{alone:?}"
        );
    }
}

/// The vectors of this processor, and the narrower ones that it has as well.
#[cfg(target_arch = "x86_64")]
fn levels() -> Vec<Level> {
    let widest = Level::new();
    let narrower = [
        widest.as_sse2().map(Level::Sse2),
        widest.as_sse4_2().map(Level::Sse4_2),
        widest.as_avx2().map(Level::Avx2),
    ];
    narrower.into_iter().flatten().chain([widest]).collect()
}

#[cfg(target_arch = "x86_64")]
#[test]
fn all_vectors_give_the_same_bits() {
    for law in [ContactLaw::Rigid, ContactLaw::Limit { force: 60.0 }] {
        for yields in [false, true] {
            let impacts: Vec<Impact> = (0..40).map(|run| impact(run, law, yields)).collect();
            let results = levels().into_iter().map(|level| {
                let results = run_on(level, &impacts, Some(Until::Duration), 700, Wanted::ALL);
                let bits = |result: &Result<Batched, ImpactError>| bits(result.as_ref().unwrap());
                results.iter().map(bits).collect::<Vec<_>>()
            });
            let results: Vec<_> = results.collect();
            assert!(results.windows(2).all(|two| two[0] == two[1]));
        }
    }
}

#[test]
fn a_batched_impact_is_the_impact_alone() {
    for law in [ContactLaw::Rigid, ContactLaw::Limit { force: 60.0 }] {
        for yields in [false, true] {
            let impacts: Vec<Impact> = (0..150).map(|run| impact(run, law, yields)).collect();
            let mut without_damper_and_weight = impacts.clone();
            for impact in &mut without_damper_and_weight {
                impact.input.damping = 0.0;
                impact.input.gravity = 0.0;
            }
            for until in [None, Some(Until::StrikerStop), Some(Until::Duration)] {
                assert!(impacts.iter().all(|impact| impact.is_batched(until)));
                compare(&impacts, until, 700);
                compare(&without_damper_and_weight, until, 700);
            }
        }
    }
}

/// One of each kind beside each other, more and fewer than the lanes; one that cannot be batched among them, one that has no answer.
#[test]
fn impacts_of_all_kinds_keep_their_order() {
    let laws = [
        ContactLaw::Rigid,
        ContactLaw::Limit { force: 60.0 },
        ContactLaw::Restitution { coefficient: 0.5 },
        ContactLaw::Hertz {
            stiffness: 1e6,
            loss: 0.1,
            force_limit: None,
        },
    ];
    let kind = |run: u64| {
        impact(
            run,
            laws[usize::try_from(run % 4).unwrap()],
            run.is_multiple_of(3),
        )
    };
    for count in [0, 1, 31, 32, 33, 80] {
        let impacts: Vec<Impact> = (0..count).map(kind).collect();
        compare(&impacts, Some(Until::StrikerStop), 300);
        compare(&impacts, Some(Until::Rebound), 300);
    }
    compare(&[impact(1, ContactLaw::Rigid, true)], None, 0);
    let mut massless = impact(1, ContactLaw::Rigid, false);
    massless.input.mass = 0.0;
    let both = [massless.clone(), impact(2, ContactLaw::Rigid, false)];
    let results = run(&both, None, 10, Wanted::ALL);
    assert_eq!(results[0], massless.run(None, 10));
    assert!(results[0].is_err() && results[1].is_ok());
}

#[test]
fn what_has_a_state_or_noise_runs_alone() {
    let plain = impact(1, ContactLaw::Rigid, true);
    let mut noisy = plain.clone();
    noisy.input.noise.force = 1.0;
    let mut explicit = plain.clone();
    explicit.input.integrator = Integrator::Explicit;
    let mut damaged = plain.clone();
    damaged.specimen.move_to(1.0);
    for other in [noisy, explicit, damaged] {
        assert!(!other.is_batched(None));
        assert_eq!(
            run(std::slice::from_ref(&other), None, 50, Wanted::ALL)[0],
            other.run(None, 50)
        );
    }
    assert!(plain.is_batched(None) && !plain.is_batched(Some(Until::Rebound)));
}

/// An elastic impact is linear: its displacements are those for 1 m/s times the impact speed. With a normal impact speed, the probability
/// that it bends too far is in closed form, and the interval of 4096 impacts contains it.
#[test]
fn a_study_of_impacts_recovers_a_known_probability() {
    use crate::study::distribution::{Distribution, Spread, normal};
    use crate::study::inputs::{Source, StudyInputs};
    use crate::study::probability::Outcomes;
    use crate::study::sampling::Design;
    use crate::study::{Confidence, Interval};

    let with_speed = |speed: f64| Impact {
        input: ImpactInput::rigid(
            STIFFNESS,
            Approaching {
                mass: 1.0,
                striker_mass: 10.0,
                velocity: speed,
                time_step: 1e-3,
            },
        ),
        specimen: SpecimenModel::Elastic(Elastic {
            stiffness: STIFFNESS,
        }),
    };
    let until = Some(Until::StrikerStop);
    let farthest = with_speed(1.0)
        .run(until, 1000)
        .unwrap()
        .summary
        .max_displacement;
    let truth = normal::below(-1.5);
    let speed = Distribution::normal(1.0, Spread::Sd(0.05)).unwrap();
    let inputs =
        StudyInputs::new(vec![Source::Distribution(speed)], &[], Design::Random, 1).unwrap();
    let mut values = Vec::new();
    let impacts: Vec<Impact> = (0..4096)
        .map(|run| {
            inputs.draw(run, &mut values);
            with_speed(values[0])
        })
        .collect();
    let mut outcomes = Outcomes::default();
    for result in run(&impacts, until, 1000, Wanted::ALL) {
        // One and a half standard deviations above the mean.
        if result.unwrap().summary.max_displacement > 1.075 * farthest {
            outcomes.failed += 1;
        } else {
            outcomes.passed += 1;
        }
    }
    let interval: Interval = outcomes.interval(Confidence::new(0.95).unwrap());
    assert!(
        interval.contains(truth) && interval.half_width() < 0.01,
        "{interval:?}"
    );
}
