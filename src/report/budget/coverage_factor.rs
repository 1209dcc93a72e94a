//! The printed coverage factor k of U = k·u and the effective degrees of freedom. In: combined uncertainties. Out: strings. The
//! module `uncertainty` calculates both.

use crate::verdict::Assessment;
use psd_plan::uncertainty::MeasurementUncertainty;
use psd_text::units::display::trimmed;

/// From this number of effective degrees of freedom on they are not printed: k is 2 to three digits.
const UNLIMITED: f64 = 1e4;

/// k to two decimals without trailing zeros.
pub(in crate::report) fn factor(known: MeasurementUncertainty) -> String {
    trimmed(&format!("{:.2}", known.coverage()))
}

/// Effective degrees of freedom, if they are few enough to be printed.
pub(in crate::report) fn degrees(known: MeasurementUncertainty) -> Option<f64> {
    (known.standard > 0.0 && known.degrees < UNLIMITED).then_some(known.degrees)
}

/// `12.8`, `3`; `∞` if they are not printed.
pub(in crate::report) fn degrees_text(known: MeasurementUncertainty) -> String {
    degrees(known).map_or_else(
        || "∞".to_owned(),
        |degrees| trimmed(&format!("{degrees:.1}")),
    )
}

/// Whether the printed k differs from 2.
pub(in crate::report) fn differs_from_two(known: MeasurementUncertainty) -> bool {
    known.standard > 0.0 && factor(known) != "2"
}

/// The largest k of the values and margins of all conditions, if it differs from 2.
pub(in crate::report) fn largest(assessment: &Assessment) -> Option<String> {
    let conditions = assessment
        .requirements
        .iter()
        .flat_map(|requirement| &requirement.conditions);
    let all = conditions
        .flat_map(|condition| {
            [
                condition.measurement_uncertainty(),
                condition.margin_uncertainty(),
            ]
        })
        .flatten();
    let worst = all
        .filter(|known| differs_from_two(*known))
        .max_by(|a, b| a.coverage().total_cmp(&b.coverage()))?;
    Some(factor(worst))
}

/// `U = 2u`, or `U = k·u`.
pub(in crate::report) fn equation(assessment: &Assessment) -> &'static str {
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
    fn a_factor_is_printed_where_it_differs_from_two() {
        let known = |degrees| MeasurementUncertainty {
            standard: 0.1,
            degrees,
        };
        assert_eq!(
            [1.0, 4.0, 1e3, f64::INFINITY].map(|degrees| factor(known(degrees))),
            ["13.97", "2.87", "2", "2"]
        );
        assert_eq!(
            [1.0, 12.84, 1e5].map(|degrees| degrees_text(known(degrees))),
            ["1", "12.8", "∞"]
        );
        assert!(
            differs_from_two(known(20.0))
                && !differs_from_two(known(2e3))
                && !differs_from_two(MeasurementUncertainty {
                    standard: 0.0,
                    degrees: 1.0
                })
        );
    }
}
