//! Errors of dimensions and missing units: E301 to E303.

use crate::check::checker::Typed;
use crate::check::messages::shown;
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;
use psd_text::units::unit::{PREFIXES, STANDARD_GRAVITY, UNITS};
use psd_text::units::{Dimension, Quantity};

/// "a length", "an energy", "a value in kg/m"
pub(super) fn article(dimension: Dimension) -> String {
    let name = dimension.describe();
    if dimension.name().is_none() {
        return format!("a value in {name}");
    }
    let article = if name.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    };
    format!("{article} {name}")
}

/// `3 kg`: the number as it is written, in a suitable unit.
fn example(number: Option<&str>, dimension: Dimension) -> String {
    let number = number.unwrap_or("1");
    if dimension == Dimension::NUMBER {
        number.to_owned()
    } else {
        format!("{number} {}", dimension.usual_unit())
    }
}

/// `kN/m` for `kN`, where `N/m` is required: the suggestion must not be a thousandth of the intended value.
fn of_the_same_size(written: &str, wanted: &str) -> Option<String> {
    let first = |unit: &str| unit.find(['*', '/', '^']).unwrap_or(unit.len());
    let parts = |name: &str| {
        let whole = UNITS
            .iter()
            .find(|unit| unit.symbol == name)
            .map(|unit| ("", unit.symbol));
        let symbols = UNITS
            .iter()
            .filter(|unit| unit.prefixes)
            .map(|unit| unit.symbol);
        let prefixed =
            symbols.flat_map(|symbol| PREFIXES.iter().map(move |(prefix, _)| (*prefix, symbol)));
        whole.or_else(|| {
            prefixed
                .into_iter()
                .find(|(prefix, symbol)| format!("{prefix}{symbol}") == name)
        })
    };
    let (prefix, symbol) = parts(&written[..first(written)])?;
    let (head, rest) = wanted.split_at(first(wanted));
    parts(head)
        .filter(|(_, base)| *base == symbol)
        .map(|_| format!("{prefix}{symbol}{rest}"))
}

pub fn missing_unit(
    text: &str,
    span: Span,
    number: Option<&str>,
    wanted: Dimension,
    wanted_by: &str,
) -> Diagnostic {
    Diagnostic::new(
        Code::MissingUnit,
        format!(
            "`{wanted_by}` requires {}, found a number without a unit",
            article(wanted)
        ),
    )
    .at(span, format!("`{text}` has no unit"))
    .help(format!(
        "write the unit, such as `{}`",
        example(number, wanted)
    ))
}

/// A plain number would be read as radians, but most users mean degrees.
pub fn angle_without_unit(text: &str, span: Span) -> Diagnostic {
    let plain = text.parse::<f64>().is_ok();
    let help = if plain {
        format!("write `{text} deg`, or `{text} rad`")
    } else {
        "write `deg` or `rad`, as in `40 deg`".to_owned()
    };
    Diagnostic::new(Code::MissingUnit, format!("angle `{text}` has no unit"))
        .at(span, "`deg` or `rad` missing")
        .help(help)
}

/// `entries`: a list or range, whose unit is written once, at its end.
pub fn missing_unit_of_entries(
    entries: &str,
    span: Span,
    wanted: Dimension,
    wanted_by: &str,
) -> Diagnostic {
    let unit = wanted.usual_unit();
    let fits = entries.len() <= 48 && !entries.contains('\n');
    let help = if fits {
        format!("write the unit after the last number or the `]`: `{entries} {unit}`")
    } else {
        format!("write the unit after the last number or the `]`, as in `[1, 2, 5] {unit}`")
    };
    Diagnostic::new(
        Code::MissingUnit,
        format!(
            "`{wanted_by}` requires {}, found numbers without a unit",
            article(wanted)
        ),
    )
    .at(span, "no unit")
    .help(help)
}

/// An expression as written; for a literal its number and its unit.
pub struct WrittenValue<'t> {
    pub text: &'t str,
    pub span: Span,
    pub number: Option<&'t str>,
    pub unit: Option<&'t str>,
    /// In SI units, if it is known before the run.
    pub value: Option<f64>,
}

/// The mass of a weight, or the weight of a mass: what to write instead of `text`, which has the other dimension and this value in SI
/// units.
fn by_gravity(text: &str, value: f64, found: Dimension, wanted: Dimension) -> Option<String> {
    match (found, wanted) {
        (Dimension::FORCE, Dimension::MASS) => {
            let mass = shown(value / STANDARD_GRAVITY, wanted);
            Some(format!("write `{mass}`, the mass of a weight of {text}"))
        }
        (Dimension::MASS, Dimension::FORCE) => {
            let weight = shown(value * STANDARD_GRAVITY, wanted);
            Some(format!("write `{weight}`, the weight of {text}"))
        }
        _ => None,
    }
}

pub fn wrong_dimension(
    written: &WrittenValue<'_>,
    found: Dimension,
    wanted: Dimension,
    wanted_by: &str,
) -> Diagnostic {
    let WrittenValue {
        text,
        span,
        number,
        unit,
        value,
    } = *written;
    let weighed = number.and(value);
    let weighed = weighed.and_then(|value| by_gravity(text, value, found, wanted));
    let help = match (number, wanted) {
        _ if weighed.is_some() => weighed.unwrap_or_default(),
        (Some(number), Dimension::ACCELERATION) if text == format!("{number} g") => {
            format!(
                "write `{number} gn` for a multiple of standard gravity (9.80665 m/s^2); `g` is the gram"
            )
        }
        (Some(_), Dimension::DAMPING) if found == Dimension::NUMBER => {
            format!(
                "write a damping coefficient: `2 * {text} * sqrt(k * m)`, with the stiffness k and the mass m"
            )
        }
        (Some(number), _) => {
            // The number is kept with a unit of the same size only: beside another one it is a guess.
            let fits = unit
                .and_then(|unit| of_the_same_size(unit, &wanted.usual_unit()))
                .map(|unit| format!("{number} {unit}"));
            format!(
                "write {}, such as `{}`",
                article(wanted),
                fits.unwrap_or_else(|| example(None, wanted))
            )
        }
        (None, Dimension::NUMBER) => format!(
            "divide `{text}` by {}, so that a number remains",
            article(found)
        ),
        (None, _) => {
            format!(
                "change `{text}` so that it gives {}, with the unit `{}`",
                article(wanted),
                wanted.usual_unit()
            )
        }
    };
    Diagnostic::new(
        Code::WrongDimension,
        format!(
            "`{wanted_by}` requires {}, found {}",
            article(wanted),
            article(found)
        ),
    )
    .at(span, format!("this is {}", article(found)))
    .help(help)
}

/// A parameter is bound to a number of another dimension.
pub fn wrong_dimension_of_quantity(
    bound: Quantity,
    wanted: Dimension,
    parameter: &str,
    declared_at: Span,
) -> Diagnostic {
    Diagnostic::new(
        Code::WrongDimension,
        format!(
            "`{parameter}` requires {}, found {}",
            article(wanted),
            article(bound.dimension)
        ),
    )
    .at(declared_at, format!("this is {}", article(wanted)))
    .help(format!(
        "write {} for `{parameter}`, not {}",
        article(wanted),
        bound.in_plan_syntax()
    ))
}

pub fn mismatched(operator: &str, left: &Typed, right: &Typed) -> Diagnostic {
    let (one, other) = (article(left.dimension), article(right.dimension));
    let forgotten = left.bare != right.bare;
    let wanted = if left.bare && forgotten {
        right.dimension
    } else {
        left.dimension
    };
    let is = |side: &Typed, name: &str| {
        if side.bare && forgotten {
            "no unit".to_owned()
        } else {
            format!("this is {name}")
        }
    };
    let how = format!("{}, as in `{}`", article(wanted), example(None, wanted));
    let help = if forgotten {
        format!("add a unit to make the number {how}")
    } else {
        format!("write both sides as the same kind of quantity: {how}")
    };
    Diagnostic::new(
        Code::MismatchedDimensions,
        format!("`{operator}` cannot combine {one} and {other}"),
    )
    .at(left.span, is(left, &one))
    .at(right.span, is(right, &other))
    .help(help)
}
