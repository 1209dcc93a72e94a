//! Numbers as a report prints them, unbroken over lines: value and standard uncertainty to the same decimal, bounds, margins.
//! In: SI values with their dimension. Out: text. Knows nothing of where the text goes.

use crate::plan::Comparison;
use crate::uncertainty::Known;
use crate::units::Dimension;
use crate::units::display;
use crate::units::display::{digits, minus, significant, trimmed, unit};
use crate::verdict::{Bound, ConditionOutcome};

/// A value in its readable unit: `7.922 mm`, `−2.000 kN`, `20` for a count.
pub(crate) fn text(value: f64, dimension: Dimension) -> String {
    kept_together(&display::readable(value, dimension))
}

/// A value as somebody stated it, without digits that nobody stated: `8.5 mm`, `10 s`.
pub(crate) fn stated(value: f64, dimension: Dimension) -> String {
    kept_together(&display::stated(value, dimension))
}

/// A stated value in the unit of `beside`, so that the two can be compared at sight.
pub(super) fn stated_beside(value: f64, beside: f64, dimension: Dimension) -> String {
    kept_together(&display::stated_beside(value, beside, dimension))
}

/// A computed value in the unit of `beside`.
pub(crate) fn text_beside(value: f64, beside: f64, dimension: Dimension) -> String {
    kept_together(&display::readable_beside(value, beside, dimension))
}

/// A part of a whole, in its unit and to this digit of it, so that parts add up at sight: `10.000 J`, `0.030 J`.
pub(crate) fn part_of(part: f64, whole: f64, digits: u8, dimension: Dimension) -> String {
    let (unit, factor) = unit(whole, dimension);
    let decimals = f64::from(digits) - 1.0 - (whole / factor).abs().log10().floor();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and 12"
    )]
    let decimals = if decimals.is_finite() {
        decimals.clamp(0.0, 12.0) as usize
    } else {
        3
    };
    let text = format!("{:.decimals$}", part / factor);
    // A rounded zero has no sign.
    let size = text.trim_start_matches('-');
    let zero = size.bytes().all(|byte| matches!(byte, b'0' | b'.'));
    join(&minus(if zero { size } else { &text }), &unit)
}

/// No line ends between a number and its unit, which is its last word.
fn kept_together(text: &str) -> String {
    match text.rsplit_once(' ') {
        Some((number, unit)) if !number.ends_with('×') => format!("{number}\u{a0}{unit}"),
        _ => text.to_owned(),
    }
}

fn join(number: &str, unit: &str) -> String {
    joined(number, &display::typeset(unit))
}

/// A number and a unit that is typeset already.
fn joined(number: &str, unit: &str) -> String {
    if unit.is_empty() {
        number.to_owned()
    } else {
        format!("{number}\u{a0}{unit}")
    }
}

/// A number and its uncertainties in one unit: value and U to the second digit of U, u to its own (JCGM 100:2008, 7.2.6).
pub(super) struct Parts {
    pub value: String,
    /// Standard, u.
    pub standard: Option<String>,
    /// Expanded, U = k·u.
    pub expanded: Option<String>,
    /// As print sets it; empty for a plain number.
    pub unit: String,
}

/// A value with its uncertainties, apart for the columns of a table. Where plain decimals would be a row of zeros all have one
/// power of ten.
pub(super) fn parts(value: f64, known: Option<Known>, dimension: Dimension) -> Parts {
    let (unit, factor) = unit(value, dimension);
    let set = display::typeset(&unit);
    let Some(known) = known.filter(|known| known.standard.is_finite()) else {
        // A row of zeros is counted by nobody.
        let small = value != 0.0 && (value / factor).abs() < 1e-3;
        let value = if small {
            minus(&format!("{:.3e}", value / factor))
        } else {
            digits(value, factor, dimension)
        };
        return Parts {
            value,
            standard: None,
            expanded: None,
            unit: set,
        };
    };
    let (uncertainty, expanded) = (known.standard / factor, known.expanded() / factor);
    let scaled = value / factor;
    let power = power_of(scaled.abs().max(uncertainty));
    let by = 10.0_f64.powi(power);
    let (value, [standard, expanded]) = match decimals_of(scaled / by, expanded / by) {
        Some(decimals) => {
            let text = |number: f64, decimals: usize| {
                raised(&minus(&format!("{:.decimals$}", number / by)), power)
            };
            let own = decimals_of(scaled / by, uncertainty / by).unwrap_or(decimals);
            (
                text(scaled, decimals),
                [text(uncertainty, own), text(expanded, decimals)],
            )
        }
        None => (
            digits(value, factor, dimension),
            [uncertainty, expanded].map(|uncertainty| minus(&significant(uncertainty, 2))),
        ),
    };
    Parts {
        value,
        standard: Some(standard),
        expanded: Some(expanded),
        unit: set,
    }
}

/// The power of ten that a number of this size is told with: none as long as plain decimals are readable.
fn power_of(size: f64) -> i32 {
    if size == 0.0 || !size.is_finite() || (1e-3..1e7).contains(&size) {
        return 0;
    }
    #[expect(clippy::cast_possible_truncation, reason = "between -324 and 308")]
    let power = size.log10().floor() as i32;
    power
}

/// `1.70` with a power of ten: `1.70 × 10⁻⁷`.
fn raised(number: &str, power: i32) -> String {
    if power == 0 {
        number.to_owned()
    } else {
        minus(&format!("{number}e{power}"))
    }
}

/// Two numbers that end alike, as one: `9.480 ± 0.948`, and with one power of ten for both, `(1.70 ± 0.23) × 10⁻⁷`.
pub(super) fn plus_minus(value: &str, uncertainty: &str) -> String {
    match (value.split_once(" × "), uncertainty.split_once(" × ")) {
        (Some((value, power)), Some((uncertainty, same))) if power == same => {
            format!("({value} ± {uncertainty}) × {power}")
        }
        _ => format!("{value} ± {uncertainty}"),
    }
}

/// A value and its standard uncertainty in one unit, both to the uncertainty's second digit, in brackets (JCGM 100:2008, 7.2.2, form 3):
/// `300.02(0.15) kN/m`.
pub(crate) fn with_uncertainty(
    value: f64,
    uncertainty: Option<f64>,
    dimension: Dimension,
) -> String {
    let Some(uncertainty) = uncertainty.filter(|uncertainty| uncertainty.is_finite()) else {
        return text(value, dimension);
    };
    let (unit, factor) = unit(value, dimension);
    let (scaled, uncertainty) = (value / factor, uncertainty / factor);
    let power = power_of(scaled.abs().max(uncertainty));
    let by = 10.0_f64.powi(power);
    let told = match decimals_of(scaled / by, uncertainty / by) {
        Some(decimals) => {
            let text = |number: f64| minus(&format!("{:.decimals$}", number / by));
            raised_bracket(&text(scaled), &text(uncertainty), power)
        }
        None => format!(
            "{}({})",
            digits(value, factor, dimension),
            minus(&significant(uncertainty, 2))
        ),
    };
    joined(&told, &display::typeset(&unit))
}

/// `1.70(0.23) × 10⁻⁷`
fn raised_bracket(value: &str, uncertainty: &str, power: i32) -> String {
    format!("{value}({uncertainty}){}", tens(power))
}

/// ` × 10⁻⁷`; nothing of no power.
fn tens(power: i32) -> String {
    if power == 0 {
        String::new()
    } else {
        minus(&format!("e{power}"))
    }
}

/// Decimals that show two digits of the uncertainty; None where plain decimals would not be readable.
fn decimals_of(value: f64, uncertainty: f64) -> Option<usize> {
    if uncertainty <= 0.0 || value.abs() >= 1e7 {
        return None;
    }
    // Rounded first: 0.0996 is 0.10, and not 0.100.
    let rounded: f64 = format!("{uncertainty:.1e}").parse().unwrap_or(uncertainty);
    let decimals = 1.0 - rounded.log10().floor();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and 9"
    )]
    (decimals <= 9.0).then(|| decimals.max(0.0) as usize)
}

/// The value of a condition with its expanded uncertainty U, in percent where the plan wrote percent. Where its budget gives no U, with
/// u in brackets.
pub(super) fn value(condition: &ConditionOutcome) -> Option<String> {
    let value = condition.value?;
    let (scale, percent) = if in_percent(condition) {
        (100.0, "\u{a0}%")
    } else {
        (1.0, "")
    };
    let known = condition.known().filter(|known| known.standard > 0.0);
    let known = known.map(|known| Known {
        standard: scale * known.standard,
        ..known
    });
    if let (Some(known), None) = (known, condition.conforms) {
        return Some(
            with_uncertainty(scale * value, Some(known.standard), condition.dimension) + percent,
        );
    }
    let parts = parts(scale * value, known, condition.dimension);
    Some(
        match parts.expanded {
            Some(expanded) => joined(&plus_minus(&parts.value, &expanded), &parts.unit),
            None => text(scale * value, condition.dimension),
        } + percent,
    )
}

/// The bound of a condition as mathematics: `≤ 8.5 mm`, `8.5 … 11.5 J`, `< 1 %`.
pub(crate) fn bound(condition: &ConditionOutcome) -> String {
    /// A bound that was computed has more digits than a reader needs.
    const DIGITS: usize = 5;
    let percent = in_percent(condition);
    let (scale, percent) = if percent {
        (100.0, "\u{a0}%")
    } else {
        (1.0, "")
    };
    let digits =
        |value: f64, factor: f64| minus(&trimmed(&rounded(scale * value / factor, DIGITS)));
    let number = |value: f64| {
        let (unit, factor) = unit(value, condition.dimension);
        join(&digits(value, factor), &unit) + percent
    };
    match condition.bound {
        None => "—".to_owned(),
        Some(Bound::Compare { comparison, limit }) => {
            format!("{} {}", comparison_sign(comparison), number(limit))
        }
        Some(Bound::Within { target, tolerance }) => {
            let (unit, factor) = unit(target, condition.dimension);
            // Nearer than a thousandth, the tolerance is readable only in a unit of its own.
            if unit.is_empty() || (tolerance >= 1e-3 * target.abs() && target != 0.0) {
                join(
                    &between(scale * target / factor, scale * tolerance / factor),
                    &unit,
                ) + percent
            } else {
                format!("{} within {}", number(target), number(tolerance))
            }
        }
    }
}

/// The ends of a tolerance, to the digit that tells it: the third where that is all of it, else the second.
fn between(target: f64, tolerance: f64) -> String {
    let power = power_of(target.abs().max(tolerance));
    let by = 10.0_f64.powi(power);
    let (target, tolerance) = (target / by, tolerance / by);
    let third: f64 = format!("{tolerance:.2e}").parse().unwrap_or(tolerance);
    let whole = (third - tolerance).abs() <= 1e-9 * tolerance;
    let ends = [target - tolerance, target + tolerance];
    let ends = match decimals_of(target, tolerance) {
        Some(second) => {
            let decimals = second + usize::from(whole);
            let mut ends = ends.map(|number| format!("{number:.decimals$}"));
            // Zeros that neither of them needs.
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

/// The margin of a condition in the unit of its value; None where there is no margin.
pub(super) fn margin(condition: &ConditionOutcome) -> Option<String> {
    condition.bound?;
    condition.margin.map(|margin| distance(margin, condition))
}

/// The guard band of a condition in the unit of its value; None where there is none.
pub(super) fn guard_band(condition: &ConditionOutcome) -> Option<String> {
    condition.guard_band.map(|band| distance(band, condition))
}

fn distance(distance: f64, condition: &ConditionOutcome) -> String {
    /// The distance to a limit is itself a difference: more digits would be the value's noise.
    const DIGITS: usize = 3;
    let (scale, percent) = if in_percent(condition) {
        (100.0, "\u{a0}%")
    } else {
        (1.0, "")
    };
    // Beside the value, in its unit; where that would be a row of zeros, in its own.
    let beside = condition.value.filter(|value| {
        distance == 0.0 || (distance / unit(*value, condition.dimension).1).abs() >= 1e-3
    });
    let (unit, factor) = unit(beside.unwrap_or(distance), condition.dimension);
    join(&minus(&rounded(scale * distance / factor, DIGITS)), &unit) + percent
}

/// Significant digits, a count as a whole number.
fn rounded(value: f64, digits: usize) -> String {
    match value.abs() {
        size if value.fract() == 0.0 && size < 1e9 => format!("{value:.0}"),
        // A row of zeros is counted by nobody.
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

/// Whether the plan spoke of a plain number as a percentage.
fn in_percent(condition: &ConditionOutcome) -> bool {
    let tolerance_only = matches!(condition.bound, Some(Bound::Within { .. }));
    condition.dimension == Dimension::NUMBER && condition.text.contains('%') && !tolerance_only
}

/// The probability that a measured value conforms, as print sets it: `39 %`, `> 99.9 %`.
pub(super) fn probability(share: f64) -> String {
    match 100.0 * share {
        percent if percent > 99.9 => ">\u{a0}99.9\u{a0}%".to_owned(),
        percent if percent < 0.1 => "<\u{a0}0.1\u{a0}%".to_owned(),
        percent if (10.0..90.0).contains(&percent) => format!("{percent:.0}\u{a0}%"),
        percent => format!("{percent:.1}\u{a0}%"),
    }
}

/// The comparison as print sets it.
pub(super) const fn comparison_sign(comparison: Comparison) -> &'static str {
    match comparison {
        Comparison::Less => "<",
        Comparison::LessEqual => "≤",
        Comparison::Greater => ">",
        Comparison::GreaterEqual => "≥",
        Comparison::Equal => "=",
        Comparison::NotEqual => "≠",
    }
}

/// A share as a percentage of five digits.
pub(crate) fn percent(share: f64) -> String {
    part_of(100.0 * share, 100.0, 5, Dimension::NUMBER) + "\u{a0}%"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_margin_has_the_values_unit_or_its_own_and_a_bound_ends_with_its_tolerance() {
        let condition = |text: &str, dimension, bound: Bound, value| ConditionOutcome {
            text: text.to_owned(),
            verdict: crate::verdict::Verdict::Pass,
            dimension,
            value: Some(value),
            uncertainty: None,
            degrees: f64::INFINITY,
            bound: Some(bound),
            margin: Some(bound.margin(value)),
            guard_band: None,
            margin_degrees: f64::INFINITY,
            conforms: None,
            wider_than_tolerance: false,
            reason: None,
        };
        let below = |limit| Bound::Compare {
            comparison: Comparison::Less,
            limit,
        };
        let travel = condition("x < 0.2 m", Dimension::LENGTH, below(0.2), 0.199_986_2);
        assert_eq!(margin(&travel).unwrap(), "13.8\u{a0}µm");
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
        let told = |target: f64, tolerance: f64, dimension| {
            bound(&condition(
                "x within y of z",
                dimension,
                Bound::Within { target, tolerance },
                target,
            ))
        };
        assert_eq!(
            told(0.156_19, 0.002 * 0.156_19, Dimension::LENGTH),
            "0.15588 … 0.15650\u{a0}m"
        );
        assert_eq!(
            told(0.833_333_3, 0.000_833_333, Dimension::NUMBER),
            "0.83250 … 0.83417"
        );
        assert_eq!(told(1.7e-7, 2e-8, Dimension::NUMBER), "(1.5 … 1.9) × 10⁻⁷");
        assert_eq!(told(20.0, 1.0, Dimension::NUMBER), "19 … 21");
        assert_eq!(told(100.0, 10.0, Dimension::FORCE), "90 … 110\u{a0}N");
        assert_eq!(told(1.0, 1e-6, Dimension::NUMBER), "0.999999 … 1.000001");
        assert_eq!(
            told(0.0, 1e-6, Dimension::LENGTH),
            "0\u{a0}mm within 1\u{a0}µm"
        );
    }

    #[test]
    fn parts_of_a_whole_add_up_at_sight() {
        let part = |value| part_of(value, 10.0, 5, Dimension::ENERGY);
        assert_eq!(
            (part(10.0), part(0.0304), part(-1.4e-8)),
            (
                "10.000\u{a0}J".into(),
                "0.030\u{a0}J".into(),
                "0.000\u{a0}J".into()
            )
        );
        assert_eq!(
            part_of(-0.0017, 4299.0, 5, Dimension::ENERGY),
            "0.0000\u{a0}kJ"
        );
        assert_eq!(part_of(0.0, 0.0, 5, Dimension::ENERGY), "0.000\u{a0}J");
        assert_eq!(
            parts(-0.000_174, None, Dimension::NUMBER).value,
            "−1.740 × 10⁻⁴"
        );
    }

    #[test]
    fn value_and_uncertainty_end_at_the_same_decimal() {
        assert_eq!(
            with_uncertainty(20.0, Some(0.123), Dimension::FORCE),
            "20.00(0.12)\u{a0}N"
        );
        assert_eq!(
            with_uncertainty(-0.002_5, Some(0.000_01), Dimension::LENGTH),
            "−2.500(0.010)\u{a0}mm"
        );
        assert_eq!(with_uncertainty(5.0, None, Dimension::NUMBER), "5");
        assert_eq!(
            with_uncertainty(5.0, Some(0.0), Dimension::FORCE),
            "5.000(0)\u{a0}N"
        );
        assert_eq!(
            with_uncertainty(-1.7e-7, Some(2.345e-8), Dimension::NUMBER),
            "−1.70(0.23) × 10⁻⁷"
        );
        assert_eq!(
            with_uncertainty(2.5e8, Some(1.25e6), Dimension::NUMBER),
            "2.500(0.013) × 10⁸"
        );
        let column = parts(1.7e-7, Some(Known::surely(2.3e-8)), Dimension::NUMBER);
        assert_eq!(
            (column.value.as_str(), column.standard.as_deref()),
            ("1.70 × 10⁻⁷", Some("0.23 × 10⁻⁷"))
        );
    }
}
