//! Numbers for people: a value in SI with its dimension becomes a value in the unit a lab would write.

use super::dimension::Dimension;

/// The unit a person would use for a value of this size, and how many SI units it is: 0.0079 m → (`mm`, 1e-3).
#[must_use]
pub fn readable_unit(value: f64, dimension: Dimension) -> (String, f64) {
    let size = value.abs();
    let choices: &[(&str, f64)] = match dimension {
        Dimension::LENGTH => &[("um", 1e-6), ("mm", 1e-3), ("m", 1.0)],
        Dimension::TIME => &[("us", 1e-6), ("ms", 1e-3), ("s", 1.0), ("min", 60.0), ("h", 3600.0)],
        Dimension::FORCE => &[("N", 1.0), ("kN", 1e3), ("MN", 1e6)],
        Dimension::STIFFNESS => &[("N/m", 1.0), ("kN/m", 1e3), ("MN/m", 1e6)],
        Dimension::VELOCITY => &[("mm/s", 1e-3), ("m/s", 1.0)],
        Dimension::MASS => &[("g", 1e-3), ("kg", 1.0), ("t", 1e3)],
        Dimension::ENERGY => &[("mJ", 1e-3), ("J", 1.0), ("kJ", 1e3)],
        Dimension::PRESSURE => &[("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9)],
        Dimension::NUMBER => return (String::new(), 1.0),
        _ => return (dimension.usual_unit(), usual_factor(dimension)),
    };
    // The unit must leave the number at 0.1 or more where it can: 0.5 mm, not 500 um; 0.29 s, not 290 ms.
    // Minutes and hours are no multiples of ten: 11 s are not 0.18 min.
    let least = |factor: f64| if dimension == Dimension::TIME && factor > 1.0 { factor } else { 0.1 * factor };
    let fits = choices.iter().rev().find(|(_, factor)| size >= least(*factor) * 0.999_999);
    let (unit, factor) = if size == 0.0 || !size.is_finite() { choices[choices.len() / 2] } else { *fits.unwrap_or(&choices[0]) };
    (unit.to_owned(), factor)
}

fn usual_factor(dimension: Dimension) -> f64 {
    super::unit::parse(&dimension.usual_unit()).map_or(1.0, |unit| unit.factor)
}

/// Up to `digits` significant digits, no trailing zeros lost from what was asked, plain decimals between 1e-4 and 1e7.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor();
    if !(-5.0..7.0).contains(&exponent) {
        return format!("{value:.*e}", digits.saturating_sub(1));
    }
    #[expect(clippy::cast_possible_truncation, reason = "the exponent is between -5 and 7")]
    let exponent = exponent as isize;
    let decimals = digits.saturating_sub(1).saturating_add_signed(-exponent);
    format!("{value:.decimals$}")
}

/// A value with a readable unit and four significant digits: `7.922 mm`, `0.2900 s`, `1.50 %` is left to callers.
#[must_use]
pub fn readable(value: f64, dimension: Dimension) -> String {
    let (unit, factor) = readable_unit(value, dimension);
    let number = significant(value / factor, 4);
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

/// A value as a person writes it, without the zeros at its end: `16 mm`, not `16.00 mm`.
#[must_use]
pub fn plain(value: f64, dimension: Dimension, digits: usize) -> String {
    let (unit, factor) = readable_unit(value, dimension);
    let number = significant(value / factor, digits);
    let decimals = number.contains('.') && !number.contains('e');
    let number = if decimals { number.trim_end_matches('0').trim_end_matches('.') } else { &number };
    if unit.is_empty() { number.to_owned() } else { format!("{number} {unit}") }
}

/// The SI unit of a dimension in the language's own syntax: `m`, `N/m`, `1`, `kg`.
#[must_use]
pub fn si_unit(dimension: Dimension) -> String {
    match dimension {
        Dimension::LENGTH => "m".to_owned(),
        Dimension::AREA => "m^2".to_owned(),
        Dimension::SECOND_MOMENT => "m^4".to_owned(),
        other => other.usual_unit(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readable_picks_the_unit_of_the_lab() {
        assert_eq!(readable(0.007_922, Dimension::LENGTH), "7.922 mm");
        assert_eq!(readable(0.157_864, Dimension::LENGTH), "0.1579 m");
        assert_eq!(readable(300e3, Dimension::STIFFNESS), "0.3000 MN/m");
        assert_eq!(readable(0.29, Dimension::TIME), "0.2900 s");
        assert_eq!(readable(11.0, Dimension::TIME), "11.00 s");
        assert_eq!(readable(90.0, Dimension::TIME), "1.500 min");
        assert_eq!(readable(0.0, Dimension::LENGTH), "0 mm");
        assert_eq!(readable(564e-6, Dimension::AREA), "564.0 mm^2");
    }

    #[test]
    fn plain_values_end_with_a_digit_that_counts() {
        assert_eq!(plain(0.016, Dimension::LENGTH, 4), "16 mm");
        assert_eq!(plain(-20.410_256_768_931_806, Dimension::FORCE, 6), "-20.4103 N");
        assert_eq!(plain(1500.0, Dimension::FORCE, 4), "1.5 kN");
        assert_eq!(plain(100.0, Dimension::NUMBER, 3), "100");
        assert_eq!(plain(1e9, Dimension::NUMBER, 3), "1.00e9");
    }

    #[test]
    fn every_usual_unit_reads_back_as_its_dimension() {
        for dimension in [Dimension::FORCE, Dimension::DAMPING, Dimension::HERTZ_STIFFNESS, Dimension::LENGTH, Dimension::AREA] {
            assert_eq!(super::super::unit::parse(&si_unit(dimension)).unwrap().dimension, dimension);
            assert_eq!(super::super::unit::parse(&si_unit(dimension)).unwrap().factor, 1.0);
        }
    }
}
