//! The engine on functions whose uncertainties are known in closed form.

use super::*;
use crate::physics::reintegration::perturbation::ReadingErrors;

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

/// First order, second order, and steps that do not converge.
#[test]
fn the_time_step_contributes_what_finer_steps_leave_out() {
    let of = |errors: [f64; 3]| {
        let [own, half, quarter] = errors.map(|error| 10.0 + error);
        of_finer_steps(own, own, [half, quarter])
    };
    let (first, sure) = of([1.0, 0.5, 0.25]);
    assert!((first - 0.75).abs() < 1e-12 && sure);
    let (second, sure) = of([1.0, 0.25, 0.0625]);
    assert!((second - 0.9375).abs() < 1e-12 && sure);
    let (none, sure) = of([0.0, 0.0, 0.0]);
    assert!(none == 0.0 && sure);
    let (wild, sure) = of([0.1, -0.4, 0.3]);
    assert!((wild - 0.5).abs() < 1e-12 && !sure);
    // A value at the end of a step is off by that too.
    assert!((of_finer_steps(10.5, 10.0, [10.0, 10.0]).0 - 0.5).abs() < 1e-12);
}
