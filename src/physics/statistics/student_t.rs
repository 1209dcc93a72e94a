//! Student's t: the coverage factor for a standard uncertainty that was estimated from few readings. In: degrees of freedom. Out: the
//! factor. It knows no result and no plan.

use statrs::function::beta::beta_reg;
use statrs::function::erf::erfc;

/// The coverage probability of ±2u for a normal distribution, erf √2.
pub const LEVEL: f64 = 0.954_499_736_103_641_6;

/// From this number of degrees of freedom the series is exact to nine digits.
const MANY: f64 = 50.0;

/// `t_p(ν)` for p = [`LEVEL`], two-sided (JCGM 100:2008, table G.2): 13.97 for one degree of freedom, 2 for infinitely many. Fewer than
/// one do not exist.
#[must_use]
pub fn coverage(degrees: f64) -> f64 {
    if degrees.is_nan() || degrees == f64::INFINITY {
        return 2.0;
    }
    let degrees = degrees.max(1.0);
    if degrees >= MANY {
        expanded_about_normal(degrees)
    } else {
        solved(degrees)
    }
}

/// Probability that Student's t with these degrees of freedom is at most `t`; for very many, the normal distribution.
#[must_use]
pub fn below(t: f64, degrees: f64) -> f64 {
    if t.is_nan() {
        return f64::NAN;
    }
    if t.is_infinite() {
        return if t > 0.0 { 1.0 } else { 0.0 };
    }
    let both_tails = if degrees.is_finite() {
        let degrees = degrees.max(1.0);
        beta_reg(0.5 * degrees, 0.5, degrees / (degrees + t * t))
    } else {
        erfc(t.abs() / std::f64::consts::SQRT_2)
    };
    if t > 0.0 {
        1.0 - 0.5 * both_tails
    } else {
        0.5 * both_tails
    }
}

/// Fisher's series in 1/ν about the normal quantile z = 2 (Abramowitz and Stegun 1964, 26.7.5): of its four terms
/// (z³ + z)/4, (5z⁵ + 16z³ + 3z)/96, (3z⁷ + 19z⁵ + 17z³ − 15z)/384, (79z⁹ + 776z⁷ + 1482z⁵ − 1920z³ − 945z)/92160.
fn expanded_about_normal(degrees: f64) -> f64 {
    const TERMS: [f64; 5] = [
        2.0,
        10.0 / 4.0,
        294.0 / 96.0,
        1098.0 / 384.0,
        169_950.0 / 92_160.0,
    ];
    TERMS
        .iter()
        .rev()
        .fold(0.0, |sum, term| sum / degrees + term)
}

/// The root at which the two tails, `I_x(ν/2, ½)` with x = ν/(ν + t²), equal 1 − [`LEVEL`]; by bisection, because they fall as t grows.
fn solved(degrees: f64) -> f64 {
    let tails = |t: f64| beta_reg(0.5 * degrees, 0.5, degrees / (degrees + t * t));
    let (mut low, mut high) = (2.0, 15.0);
    while high - low > 1e-13 * high {
        let middle = 0.5 * (low + high);
        if tails(middle) > 1.0 - LEVEL {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Normal: Φ(1) = 0.841345, Φ(−2) = 0.022750. For one degree of freedom ½ + atan(t)/π; k leaves half of 1 − level on either side.
    #[test]
    fn shares_below_are_those_of_closed_forms() {
        assert!((below(1.0, f64::INFINITY) - 0.841_344_746).abs() < 1e-8);
        assert!((below(-2.0, f64::INFINITY) - 0.022_750_132).abs() < 1e-8);
        for t in [-3.0, -0.5, 0.0, 0.7, 12.0] {
            assert!(
                (below(t, 1.0) - (0.5 + f64::atan(t) / std::f64::consts::PI)).abs() < 1e-10,
                "{t}"
            );
        }
        for degrees in [1.0, 4.0, 30.0] {
            assert!(
                (below(coverage(degrees), degrees) - (0.5 + 0.5 * LEVEL)).abs() < 1e-9,
                "{degrees}"
            );
        }
        assert_eq!(
            [below(f64::INFINITY, 3.0), below(f64::NEG_INFINITY, 3.0)],
            [1.0, 0.0]
        );
    }

    /// NIST Technical Note 1297 (1994), table B.1, the column of 95.45 %: the same as JCGM 100:2008, table G.2.
    #[test]
    fn it_is_the_published_table() {
        let table = [
            (1.0, 13.97),
            (2.0, 4.53),
            (3.0, 3.31),
            (4.0, 2.87),
            (5.0, 2.65),
            (6.0, 2.52),
            (7.0, 2.43),
            (8.0, 2.37),
            (9.0, 2.32),
            (10.0, 2.28),
            (12.0, 2.23),
            (15.0, 2.18),
            (20.0, 2.13),
            (30.0, 2.09),
            (40.0, 2.06),
            (50.0, 2.05),
            (f64::INFINITY, 2.0),
        ];
        for (degrees, published) in table {
            let found = coverage(degrees);
            assert!(
                (found - published).abs() < 0.006,
                "{degrees}: {found} is not {published}"
            );
        }
        assert!((coverage(100.0) - 2.025).abs() < 6e-4);
    }

    /// In closed form: ν = 1 is Cauchy's distribution, t = tan(πp/2); ν = 2 has t = p√(2/(1 − p²)).
    #[test]
    fn it_is_the_closed_form_where_there_is_one() {
        assert!((coverage(1.0) / (std::f64::consts::FRAC_PI_2 * LEVEL).tan() - 1.0).abs() < 1e-11);
        assert!(
            (coverage(2.0) / (LEVEL * (2.0 / (1.0 - LEVEL * LEVEL)).sqrt()) - 1.0).abs() < 1e-11
        );
        assert_eq!((coverage(0.3), coverage(f64::NAN)), (coverage(1.0), 2.0));
    }

    /// Roots of the same equation calculated with forty digits (mpmath 1.3, `betainc`), also for fractions of a degree.
    #[test]
    fn it_is_the_root_to_twelve_digits() {
        let roots = [
            (1.5, 6.418_189_544_598_454),
            (3.0, 3.306_822_175_005_652),
            (5.5, 2.575_185_319_044_678),
            (10.0, 2.283_678_202_477_93),
            (30.0, 2.086_844_327_310_369),
            (49.9, 2.051_353_428_223_419),
        ];
        for (degrees, root) in roots {
            let found = coverage(degrees);
            assert!(
                (found / root - 1.0).abs() < 1e-12,
                "{degrees}: {found} is not {root}"
            );
        }
    }

    /// Both methods agree at the transition between them, and the factor falls with every degree of freedom.
    #[test]
    fn series_and_solution_meet() {
        assert!((solved(MANY) / expanded_about_normal(MANY) - 1.0).abs() < 1e-8);
        let factors: Vec<f64> = (2..400)
            .map(|halves| coverage(0.5 * f64::from(halves)))
            .collect();
        assert!(
            factors.windows(2).all(|pair| pair[1] < pair[0])
                && factors.iter().all(|factor| *factor > 2.0)
        );
    }
}
