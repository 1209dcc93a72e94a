//! Numbers as a report prints them, with a non-breaking space before the unit. In: SI values with their dimension. Out: strings.
//! Values with uncertainty are in `uncertain.rs`, values, bounds and margins of a condition in `condition.rs`.

mod condition;
mod uncertain;

pub(super) use condition::{
    bound, difference, guard_band, margin, probability, target, tolerance, value,
};
pub(crate) use condition::{bound_alone, comparison_sign};
pub(crate) use uncertain::with_uncertainty;
pub(super) use uncertain::{of_result, parts_of_result, plus_minus, with_expanded};

use psd_text::units::Dimension;
use psd_text::units::display;
use psd_text::units::display::{digits, minus, unit};

/// A value in its readable unit: `7.922 mm`, `−2.000 kN`, `20` for a count.
pub(crate) fn text(value: f64, dimension: Dimension) -> String {
    kept_together(&display::readable(value, dimension))
}

/// A stated value, without further digits: `8.5 mm`, `10 s`.
pub(crate) fn stated(value: f64, dimension: Dimension) -> String {
    kept_together(&display::stated(value, dimension))
}

/// A stated value in the unit of `beside`, for comparison.
pub(super) fn stated_beside(value: f64, beside: f64, dimension: Dimension) -> String {
    kept_together(&display::stated_beside(value, beside, dimension))
}

/// A computed value in the unit of `beside`.
pub(crate) fn text_beside(value: f64, beside: f64, dimension: Dimension) -> String {
    kept_together(&display::readable_beside(value, beside, dimension))
}

/// A part of a whole, in the unit of the whole and to its digit number `digits`, so that printed parts add up: `10.000 J`,
/// `0.030 J`.
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
    join(&minus(without_sign_of_zero(&text)), &unit)
}

/// A number in digits; a rounded zero has no sign.
fn without_sign_of_zero(text: &str) -> &str {
    let size = text.trim_start_matches('-');
    if size.bytes().all(|byte| matches!(byte, b'0' | b'.')) {
        size
    } else {
        text
    }
}

/// Joins a number and its unit, the last word, by a non-breaking space.
fn kept_together(text: &str) -> String {
    match text.rsplit_once(' ') {
        Some((number, unit)) if !number.ends_with('×') => format!("{number}\u{a0}{unit}"),
        _ => text.to_owned(),
    }
}

fn join(number: &str, unit: &str) -> String {
    join_typeset(number, &display::typeset(unit))
}

/// A number and a typeset unit.
fn join_typeset(number: &str, unit: &str) -> String {
    if unit.is_empty() {
        number.to_owned()
    } else {
        format!("{number}\u{a0}{unit}")
    }
}

/// A fraction as a percentage to four significant digits: `0.005079 %`.
pub(crate) fn small_percent(fraction: f64) -> String {
    join(&digits(fraction, 0.01, Dimension::NUMBER), "%")
}

/// A fraction as a percentage to five digits.
pub(crate) fn percent(fraction: f64) -> String {
    part_of(100.0 * fraction, 100.0, 5, Dimension::NUMBER) + "\u{a0}%"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_parts_of_a_whole_add_up() {
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
            uncertain::parts(-0.000_017_4, None, Dimension::NUMBER).value,
            "−1.740 × 10⁻⁵"
        );
    }
}
