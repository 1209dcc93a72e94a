//! Errors of units: E204.

use std::sync::LazyLock;

use crate::language::check::messages::one_of;
use crate::text::diagnostic::{Code, Diagnostic};
use crate::text::source::Span;
use crate::units::unit::{PREFIXES, UNITS};

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
];

/// `kN*m` for `kNm`.
fn unit_product(name: &str) -> Option<String> {
    let dimension = |part: &str| crate::units::unit::lookup(part).map(|unit| unit.dimension);
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

pub fn unknown_unit(name: &str, span: Span) -> Diagnostic {
    static KNOWN: LazyLock<Vec<String>> = LazyLock::new(|| {
        let plain = UNITS.iter().map(|unit| unit.symbol.to_owned());
        let prefixed = UNITS.iter().filter(|unit| unit.prefixes);
        let prefixed = prefixed.flat_map(|unit| {
            PREFIXES
                .iter()
                .map(move |(prefix, _)| format!("{prefix}{}", unit.symbol))
        });
        plain.chain(prefixed).collect()
    });
    let same_letters = KNOWN
        .iter()
        .find(|unit| unit.eq_ignore_ascii_case(name))
        .map(String::as_str);
    let spelt_out = SPELT_OUT
        .iter()
        .find(|(words, _)| words.split(' ').any(|word| word.eq_ignore_ascii_case(name)))
        .map(|(_, unit)| *unit);
    let product = unit_product(name);
    let near = same_letters.or(spelt_out).or(product.as_deref());
    let near =
        near.or_else(|| crate::text::suggest::nearest(name, KNOWN.iter().map(String::as_str)));
    let help = near.map_or_else(
        || {
            format!(
                "known units: {}; SI units can have prefixes",
                one_of(UNITS.iter().map(|unit| unit.symbol))
            )
        },
        |near| format!("did you mean `{near}`?"),
    );
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
