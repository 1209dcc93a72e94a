//! Tests of fragility curves: known curves recovered, coverage of the intervals, studies that no curve fits.

use super::super::sampling::philox::{Philox, Purpose};
use super::*;

const TRUTH: Curve = Curve {
    median: 0.8,
    dispersion: 0.4,
};

fn stripe(intensity: f64, exceeded: u64, not_exceeded: u64) -> Stripe {
    Stripe {
        intensity,
        exceeded,
        not_exceeded,
        no_result: 0,
    }
}

/// Runs at 0.3, 0.5 … 1.7 of a structure with the true curve.
fn study(seed: u64, runs: u64) -> Vec<Stripe> {
    let stream = Philox::new(seed);
    (0..8)
        .map(|at| {
            let intensity = 0.3 + 0.2 * f64::from(at);
            let exceeds =
                |run: &u64| stream.uniform(Purpose::Value, *run, at) < TRUTH.probability(intensity);
            let exceeded = (0..runs).filter(exceeds).count() as u64;
            stripe(intensity, exceeded, runs - exceeded)
        })
        .collect()
}

/// With 100,000 runs a stripe, θ and β come back within 1 %, and the deviance is no surprise.
#[test]
fn a_known_curve_is_recovered() {
    let fit = Fit::new(&study(1, 100_000), NoResult::AsExceeded).unwrap();
    assert!((fit.curve.median / TRUTH.median - 1.0).abs() < 0.01);
    assert!((fit.curve.dispersion / TRUTH.dispersion - 1.0).abs() < 0.01);
    assert!(fit.has_middle && fit.goodness.unwrap() > 0.001);
}

/// Of 1000 studies of eight stripes of 40 runs, the 95 % intervals of θ, β and of the probability at 0.6 and at 1.5 contain the truth.
/// The likelihood ratio is exact for many runs only: three standard errors of the share are 2 %.
#[test]
fn band_and_intervals_cover_the_truth() {
    let confidence = Confidence::new(0.95).unwrap();
    let mut covered = [0_u32; 4];
    for seed in 0..1000 {
        let fit = Fit::new(&study(seed, 40), NoResult::AsExceeded).unwrap();
        let intervals = [
            (fit.median_interval(confidence).unwrap(), TRUTH.median),
            (
                fit.dispersion_interval(confidence).unwrap(),
                TRUTH.dispersion,
            ),
            (fit.band(0.6, confidence), TRUTH.probability(0.6)),
            (fit.band(1.5, confidence), TRUTH.probability(1.5)),
        ];
        for (covered, (interval, truth)) in covered.iter_mut().zip(intervals) {
            *covered += u32::from(interval.contains(truth));
        }
    }
    assert!(
        covered.iter().all(|count| (930..=970).contains(count)),
        "{covered:?}"
    );
}

/// A band contains its curve, and the median is where the band covers one half.
#[test]
fn the_band_goes_with_the_curve() {
    let confidence = Confidence::new(0.9).unwrap();
    let fit = Fit::new(&study(3, 30), NoResult::AsExceeded).unwrap();
    for intensity in [1e-3, 0.2, 0.5, 0.8, 1.5, 10.0] {
        let band = fit.band(intensity, confidence);
        assert!(
            band.contains(fit.curve.probability(intensity)),
            "{intensity}"
        );
    }
    let median = fit.median_interval(confidence).unwrap();
    assert!((fit.band(median.low, confidence).high - 0.5).abs() < 1e-6);
    assert!((fit.band(median.high, confidence).low - 0.5).abs() < 1e-6);
}

#[test]
fn runs_without_a_result_give_two_curves() {
    let mut stripes = study(5, 40);
    for stripe in &mut stripes {
        stripe.no_result = 4;
    }
    let [least, most] = [NoResult::AsExceeded, NoResult::AsNotExceeded]
        .map(|counted| Fit::new(&stripes, counted).unwrap().curve.median);
    let known = Fit::new(&study(5, 40), NoResult::AsExceeded).unwrap();
    assert!(least < known.curve.median && known.curve.median < most);
}

#[test]
fn a_study_that_no_curve_fits_gives_the_reason() {
    let why = |stripes: &[Stripe]| Fit::new(stripes, NoResult::AsExceeded).err();
    assert_eq!(why(&[]), Some(NoFit::NoneExceeds));
    assert_eq!(
        why(&[stripe(1.0, 0, 9), stripe(2.0, 0, 9)]),
        Some(NoFit::NoneExceeds)
    );
    assert_eq!(
        why(&[stripe(1.0, 9, 0), stripe(2.0, 9, 0)]),
        Some(NoFit::AllExceed)
    );
    assert_eq!(
        why(&[stripe(1.0, 4, 5), stripe(1.0, 5, 4)]),
        Some(NoFit::OneIntensity)
    );
    assert_eq!(why(&[stripe(0.0, 4, 5)]), Some(NoFit::Intensity(0.0)));
    assert_eq!(
        why(&[stripe(1.0, 0, 9), stripe(2.0, 9, 0)]),
        Some(NoFit::Step {
            below: 1.0,
            above: 2.0
        })
    );
    assert_eq!(
        why(&[stripe(1.0, 0, 9), stripe(1.5, 4, 5), stripe(2.0, 9, 0)]),
        Some(NoFit::OneMixed {
            mixed: 1.5,
            below: 1.0,
            above: 2.0
        })
    );
    assert_eq!(
        why(&[stripe(1.5, 4, 5), stripe(2.0, 9, 0)]),
        Some(NoFit::OneMixed {
            mixed: 1.5,
            below: 0.0,
            above: 2.0
        })
    );
    assert_eq!(
        why(&[stripe(1.0, 0, 9), stripe(1.5, 4, 5)]),
        Some(NoFit::OneMixed {
            mixed: 1.5,
            below: 1.0,
            above: f64::INFINITY
        })
    );
    assert_eq!(
        why(&[stripe(1.0, 6, 4), stripe(2.0, 5, 5)]),
        Some(NoFit::NotRising)
    );
    assert_eq!(
        why(&[stripe(1.0, 9, 0), stripe(2.0, 0, 9)]),
        Some(NoFit::NotRising)
    );
}

/// Five of ten against six of ten do not show that the curve rises: the median and the dispersion have no interval, the band does.
#[test]
fn a_study_too_small_has_no_interval_of_the_median() {
    let confidence = Confidence::new(0.95).unwrap();
    let fit = Fit::new(
        &[stripe(1.0, 5, 5), stripe(2.0, 6, 4)],
        NoResult::AsExceeded,
    )
    .unwrap();
    assert_eq!(fit.median_interval(confidence), None);
    assert_eq!(fit.dispersion_interval(confidence), None);
    assert_eq!(fit.goodness, None);
    let band = fit.band(1.0, confidence);
    assert!(band.low < 0.3 && band.high > 0.7);
}
