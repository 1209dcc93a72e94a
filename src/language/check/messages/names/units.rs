//! Errors of units: E204.

use std::sync::LazyLock;

use crate::check::messages::one_of;
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;
use psd_text::units::display;
use psd_text::units::unit::{STANDARD_GRAVITY, UNITS};

/// Units as words.
const SPELT_OUT: &[(&str, &str)] = &[
    ("percent pct", "%"),
    ("meter metre meters metres", "m"),
    ("millimeter millimetre millimeters millimetres", "mm"),
    ("micron microns", "um"),
    ("gram grams", "g"),
    ("kilogram kilograms kgs", "kg"),
    ("tonne tonnes ton tons", "t"),
    ("sec secs second seconds", "s"),
    ("msec millisecond milliseconds", "ms"),
    ("minute minutes mins", "min"),
    ("hour hours hr hrs", "h"),
    ("newton newtons", "N"),
    ("kilonewton kilonewtons", "kN"),
    ("pascal pascals", "Pa"),
    ("joule joules", "J"),
    ("hertz cps", "Hz"),
    ("inch inches", "in"),
    ("foot feet", "ft"),
    ("lbs pound pounds", "lb"),
    ("degree degrees", "deg"),
    ("mps", "m/s"),
    ("kph kmh", "km/h"),
];

/// `kN*m` for `kNm`.
fn unit_product(name: &str) -> Option<String> {
    let dimension = |part: &str| psd_text::units::unit::lookup(part).map(|unit| unit.dimension);
    // `mmm` is a typing error, and not an area.
    let product = |(one, other): &(&str, &str)| {
        dimension(one)
            .zip(dimension(other))
            .is_some_and(|(one, other)| one != other)
    };
    let (first, second) = (1..name.len())
        .filter_map(|at| name.split_at_checked(at))
        .find(product)?;
    Some(format!("{first}*{second}"))
}

/// The prefixes that are usual with a unit in tests of structures. Only such units are suggested: a slip of the keyboard must not become
/// a number that is a billion times too small, as `mPa` for `mpa`.
const USUAL_PREFIXES: &[(&str, &[&str])] = &[
    ("m", &["u", "m", "c", "k"]),
    ("g", &["m", "k"]),
    ("s", &["u", "m"]),
    ("N", &["k", "M"]),
    ("Pa", &["k", "M", "G"]),
    ("J", &["m", "k"]),
    ("Hz", &["k"]),
];

/// Units that psd does not know, with their size in a unit that it knows.
const CONVERTED: &[(&str, f64, &str)] = &[
    ("mph", 0.447_04, "m/s"),
    ("kgf", STANDARD_GRAVITY, "N"),
    ("bar", 1e5, "Pa"),
];

/// The units that are suggested.
static USUAL: LazyLock<Vec<String>> = LazyLock::new(|| {
    let plain = UNITS.iter().map(|unit| unit.symbol.to_owned());
    let prefixed = USUAL_PREFIXES.iter().flat_map(|(symbol, prefixes)| {
        prefixes
            .iter()
            .map(move |prefix| format!("{prefix}{symbol}"))
    });
    plain.chain(prefixed).collect()
});

/// `mm^2` for `mm2`.
fn power(name: &str) -> Option<String> {
    let unit = name.trim_end_matches(|digit: char| digit.is_ascii_digit());
    let exponent = &name[unit.len()..];
    let known = psd_text::units::unit::lookup(unit).is_some();
    (known && !exponent.is_empty()).then(|| format!("{unit}^{exponent}"))
}

/// The unit that was meant.
fn meant(name: &str) -> Option<String> {
    let among = |words: &str| words.split(' ').any(|word| word.eq_ignore_ascii_case(name));
    let spelt_out = SPELT_OUT.iter().find(|(words, _)| among(words));
    spelt_out
        .map(|(_, unit)| (*unit).to_owned())
        .or_else(|| power(name))
        .or_else(|| unit_product(name))
        .or_else(|| {
            USUAL
                .iter()
                .find(|unit| unit.eq_ignore_ascii_case(name))
                .cloned()
        })
        .or_else(|| {
            psd_text::suggest::nearest(name, USUAL.iter().map(String::as_str)).map(str::to_owned)
        })
}

/// `number`: the number before the unit, if nothing but this unit is behind it.
pub fn unknown_unit(name: &str, number: Option<f64>, span: Span) -> Diagnostic {
    let converted = CONVERTED.iter().find(|(unit, ..)| *unit == name);
    let help = match (converted, meant(name)) {
        (Some((_, factor, unit)), _) => {
            let count = number.unwrap_or(1.0);
            let size = display::significant(count * factor, 4);
            format!("write it in `{unit}`: {count} {name} is `{size} {unit}`")
        }
        (None, Some(near)) => format!("did you mean `{near}`?"),
        (None, None) => format!(
            "known units: {}; SI units can have prefixes",
            one_of(UNITS.iter().map(|unit| unit.symbol))
        ),
    };
    Diagnostic::new(Code::UnknownUnit, format!("unknown unit `{name}`"))
        .at(span, "unknown unit")
        .help(help)
}

pub fn name_glued_to_unit(name: &str, span: Span, corrected: &str) -> Diagnostic {
    Diagnostic::new(
        Code::UnknownUnit,
        format!("`{name}` is a name of the plan, not a unit"),
    )
    .at(span, "read as part of the unit")
    .help(format!("write spaces around the operator: `{corrected}`"))
}
