//! The choice between two laws of relaxation: the right one from noisy readings, its parameters within their standard errors, and
//! none if nothing relaxes.

use super::{LawFit, SuperpositionFit};
use crate::identification::StatedVariance;
use crate::relaxation::hold::{Hold, Unrelaxed};
use crate::relaxation::law::RelaxationLaw;
use crate::relaxation::law::RelaxationLaw::{Exponential, Logarithmic};
use crate::statistics::least_squares::FitSize;
use crate::statistics::testing::normal;

/// Of readings without stated errors.
fn fit_superposition(
    holds: &[Hold],
    before: f64,
    asked: Option<RelaxationLaw>,
    rate: f64,
) -> Result<SuperpositionFit, Unrelaxed> {
    super::fit_superposition(holds, before, asked, rate, StatedVariance::default())
}

/// N/s, at the end of a pause.
const SLOW: f64 = 2.0;
const PAUSE: f64 = 6.0;
const MOVED_FOR: f64 = 0.5;
/// Forces without relaxation: elastic increments, then yielding ones, from 12 N.
const BEFORE: f64 = 12.0;
const REACHED: [f64; 6] = [2000.0, 4000.0, 6000.0, 7000.0, 7200.0, 7300.0];

/// Share and time of each law: either loses some 200 N of the first force in a pause.
const fn parameters(law: RelaxationLaw) -> (f64, f64) {
    match law {
        Exponential => (0.04, 1.5),
        Logarithmic => (0.012, 0.3),
    }
}

/// By the definition: every move brings its force in 400 small increments, each of which relaxes separately.
fn holds(law: RelaxationLaw, readings: u32) -> Vec<Hold> {
    holds_with(law, parameters(law), readings)
}

fn holds_with(law: RelaxationLaw, (share, time): (f64, f64), readings: u32) -> Vec<Hold> {
    let instant = |t: f64| match law {
        Exponential => 1.0 - (-t / time).exp(),
        Logarithmic => (1.0 + t / time).ln(),
    };
    let began = |hold: usize| f64::from(u32::try_from(hold).unwrap()) * (MOVED_FOR + PAUSE);
    let lost = |now: f64, upto: usize| {
        let increment = |step: usize| {
            let force = REACHED[step] - if step == 0 { BEFORE } else { REACHED[step - 1] };
            let parts = (0..400).map(|part| {
                instant(now - began(step) - MOVED_FOR * (f64::from(part) + 0.5) / 400.0)
            });
            force * parts.sum::<f64>() / 400.0
        };
        share * (0..=upto).map(increment).sum::<f64>()
    };
    let hold = |index: usize| {
        let reading = |number: u32| {
            let seconds = PAUSE * (f64::from(number) / f64::from(readings)).powi(2);
            (
                seconds,
                REACHED[index] - lost(began(index) + MOVED_FOR + seconds, index),
            )
        };
        Hold {
            step: index as u64 + 1,
            displacement: 0.0,
            waited_for: 0.0,
            moved_for: MOVED_FOR,
            settled_for: 0.0,
            readings: (0..=readings).map(reading).collect(),
        }
    };
    (0..REACHED.len()).map(hold).collect()
}

fn noisy(exact: &[Hold], size: f64, state: &mut u64) -> Vec<Hold> {
    let mut holds = exact.to_vec();
    holds
        .iter_mut()
        .flat_map(|hold| &mut hold.readings)
        .for_each(|(_, force)| *force += size * normal(state));
    holds
}

#[test]
fn without_noise_the_law_and_its_parameters_are_exact() {
    for law in RelaxationLaw::BOTH {
        let found = fit_superposition(&holds(law, 20), BEFORE, None, SLOW).expect("it relaxes");
        let (fit, (share, time)) = (found.best(), parameters(law));
        assert_eq!(fit.law, law);
        assert!(
            (fit.share.0 / share - 1.0).abs() < 1e-4 && (fit.time.0 / time - 1.0).abs() < 1e-4,
            "{:?} {:?}",
            fit.share,
            fit.time
        );
        for (found, exact) in fit.reached.iter().zip(REACHED) {
            assert!((found - exact).abs() < 0.01, "{found} N is not {exact} N");
        }
        let margin = found.margin().expect("both were fitted");
        assert!(
            if law == Logarithmic {
                margin > 500.0
            } else {
                margin < -500.0
            },
            "{margin}"
        );
        let alone = fit_superposition(&holds(law, 20), BEFORE, Some(law), SLOW).unwrap();
        assert_eq!((alone.fits.len(), alone.margin()), (1, None));
        assert_eq!(alone.best(), fit);
    }
}

/// One instantaneous increment of 2000 N: rate and required dwell in closed form.
#[test]
fn the_required_pause_is_the_closed_form() {
    for law in RelaxationLaw::BOTH {
        let (share, time) = parameters(law);
        let lost = |t: f64| {
            if law == Exponential {
                1.0 - f64::exp(-t / time)
            } else {
                f64::ln(1.0 + t / time)
            }
        };
        let reading = |number: u32| {
            let seconds = PAUSE * (f64::from(number) / 20.0).powi(2);
            (seconds, 2000.0 * (1.0 - share * lost(seconds)))
        };
        let one = [Hold {
            step: 1,
            displacement: 0.0,
            waited_for: 0.0,
            moved_for: 0.0,
            settled_for: 0.0,
            readings: (0..=20).map(reading).collect(),
        }];
        let found = fit_superposition(&one, 0.0, None, SLOW).expect("it relaxes");
        let fit = found.best();
        let (rate, needed) = match law {
            Exponential => (
                2000.0 * share / time * f64::exp(-PAUSE / time),
                time * f64::ln(2000.0 * share / time / SLOW),
            ),
            Logarithmic => (
                2000.0 * share / (time + PAUSE),
                2000.0 * share / SLOW - time,
            ),
        };
        assert_eq!(fit.law, law);
        assert!(
            (fit.rate.0 / rate - 1.0).abs() < 1e-5,
            "{:?} N/s is not {rate} N/s",
            fit.rate
        );
        assert!(
            (fit.required_pause.0 / needed - 1.0).abs() < 1e-5,
            "{:?} s is not {needed} s",
            fit.required_pause
        );
        let remaining = (law == Exponential).then(|| 2000.0 * share * f64::exp(-PAUSE / time));
        assert_eq!(fit.remaining.is_some(), remaining.is_some());
        assert!(
            fit.remaining
                .zip(remaining)
                .is_none_or(|((found, _), exact)| (found / exact - 1.0).abs() < 1e-4)
        );
        assert!((fit.force(0, 2.5).unwrap() - 2000.0 * (1.0 - share * lost(2.5))).abs() < 1e-3);
        let calm = fit_superposition(&one, 0.0, None, 1e6).unwrap();
        assert_eq!(calm.best().required_pause, (0.0, 0.0), "no pause at all");
    }
}

type Read = fn(&LawFit) -> (f64, f64);

/// 120 series of readings by each law with a noise of 4 N: the right law is chosen in nearly all, the standard deviation of its
/// results is the stated error, and twice that error covers the exact value in about 95 of 100.
#[test]
fn the_right_law_is_chosen_from_noisy_readings_and_its_errors_are_their_scatter() {
    const RUNS: u32 = 120;
    let read: [Read; 4] = [
        |fit| fit.share,
        |fit| fit.time,
        |fit| fit.rate,
        |fit| fit.required_pause,
    ];
    for law in RelaxationLaw::BOTH {
        let exact = holds(law, 20);
        let noiseless = fit_superposition(&exact, BEFORE, Some(law), SLOW).unwrap();
        let mut state = 77;
        let found: Vec<_> = (0..RUNS)
            .map(|_| {
                fit_superposition(&noisy(&exact, 4.0, &mut state), BEFORE, None, SLOW)
                    .expect("it relaxes")
            })
            .collect();
        let right: Vec<&LawFit> = found
            .iter()
            .map(SuperpositionFit::best)
            .filter(|fit| fit.law == law)
            .collect();
        assert!(
            right.len() >= 118,
            "{law:?} is chosen {} times of {RUNS}",
            right.len()
        );
        #[allow(clippy::cast_precision_loss)] // some hundred
        let count = right.len() as f64;
        let scatter = right.iter().map(|fit| fit.scatter).sum::<f64>() / count;
        assert!((scatter / 4.0 - 1.0).abs() < 0.02, "{scatter} N of 4 N");
        for (index, read) in read.into_iter().enumerate() {
            let values: Vec<(f64, f64)> = right.iter().map(|fit| read(fit)).collect();
            let exact = read(noiseless.best()).0;
            let mean = values.iter().map(|(value, _)| value).sum::<f64>() / count;
            let deviation = (values
                .iter()
                .map(|(value, _)| (value - mean).powi(2))
                .sum::<f64>()
                / (count - 1.0))
                .sqrt();
            let stated =
                (values.iter().map(|(_, error)| error.powi(2)).sum::<f64>() / count).sqrt();
            // The standard deviation of 120 runs has a relative uncertainty of 6.5 %.
            assert!(
                (deviation / stated - 1.0).abs() < 0.2,
                "{law:?} {index}: {deviation} is stated as {stated}"
            );
            assert!(
                (mean - exact).abs() < 4.0 * deviation / count.sqrt() + 0.02 * deviation,
                "{law:?} {index}: {mean} is not {exact}"
            );
            let covered = values
                .iter()
                .filter(|(value, error)| (value - exact).abs() < 2.0 * error)
                .count();
            // 114 of 120 by the normal distribution; three binomial deviations are 7.
            assert!(
                (107..=120).contains(&covered),
                "{law:?} {index}: covered {covered} times"
            );
        }
    }
}

/// With more noise the laws differ less: the right one is still chosen in nine of ten, then in a little more than half; but the wrong
/// one is almost never chosen by a large margin.
#[test]
fn with_more_noise_the_margin_is_smaller() {
    let exact = holds(Logarithmic, 20);
    let mut state = 9;
    for (noise, least, strong) in [(10.0, 90, 60), (40.0, 25, 0)] {
        let found: Vec<_> = (0..100)
            .filter_map(|_| {
                fit_superposition(&noisy(&exact, noise, &mut state), BEFORE, None, SLOW).ok()
            })
            .collect();
        let chosen = |law: RelaxationLaw, margin: f64| {
            let by_margin = |fit: &&SuperpositionFit| {
                fit.best().law == law && fit.margin().is_some_and(|found| found.abs() >= margin)
            };
            found.iter().filter(by_margin).count()
        };
        assert!(
            chosen(Logarithmic, 0.0) >= least,
            "{noise} N: right {} times",
            chosen(Logarithmic, 0.0)
        );
        assert!(
            chosen(Logarithmic, 6.0) >= strong,
            "{noise} N: strongly right {} times",
            chosen(Logarithmic, 6.0)
        );
        assert!(
            chosen(Exponential, 6.0) <= 3,
            "{noise} N: strongly wrong {} times",
            chosen(Exponential, 6.0)
        );
    }
}

#[test]
fn a_steady_force_has_no_law() {
    let still = || -> Vec<Hold> {
        let hold = |(hold, force): (Hold, f64)| {
            let readings = hold
                .readings
                .iter()
                .map(|(time, _)| (*time, force))
                .collect();
            Hold { readings, ..hold }
        };
        holds(Exponential, 10)
            .into_iter()
            .zip(REACHED)
            .map(hold)
            .collect()
    };
    assert_eq!(
        fit_superposition(&still(), BEFORE, None, SLOW),
        Err(Unrelaxed::Steady)
    );
    let mut state = 11;
    let seen = (0..40).filter(|_| {
        fit_superposition(&noisy(&still(), 4.0, &mut state), BEFORE, None, SLOW)
            != Err(Unrelaxed::Steady)
    });
    assert!(seen.count() <= 3, "relaxation is seen in noise");
    assert_eq!(
        fit_superposition(&[], BEFORE, None, SLOW),
        Err(Unrelaxed::TooFew)
    );
    let short: Vec<Hold> = still()
        .into_iter()
        .map(|hold| Hold {
            readings: hold.readings[..1].to_vec(),
            ..hold
        })
        .collect();
    assert_eq!(
        fit_superposition(&short, BEFORE, None, SLOW),
        Err(Unrelaxed::TooFew)
    );
    // Relaxation over hours.
    for law in RelaxationLaw::BOTH {
        let slow = holds_with(law, (0.5, 5000.0), 10);
        assert_eq!(
            fit_superposition(&slow, BEFORE, Some(law), SLOW),
            Err(Unrelaxed::OutOfReach)
        );
    }
}

/// n ln(S/n) + k ln n·n/(n − k − 2), by hand.
#[test]
fn the_criterion_is_the_closed_form() {
    let by_hand = 20.0 * f64::ln(5.0 / 20.0) + 3.0 * f64::ln(20.0) * 20.0 / 15.0;
    assert!(
        (FitSize {
            squares: 5.0,
            count: 20.0,
            parameters: 3.0
        }
        .corrected_bic()
            - by_hand)
            .abs()
            < 1e-12
    );
    assert_eq!(
        FitSize {
            squares: 5.0,
            count: 5.0,
            parameters: 3.0
        }
        .corrected_bic(),
        f64::INFINITY
    );
}
