//! The normal distribution: its quantile, its tail, its density. In: a probability or a number. Out: the other one.

use std::f64::consts::{PI, SQRT_2};

use statrs::function::erf::erfc;

use super::{Continuous, DistributionError, Spread, Tails};

/// By mean and standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Normal {
    mean: f64,
    sd: f64,
}

impl Normal {
    pub(super) fn new(mean: f64, spread: Spread) -> Result<Self, DistributionError> {
        let sd = spread.sd(mean)?;
        Ok(Self { mean, sd })
    }
}

impl Continuous for Normal {
    fn quantile(&self, tails: Tails) -> f64 {
        self.mean + self.sd * tails.score()
    }

    fn tails(&self, value: f64) -> Tails {
        Tails::of_score((value - self.mean) / self.sd)
    }
}

/// Φ(z), the probability of a smaller standard normal number.
#[must_use]
pub fn below(score: f64) -> f64 {
    0.5 * erfc(-score / SQRT_2)
}

/// φ(z), the density.
#[must_use]
pub fn density(score: f64) -> f64 {
    (-0.5 * score * score).exp() / (2.0 * PI).sqrt()
}

/// Φ⁻¹(p) to about sixteen digits (M. J. Wichura, *Algorithm AS 241: the percentage points of the normal distribution*, Appl. Statist. 37
/// (1988) 477–484, PPND16). −∞ at 0, ∞ at 1, NaN outside.
#[must_use]
pub fn quantile(probability: f64) -> f64 {
    let from_middle = probability - 0.5;
    if from_middle.abs() <= 0.425 {
        let argument = 0.180_625 - from_middle * from_middle;
        return from_middle * ratio(&MIDDLE, argument);
    }
    if !(0.0..=1.0).contains(&probability) {
        return f64::NAN;
    }
    let tail = if from_middle < 0.0 {
        probability
    } else {
        1.0 - probability
    };
    if tail == 0.0 {
        return from_middle.signum() * f64::INFINITY;
    }
    let root = (-tail.ln()).sqrt();
    let score = if root <= 5.0 {
        ratio(&TAIL, root - 1.6)
    } else {
        ratio(&FAR_TAIL, root - 5.0)
    };
    score.copysign(from_middle)
}

/// Coefficients of a rational function, the constant first: numerator, denominator.
type Rational = [[f64; 8]; 2];

const MIDDLE: Rational = [
    [
        3.387_132_872_796_366_5,
        133.141_667_891_784_38,
        1_971.590_950_306_551_3,
        13_731.693_765_509_46,
        45_921.953_931_549_87,
        67_265.770_927_008_7,
        33_430.575_583_588_13,
        2_509.080_928_730_122_7,
    ],
    [
        1.0,
        42.313_330_701_600_91,
        687.187_007_492_057_9,
        5_394.196_021_424_751,
        21_213.794_301_586_597,
        39_307.895_800_092_71,
        28_729.085_735_721_943,
        5_226.495_278_852_854,
    ],
];

const TAIL: Rational = [
    [
        1.423_437_110_749_683_5,
        4.630_337_846_156_546,
        5.769_497_221_460_691,
        3.647_848_324_763_204_5,
        1.270_458_252_452_368_4,
        0.241_780_725_177_450_6,
        0.022_723_844_989_269_184,
        0.000_774_545_014_278_341_4,
    ],
    [
        1.0,
        2.053_191_626_637_759,
        1.676_384_830_183_803_8,
        0.689_767_334_985_1,
        0.148_103_976_427_480_08,
        0.015_198_666_563_616_457,
        0.000_547_593_808_499_534_5,
        1.050_750_071_644_416_9e-9,
    ],
];

const FAR_TAIL: Rational = [
    [
        6.657_904_643_501_103,
        5.463_784_911_164_114,
        1.784_826_539_917_291_3,
        0.296_560_571_828_504_87,
        0.026_532_189_526_576_124,
        0.001_242_660_947_388_078_4,
        2.711_555_568_743_487_6e-5,
        2.010_334_399_292_288_1e-7,
    ],
    [
        1.0,
        0.599_832_206_555_888,
        0.136_929_880_922_735_8,
        0.014_875_361_290_850_615,
        0.000_786_869_131_145_613_3,
        1.846_318_317_510_054_8e-5,
        1.421_511_758_316_446e-7,
        2.044_263_103_389_939_7e-15,
    ],
];

fn ratio(coefficients: &Rational, argument: f64) -> f64 {
    let [numerator, denominator] = coefficients.each_ref().map(|terms| {
        terms
            .iter()
            .rev()
            .fold(0.0, |sum, term| sum * argument + term)
    });
    numerator / denominator
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wichura (1988), p. 478, gives the first two and the fourth for checks; all are solved from Φ(z) = p with forty digits (mpmath 1.3).
    #[test]
    fn quantiles_are_the_published_ones() {
        for (probability, score) in [
            (0.25, -0.674_489_750_196_081_7),
            (0.001, -3.090_232_306_167_813_6),
            (0.975, 1.959_963_984_540_053_8),
            (1e-20, -9.262_340_089_798_407),
            (1e-300, -37.047_096_299_361_2),
        ] {
            let found = quantile(probability);
            assert!(
                (found / score - 1.0).abs() < 1e-15,
                "{found} is not {score}"
            );
        }
        assert_eq!(
            [0.5, 0.0, 1.0].map(quantile),
            [0.0, f64::NEG_INFINITY, f64::INFINITY]
        );
        assert!(quantile(-0.1).is_nan() && quantile(f64::NAN).is_nan());
    }

    /// The error function of `statrs` has ten digits.
    #[test]
    fn quantile_and_tail_are_inverse() {
        for step in -70..=70 {
            let score = 0.1 * f64::from(step);
            let found = Tails::of_score(score).score();
            assert!(
                (found - score).abs() < 1e-10 * (1.0 + score.abs()),
                "{found} is not {score}"
            );
        }
    }
}
