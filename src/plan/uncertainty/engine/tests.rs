//! The engine on functions whose uncertainties are known in closed form.

use super::*;
use psd_physics::reintegration::perturbation::ReadingErrors;

fn source(index: usize) -> Source {
    Source::StrikerMass(index)
}

/// y(a, b) of the two first sources, from (1, 2), each with its standard uncertainty and within bounds; past `departs` of the first
/// one it departs from its record.
struct Formula {
    y: fn(f64, f64) -> f64,
    u: [f64; 2],
    bounds: [f64; 2],
    departs: f64,
}

impl Evaluate for Formula {
    type Inputs = [f64; 2];

    fn inputs(&self, shifts: Shifts<'_>) -> Result<[f64; 2], String> {
        let mut inputs = [1.0, 2.0];
        for (index, input) in inputs.iter_mut().enumerate() {
            *input += shifts
                .iter()
                .filter(|(moved, _)| *moved == source(index))
                .map(|(_, by)| by * self.u[index])
                .sum::<f64>();
        }
        let within = inputs
            .iter()
            .all(|input| (self.bounds[0]..=self.bounds[1]).contains(input));
        within
            .then_some(inputs)
            .ok_or_else(|| "out of bounds".to_owned())
    }

    fn evaluate(&self, readings: &Perturbation, [a, b]: &[f64; 2]) -> Evaluation {
        let (_, read) = readings.read(1, 0, 1, (0.0, 0.0));
        let before_departure = (*a > self.departs).then(|| vec![f64::NAN]);
        Evaluation {
            values: vec![(self.y)(*a, *b) + read],
            before_departure,
            farthest: 1.0,
        }
    }
}

const ANY: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

fn propagation(evaluate: &Formula, errors: ReadingErrors) -> Result<Vec<Contribution>, String> {
    let instruments = InstrumentUncertainty::exact_but_for(errors);
    let inputs = [0, 1]
        .into_iter()
        .filter(|index| evaluate.u[*index] > 0.0)
        .map(source)
        .collect();
    let propagation = Propagation {
        procedure: ProcedureId(0),
        impact: 0,
        evaluate,
        instruments: &instruments,
        inputs,
        steps: 10,
        reported: None,
        nominal: None,
    };
    match propagation.contributions::<()>(&mut |_, _| Ok(())) {
        Ok(mut found) => Ok(found.remove(0)),
        Err(Unknown::Reason(reason)) => Err(reason),
        Err(Unknown::Ended(())) => panic!("nobody ends it"),
    }
}

/// y = 3a + b², u(a) = 0.1, u(b) = 0.5 at b = 2: half the difference is exact for both; the quadratic to either side
/// differs by 2·0.25 of 2.25, more than a fifth.
#[test]
fn a_study_finds_the_effect_of_each_source() {
    let evaluate = Formula {
        y: |a, b| 3.0 * a + b * b,
        u: [0.1, 0.5],
        bounds: ANY,
        departs: 1.01,
    };
    let found = propagation(&evaluate, ReadingErrors::default()).unwrap();
    assert!(
        (found[0].amount - 0.3).abs() < 1e-12 && !found[0].smooth,
        "where nothing is recorded"
    );
    assert!(
        (found[1].amount - 2.25).abs() < 1e-12 && !found[1].smooth,
        "{found:?}"
    );
}

/// Between bounds that let it go up alone, by a part to either side, and nowhere.
#[test]
fn an_input_is_perturbed_as_far_as_its_bounds_let_it() {
    let of = |u, bounds| {
        propagation(
            &Formula {
                y: |a, _| 3.0 * a,
                u: [u, 0.0],
                bounds,
                departs: f64::INFINITY,
            },
            ReadingErrors::default(),
        )
    };
    for (u, bounds, by_hand) in [(2.0, [0.0, 9.0], 6.0), (3.0, [0.0, 2.0], 9.0)] {
        let part = of(u, bounds).unwrap()[0];
        assert!(
            (part.amount - by_hand).abs() < 1e-12 && part.smooth,
            "{part:?}"
        );
    }
    assert_eq!(of(1e9, [0.0, 2.0]).unwrap_err(), "out of bounds");
}

#[test]
fn trials_come_to_the_errors_of_the_readings() {
    let evaluate = Formula {
        y: |a, _| a,
        u: [0.0; 2],
        bounds: ANY,
        departs: f64::INFINITY,
    };
    let errors = ReadingErrors {
        noise: 0.2,
        ..ReadingErrors::default()
    };
    let found = propagation(&evaluate, errors).unwrap();
    assert_eq!(found.len(), usize::from(MOST_DRAWS));
    assert!((crate::uncertainty::combined(&found).unwrap() - 0.2).abs() < 1e-12);
}

/// First order, second order, no effect, and steps that do not converge.
#[test]
fn effects_of_the_time_step_are_marked_if_the_steps_do_not_converge() {
    let sure = |errors: [f64; 3]| {
        let amounts = Refinement::ALL.into_iter().zip(errors);
        let mut parts: Vec<Contribution> = amounts
            .map(|(steps, error)| Contribution::new(Source::TimeStep(steps), error - errors[0]))
            .collect();
        mark_if_not_converging(10.0, &mut parts);
        assert_eq!(crate::uncertainty::combined(&parts), Some(0.0));
        parts.iter().all(|part| part.smooth)
    };
    assert!(sure([1.0, 0.5, 0.25]));
    assert!(sure([1.0, 0.25, 0.0625]));
    assert!(sure([0.0, 0.0, 0.0]));
    assert!(!sure([0.1, -0.4, 0.3]));
}

/// y = a·e(Δt) with the error e of first order and a of an earlier procedure, 1 in its own steps, 1.5 and 1.75 in finer ones. The value
/// is reported at the end of a step, 0.25 too large.
#[test]
fn finer_steps_are_those_of_every_procedure() {
    struct Stepped;
    impl Evaluate for Stepped {
        type Inputs = f64;

        fn inputs(&self, shifts: Shifts<'_>) -> Result<f64, String> {
            let earlier = |(source, by): &(Source, f64)| match source {
                Source::TimeStep(Refinement::Half) => 0.5 * by,
                Source::TimeStep(Refinement::Quarter) => 0.75 * by,
                _ => 0.0,
            };
            Ok(1.0 + shifts.iter().map(earlier).sum::<f64>())
        }

        fn evaluate(&self, readings: &Perturbation, a: &f64) -> Evaluation {
            let error = 1.0 / f64::from(readings.finer);
            Evaluation {
                farthest: 1.0,
                ..Evaluation::of_readings(vec![a * (1.0 + error)])
            }
        }
    }
    let instruments = InstrumentUncertainty::exact_but_for(ReadingErrors::default());
    let found = |reported| {
        let propagation = Propagation {
            procedure: ProcedureId(1),
            impact: 0,
            evaluate: &Stepped,
            instruments: &instruments,
            inputs: vec![Source::TimeStep(Refinement::Half)],
            steps: 10,
            reported,
            nominal: None,
        };
        let Ok(found) = propagation.contributions::<()>(&mut |_, _| Ok(())) else {
            panic!("not evaluated")
        };
        found[0]
            .iter()
            .map(|part| (part.source, part.amount))
            .collect::<Vec<_>>()
    };
    let of = Source::TimeStep;
    assert_eq!(
        found(Some(vec![2.25])),
        [
            (of(Refinement::Own), -0.25),
            (of(Refinement::Half), 1.5 * 1.5 - 2.25),
            (of(Refinement::Quarter), 1.75 * 1.25 - 2.25)
        ]
    );
    // A procedure without time steps has the effect of its inputs.
    assert_eq!(found(None), [(of(Refinement::Half), 1.5 * 2.0 - 2.0)]);
}
