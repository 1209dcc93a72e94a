//! Dimensions with rational exponents, and their names in the field.

use std::fmt;

/// A rational exponent, always reduced, denominator positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Exponent {
    numerator: i16,
    denominator: i16,
}

impl Exponent {
    pub const ZERO: Self = Self {
        numerator: 0,
        denominator: 1,
    };

    /// A whole exponent.
    #[must_use]
    pub const fn whole(numerator: i16) -> Self {
        Self {
            numerator,
            denominator: 1,
        }
    }

    /// `numerator / denominator`, reduced. None if the denominator is zero or a part exceeds 16 bits.
    #[must_use]
    pub fn ratio(numerator: i64, denominator: i64) -> Option<Self> {
        match denominator {
            0 => return None,
            // Nearly every exponent is whole.
            1 => return i16::try_from(numerator).ok().map(Self::whole),
            _ => {}
        }
        let divisor = greatest_common_divisor(numerator.unsigned_abs(), denominator.unsigned_abs());
        let divisor = i64::try_from(divisor).ok()? * denominator.signum();
        Some(Self {
            numerator: i16::try_from(numerator / divisor).ok()?,
            denominator: i16::try_from(denominator / divisor).ok()?,
        })
    }

    /// The decimal `value` as a fraction with a denominator of at most 12 (`1.5`, `0.25`, `0.333…`), if it is one.
    #[must_use]
    pub fn from_decimal(value: f64) -> Option<Self> {
        (1_i64..=12).find_map(|denominator| {
            #[expect(clippy::cast_precision_loss, reason = "at most 12")]
            let scaled = value * denominator as f64;
            let nearest = scaled.round();
            #[expect(clippy::cast_possible_truncation, reason = "bounded just before")]
            (nearest.abs() < 1e4 && (scaled - nearest).abs() < 1e-9)
                .then(|| Self::ratio(nearest as i64, denominator))
                .flatten()
        })
    }

    #[must_use]
    pub fn is_zero(self) -> bool {
        self.numerator == 0
    }

    #[must_use]
    pub fn as_f64(self) -> f64 {
        f64::from(self.numerator) / f64::from(self.denominator)
    }

    fn plus(self, other: Self) -> Option<Self> {
        let (a, b) = (i64::from(self.numerator), i64::from(self.denominator));
        let (c, d) = (i64::from(other.numerator), i64::from(other.denominator));
        Self::ratio(a * d + c * b, b * d)
    }

    fn times(self, other: Self) -> Option<Self> {
        Self::ratio(
            i64::from(self.numerator) * i64::from(other.numerator),
            i64::from(self.denominator) * i64::from(other.denominator),
        )
    }
}

const fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 {
        if a == 0 { 1 } else { a }
    } else {
        greatest_common_divisor(b, a % b)
    }
}

impl fmt::Display for Exponent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.denominator == 1 {
            write!(f, "{}", self.numerator)
        } else {
            write!(f, "{}", self.as_f64())
        }
    }
}

/// The dimension of a quantity: exponents of length, mass, time, angle and temperature.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Dimension {
    pub length: Exponent,
    pub mass: Exponent,
    pub time: Exponent,
    pub angle: Exponent,
    pub temperature: Exponent,
}

const fn dimension(length: i16, mass: i16, time: i16) -> Dimension {
    Dimension {
        length: Exponent::whole(length),
        mass: Exponent::whole(mass),
        time: Exponent::whole(time),
        angle: Exponent::ZERO,
        temperature: Exponent::ZERO,
    }
}

impl Dimension {
    pub const NUMBER: Self = dimension(0, 0, 0);
    pub const LENGTH: Self = dimension(1, 0, 0);
    pub const MASS: Self = dimension(0, 1, 0);
    pub const TIME: Self = dimension(0, 0, 1);
    pub const AREA: Self = dimension(2, 0, 0);
    pub const SECTION_MODULUS: Self = dimension(3, 0, 0);
    pub const SECOND_MOMENT: Self = dimension(4, 0, 0);
    pub const ANGLE: Self = Self {
        angle: Exponent::whole(1),
        ..Self::NUMBER
    };
    pub const TEMPERATURE: Self = Self {
        temperature: Exponent::whole(1),
        ..Self::NUMBER
    };
    /// N·m/rad, moment over rotation.
    pub const ROTATIONAL_STIFFNESS: Self = Self {
        angle: Exponent::whole(-1),
        ..Self::ENERGY
    };
    pub const DENSITY: Self = dimension(-3, 1, 0);
    pub const MASS_PER_LENGTH: Self = dimension(-1, 1, 0);
    pub const VELOCITY: Self = dimension(1, 0, -1);
    pub const ACCELERATION: Self = dimension(1, 0, -2);
    pub const FREQUENCY: Self = dimension(0, 0, -1);
    pub const FORCE: Self = dimension(1, 1, -2);
    pub const FORCE_RATE: Self = dimension(1, 1, -3);
    pub const STIFFNESS: Self = dimension(0, 1, -2);
    pub const DAMPING: Self = dimension(0, 1, -1);
    pub const ENERGY: Self = dimension(2, 1, -2);
    pub const IMPULSE: Self = dimension(1, 1, -1);
    pub const PRESSURE: Self = dimension(-1, 1, -2);
    /// N/m^1.5, the stiffness of a Hertz contact.
    pub const HERTZ_STIFFNESS: Self = Self {
        length: Exponent {
            numerator: -1,
            denominator: 2,
        },
        mass: Exponent::whole(1),
        time: Exponent::whole(-2),
        ..Self::NUMBER
    };

    /// The name the field uses for this dimension, such as "force" or "stiffness".
    #[must_use]
    pub fn name(self) -> Option<&'static str> {
        NAMES
            .iter()
            .find(|(named, ..)| *named == self)
            .map(|(_, name, _)| *name)
    }

    /// A unit to suggest for this dimension, such as `N/m` for a stiffness; made of base units where none is usual.
    #[must_use]
    pub fn usual_unit(self) -> String {
        NAMES
            .iter()
            .find(|(named, ..)| *named == self)
            .map_or_else(|| self.in_base_units(), |(_, _, unit)| (*unit).to_owned())
    }

    /// The dimension for the reader: its name, else its base units: "force", "kg·m/s^3".
    #[must_use]
    pub fn describe(self) -> String {
        self.name()
            .map_or_else(|| self.in_base_units(), str::to_owned)
    }

    /// Product of two dimensions. None if an exponent is out of range.
    #[must_use]
    pub fn times(self, other: Self) -> Option<Self> {
        self.combine(other, Exponent::plus)
    }

    /// Quotient of two dimensions. None if an exponent is out of range.
    #[must_use]
    pub fn over(self, other: Self) -> Option<Self> {
        self.times(other.to_power(Exponent::whole(-1))?)
    }

    /// The dimension raised to a rational power. None if an exponent is out of range.
    #[must_use]
    pub fn to_power(self, power: Exponent) -> Option<Self> {
        self.combine(self, |exponent, _| exponent.times(power))
    }

    fn combine(
        self,
        other: Self,
        f: impl Fn(Exponent, Exponent) -> Option<Exponent>,
    ) -> Option<Self> {
        Some(Self {
            length: f(self.length, other.length)?,
            mass: f(self.mass, other.mass)?,
            time: f(self.time, other.time)?,
            angle: f(self.angle, other.angle)?,
            temperature: f(self.temperature, other.temperature)?,
        })
    }

    /// In the language's own unit syntax: `kg*m/s^2`.
    fn in_base_units(self) -> String {
        let parts = [
            ("kg", self.mass),
            ("m", self.length),
            ("s", self.time),
            ("rad", self.angle),
            ("K", self.temperature),
        ];
        let side = |positive: bool| {
            parts
                .iter()
                .filter(move |(_, e)| !e.is_zero() && (e.numerator > 0) == positive)
                .map(|(name, e)| {
                    let size = Exponent {
                        numerator: e.numerator.abs(),
                        denominator: e.denominator,
                    };
                    if size == Exponent::whole(1) {
                        (*name).to_owned()
                    } else {
                        format!("{name}^{size}")
                    }
                })
        };
        let above: Vec<String> = side(true).collect();
        let below: Vec<String> = side(false).collect();
        match (above.is_empty(), below.is_empty()) {
            (true, true) => "number".to_owned(),
            (false, true) => above.join("*"),
            (true, false) => format!("1/{}", below.join("/")),
            (false, false) => format!("{}/{}", above.join("*"), below.join("/")),
        }
    }
}

/// Dimension, its name in the field, and the unit to suggest for it.
const NAMES: &[(Dimension, &str, &str)] = &[
    (Dimension::NUMBER, "number", "1"),
    (Dimension::LENGTH, "length", "mm"),
    (Dimension::MASS, "mass", "kg"),
    (Dimension::TIME, "time", "s"),
    (Dimension::AREA, "area", "mm^2"),
    (Dimension::SECTION_MODULUS, "section modulus", "mm^3"),
    (Dimension::SECOND_MOMENT, "second moment of area", "mm^4"),
    (Dimension::ANGLE, "angle", "rad"),
    (Dimension::TEMPERATURE, "temperature", "K"),
    (
        Dimension::ROTATIONAL_STIFFNESS,
        "rotational stiffness",
        "N*m/rad",
    ),
    (Dimension::DENSITY, "density", "kg/m^3"),
    (Dimension::MASS_PER_LENGTH, "mass per length", "kg/m"),
    (Dimension::VELOCITY, "velocity", "m/s"),
    (Dimension::ACCELERATION, "acceleration", "m/s^2"),
    (Dimension::FREQUENCY, "frequency", "Hz"),
    (Dimension::FORCE, "force", "N"),
    (Dimension::FORCE_RATE, "force rate", "N/s"),
    (Dimension::STIFFNESS, "stiffness", "N/m"),
    (Dimension::DAMPING, "damping", "N*s/m"),
    (Dimension::ENERGY, "energy", "J"),
    (Dimension::IMPULSE, "impulse", "N*s"),
    (Dimension::PRESSURE, "pressure", "Pa"),
    (
        Dimension::HERTZ_STIFFNESS,
        "Hertz contact stiffness",
        "N/m^1.5",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_reduce_and_keep_their_sign_above() {
        assert_eq!(Exponent::ratio(4, -6), Exponent::ratio(-2, 3));
        assert_eq!(Exponent::from_decimal(1.5), Exponent::ratio(3, 2));
        assert_eq!(Exponent::from_decimal(0.37), None);
        assert_eq!(Exponent::ratio(1, 0), None);
    }

    #[test]
    fn force_over_length_is_stiffness() {
        assert_eq!(
            Dimension::FORCE.over(Dimension::LENGTH),
            Some(Dimension::STIFFNESS)
        );
        let power = Exponent::ratio(3, 2).unwrap();
        let hertz = Dimension::FORCE.over(Dimension::LENGTH.to_power(power).unwrap());
        assert_eq!(hertz, Some(Dimension::HERTZ_STIFFNESS));
    }

    #[test]
    fn a_dimension_without_a_name_shows_its_base_units() {
        assert_eq!(
            Dimension::FORCE.times(Dimension::LENGTH),
            Some(Dimension::ENERGY)
        );
        assert_eq!(
            Dimension::FORCE.times(Dimension::FORCE).unwrap().describe(),
            "kg^2*m^2/s^4"
        );
        assert_eq!(
            Dimension::ROTATIONAL_STIFFNESS.in_base_units(),
            "kg*m^2/s^2/rad"
        );
        assert_eq!(Dimension::HERTZ_STIFFNESS.in_base_units(), "kg/m^0.5/s^2");
    }
}
