//! The multilinear fit: exact without noise, its standard errors and correlations those of many fits, its criterion rarely wrong.

use super::StatedVariance;
use super::multilinear_fit::{self, BreakCount, MultilinearFit};
use super::polyline::row;
use crate::statistics::testing::normal;

/// Of readings without stated errors.
fn fit_multilinear(x: &[f64], y: &[f64], count: BreakCount) -> Option<MultilinearFit> {
    multilinear_fit::fit_multilinear(x, y, count, StatedVariance::default())
}

const BY_CRITERION: BreakCount = BreakCount::ByCriterion { most: 4 };

/// 400 kN/m to 10.3 mm, 120 kN/m to 16.2 mm, 20 kN/m on; 12 N at zero displacement.
fn curve(x: f64) -> f64 {
    12.0 + row(x, &[0.0103, 0.0162])
        .zip([0.0, 4e5, 1.2e5, 2e4])
        .map(|(part, by)| part * by)
        .sum::<f64>()
}

fn ramp(noise: &mut dyn FnMut() -> f64) -> (Vec<f64>, Vec<f64>) {
    (1..=50)
        .map(|step| f64::from(step) * 0.5e-3)
        .map(|x| (x, curve(x) + noise()))
        .unzip()
}

#[test]
fn without_noise_the_segments_and_their_number_are_exact() {
    let (x, y) = ramp(&mut || 0.0);
    for count in [BY_CRITERION, BreakCount::Exactly(2)] {
        let fit = fit_multilinear(&x, &y, count).unwrap();
        for ((found, _), exact) in fit.stiffnesses.iter().zip([4e5, 1.2e5, 2e4]) {
            assert!(
                (found / exact - 1.0).abs() < 1e-8,
                "{found} N/m is not {exact}"
            );
        }
        for ((found, force), exact) in fit
            .breakpoints
            .iter()
            .map(|(at, _)| (*at, fit.force(*at)))
            .zip([0.0103, 0.0162])
        {
            assert!(
                (found - exact).abs() < 1e-10 && (force - curve(exact)).abs() < 1e-5,
                "{found} m is not {exact}"
            );
        }
        assert!(
            (fit.forces[1].0 - curve(0.0162)).abs() < 1e-5 && (fit.intercept.0 - 12.0).abs() < 1e-5
        );
        assert!((fit.post_yield_ratio.0 - 0.05).abs() < 1e-9 && fit.r_squared > 1.0 - 1e-12);
        assert!((fit.yield_point().unwrap()[0].0 - 0.0103).abs() < 1e-10);
    }
}

#[test]
fn a_pull_is_the_mirrored_push_and_its_backbone_is_a_specimen() {
    let (x, y) = ramp(&mut || 0.0);
    let mirrored = |values: &[f64]| values.iter().map(|value| -value).collect::<Vec<f64>>();
    let (push, pull) = (
        fit_multilinear(&x, &y, BY_CRITERION).unwrap(),
        fit_multilinear(&mirrored(&x), &mirrored(&y), BY_CRITERION).unwrap(),
    );
    assert_eq!(push.stiffnesses, pull.stiffnesses);
    assert_eq!(
        (pull.breakpoints[0].0, pull.forces[1].0, pull.intercept.0),
        (-push.breakpoints[0].0, -push.forces[1].0, -push.intercept.0)
    );
    assert_eq!(pull.force(-0.013), -push.force(0.013));
    let (backbone, same) = (
        push.backbone_points(0.025).unwrap(),
        pull.backbone_points(-0.025).unwrap(),
    );
    assert_eq!(backbone, same);
    // Without the offset of the cell: 4120 N, 708 N more, 176 N more.
    for (point, force) in backbone.iter().zip([4120.0, 4828.0, 5004.0]) {
        assert!((point[1] - force).abs() < 1e-4, "{point:?}");
    }
}

#[test]
fn an_elastic_ramp_has_no_breakpoint_and_a_stiffening_one_no_yield_point() {
    let x: Vec<f64> = (1..=30).map(|step| f64::from(step) * 1e-3).collect();
    let straight: Vec<f64> = x.iter().map(|x| 3e5 * x - 7.0).collect();
    let fit = fit_multilinear(&x, &straight, BY_CRITERION).unwrap();
    assert!(
        fit.breakpoints.is_empty()
            && fit.yield_point().is_none()
            && fit.indistinct_breakpoints().is_empty()
    );
    assert!(
        (fit.stiffnesses[0].0 / 3e5 - 1.0).abs() < 1e-12
            && (fit.post_yield_ratio.0 - 1.0).abs() < 1e-12
    );
    assert_eq!(fit.criterion.len(), 5);
    let stiffening: Vec<f64> = x
        .iter()
        .map(|x| 1e5 * x.min(0.0055) + 3e5 * (x - 0.0055).max(0.0))
        .collect();
    let fit = fit_multilinear(&x, &stiffening, BY_CRITERION).unwrap();
    assert!(
        (fit.breakpoints[0].0 - 0.0055).abs() < 1e-10
            && fit.yield_point().is_none()
            && fit.backbone_points(0.03).is_none()
    );
}

#[test]
fn more_segments_than_the_points_determine_are_not_found() {
    let x: Vec<f64> = (0..8).map(f64::from).collect();
    assert_eq!(
        fit_multilinear(&x, &x, BreakCount::Exactly(2)),
        None,
        "three segments of three points"
    );
    assert_eq!(fit_multilinear(&x[..2], &x[..2], BY_CRITERION), None);
    assert_eq!(fit_multilinear(&[0.0; 8], &x, BY_CRITERION), None);
    assert_eq!(fit_multilinear(&x, &[f64::NAN; 8], BY_CRITERION), None);
}

type Read = fn(&MultilinearFit) -> (f64, f64);

/// The standard deviation of 400 fits with two breakpoints is the standard error that each of them states, and twice that error
/// covers the exact value in 95 of 100.
#[test]
fn the_standard_errors_are_the_scatter_of_many_fits() {
    let mut state = 5;
    let mut noise = || 15.0 * normal(&mut state);
    let fits: Vec<MultilinearFit> = (0..400)
        .map(|_| {
            let (x, y) = ramp(&mut noise);
            fit_multilinear(&x, &y, BreakCount::Exactly(2)).unwrap()
        })
        .collect();
    let readings: [(Read, f64); 8] = [
        (|fit| fit.stiffnesses[0], 4e5),
        (|fit| fit.stiffnesses[1], 1.2e5),
        (|fit| fit.stiffnesses[2], 2e4),
        (|fit| fit.breakpoints[0], 0.0103),
        (|fit| fit.breakpoints[1], 0.0162),
        (|fit| fit.forces[0], curve(0.0103)),
        (|fit| fit.forces[1], curve(0.0162)),
        (|fit| fit.post_yield_ratio, 0.05),
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
        // The standard deviation of 400 fits has a relative uncertainty of 3.5 %.
        assert!(
            (deviation / stated - 1.0).abs() < 0.12,
            "{index}: {deviation} is stated as {stated}"
        );
        assert!(
            (mean - exact).abs() < 4.0 * deviation / 20.0,
            "{index}: {mean} is not {exact}"
        );
        let covered = values
            .iter()
            .filter(|(value, error)| (value - exact).abs() < 2.0 * error)
            .count();
        // 382 by the normal distribution; three binomial deviations are 13.
        assert!(
            (366..=397).contains(&covered),
            "{index}: twice the error covers the value {covered} times of 400"
        );
    }
}

/// The squares of the shares of a result add up to the square of its standard error, and two results are correlated as those of
/// 400 fits are.
#[test]
fn the_shares_add_up_to_the_errors_and_give_the_correlations() {
    let mut state = 7;
    let mut noise = || 15.0 * normal(&mut state);
    let mut fit = || {
        let (x, y) = ramp(&mut noise);
        fit_multilinear(&x, &y, BreakCount::Exactly(2)).unwrap()
    };
    let one = fit();
    let shares = &one.shares;
    let size = |share: &[f64]| share.iter().map(|part| part * part).sum::<f64>().sqrt();
    let lists = [
        (&one.stiffnesses, &shares.stiffnesses),
        (&one.breakpoints, &shares.breakpoints),
        (&one.forces, &shares.forces),
    ];
    let listed = lists
        .into_iter()
        .flat_map(|(numbers, shares)| numbers.iter().zip(shares));
    for ((value, error), share) in listed.chain([
        (&one.intercept, &shares.intercept),
        (&one.post_yield_ratio, &shares.post_yield_ratio),
    ]) {
        assert!(
            (size(share) / error - 1.0).abs() < 1e-6,
            "{value} ± {error}: {share:?}"
        );
    }
    assert!(
        shares.stiffnesses[0][1..]
            .iter()
            .all(|part| part.abs() < 1e-9 * one.stiffnesses[0].1),
        "K₁ is the first independent error"
    );
    let correlation = |a: &[f64], b: &[f64]| {
        a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / (size(a) * size(b))
    };
    let fits: Vec<MultilinearFit> = (0..400).map(|_| fit()).collect();
    let pairs: [(Read, Read, f64); 4] = [
        (
            |fit| fit.stiffnesses[0],
            |fit| fit.breakpoints[0],
            correlation(&shares.stiffnesses[0], &shares.breakpoints[0]),
        ),
        (
            |fit| fit.stiffnesses[0],
            |fit| fit.intercept,
            correlation(&shares.stiffnesses[0], &shares.intercept),
        ),
        (
            |fit| fit.breakpoints[0],
            |fit| fit.forces[0],
            correlation(&shares.breakpoints[0], &shares.forces[0]),
        ),
        (
            |fit| fit.stiffnesses[1],
            |fit| fit.breakpoints[1],
            correlation(&shares.stiffnesses[1], &shares.breakpoints[1]),
        ),
    ];
    for (index, (first, second, stated)) in pairs.into_iter().enumerate() {
        let mean = |read: Read| fits.iter().map(|fit| read(fit).0).sum::<f64>() / 400.0;
        let product = |a: Read, b: Read| {
            let (mean_a, mean_b) = (mean(a), mean(b));
            fits.iter()
                .map(|fit| (a(fit).0 - mean_a) * (b(fit).0 - mean_b))
                .sum::<f64>()
        };
        let found =
            product(first, second) / (product(first, first) * product(second, second)).sqrt();
        // The standard deviation of a correlation of 400 pairs is (1 − r²)/√400; three of them, and the difference of one fit from all.
        assert!(
            (found - stated).abs() < 3.0 / 20.0 * (1.0 - stated * stated) + 0.02,
            "pair {index}: {found}, stated {stated}"
        );
    }
}

/// The criterion finds the number of breakpoints of most noisy ramps: of a straight one, rarely any.
#[test]
fn the_criterion_rarely_finds_a_breakpoint_too_many() {
    let mut state = 9;
    let (mut straight, mut two) = (0, 0);
    for _ in 0..100 {
        let mut noise = || 15.0 * normal(&mut state);
        let (x, y) = ramp(&mut noise);
        two += usize::from(
            fit_multilinear(&x, &y, BY_CRITERION)
                .unwrap()
                .breakpoints
                .len()
                == 2,
        );
        let y: Vec<f64> = x.iter().map(|x| 4e5 * x + noise()).collect();
        straight += usize::from(
            fit_multilinear(&x, &y, BY_CRITERION)
                .unwrap()
                .breakpoints
                .is_empty(),
        );
    }
    assert!(
        straight >= 85 && two >= 85,
        "{straight} straight, {two} of two breaks"
    );
}
