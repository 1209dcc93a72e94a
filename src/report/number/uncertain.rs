//! Values with their uncertainties, both to the same decimal (JCGM 100:2008, 7.2). In: SI values with their dimension. Out:
//! strings.

use super::{join_typeset, text, without_sign_of_zero};
use psd_plan::schema::{Printed, printed, printed_unit};
use psd_plan::uncertainty::MeasurementUncertainty;
use psd_text::units::Dimension;
use psd_text::units::display::{digits, is_rounding, minus, significant, typeset, unit};

/// A number and its uncertainties in one unit: value and U to the second digit of U, u to its own (JCGM 100:2008, 7.2.6).
pub(in crate::report) struct Parts {
    pub value: String,
    /// Standard, u.
    pub standard: Option<String>,
    /// Expanded, U = k·u.
    pub expanded: Option<String>,
    /// Typeset; empty for a plain number.
    pub unit: String,
}

/// A value with its uncertainties, one string per column of a table. Small and large numbers share one power of ten.
pub(in crate::report) fn parts(
    value: f64,
    known: Option<MeasurementUncertainty>,
    dimension: Dimension,
) -> Parts {
    let (unit, factor) = unit(value, dimension);
    parts_in(&unit, factor, value, known, dimension)
}

/// The same for a result: a number near 1 to its nines, a fraction in percent.
pub(in crate::report) fn parts_of_result(
    name: &str,
    value: f64,
    known: Option<MeasurementUncertainty>,
    dimension: Dimension,
) -> Parts {
    if printed(name) == Printed::NearOne {
        return Parts {
            value: format!("{value:.6}"),
            standard: None,
            expanded: None,
            unit: String::new(),
        };
    }
    let (unit, factor) = printed_unit(name, value, dimension);
    parts_in(&unit, factor, value, known, dimension)
}

/// The same in this unit.
pub(super) fn parts_in(
    unit: &str,
    factor: f64,
    value: f64,
    known: Option<MeasurementUncertainty>,
    dimension: Dimension,
) -> Parts {
    let set = typeset(unit);
    let Some(known) = known.filter(|known| known.standard.is_finite()) else {
        return Parts {
            value: digits(value, factor, dimension),
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
            let text =
                |number: f64, decimals: i32| raised(&minus(&fixed(number / by, decimals)), power);
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

/// The power of ten of a printed number: 0 where plain decimals are readable.
pub(super) fn power_of(size: f64) -> i32 {
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

/// Two numbers with the same last decimal, as one: `9.480 ± 0.948`, and with one power of ten for both, `(1.70 ± 0.23) × 10⁻⁷`.
pub(in crate::report) fn plus_minus(value: &str, uncertainty: &str) -> String {
    match (value.split_once(" × "), uncertainty.split_once(" × ")) {
        (Some((value, power)), Some((uncertainty, same))) if power == same => {
            format!("({value} ± {uncertainty}) × {power}")
        }
        _ => format!("{value} ± {uncertainty}"),
    }
}

/// A value and its expanded uncertainty in one unit: `7.88 ± 0.32 mm`.
pub(in crate::report) fn with_expanded(
    value: f64,
    known: MeasurementUncertainty,
    dimension: Dimension,
) -> String {
    joined(parts(value, Some(known), dimension))
}

/// A result with its expanded uncertainty if it has one: `7.88 ± 0.32 mm`, `−0.01693 %`.
pub(in crate::report) fn of_result(
    name: &str,
    value: f64,
    known: Option<MeasurementUncertainty>,
    dimension: Dimension,
) -> String {
    joined(parts_of_result(name, value, known, dimension))
}

pub(super) fn joined(parts: Parts) -> String {
    match parts.expanded {
        Some(expanded) => join_typeset(&plus_minus(&parts.value, &expanded), &parts.unit),
        None => join_typeset(&parts.value, &parts.unit),
    }
}

/// A value and its standard uncertainty in one unit, both to the uncertainty's second digit, in parentheses (JCGM 100:2008, 7.2.2, form 3):
/// `300.02(0.15) kN/m`.
pub(crate) fn with_uncertainty(
    value: f64,
    uncertainty: Option<f64>,
    dimension: Dimension,
) -> String {
    let Some(uncertainty) = uncertainty.filter(|u| u.is_finite() && !is_rounding(*u, dimension))
    else {
        return text(value, dimension);
    };
    let (unit, factor) = unit(value, dimension);
    with_standard(value, uncertainty, &unit, factor, dimension)
}

/// The same in this unit.
pub(super) fn with_standard(
    value: f64,
    uncertainty: f64,
    unit: &str,
    factor: f64,
    dimension: Dimension,
) -> String {
    let (scaled, uncertainty) = (value / factor, uncertainty / factor);
    let power = power_of(scaled.abs().max(uncertainty));
    let by = 10.0_f64.powi(power);
    let number = match decimals_of(scaled / by, uncertainty / by) {
        Some(decimals) => {
            let text = |number: f64| minus(&fixed(number / by, decimals));
            raised_bracket(&text(scaled), &text(uncertainty), power)
        }
        None => format!(
            "{}({})",
            digits(value, factor, dimension),
            minus(&significant(uncertainty, 2))
        ),
    };
    join_typeset(&number, &typeset(unit))
}

/// `1.70(0.23) × 10⁻⁷`
fn raised_bracket(value: &str, uncertainty: &str, power: i32) -> String {
    format!("{value}({uncertainty}){}", tens(power))
}

/// ` × 10⁻⁷`; empty for the power 0.
pub(super) fn tens(power: i32) -> String {
    if power == 0 {
        String::new()
    } else {
        minus(&format!("e{power}"))
    }
}

/// A number to so many decimals; below zero, to tens, hundreds, …
fn fixed(number: f64, decimals: i32) -> String {
    if let Ok(decimals) = usize::try_from(decimals) {
        return without_sign_of_zero(&format!("{number:.decimals$}")).to_owned();
    }
    let step = 10.0_f64.powi(-decimals);
    // Zero is added for a rounded zero without a minus sign.
    format!("{:.0}", (number / step).round() * step + 0.0)
}

/// Decimals that show two digits of the uncertainty, below zero for tens, hundreds, …; None if plain decimals would not be readable.
pub(super) fn decimals_of(value: f64, uncertainty: f64) -> Option<i32> {
    if uncertainty <= 0.0 || value.abs() >= 1e7 {
        return None;
    }
    // Rounded first: 0.0996 is 0.10, and not 0.100.
    let rounded: f64 = format!("{uncertainty:.1e}").parse().unwrap_or(uncertainty);
    let decimals = 1.0 - rounded.log10().floor();
    #[expect(clippy::cast_possible_truncation, reason = "between -308 and 9")]
    (decimals <= 9.0).then_some(decimals as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

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
            "5.000\u{a0}N"
        );
        assert_eq!(
            with_uncertainty(-1.7e-7, Some(2.345e-8), Dimension::NUMBER),
            "−1.70(0.23) × 10⁻⁷"
        );
        assert_eq!(
            with_uncertainty(2.5e8, Some(1.25e6), Dimension::NUMBER),
            "2.500(0.013) × 10⁸"
        );
        // Two digits also of a large uncertainty.
        assert_eq!(
            with_uncertainty(100.4, Some(542.0), Dimension::NUMBER),
            "100(540)"
        );
        assert_eq!(
            with_uncertainty(-12_344.0, Some(996.0), Dimension::NUMBER),
            "−12300(1000)"
        );
        assert_eq!(
            with_expanded(
                -2.0,
                MeasurementUncertainty::exact(271.0),
                Dimension::NUMBER
            ),
            "0 ± 540"
        );
        let column = parts(
            1.7e-7,
            Some(MeasurementUncertainty::exact(2.3e-8)),
            Dimension::NUMBER,
        );
        assert_eq!(
            (column.value.as_str(), column.standard.as_deref()),
            ("1.70 × 10⁻⁷", Some("0.23 × 10⁻⁷"))
        );
    }
}
