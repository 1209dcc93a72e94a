//! What is printed of k, the factor between U and u. In: how well numbers are known. Out: words. It reckons nothing: that is
//! `uncertainty`'s.

use crate::uncertainty::Known;
use crate::units::display::trimmed;
use crate::verdict::Assessment;

/// From so many effective degrees of freedom on they are not told: k is 2 to three digits.
const COUNTLESS: f64 = 1e4;

/// k to two decimals, `2` where that is all there is to say.
pub(super) fn factor(known: Known) -> String {
    trimmed(&format!("{:.2}", known.coverage()))
}

/// Effective degrees of freedom where they are few enough to count.
pub(super) fn degrees(known: Known) -> Option<f64> {
    (known.standard > 0.0 && known.degrees < COUNTLESS).then_some(known.degrees)
}

/// `12.8`, `3`; a dash where there are countless.
pub(super) fn degrees_text(known: Known) -> String {
    degrees(known).map_or_else(
        || "∞".to_owned(),
        |degrees| trimmed(&format!("{degrees:.1}")),
    )
}

/// Whether k is another than 2 at sight.
pub(super) fn is_more(known: Known) -> bool {
    known.standard > 0.0 && factor(known) != "2"
}

/// The largest k by which a condition's value or its guard band is told, where it is another than 2.
pub(super) fn largest(assessment: &Assessment) -> Option<String> {
    let conditions = assessment
        .requirements
        .iter()
        .flat_map(|requirement| &requirement.conditions);
    let all = conditions
        .flat_map(|condition| [condition.known(), condition.margin_known()])
        .flatten();
    let worst = all
        .filter(|known| is_more(*known))
        .max_by(|a, b| a.coverage().total_cmp(&b.coverage()))?;
    Some(factor(worst))
}

/// `U = 2u`, or `U = k·u`.
pub(super) fn equation(assessment: &Assessment) -> &'static str {
    if largest(assessment).is_some() {
        "U = k·u"
    } else {
        "U = 2u"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factor_is_told_where_it_is_not_two() {
        let of = |degrees| Known {
            standard: 0.1,
            degrees,
        };
        assert_eq!(
            [1.0, 4.0, 1e3, f64::INFINITY].map(|degrees| factor(of(degrees))),
            ["13.97", "2.87", "2", "2"]
        );
        assert_eq!(
            [1.0, 12.84, 1e5].map(|degrees| degrees_text(of(degrees))),
            ["1", "12.8", "∞"]
        );
        assert!(
            is_more(of(20.0))
                && !is_more(of(2e3))
                && !is_more(Known {
                    standard: 0.0,
                    degrees: 1.0
                })
        );
    }
}
