//! Value, bound, margin and guard band of a condition, as a report prints them. In: the outcome of a condition. Out: strings.

use super::join;
use super::uncertain::{decimals_of, joined, parts_in, power_of, tens, with_standard};
use crate::verdict::{Bound, ConditionOutcome, ReproductionOutcome};
use psd_plan::Comparison;
#[cfg(test)]
use psd_plan::formula::UncertaintyStatus;
#[cfg(test)]
use psd_text::units::Dimension;
use psd_text::units::display::{self, is_rounding, minus, significant, trimmed, unit};

/// The value of a condition with its expanded uncertainty U, in percent if the plan specifies percent; with u in parentheses if its
/// budget gives no U.
pub(in crate::report) fn value(condition: &ConditionOutcome) -> Option<String> {
    let value = condition.value?;
    let known = condition
        .measurement_uncertainty()
        .filter(|known| !is_rounding(known.standard, condition.dimension));
    let (unit, factor) = if condition.percent {
        ("%".to_owned(), 0.01)
    } else {
        common_unit(condition)
    };
    Some(match (known, condition.conforms) {
        (Some(known), None) => {
            with_standard(value, known.standard, &unit, factor, condition.dimension)
        }
        _ => joined(parts_in(&unit, factor, value, known, condition.dimension)),
    })
}

/// The unit of a row, in which the larger of value and limit is readable: `0.004 ± 0.015 mm` beside `< 0.1 mm`.
fn common_unit(condition: &ConditionOutcome) -> (String, f64) {
    let value = condition.value.unwrap_or_default();
    let limit = condition.bound.map_or(0.0, bounding);
    let larger = if value.abs() > limit.abs() {
        value
    } else {
        limit
    };
    unit(larger, condition.dimension)
}

const fn bounding(bound: Bound) -> f64 {
    match bound {
        Bound::Compare { limit, .. } => limit,
        Bound::Within { target, .. } => target,
    }
}

/// The bound of a condition as mathematics, in the unit of its row: `≤ 8.5 mm`, `8.5 … 11.5 J`, `< 1 %`.
pub(in crate::report) fn bound(condition: &ConditionOutcome) -> String {
    bound_in(&common_unit(condition), condition)
}

/// The same in the usual unit of the bound, for a label without a value beside it.
pub(crate) fn bound_alone(condition: &ConditionOutcome) -> String {
    let own = unit(condition.bound.map_or(0.0, bounding), condition.dimension);
    bound_in(&own, condition)
}

fn bound_in((unit, factor): &(String, f64), condition: &ConditionOutcome) -> String {
    let (scale, percent) = scale(condition);
    let number = |value: f64| limit(value, unit, *factor, condition);
    match condition.bound {
        None => "—".to_owned(),
        Some(Bound::Compare { comparison, limit }) => {
            format!("{} {}", comparison_sign(comparison), number(limit))
        }
        Some(Bound::Within { target, tolerance }) => {
            // A tolerance below a thousandth of the target is printed in a separate unit.
            if unit.is_empty() || (tolerance >= 1e-3 * target.abs() && target != 0.0) {
                join(
                    &between(scale * target / factor, scale * tolerance / factor),
                    unit,
                ) + percent
            } else {
                let (own, factor) = display::unit(tolerance, condition.dimension);
                let tolerance = limit(tolerance, &own, factor, condition);
                format!("{} within {tolerance}", number(target))
            }
        }
    }
}

/// The factor of percent, if the plan specifies it, and its sign.
const fn scale(condition: &ConditionOutcome) -> (f64, &'static str) {
    if condition.percent {
        (100.0, "\u{a0}%")
    } else {
        (1.0, "")
    }
}

/// A number that a value is compared with.
fn limit(value: f64, unit: &str, factor: f64, condition: &ConditionOutcome) -> String {
    /// Digits of a computed bound.
    const DIGITS: usize = 5;
    let (scale, percent) = scale(condition);
    let digits = minus(&trimmed(&rounded(scale * value / factor, DIGITS)));
    join(&digits, unit) + percent
}

/// The published number, or the target of a tolerance, in the unit of its row.
pub(in crate::report) fn target(condition: &ConditionOutcome) -> String {
    let (unit, factor) = common_unit(condition);
    match condition.bound {
        Some(Bound::Within { target, .. }) => limit(target, &unit, factor, condition),
        _ => "—".to_owned(),
    }
}

/// The tolerance about a published number.
pub(in crate::report) fn tolerance(condition: &ConditionOutcome) -> String {
    match condition.bound {
        Some(Bound::Within { tolerance, .. }) => {
            let (unit, factor) = unit(tolerance, condition.dimension);
            limit(tolerance, &unit, factor, condition)
        }
        _ => "—".to_owned(),
    }
}

/// The signed difference from the published number, with its fraction: `+0.914 mm (+0.58 %)`.
pub(in crate::report) fn difference(outcome: &ReproductionOutcome) -> String {
    /// Digits of a difference, and of its fraction.
    const DIGITS: (usize, usize) = (3, 2);
    let sign = |number: f64| if number > 0.0 { "+" } else { "" };
    let Some(difference) = outcome.difference() else {
        return "—".to_owned();
    };
    let text = distance(difference, DIGITS.0, &outcome.compared);
    let percent = outcome
        .relative_difference()
        .map_or_else(String::new, |relative| {
            let digits = minus(&rounded(100.0 * relative, DIGITS.1));
            format!(" ({}{digits}\u{a0}%)", sign(relative))
        });
    format!("{}{text}{percent}", sign(difference))
}

/// The ends of a tolerance interval, to the third digit of the tolerance if it has no more digits, else to the second.
fn between(target: f64, tolerance: f64) -> String {
    let power = power_of(target.abs().max(tolerance));
    let by = 10.0_f64.powi(power);
    let (target, tolerance) = (target / by, tolerance / by);
    let third: f64 = format!("{tolerance:.2e}").parse().unwrap_or(tolerance);
    let whole = (third - tolerance).abs() <= 1e-9 * tolerance;
    let ends = [target - tolerance, target + tolerance];
    let ends = match decimals_of(target, tolerance) {
        Some(second) => {
            let decimals = usize::try_from(second + i32::from(whole)).unwrap_or(0);
            let mut ends = ends.map(|number| format!("{number:.decimals$}"));
            // Trailing zeros of both are removed.
            while ends[0].contains('.')
                && ends
                    .iter()
                    .all(|text| text.ends_with('0') || text.ends_with('.'))
            {
                ends = ends.map(|mut text| {
                    text.pop();
                    text
                });
            }
            ends.map(|text| minus(&text))
        }
        None => ends.map(|number| minus(&trimmed(&significant(number, 6)))),
    };
    let [low, high] = ends;
    if power == 0 {
        format!("{low} … {high}")
    } else {
        format!("({low} … {high}){}", tens(power))
    }
}

/// The margin of a condition in the unit of its row; None if it has no margin.
pub(in crate::report) fn margin(condition: &ConditionOutcome) -> Option<String> {
    /// Digits of a distance to a limit: a difference has no more.
    const DIGITS: usize = 3;
    condition.bound?;
    condition
        .margin
        .map(|margin| distance(margin, DIGITS, condition))
}

/// The guard band of a condition in the unit of its row; None if it has no guard band.
pub(in crate::report) fn guard_band(condition: &ConditionOutcome) -> Option<String> {
    /// The band is U, of which two digits are printed.
    const DIGITS: usize = 2;
    condition
        .guard_band
        .map(|band| distance(band, DIGITS, condition))
}

fn distance(distance: f64, digits: usize, condition: &ConditionOutcome) -> String {
    let (scale, percent) = scale(condition);
    // In the unit of the row, or in a separate unit if that would give many zeros.
    let common = common_unit(condition);
    let (unit, factor) = if distance == 0.0 || (distance / common.1).abs() >= 1e-3 {
        common
    } else {
        unit(distance, condition.dimension)
    };
    join(&minus(&rounded(scale * distance / factor, digits)), &unit) + percent
}

/// A number to `digits` significant digits; a whole number in full.
fn rounded(value: f64, digits: usize) -> String {
    match value.abs() {
        size if value.fract() == 0.0 && size < 1e9 => format!("{value:.0}"),
        // A power of ten instead of a row of zeros.
        size if size < 1e-3 => format!("{value:.*e}", digits.saturating_sub(1)),
        // Rounded first: 0.009999999 is 0.0100, not 0.01000.
        _ => significant(
            format!("{value:.*e}", digits.saturating_sub(1))
                .parse()
                .unwrap_or(value),
            digits,
        ),
    }
}

/// The probability of conformity, as printed: `39 %`, `> 99.9 %`.
pub(in crate::report) fn probability(fraction: f64) -> String {
    match 100.0 * fraction {
        percent if percent > 99.9 => ">\u{a0}99.9\u{a0}%".to_owned(),
        percent if percent < 0.1 => "<\u{a0}0.1\u{a0}%".to_owned(),
        percent if (10.0..90.0).contains(&percent) => format!("{percent:.0}\u{a0}%"),
        percent => format!("{percent:.1}\u{a0}%"),
    }
}

/// The printed sign of a comparison.
pub(crate) const fn comparison_sign(comparison: Comparison) -> &'static str {
    match comparison {
        Comparison::Less => "<",
        Comparison::LessEqual => "≤",
        Comparison::Greater => ">",
        Comparison::GreaterEqual => "≥",
        Comparison::Equal => "=",
        Comparison::NotEqual => "≠",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_margin_has_the_unit_of_the_value_or_its_own() {
        let condition = |text: &str, dimension, bound: Bound, value| ConditionOutcome {
            text: text.to_owned(),
            verdict: crate::verdict::Verdict::Pass,
            dimension,
            value: Some(value),
            uncertainty: None,
            status: UncertaintyStatus::Exact,
            percent: text.ends_with('%'),
            degrees: f64::INFINITY,
            bound: Some(bound),
            margin: Some(bound.margin(value)),
            guard_band: None,
            margin_degrees: f64::INFINITY,
            conforms: None,
            wider_than_tolerance: false,
            reason: None,
            in_finer_steps: None,
        };
        let below = |limit| Bound::Compare {
            comparison: Comparison::Less,
            limit,
        };
        let travel = condition("x < 0.2 m", Dimension::LENGTH, below(0.2), 0.199_986_2);
        assert_eq!(margin(&travel).unwrap(), "13.8\u{a0}µm");
        let small = condition("x < 0.1 mm", Dimension::LENGTH, below(1e-4), 4e-6);
        assert_eq!(
            (
                value(&small).unwrap(),
                bound(&small),
                margin(&small).unwrap()
            ),
            (
                "0.004000\u{a0}mm".to_owned(),
                "< 0.1\u{a0}mm".to_owned(),
                "0.0960\u{a0}mm".to_owned()
            ),
            "one unit for value, limit and margin"
        );
        let large = condition("x < 0.1 mm", Dimension::LENGTH, below(1e-4), 0.4);
        assert_eq!(
            (bound(&large), bound_alone(&large)),
            ("< 1 × 10⁻⁴\u{a0}m".to_owned(), "< 0.1\u{a0}mm".to_owned())
        );
        let closes = condition("abs(e) < 1e-6", Dimension::NUMBER, below(1e-6), 0.0);
        assert_eq!(bound(&closes), "< 1 × 10⁻⁶");
        let percent = condition("abs(e) < 1 %", Dimension::NUMBER, below(0.01), 0.001_71);
        assert_eq!(
            (bound(&percent), value(&percent).unwrap()),
            ("< 1\u{a0}%".to_owned(), "0.1710\u{a0}%".to_owned())
        );
        assert_eq!(margin(&percent).unwrap(), "0.829\u{a0}%");
        let energy = Bound::Within {
            target: 9.48,
            tolerance: 0.948,
        };
        assert_eq!(
            bound(&condition(
                "e within 10 % of 9.48 J",
                Dimension::ENERGY,
                energy,
                9.0
            )),
            "8.532 … 10.428\u{a0}J"
        );
        let reached = condition("e within 10 % of 9.48 J", Dimension::ENERGY, energy, 9.316);
        assert_eq!(margin(&reached).unwrap(), "0.784\u{a0}J");
        let stiff = Bound::Within {
            target: 3e5,
            tolerance: 1.5e3,
        };
        assert_eq!(
            bound(&condition(
                "k within 0.5 % of 300 kN/m",
                Dimension::STIFFNESS,
                stiff,
                3e5
            )),
            "298.5 … 301.5\u{a0}kN/m"
        );
        let within = |target: f64, tolerance: f64, dimension| {
            bound(&condition(
                "x within y of z",
                dimension,
                Bound::Within { target, tolerance },
                target,
            ))
        };
        assert_eq!(
            within(0.156_19, 0.002 * 0.156_19, Dimension::LENGTH),
            "0.15588 … 0.15650\u{a0}m"
        );
        assert_eq!(
            within(0.833_333_3, 0.000_833_333, Dimension::NUMBER),
            "0.83250 … 0.83417"
        );
        assert_eq!(
            within(1.7e-7, 2e-8, Dimension::NUMBER),
            "(1.5 … 1.9) × 10⁻⁷"
        );
        assert_eq!(within(20.0, 1.0, Dimension::NUMBER), "19 … 21");
        assert_eq!(within(100.0, 10.0, Dimension::FORCE), "90 … 110\u{a0}N");
        assert_eq!(within(1.0, 1e-6, Dimension::NUMBER), "0.999999 … 1.000001");
        assert_eq!(
            within(0.0, 1e-6, Dimension::LENGTH),
            "0\u{a0}mm within 1\u{a0}µm"
        );
    }
}
