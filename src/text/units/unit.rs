//! The unit table, and the parser of a unit token such as `kN/m`, `mm^2` or `N/m^1.5`.

use std::collections::HashMap;
use std::sync::LazyLock;

use super::dimension::{Dimension, Exponent};

/// A unit: its factor to SI base units, and its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    pub factor: f64,
    pub dimension: Dimension,
    /// The zero of its scale in SI base units: 273.15 K for `degC`, else 0.
    pub zero: f64,
}

impl Unit {
    /// A number of this unit in SI base units.
    #[must_use]
    pub fn to_si(self, number: f64) -> f64 {
        number * self.factor + self.zero
    }

    /// A value in SI base units as a number of this unit.
    #[must_use]
    pub fn of_si(self, value: f64) -> f64 {
        (value - self.zero) / self.factor
    }
}

/// One row of the unit table.
#[derive(Clone, Copy, Debug)]
pub struct UnitName {
    pub symbol: &'static str,
    pub factor: f64,
    pub dimension: Dimension,
    /// The zero of its scale in SI base units.
    pub zero: f64,
    /// Whether SI prefixes are allowed.
    pub prefixes: bool,
    pub doc: &'static str,
}

const fn unit(
    symbol: &'static str,
    factor: f64,
    dimension: Dimension,
    prefixes: bool,
    doc: &'static str,
) -> UnitName {
    UnitName {
        symbol,
        factor,
        dimension,
        zero: 0.0,
        prefixes,
        doc,
    }
}

/// The ice point \[K\]: 0 °C, SI brochure (2019), 2.3.1.
pub const ICE_POINT: f64 = 273.15;

/// Standard gravity \[m/s²\], 3rd CGPM (1901).
pub const STANDARD_GRAVITY: f64 = 9.806_65;
const POUND_FORCE: f64 = 0.453_592_37 * STANDARD_GRAVITY;

/// Every unit name; exact factors from the SI brochure and the international yard and pound agreement (1959).
pub const UNITS: &[UnitName] = &[
    unit("m", 1.0, Dimension::LENGTH, true, "metre"),
    unit("g", 1e-3, Dimension::MASS, true, "gram"),
    unit("t", 1e3, Dimension::MASS, false, "tonne"),
    unit("s", 1.0, Dimension::TIME, true, "second"),
    unit("min", 60.0, Dimension::TIME, false, "minute"),
    unit("h", 3600.0, Dimension::TIME, false, "hour"),
    unit("N", 1.0, Dimension::FORCE, true, "newton"),
    unit("Pa", 1.0, Dimension::PRESSURE, true, "pascal"),
    unit("J", 1.0, Dimension::ENERGY, true, "joule"),
    unit("Hz", 1.0, Dimension::FREQUENCY, true, "hertz"),
    unit(
        "gn",
        STANDARD_GRAVITY,
        Dimension::ACCELERATION,
        false,
        "standard gravity",
    ),
    unit("in", 0.0254, Dimension::LENGTH, false, "inch"),
    unit("ft", 0.3048, Dimension::LENGTH, false, "foot"),
    unit("lb", 0.453_592_37, Dimension::MASS, false, "pound"),
    unit("lbf", POUND_FORCE, Dimension::FORCE, false, "pound-force"),
    unit(
        "kip",
        1e3 * POUND_FORCE,
        Dimension::FORCE,
        false,
        "thousand pound-force",
    ),
    unit(
        "psi",
        POUND_FORCE / (0.0254 * 0.0254),
        Dimension::PRESSURE,
        false,
        "pound-force per square inch",
    ),
    unit(
        "ksi",
        1e3 * POUND_FORCE / (0.0254 * 0.0254),
        Dimension::PRESSURE,
        false,
        "thousand psi",
    ),
    unit("rad", 1.0, Dimension::ANGLE, false, "radian"),
    unit(
        "deg",
        std::f64::consts::PI / 180.0,
        Dimension::ANGLE,
        false,
        "degree of arc",
    ),
    unit("K", 1.0, Dimension::TEMPERATURE, false, "kelvin"),
    UnitName {
        zero: ICE_POINT,
        ..unit(
            "degC",
            1.0,
            Dimension::TEMPERATURE,
            false,
            "degree Celsius, an absolute temperature: `23 degC` is 296.15 K",
        )
    },
    unit("%", 0.01, Dimension::NUMBER, false, "hundredth"),
    unit("1", 1.0, Dimension::NUMBER, false, "one, as in `1/s`"),
];

/// SI prefixes; `u` and `µ` both mean 10⁻⁶.
pub const PREFIXES: &[(&str, f64)] = &[
    ("n", 1e-9),
    ("u", 1e-6),
    ("µ", 1e-6),
    ("μ", 1e-6),
    ("m", 1e-3),
    ("c", 1e-2),
    ("k", 1e3),
    ("M", 1e6),
    ("G", 1e9),
];

/// Why a unit token could not be parsed. Offsets are bytes in the token.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UnitError {
    #[error("no unit is called `{name}`")]
    Unknown { name: String, start: usize },
    #[error("`{text}` is not an exponent")]
    Exponent { text: String, start: usize },
    #[error("`{name}` cannot be part of another unit")]
    Absolute { name: String, start: usize },
    #[error("the unit's exponents are too large")]
    TooLarge,
}

/// Every name of a unit, with and without a prefix. A name of the table is not read as a prefix and another name.
static NAMES: LazyLock<HashMap<String, Unit>> = LazyLock::new(|| {
    let of = |unit: &UnitName, scale: f64| Unit {
        factor: scale * unit.factor,
        dimension: unit.dimension,
        zero: unit.zero,
    };
    let exact = UNITS
        .iter()
        .map(|unit| (unit.symbol.to_owned(), of(unit, 1.0)));
    let mut names: HashMap<String, Unit> = exact.collect();
    for (prefix, scale) in PREFIXES {
        for unit in UNITS.iter().filter(|unit| unit.prefixes) {
            let name = format!("{prefix}{}", unit.symbol);
            names.entry(name).or_insert_with(|| of(unit, *scale));
        }
    }
    names
});

/// Looks up one name, with or without a prefix: `kN`, `mm`, `%`.
#[must_use]
pub fn lookup(name: &str) -> Option<Unit> {
    NAMES.get(name).copied()
}

/// Parses a whole unit token, left to right: `N/m*s` is (N/m)·s.
///
/// # Errors
/// An unknown name, an exponent that is not a number, an exponent out of range, or `degC` beside another unit, with its position in the
/// token.
pub fn parse(token: &str) -> Result<Unit, UnitError> {
    if let Some(alone) = lookup(token) {
        return Ok(alone);
    }
    let mut result = Unit {
        factor: 1.0,
        dimension: Dimension::NUMBER,
        zero: 0.0,
    };
    let mut start = 0;
    let mut divide = false;
    for part in token.split_inclusive(['*', '/']) {
        let body = part.trim_end_matches(['*', '/']);
        let (name, exponent) = match body.split_once('^') {
            Some((name, text)) => {
                let start = start + name.len() + 1;
                let value = text.parse().ok().and_then(Exponent::from_decimal);
                (
                    name,
                    value.ok_or_else(|| UnitError::Exponent {
                        text: text.to_owned(),
                        start,
                    })?,
                )
            }
            None => (body, Exponent::whole(1)),
        };
        let unit = lookup(name).ok_or_else(|| UnitError::Unknown {
            name: name.to_owned(),
            start,
        })?;
        if unit.zero != 0.0 {
            return Err(UnitError::Absolute {
                name: name.to_owned(),
                start,
            });
        }
        let factor = power(unit.factor, exponent);
        let dimension = unit
            .dimension
            .to_power(exponent)
            .ok_or(UnitError::TooLarge)?;
        result = if divide {
            Unit {
                factor: result.factor / factor,
                dimension: result
                    .dimension
                    .over(dimension)
                    .ok_or(UnitError::TooLarge)?,
                zero: 0.0,
            }
        } else {
            Unit {
                factor: result.factor * factor,
                dimension: result
                    .dimension
                    .times(dimension)
                    .ok_or(UnitError::TooLarge)?,
                zero: 0.0,
            }
        };
        divide = part.ends_with('/');
        start += part.len();
    }
    Ok(result)
}

/// `factor^exponent`, by multiplication where the exponent is whole, so that `mm^2` is exactly 1e-6.
fn power(factor: f64, exponent: Exponent) -> f64 {
    let value = exponent.as_f64();
    #[expect(clippy::cast_possible_truncation, reason = "whole and within 16 bits")]
    if value.fract() == 0.0 {
        factor.powi(value as i32)
    } else {
        factor.powf(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn si(token: &str) -> (f64, Dimension) {
        let unit = parse(token).unwrap();
        (unit.factor, unit.dimension)
    }

    #[test]
    fn compound_units_read_left_to_right() {
        assert_eq!(si("kN/m"), (1e3, Dimension::STIFFNESS));
        assert_eq!(si("N/m*s"), (1.0, Dimension::DAMPING));
        assert_eq!(si("kg/m^3"), (1.0, Dimension::DENSITY));
        assert_eq!(si("N/m^1.5"), (1.0, Dimension::HERTZ_STIFFNESS));
        assert_eq!(si("1/s"), (1.0, Dimension::FREQUENCY));
        assert!((si("mm^2").0 - 1e-6).abs() < 1e-21);
    }

    #[test]
    fn a_degree_celsius_stands_alone() {
        let celsius = parse("degC").unwrap();
        assert_eq!((celsius.factor, celsius.zero), (1.0, 273.15));
        assert_eq!(
            si("J/K").1,
            Dimension::ENERGY.over(Dimension::TEMPERATURE).unwrap()
        );
        for (token, start) in [("1/degC", 2), ("J/degC", 2), ("degC^2", 0)] {
            let name = "degC".to_owned();
            assert_eq!(parse(token), Err(UnitError::Absolute { name, start }));
        }
    }

    #[test]
    fn exact_names_win_over_prefixed_ones() {
        assert_eq!(si("min"), (60.0, Dimension::TIME));
        assert_eq!(si("ft").1, Dimension::LENGTH);
        assert_eq!(si("m").0, 1.0);
        assert!((si("lbf").0 - 4.448_221_615_260_5).abs() < 1e-12);
    }

    #[test]
    fn errors_state_the_position_in_the_token() {
        assert_eq!(
            parse("N/mx"),
            Err(UnitError::Unknown {
                name: "mx".into(),
                start: 2
            })
        );
        assert_eq!(
            parse("m^x"),
            Err(UnitError::Exponent {
                text: "x".into(),
                start: 2
            })
        );
    }
}
