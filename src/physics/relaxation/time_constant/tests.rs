//! The fit of one time constant: exact without noise, its standard errors those of many fits, none if nothing relaxes.

use super::{RelaxationFit, RelaxationModel};
use crate::identification::StatedVariance;
use crate::relaxation::hold::{Hold, Unrelaxed};
use crate::relaxation::maxwell::{MaxwellBranch, Motion};
use crate::statistics::testing::normal;

/// Of readings without stated errors.
fn fit_relaxation(
    holds: &[Hold],
    start: f64,
    model: RelaxationModel,
) -> Result<RelaxationFit, Unrelaxed> {
    super::fit_relaxation(holds, start, model, StatedVariance::default())
}

const BOTH: [RelaxationModel; 2] = [
    RelaxationModel::Exponential,
    RelaxationModel::StandardLinearSolid,
];
/// 300 kN/m, in parallel with 200 kN/m that relax with 1.5 s; 12 N at zero displacement.
const K: f64 = 3e5;
const K1: f64 = 2e5;
const TAU: f64 = 1.5;

/// Eight dwells of `pause` \[s\] every 1 mm, reached in 0.5 s, with twenty readings each, closer together at first.
fn holds(stiffness: f64, pause: f64, noise: &mut dyn FnMut() -> f64) -> Vec<Hold> {
    let mut branch = MaxwellBranch::new(stiffness, TAU);
    (1_u32..=8)
        .map(|step| {
            let displacement = 1e-3 * f64::from(step);
            branch.follow(&Motion::even(2e-3, 0.5));
            let begins = branch.force();
            let reading = |index: u32| {
                let time = pause * (f64::from(index) / 20.0).powi(2);
                (
                    time,
                    12.0 + K * displacement + begins * (-time / TAU).exp() + noise(),
                )
            };
            let readings = (0..=20).map(reading).collect();
            branch.follow(&Motion::rest(pause));
            Hold {
                step: u64::from(step),
                displacement,
                waited_for: 0.0,
                moved_for: 0.5,
                settled_for: 0.0,
                readings,
            }
        })
        .collect()
}

fn by_hand(pause: f64) -> Vec<f64> {
    let gained = K1 * 2e-3 * TAU * (1.0 - f64::exp(-0.5 / TAU));
    let mut q = 0.0;
    (0..8)
        .map(|_| {
            q = q * f64::exp(-(pause + 0.5) / TAU) + gained;
            q
        })
        .collect()
}

#[test]
fn without_noise_the_parameters_are_exact() {
    let pause = 2.0;
    for model in BOTH {
        let fit = fit_relaxation(&holds(K1, pause, &mut || 0.0), 0.0, model).expect("it relaxes");
        assert!(
            (fit.time_constant.0 / TAU - 1.0).abs() < 1e-7,
            "{model:?}: {:?}",
            fit.time_constant
        );
        for ([relaxed, amplitude], (step, exact)) in fit.holds.iter().zip((1..).zip(by_hand(pause)))
        {
            assert!(
                (amplitude - exact).abs() < 1e-4,
                "{amplitude} N is not {exact} N"
            );
            assert!((relaxed - 12.0 - K * 1e-3 * f64::from(step)).abs() < 1e-4);
        }
        assert!((fit.relaxed_stiffness.unwrap().0 / K - 1.0).abs() < 1e-7);
        let last = by_hand(pause)[7];
        assert!((fit.remaining.0 - last * f64::exp(-pause / TAU)).abs() < 1e-4);
        assert!((fit.required_pause(1.0).0 - TAU * last.ln()).abs() < 1e-5);
        assert_eq!(
            fit.required_pause(2.0 * last),
            (0.0, 0.0),
            "no pause at all"
        );
        let [relaxed, amplitude] = fit.holds[7];
        let force = relaxed + amplitude * f64::exp(-0.7 / fit.time_constant.0);
        assert!((force - 12.0 - K * 8e-3 - last * f64::exp(-0.7 / TAU)).abs() < 1e-4);
    }
    let fit = fit_relaxation(
        &holds(K1, pause, &mut || 0.0),
        0.0,
        RelaxationModel::StandardLinearSolid,
    )
    .unwrap();
    assert!((fit.branch_stiffness.unwrap().0 / K1 - 1.0).abs() < 1e-7);
}

type Read = fn(&RelaxationFit) -> (f64, f64);

/// The standard deviation of 300 fits is the standard error that each states, and twice that error covers the value in 95 of 100.
#[test]
fn the_standard_errors_are_the_scatter_of_many_fits() {
    let last = by_hand(2.0)[7];
    let (left, needed) = (last * f64::exp(-2.0 / TAU), TAU * (last / 10.0).ln());
    let readings: [(Read, f64); 5] = [
        (|fit| fit.time_constant, TAU),
        (|fit| fit.relaxed_stiffness.unwrap(), K),
        (|fit| fit.required_pause(10.0), needed),
        (|fit| fit.remaining, left),
        (|fit| fit.branch_stiffness.unwrap(), K1),
    ];
    for model in BOTH {
        let mut state = 21;
        let fits: Vec<RelaxationFit> = (0..300)
            .map(|_| {
                fit_relaxation(
                    &holds(K1, 2.0, &mut || 5.0 * normal(&mut state)),
                    0.0,
                    model,
                )
                .expect("it relaxes")
            })
            .collect();
        let results = if model == RelaxationModel::Exponential {
            2
        } else {
            5
        };
        for (index, (read, exact)) in readings.into_iter().enumerate().take(results) {
            let values: Vec<(f64, f64)> = fits.iter().map(read).collect();
            let mean = values.iter().map(|(value, _)| value).sum::<f64>() / 300.0;
            let deviation = (values
                .iter()
                .map(|(value, _)| (value - mean).powi(2))
                .sum::<f64>()
                / 299.0)
                .sqrt();
            let stated =
                (values.iter().map(|(_, error)| error.powi(2)).sum::<f64>() / 300.0).sqrt();
            // The standard deviation of 300 fits has a relative uncertainty of 4.1 %.
            assert!(
                (deviation / stated - 1.0).abs() < 0.13,
                "{model:?} {index}: {deviation} is stated as {stated}"
            );
            assert!(
                (mean - exact).abs() < 4.0 * deviation / 300_f64.sqrt(),
                "{model:?} {index}: {mean} is not {exact}"
            );
            let covered = values
                .iter()
                .filter(|(value, error)| (value - exact).abs() < 2.0 * error)
                .count();
            // 286 by the normal distribution; three binomial deviations are 11.
            assert!(
                (272..=298).contains(&covered),
                "{model:?} {index}: covered {covered} times of 300"
            );
        }
    }
}

/// A single hold determines its amplitude, the error of it, and its covariance with τ.
#[test]
fn one_hold_is_enough() {
    let mut state = 4;
    let mut one = || {
        let all = holds(K1, 4.0, &mut || 5.0 * normal(&mut state));
        fit_relaxation(&all[..1], 0.0, RelaxationModel::Exponential).expect("it relaxes")
    };
    let fits: Vec<RelaxationFit> = (0..400).map(|_| one()).collect();
    let first = by_hand(4.0)[0];
    let readings: [(Read, f64); 4] = [
        (|fit| fit.time_constant, TAU),
        (|fit| (fit.worst.force, fit.worst.error), first),
        (|fit| fit.remaining, first * f64::exp(-4.0 / TAU)),
        (|fit| fit.required_pause(10.0), TAU * (first / 10.0).ln()),
    ];
    for (index, (read, exact)) in readings.into_iter().enumerate() {
        let values: Vec<(f64, f64)> = fits.iter().map(read).collect();
        let mean = values.iter().map(|(value, _)| value).sum::<f64>() / 400.0;
        let deviation = (values
            .iter()
            .map(|(value, _)| (value - mean).powi(2))
            .sum::<f64>()
            / 399.0)
            .sqrt();
        let stated = (values.iter().map(|(_, error)| error.powi(2)).sum::<f64>() / 400.0).sqrt();
        assert!(
            (deviation / stated - 1.0).abs() < 0.12,
            "{index}: {deviation} is stated as {stated}"
        );
        // The distribution of a time constant is not quite normal: its bias is of the order of its squared error.
        assert!(
            (mean - exact).abs() < 0.3 * deviation,
            "{index}: {mean} is not {exact}"
        );
    }
}

#[test]
fn a_steady_force_and_an_unresolved_time_have_no_fit() {
    let mut state = 8;
    for model in BOTH {
        assert_eq!(
            fit_relaxation(&holds(0.0, 2.0, &mut || 0.0), 0.0, model),
            Err(Unrelaxed::Steady)
        );
        let noisy = (0..50).filter(|_| {
            let quiet = holds(0.0, 2.0, &mut || 5.0 * normal(&mut state));
            fit_relaxation(&quiet, 0.0, model) != Err(Unrelaxed::Steady)
        });
        assert!(noisy.count() <= 4, "{model:?} sees relaxation in noise");
        let short: Vec<Hold> = holds(K1, 2.0, &mut || 0.0)
            .into_iter()
            .map(|hold| Hold {
                readings: hold.readings[..2].to_vec(),
                ..hold
            })
            .collect();
        assert_eq!(
            fit_relaxation(&short[..1], 0.0, model),
            Err(Unrelaxed::TooFew)
        );
        assert_eq!(fit_relaxation(&[], 0.0, model), Err(Unrelaxed::TooFew));
        // A continuing drift: slower than thirty times the dwell.
        let drift: Vec<Hold> = holds(0.0, 2.0, &mut || 0.0)
            .into_iter()
            .map(|hold| Hold {
                readings: hold
                    .readings
                    .iter()
                    .map(|(time, force)| (*time, force - 3.0 * time))
                    .collect(),
                ..hold
            })
            .collect();
        assert!(
            model == RelaxationModel::StandardLinearSolid
                || fit_relaxation(&drift, 0.0, model) == Err(Unrelaxed::OutOfReach)
        );
    }
}
