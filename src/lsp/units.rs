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
pub fn of(dimension: Dimension) -> Vec<String> {
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

/// A number in another unit, if it means exactly the same.
pub fn converted(value: f64, from: Unit, to: &str) -> Option<String> {
    let unit = unit::parse(to)
        .ok()
        .filter(|unit| unit.dimension == from.dimension && unit.zero == from.zero)?;
    let exact = value * from.factor / unit.factor;
    // The shortest number that means the same to 15 digits.
    let digits: f64 = format!("{exact:.14e}").parse().ok()?;
    let same =
        (digits * unit.factor - value * from.factor).abs() <= 1e-14 * (value * from.factor).abs();
    let text = if (1e-4..1e9).contains(&digits.abs()) || digits == 0.0 {
        format!("{digits}")
    } else {
        format!("{digits:e}")
    };
    same.then(|| format!("{text} {to}"))
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
            let found = of(dimension);
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
    fn a_converted_number_means_the_same() {
        let of = |token: &str| unit::parse(token).unwrap();
        assert_eq!(
            converted(300.0, of("kN/m"), "N/mm").as_deref(),
            Some("300 N/mm")
        );
        assert_eq!(converted(2.0, of("in"), "mm").as_deref(), Some("50.8 mm"));
        assert_eq!(converted(0.3, of("mm"), "m").as_deref(), Some("0.0003 m"));
        assert_eq!(converted(1.0, of("m"), "kg"), None);
    }
}
