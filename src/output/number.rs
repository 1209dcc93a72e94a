//! Numbers as a report prints them: readable unit, true minus sign, value and standard uncertainty to the same decimal.
//! In: SI values with their dimension. Out: text. Knows nothing of where the text goes.

use crate::plan::Comparison;
use crate::quantity::Dimension;
use crate::quantity::display::{readable_unit, significant};
use crate::verdict::{Bound, ConditionOutcome};

/// A value in its readable unit: `7.922 mm`, `−2.000 kN`, `20` for a count.
pub(super) fn text(value: f64, dimension: Dimension) -> String {
    text_beside(value, value, dimension)
}

/// A value as somebody stated it, without digits that nobody stated: `8.5 mm`, `10 s`.
pub(super) fn stated(value: f64, dimension: Dimension) -> String {
    stated_beside(value, value, dimension)
}

/// A stated value in the unit of `beside`, so that the two can be compared at sight.
pub(super) fn stated_beside(value: f64, beside: f64, dimension: Dimension) -> String {
    let (unit, factor) = unit(beside, dimension);
    let digits = significant(value / factor, 6);
    let trimmed = match digits.split_once('.') {
        Some((_, decimals)) if decimals.contains('e') => digits,
        Some(_) => digits.trim_end_matches('0').trim_end_matches('.').to_owned(),
        None => digits,
    };
    join(&minus(&trimmed), &unit)
}

/// A computed value in the unit of `beside`.
pub(super) fn text_beside(value: f64, beside: f64, dimension: Dimension) -> String {
    let (unit, factor) = unit(beside, dimension);
    join(&number(value, factor, dimension), &unit)
}

/// A value and its standard uncertainty in one unit, both to the uncertainty's second digit: `300.02 ± 0.15 kN/m`.
pub(super) fn with_uncertainty(value: f64, uncertainty: Option<f64>, dimension: Dimension) -> String {
    let Some(uncertainty) = uncertainty.filter(|u| u.is_finite()) else { return text(value, dimension) };
    let (unit, factor) = unit(value, dimension);
    let (scaled, scaled_uncertainty) = (value / factor, uncertainty / factor);
    let Some(decimals) = decimals_of(scaled, scaled_uncertainty) else {
        return join(&format!("{} ± {}", number(value, factor, dimension), significant(scaled_uncertainty, 2)), &unit);
    };
    join(&minus(&format!("{scaled:.decimals$} ± {scaled_uncertainty:.decimals$}")), &unit)
}

/// The unit to print a value in, and how many SI units it is. Forces, stiffnesses and energies keep three digits before
/// the decimal (`327.7 N/m`); the others go by the shared rule (`0.1579 m`).
pub(super) fn unit(value: f64, dimension: Dimension) -> (String, f64) {
    let by_thousands = matches!(dimension, Dimension::FORCE | Dimension::STIFFNESS | Dimension::ENERGY);
    match dimension {
        // A time-out of 10 s is not 0.1667 min.
        Dimension::TIME if value.abs() < 60.0 && value.abs() >= 1.0 => ("s".to_owned(), 1.0),
        Dimension::TIME if value.abs() < 3600.0 && value.abs() >= 60.0 => ("min".to_owned(), 60.0),
        _ => readable_unit(if by_thousands { 0.1 * value } else { value }, dimension),
    }
}

/// Decimals that show two digits of the uncertainty; None where plain decimals would not be readable.
fn decimals_of(value: f64, uncertainty: f64) -> Option<usize> {
    if uncertainty <= 0.0 || value.abs() >= 1e7 {
        return None;
    }
    let decimals = 1.0 - uncertainty.log10().floor();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 9")]
    (decimals <= 9.0).then(|| decimals.max(0.0) as usize)
}

fn number(value: f64, factor: f64, dimension: Dimension) -> String {
    let is_count = dimension == Dimension::NUMBER && value.fract() == 0.0 && value.abs() < 1e9;
    if is_count {
        return minus(&format!("{value:.0}"));
    }
    // Rounded first: 0.009999999 is 0.01000, not 0.010000.
    let scaled = value / factor;
    let rounded = format!("{scaled:.3e}").parse().unwrap_or(scaled);
    minus(&significant(rounded, 4))
}

fn join(number: &str, unit: &str) -> String {
    if unit.is_empty() { number.to_owned() } else { format!("{number}\u{a0}{}", typeset(unit)) }
}

/// A number with a true minus sign and its power of ten raised: `-1.6e-15` → `−1.6 × 10⁻¹⁵`.
pub(super) fn minus(number: &str) -> String {
    match number.split_once('e') {
        Some((lead, power)) => {
            let raised: String = power.chars().filter_map(superscript).collect();
            format!("{} × 10{raised}", lead.replace('-', "−"))
        }
        None => number.replace('-', "−"),
    }
}

/// A unit of the language as print sets it: `N*s/m` → `N·s/m`, `mm^2` → `mm²`, `um` → `µm`.
pub(super) fn typeset(unit: &str) -> String {
    let mut set = String::with_capacity(unit.len());
    let mut rest = unit.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '*' => set.push('·'),
            '^' => {
                while let Some(raised) = rest.peek().copied().and_then(superscript) {
                    set.push(raised);
                    rest.next();
                }
            }
            other => set.push(other),
        }
    }
    if let Some(rest) = set.strip_prefix('u') { format!("µ{rest}") } else { set }
}

/// The bound of a condition as mathematics: `≤ 8.500 mm`, `10 J ± 1.5 J`.
pub(super) fn bound(condition: &ConditionOutcome) -> String {
    let number = |value| stated(value, condition.dimension);
    match condition.bound {
        None => "—".to_owned(),
        Some(Bound::Compare { comparison, limit }) => format!("{} {}", comparison_sign(comparison), number(limit)),
        Some(Bound::Within { target, tolerance }) => format!("{} ± {}", number(target), number(tolerance)),
    }
}

/// The margin of a condition in the unit of its bound; None where there is no margin.
pub(super) fn margin(condition: &ConditionOutcome) -> Option<String> {
    let beside = match condition.bound? {
        Bound::Compare { limit: at, .. } | Bound::Within { target: at, .. } => at,
    };
    condition.margin.map(|margin| text_beside(margin, if beside == 0.0 { margin } else { beside }, condition.dimension))
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

fn superscript(c: char) -> Option<char> {
    Some(match c {
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        '.' => '\u{b7}',
        '-' => '⁻',
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_typeset() {
        assert_eq!(typeset("N*s/m"), "N·s/m");
        assert_eq!(typeset("mm^2"), "mm²");
        assert_eq!(typeset("um"), "µm");
        assert_eq!(minus("-1.6e-15"), "−1.6 × 10⁻¹⁵");
    }

    #[test]
    fn a_stated_value_has_no_digits_that_nobody_stated() {
        assert_eq!(stated(10.0, Dimension::TIME), "10\u{a0}s");
        assert_eq!(stated(0.0085, Dimension::LENGTH), "8.5\u{a0}mm");
        assert_eq!(stated_beside(-0.01, 0.2, Dimension::LENGTH), "−0.01\u{a0}m");
        assert_eq!(stated(300_000.0, Dimension::STIFFNESS), "300\u{a0}kN/m");
    }

    #[test]
    fn value_and_uncertainty_end_at_the_same_decimal() {
        assert_eq!(with_uncertainty(20.0, Some(0.123), Dimension::FORCE), "20.00 ± 0.12\u{a0}N");
        assert_eq!(with_uncertainty(-0.002_5, Some(0.000_01), Dimension::LENGTH), "−2.500 ± 0.010\u{a0}mm");
        assert_eq!(with_uncertainty(5.0, None, Dimension::NUMBER), "5");
        assert_eq!(with_uncertainty(5.0, Some(0.0), Dimension::FORCE), "5.000 ± 0\u{a0}N");
    }
}
