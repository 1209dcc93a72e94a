//! Student's t: how many standard uncertainties hold a share of all cases, where the standard uncertainty itself is known by few
//! readings. In: degrees of freedom. Out: the factor. It knows no result and no plan.

/// The share of the cases that is held: what ±2u hold of a normal distribution, erf √2.
pub const LEVEL: f64 = 0.954_499_736_103_641_6;

/// From so many degrees of freedom on the series is exact to nine digits.
const MANY: f64 = 50.0;

/// `t_p(ν)` for p = [`LEVEL`], two-sided (JCGM 100:2008, table G.2): 13.97 of one degree of freedom, 2 of infinitely many. Fewer than one
/// there are not.
#[must_use]
pub fn coverage(degrees: f64) -> f64 {
    if degrees.is_nan() || degrees == f64::INFINITY {
        return 2.0;
    }
    let degrees = degrees.max(1.0);
    if degrees >= MANY { expanded_about_normal(degrees) } else { solved(degrees) }
}

/// Fisher's series in 1/ν about the normal quantile z = 2 (Abramowitz and Stegun 1964, 26.7.5): of its four terms
/// (z³ + z)/4, (5z⁵ + 16z³ + 3z)/96, (3z⁷ + 19z⁵ + 17z³ − 15z)/384, (79z⁹ + 776z⁷ + 1482z⁵ − 1920z³ − 945z)/92160.
fn expanded_about_normal(degrees: f64) -> f64 {
    const TERMS: [f64; 5] = [2.0, 10.0 / 4.0, 294.0 / 96.0, 1098.0 / 384.0, 169_950.0 / 92_160.0];
    TERMS.iter().rev().fold(0.0, |sum, term| sum / degrees + term)
}

/// Where the two tails, `I_x(ν/2, ½)` with x = ν/(ν + t²), are what the level leaves; by halves, for they fall as t grows.
fn solved(degrees: f64) -> f64 {
    let tails = |t: f64| incomplete_beta(0.5 * degrees, 0.5, degrees / (degrees + t * t));
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

/// The regularised incomplete beta function by its continued fraction (Abramowitz and Stegun 1964, 26.5.8), on the side of its middle
/// where that converges fast.
fn incomplete_beta(a: f64, b: f64, x: f64) -> f64 {
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta(b, a, 1.0 - x);
    }
    let front = (ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b) + a * x.ln() + b * (1.0 - x).ln()).exp();
    front / a * continued_fraction(a, b, x)
}

/// 1/(1 + d₁/(1 + d₂/(1 + …))), from the far end: of what is asked here 200 are more than enough.
fn continued_fraction(a: f64, b: f64, x: f64) -> f64 {
    const TERMS: u32 = 200;
    let inner = (1..=TERMS).rev().fold(1.0, |below, term| {
        let m = f64::from(term / 2);
        let part = if term % 2 == 0 {
            m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m))
        } else {
            -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))
        };
        1.0 + part / below
    });
    1.0 / inner
}

/// ln Γ of a positive number (Lanczos 1964, g = 7 and nine terms: 15 digits).
fn ln_gamma(x: f64) -> f64 {
    const SERIES: [f64; 8] = [
        676.520_368_121_885_1,
        -1_259.139_216_722_402_8,
        771.323_428_777_653_1,
        -176.615_029_162_140_6,
        12.507_343_278_686_905,
        -0.138_571_095_265_720_12,
        9.984_369_578_019_572e-6,
        1.505_632_735_149_311_6e-7,
    ];
    let sum = SERIES.iter().zip(0_u8..).fold(0.999_999_999_999_809_9, |sum, (term, place)| sum + term / (x + f64::from(place)));
    let shifted = x + 6.5;
    (x - 0.5) * shifted.ln() - shifted + (std::f64::consts::TAU.sqrt() * sum).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

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
            assert!((found - published).abs() < 0.006, "{degrees}: {found} is not {published}");
        }
        assert!((coverage(100.0) - 2.025).abs() < 6e-4);
    }

    /// In closed form: ν = 1 is Cauchy's distribution, t = tan(πp/2); ν = 2 has t = p√(2/(1 − p²)).
    #[test]
    fn it_is_the_closed_form_where_there_is_one() {
        assert!((coverage(1.0) / (std::f64::consts::FRAC_PI_2 * LEVEL).tan() - 1.0).abs() < 1e-11);
        assert!((coverage(2.0) / (LEVEL * (2.0 / (1.0 - LEVEL * LEVEL)).sqrt()) - 1.0).abs() < 1e-11);
        assert_eq!((coverage(0.3), coverage(f64::NAN)), (coverage(1.0), 2.0));
    }

    /// Both ways lead to the same where one gives over to the other, and the factor falls with every degree of freedom.
    #[test]
    fn series_and_solution_meet() {
        assert!((solved(MANY) / expanded_about_normal(MANY) - 1.0).abs() < 1e-8);
        let factors: Vec<f64> = (2..400).map(|halves| coverage(0.5 * f64::from(halves))).collect();
        assert!(factors.windows(2).all(|pair| pair[1] < pair[0]) && factors.iter().all(|factor| *factor > 2.0));
    }
}
