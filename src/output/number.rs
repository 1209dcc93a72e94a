//! Numbers as a report prints them: readable unit, true minus sign, value and standard uncertainty to the same decimal.
//! In: SI values with their dimension. Out: text. Knows nothing of where the text goes.

use crate::plan::Comparison;
use crate::quantity::Dimension;
use crate::quantity::display::{readable_unit, significant};
use crate::verdict::{Bound, ConditionOutcome};

/// A value in its readable unit: `7.922 mm`, `−2.000 kN`, `20` for a count.
pub(super) fn text(value: f64, dimension: Dimension) -> String {
    let (unit, factor) = unit(value, dimension);
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
    readable_unit(if by_thousands { 0.1 * value } else { value }, dimension)
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
    minus(&if is_count { format!("{value:.0}") } else { significant(value / factor, 4) })
}

fn join(number: &str, unit: &str) -> String {
    if unit.is_empty() { number.to_owned() } else { format!("{number}\u{a0}{}", typeset(unit)) }
}

/// The hyphen of a negative number as a minus sign.
pub(super) fn minus(number: &str) -> String {
    number.replace('-', "−")
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

/// The bound of a condition as mathematics: `≤ 8.500 mm`, `10.00 J ± 1.500 J`.
pub(super) fn bound(condition: &ConditionOutcome) -> String {
    let number = |value| text(value, condition.dimension);
    match condition.bound {
        None => "—".to_owned(),
        Some(Bound::Compare { comparison, limit }) => format!("{} {}", comparison_sign(comparison), number(limit)),
        Some(Bound::Within { target, tolerance }) => format!("{} ± {}", number(target), number(tolerance)),
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
    }

    #[test]
    fn value_and_uncertainty_end_at_the_same_decimal() {
        assert_eq!(with_uncertainty(20.0, Some(0.123), Dimension::FORCE), "20.00 ± 0.12\u{a0}N");
        assert_eq!(with_uncertainty(-0.002_5, Some(0.000_01), Dimension::LENGTH), "−2.500 ± 0.010\u{a0}mm");
        assert_eq!(with_uncertainty(5.0, None, Dimension::NUMBER), "5");
        assert_eq!(with_uncertainty(5.0, Some(0.0), Dimension::FORCE), "5.000 ± 0\u{a0}N");
    }
}
