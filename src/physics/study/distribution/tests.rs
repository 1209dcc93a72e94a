//! Tests of all distributions: moments, tails, truncation, refused parameters.

use super::*;

fn all() -> [Distribution; 7] {
    [
        Distribution::normal(-2.0, Spread::Cv(0.25)),
        Distribution::lognormal(3.0, Spread::Sd(0.6)),
        Distribution::uniform(1.0, 4.0),
        Distribution::uniform_around(10.0, Spread::Cv(0.1)),
        Distribution::triangular(&(0.0..=4.0), 1.0),
        Distribution::weibull(5.0, Spread::Cv(0.3)),
        Distribution::gumbel(1.0, Spread::Sd(0.5)),
    ]
    .map(Result::unwrap)
}

/// Mean and standard deviation by the midpoint rule over a million probabilities. In closed form: uniform (a + b)/2 and (b − a)/√12,
/// triangular (a + m + b)/3 and √((a² + m² + b² − am − ab − mb)/18); the others as stated.
#[test]
fn mean_and_standard_deviation_are_those_stated() {
    const COUNT: u32 = 1_000_000;
    let stated = [
        [-2.0, 0.5],
        [3.0, 0.6],
        [2.5, 3.0 / 12.0_f64.sqrt()],
        [10.0, 1.0],
        [5.0 / 3.0, (13.0_f64 / 18.0).sqrt()],
        [5.0, 1.5],
        [1.0, 0.5],
    ];
    for (distribution, [mean, sd]) in all().iter().zip(stated) {
        let (mut sum, mut squares) = (0.0, 0.0);
        for part in 0..COUNT {
            let uniform = (f64::from(part) + 0.5) / f64::from(COUNT);
            let value = distribution.quantile(Tails::of_uniform(uniform)) - mean;
            sum += value;
            squares += value * value;
        }
        let found = (squares / f64::from(COUNT)).sqrt();
        assert!(
            (sum / f64::from(COUNT)).abs() < 1e-5 * sd,
            "{distribution:?}"
        );
        assert!((found / sd - 1.0).abs() < 1e-4, "{distribution:?}: {found}");
    }
}

#[test]
fn quantiles_and_tails_are_inverse_in_both_tails() {
    for distribution in all() {
        for tail in [1e-14, 1e-6, 0.01, 0.3, 0.499, 0.5] {
            for tails in [
                Tails {
                    below: tail,
                    above: 1.0 - tail,
                },
                Tails {
                    below: 1.0 - tail,
                    above: tail,
                },
            ] {
                let found = distribution
                    .continuous()
                    .tails(distribution.quantile(tails));
                let [found, stated] = [found, tails].map(|tails| tails.below.min(tails.above));
                // At the limits of uniform and triangular, the value itself has no more digits.
                assert!(
                    (found - stated).abs() < 1e-9 * stated + 1e-14,
                    "{distribution:?}: {found} is not {stated}"
                );
            }
        }
    }
}

/// The values of a truncated distribution are inside, and their tails are those of the whole over the probability inside.
#[test]
fn a_truncated_distribution_stays_inside_and_keeps_its_shape() {
    for (distribution, [low, high]) in [
        (all()[0], [-2.5, f64::INFINITY]),
        // Far in the upper tail, where 1 − p has no digits.
        (all()[0], [-2.0 + 2.5, -2.0 + 2.6]),
        (all()[1], [f64::NEG_INFINITY, 3.2]),
        (all()[4], [0.5, 2.0]),
        (all()[6], [0.0, 2.0]),
    ] {
        let truncated = distribution.truncated(low, high).unwrap();
        let [from, to] = [low, high].map(|limit| distribution.continuous().tails(limit));
        for below in [f64::EPSILON / 2.0, 0.1, 0.5, 0.9, 1.0 - f64::EPSILON / 2.0] {
            let value = truncated.quantile(Tails::of_uniform(below));
            assert!((low..=high).contains(&value), "{value} of {below}");
            let found = distribution.continuous().tails(value);
            let share = (from.above - found.above) / (from.above - to.above);
            assert!((share - below).abs() < 1e-9, "{share} is not {below}");
        }
    }
}

#[test]
fn impossible_parameters_are_refused() {
    use DistributionError as E;
    let normal = Distribution::normal(1.0, Spread::Sd(0.1)).unwrap();
    assert_eq!(
        Distribution::normal(0.0, Spread::Cv(0.1)),
        Err(E::NoSpread { mean: 0.0, sd: 0.0 })
    );
    assert!(Distribution::normal(1.0, Spread::Sd(-1.0)).is_err());
    assert!(Distribution::gumbel(f64::INFINITY, Spread::Sd(1.0)).is_err());
    assert_eq!(
        Distribution::lognormal(-1.0, Spread::Sd(1.0)),
        Err(E::NotPositive(-1.0))
    );
    assert_eq!(
        Distribution::weibull(1.0, Spread::Cv(1e-5)),
        Err(E::WeibullSpread { cv: 1e-5 })
    );
    assert_eq!(
        Distribution::uniform(2.0, 2.0),
        Err(E::Limits {
            low: 2.0,
            high: 2.0
        })
    );
    assert!(Distribution::uniform(f64::NAN, 2.0).is_err());
    assert_eq!(
        Distribution::triangular(&(0.0..=4.0), 5.0),
        Err(E::Mode {
            low: 0.0,
            mode: 5.0,
            high: 4.0
        })
    );
    assert!(matches!(
        normal.truncated(2.0, 3.0),
        Err(E::NothingInside { .. })
    ));
    assert_eq!(
        normal.truncated(3.0, 2.0),
        Err(E::Limits {
            low: 3.0,
            high: 2.0
        })
    );
}
