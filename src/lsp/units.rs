//! The units of a dimension. In: a dimension. Out: the units in which it is written, the usual ones first. They are found by trying the
//! units of the language and their products, so that no list is kept beside the table of units.

use psd_text::units::unit::{self, Unit};
use psd_text::units::{Dimension, display};

/// The single units, in the order in which an engineer thinks of them.
const PARTS: &[&str] = &[
    "m", "mm", "kg", "s", "N", "kN", "ms", "MPa", "GPa", "J", "kJ", "Hz", "t", "g", "cm", "MN",
    "um", "us", "Pa", "kPa", "mJ", "min", "h", "kHz", "in", "ft", "lb", "lbf", "kip", "psi", "ksi",
    "gn", "deg", "rad", "K", "%",
];
/// The units of which products are made.
const PRODUCTS: &[&str] = &[
    "N", "kN", "MN", "m", "mm", "kg", "s", "t", "J", "cm", "lbf", "kip", "in", "ft", "lb",
];
const FORCES: &[&str] = &["N", "kN", "MN", "lbf", "kip"];
const LENGTHS: &[&str] = &["m", "mm", "in"];
/// Most units that are offered.
const MOST: usize = 16;

/// The units of a dimension.
pub fn units_of(dimension: Dimension) -> Vec<String> {
    let mut found = Vec::new();
    let add = |found: &mut Vec<String>, token: String| {
        let fits = unit::parse(&token).is_ok_and(|unit| unit.dimension == dimension);
        if fits && !found.contains(&token) && found.len() < MOST {
            found.push(token);
        }
    };
    let usual = dimension.usual_unit();
    add(&mut found, usual);
    add(&mut found, display::si_unit(dimension));
    let plain = |part: &&&str| !matches!(**part, "deg" | "rad" | "K" | "%" | "gn");
    for part in PARTS {
        add(&mut found, (*part).to_owned());
    }
    for power in [2, 3, 4] {
        for part in PARTS.iter().filter(plain) {
            add(&mut found, format!("{part}^{power}"));
        }
    }
    // A length is not written as J/N.
    if found.len() > 2 || dimension == Dimension::NUMBER {
        return found;
    }
    for above in PRODUCTS {
        for below in PRODUCTS {
            for power in ["", "^2", "^3", "^1.5"] {
                add(&mut found, format!("{above}/{below}{power}"));
            }
        }
        if FORCES.contains(above) {
            add(&mut found, format!("{above}*s"));
            for below in LENGTHS {
                add(&mut found, format!("{above}*s/{below}"));
            }
        }
    }
    found
}

/// Most digits of a number that is converted exactly: a pound in kilograms has 8.
const MOST_DIGITS: usize = 10;
/// Fewest digits of a number that is rounded, as those that are only shown.
const LEAST_DIGITS: usize = 4;

/// A number in another unit.
#[derive(Debug, PartialEq)]
pub struct Converted {
    pub text: String,
    /// It means the same only to the digits that the number carried, or to `LEAST_DIGITS`.
    pub is_rounded: bool,
}

/// A number in another unit of its dimension.
pub fn converted(value: f64, from: Unit, to: &str) -> Option<Converted> {
    let unit = unit::parse(to)
        .ok()
        .filter(|unit| unit.dimension == from.dimension && unit.zero == from.zero)?;
    let meant = value * from.factor;
    let with = |digits: usize| -> Option<f64> {
        let text = format!("{:.*e}", digits - 1, meant / unit.factor);
        text.parse().ok().filter(|number: &f64| number.is_finite())
    };
    let short = with(MOST_DIGITS)?;
    // The factors are floats: their quotient is the decimal number to 15 digits.
    let is_rounded = (short * unit.factor - meant).abs() > 1e-14 * meant.abs();
    let number = if is_rounded {
        with(digits_of(value).max(LEAST_DIGITS))?
    } else {
        short
    };
    let text = if (1e-4..1e9).contains(&number.abs()) || number == 0.0 {
        format!("{number} {to}")
    } else {
        format!("{number:e} {to}")
    };
    Some(Converted { text, is_rounded })
}

/// The digits that a number carries, without zeros at its end.
fn digits_of(value: f64) -> usize {
    let text = format!("{value:e}");
    let mantissa = text.split('e').next().unwrap_or_default();
    mantissa.chars().filter(char::is_ascii_digit).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_fits_and_the_usual_one_is_first() {
        for (dimension, wanted) in [
            (
                Dimension::STIFFNESS,
                ["N/m", "kN/m", "N/mm", "kN/mm"].as_slice(),
            ),
            (Dimension::DAMPING, &["N*s/m", "kg/s", "kN*s/m"]),
            (Dimension::LENGTH, &["m", "mm", "in"]),
            (Dimension::TIME, &["s", "ms", "min"]),
            (Dimension::VELOCITY, &["m/s", "mm/s"]),
            (Dimension::SECOND_MOMENT, &["mm^4", "m^4"]),
            (Dimension::PRESSURE, &["MPa", "Pa", "GPa", "psi"]),
            (Dimension::ACCELERATION, &["gn", "m/s^2"]),
            (Dimension::NUMBER, &["%"]),
            (Dimension::ANGLE, &["rad", "deg"]),
            (Dimension::TEMPERATURE, &["K"]),
        ] {
            let found = units_of(dimension);
            assert!(found.len() <= MOST, "{found:?}");
            let usual = dimension.usual_unit();
            assert!(usual.is_empty() || found[0] == usual, "{found:?}");
            for unit in wanted {
                assert!(
                    found.iter().any(|one| one == unit),
                    "{unit} is not in {found:?}"
                );
            }
            for unit in &found {
                assert_eq!(unit::parse(unit).unwrap().dimension, dimension);
            }
        }
    }

    #[test]
    fn a_converted_number_means_the_same_or_says_that_it_is_rounded() {
        let of = |token: &str| unit::parse(token).unwrap();
        for (value, from, to, text, is_rounded) in [
            (300.0, "kN/m", "N/mm", "300 N/mm", false),
            (2.0, "in", "mm", "50.8 mm", false),
            (0.3, "mm", "m", "0.0003 m", false),
            (1.0, "lb", "kg", "0.45359237 kg", false),
            (0.0, "mm", "in", "0 in", false),
            (1.0, "mm", "in", "0.03937 in", true),
            (40.0, "in", "ft", "3.333 ft", true),
            (-25.12345, "mm", "in", "-0.9891122 in", true),
            (210.0, "GPa", "ksi", "30460 ksi", true),
            (1.0, "lbf", "N", "4.448 N", true),
        ] {
            let wanted = Converted {
                text: text.to_owned(),
                is_rounded,
            };
            assert_eq!(converted(value, of(from), to), Some(wanted));
        }
        assert_eq!(converted(1.0, of("m"), "kg"), None);
        assert_eq!(converted(1e308, of("GPa"), "Pa"), None);
    }
}
