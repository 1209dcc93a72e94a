//! Numbers for the reader: a value in SI units with its dimension is converted to the unit that a laboratory would use.

use super::dimension::Dimension;

/// A pure number that is smaller in absolute value is a rounding error.
const ROUNDING_OF_NUMBERS: f64 = 1e-12;

/// A value below this fraction of the smallest unit of its dimension is a rounding error: 1e-6 um, 1e-6 N.
const ROUNDING: f64 = 1e-6;

/// Whether a value is only the rounding error of a calculation. It is printed as zero.
#[must_use]
pub fn is_rounding(value: f64, dimension: Dimension) -> bool {
    let least = if dimension == Dimension::NUMBER {
        ROUNDING_OF_NUMBERS
    } else {
        ROUNDING * readable_unit(f64::MIN_POSITIVE, dimension).1
    };
    value.abs() < least
}

/// The usual unit for a value of this size, and its factor to SI units: 0.0079 m → (`mm`, 1e-3).
#[must_use]
pub fn readable_unit(value: f64, dimension: Dimension) -> (String, f64) {
    let size = value.abs();
    let choices: &[(&str, f64)] = match dimension {
        Dimension::LENGTH => &[("um", 1e-6), ("mm", 1e-3), ("m", 1.0)],
        Dimension::TIME => &[
            ("us", 1e-6),
            ("ms", 1e-3),
            ("s", 1.0),
            ("min", 60.0),
            ("h", 3600.0),
        ],
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
    // Minutes and hours are not multiples of ten: 11 s is not 0.18 min.
    let least = |factor: f64| {
        if dimension == Dimension::TIME && factor > 1.0 {
            factor
        } else {
            0.1 * factor
        }
    };
    let fits = choices
        .iter()
        .rev()
        .find(|(_, factor)| size >= least(*factor) * 0.999_999);
    let (unit, factor) = if size == 0.0 || !size.is_finite() {
        choices[choices.len() / 2]
    } else {
        *fits.unwrap_or(&choices[0])
    };
    (unit.to_owned(), factor)
}

fn usual_factor(dimension: Dimension) -> f64 {
    super::unit::parse(&dimension.usual_unit()).map_or(1.0, |unit| unit.factor)
}

/// `digits` significant digits, with trailing zeros, as plain decimals between 1e-4 and 1e7.
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
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the exponent is between -5 and 7"
    )]
    let exponent = exponent as isize;
    let decimals = digits.saturating_sub(1).saturating_add_signed(-exponent);
    format!("{value:.decimals$}")
}

/// The unit to print a value in, and its factor to SI units. Forces, stiffnesses and energies keep three digits before
/// the decimal (`327.7 N/m`); the others go by [`readable_unit`] (`0.1579 m`).
#[must_use]
pub fn unit(value: f64, dimension: Dimension) -> (String, f64) {
    let by_thousands = matches!(
        dimension,
        Dimension::FORCE | Dimension::STIFFNESS | Dimension::ENERGY
    );
    match dimension {
        _ if is_rounding(value, dimension) => readable_unit(0.0, dimension),
        // A time-out of 10 s is not 0.1667 min.
        Dimension::TIME if value.abs() < 60.0 && value.abs() >= 1.0 => ("s".to_owned(), 1.0),
        Dimension::TIME if value.abs() < 3600.0 && value.abs() >= 60.0 => ("min".to_owned(), 60.0),
        _ => readable_unit(if by_thousands { 0.1 * value } else { value }, dimension),
    }
}

/// A measured or computed value with four significant digits in a typeset unit: `7.922 mm`, `355.1 kN/m`, `20.41 µm`.
#[must_use]
pub fn readable(value: f64, dimension: Dimension) -> String {
    readable_beside(value, value, dimension)
}

/// The same in the unit of `beside`, so that the two can be compared directly.
#[must_use]
pub fn readable_beside(value: f64, beside: f64, dimension: Dimension) -> String {
    let (unit, factor) = unit(beside, dimension);
    join(&digits(value, factor, dimension), &unit)
}

/// A value as it was stated, without additional digits: `20 µm`, `8.5 mm`, `10 s`.
#[must_use]
pub fn stated(value: f64, dimension: Dimension) -> String {
    stated_beside(value, value, dimension)
}

/// A stated value in the unit of `beside`.
#[must_use]
pub fn stated_beside(value: f64, beside: f64, dimension: Dimension) -> String {
    let (unit, factor) = unit(beside, dimension);
    join(&minus(&trimmed(&significant(value / factor, 6))), &unit)
}

/// A number without trailing zeros: `8.50000` → `8.5`, `1.000e-6` → `1e-6`.
#[must_use]
pub fn trimmed(digits: &str) -> String {
    let (lead, power) = digits
        .find('e')
        .map_or((digits, ""), |at| digits.split_at(at));
    let lead = if lead.contains('.') {
        lead.trim_end_matches('0').trim_end_matches('.')
    } else {
        lead
    };
    format!("{lead}{power}")
}

/// Four significant digits of a value in a unit; a count has no decimals. A power of ten replaces a row of zeros.
#[must_use]
pub fn digits(value: f64, factor: f64, dimension: Dimension) -> String {
    if is_rounding(value, dimension) {
        return "0".to_owned();
    }
    let scaled = value / factor;
    let is_count = dimension == Dimension::NUMBER && scaled.fract() == 0.0 && scaled.abs() < 1e9;
    if is_count {
        return minus(&format!("{scaled:.0}"));
    }
    // Rounded first: 0.009999999 is 0.01000, not 0.010000.
    let text = format!("{scaled:.3e}");
    let rounded: f64 = text.parse().unwrap_or(scaled);
    minus(&if rounded.abs() < 1e-4 {
        text
    } else {
        significant(rounded, 4)
    })
}

/// A number and its typeset unit.
#[must_use]
pub fn join(number: &str, unit: &str) -> String {
    if unit.is_empty() {
        number.to_owned()
    } else {
        format!("{number} {}", typeset(unit))
    }
}

/// A number with a true minus sign and its power of ten as a superscript: `-1.6e-15` → `−1.6 × 10⁻¹⁵`.
#[must_use]
pub fn minus(number: &str) -> String {
    match number.split_once('e') {
        Some((lead, power)) => {
            let raised: String = power.chars().filter_map(superscript).collect();
            format!("{} × 10{raised}", lead.replace('-', "−"))
        }
        None => number.replace('-', "−"),
    }
}

/// A unit of the language, typeset: `N*s/m` → `N·s/m`, `mm^2` → `mm²`, `um` → `µm`.
#[must_use]
pub fn typeset(unit: &str) -> String {
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
    if let Some(rest) = set.strip_prefix('u') {
        format!("µ{rest}")
    } else {
        set
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

/// A value as a plan writes it, in the language's own units and characters, without trailing zeros: `16 mm`, `-20 um`.
#[must_use]
pub fn plain(value: f64, dimension: Dimension, digits: usize) -> String {
    let (unit, factor) = readable_unit(value, dimension);
    let number = significant(value / factor, digits);
    let decimals = number.contains('.') && !number.contains('e');
    let number = if decimals {
        number.trim_end_matches('0').trim_end_matches('.')
    } else {
        &number
    };
    if unit.is_empty() {
        number.to_owned()
    } else {
        format!("{number} {unit}")
    }
}

/// The SI unit of a dimension in the language's own syntax: `m`, `N/m`, `1`, `kg`.
#[must_use]
pub fn si_unit(dimension: Dimension) -> String {
    match dimension {
        Dimension::LENGTH => "m".to_owned(),
        Dimension::AREA => "m^2".to_owned(),
        Dimension::SECTION_MODULUS => "m^3".to_owned(),
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
        assert_eq!(readable(300e3, Dimension::STIFFNESS), "300.0 kN/m");
        assert_eq!(readable(-20.41e-6, Dimension::LENGTH), "−20.41 µm");
        assert_eq!(readable(0.29, Dimension::TIME), "0.2900 s");
        assert_eq!(readable(11.0, Dimension::TIME), "11.00 s");
        assert_eq!(readable(90.0, Dimension::TIME), "1.500 min");
        assert_eq!(readable(0.0, Dimension::LENGTH), "0 mm");
        assert_eq!(readable(1.084e-19, Dimension::LENGTH), "0 mm");
        assert_eq!(readable(-1.6e-15, Dimension::NUMBER), "0");
        assert_eq!(readable(-0.000_016_93, Dimension::NUMBER), "−1.693 × 10⁻⁵");
        assert_eq!(readable(564e-6, Dimension::AREA), "564.0 mm²");
    }

    #[test]
    fn a_stated_value_has_no_digits_that_nobody_stated() {
        assert_eq!(stated(20e-6, Dimension::LENGTH), "20 µm");
        assert_eq!(stated(10.0, Dimension::TIME), "10 s");
        assert_eq!(stated(0.0085, Dimension::LENGTH), "8.5 mm");
        assert_eq!(stated_beside(-0.01, 0.2, Dimension::LENGTH), "−0.01 m");
        assert_eq!(stated(300_000.0, Dimension::STIFFNESS), "300 kN/m");
    }

    #[test]
    fn units_are_typeset() {
        assert_eq!(typeset("N*s/m"), "N·s/m");
        assert_eq!(typeset("mm^2"), "mm²");
        assert_eq!(typeset("um"), "µm");
        assert_eq!(minus("-1.6e-15"), "−1.6 × 10⁻¹⁵");
    }

    #[test]
    fn plain_values_end_with_a_digit_that_counts() {
        assert_eq!(plain(0.016, Dimension::LENGTH, 4), "16 mm");
        assert_eq!(
            plain(-20.410_256_768_931_806, Dimension::FORCE, 6),
            "-20.4103 N"
        );
        assert_eq!(plain(1500.0, Dimension::FORCE, 4), "1.5 kN");
        assert_eq!(plain(100.0, Dimension::NUMBER, 3), "100");
        assert_eq!(plain(1e9, Dimension::NUMBER, 3), "1.00e9");
    }

    #[test]
    fn every_usual_unit_reads_back_as_its_dimension() {
        for dimension in [
            Dimension::FORCE,
            Dimension::DAMPING,
            Dimension::HERTZ_STIFFNESS,
            Dimension::LENGTH,
            Dimension::AREA,
        ] {
            assert_eq!(
                super::super::unit::parse(&si_unit(dimension))
                    .unwrap()
                    .dimension,
                dimension
            );
            assert_eq!(
                super::super::unit::parse(&si_unit(dimension))
                    .unwrap()
                    .factor,
                1.0
            );
        }
    }
}
