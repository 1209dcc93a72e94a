//! Errors of dimension and type: E3xx.

use super::one_of;
use crate::language::check::checker::Typed;
use crate::schema::{BlockKind, Field, Kind, Variant};
use crate::text::diagnostic::{Code, Diagnostic};
use crate::text::source::Span;
use crate::units::unit::{PREFIXES, UNITS};
use crate::units::{Dimension, Quantity};

/// "a length", "an energy", "a value in kg/m"
fn article(dimension: Dimension) -> String {
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
    } = *written;
    let help = match (number, wanted) {
        (Some(number), Dimension::ACCELERATION) if text == format!("{number} g") => {
            format!(
                "write `{number} gn` for a multiple of standard gravity (9.80665 m/s^2); `g` is the gram"
            )
        }
        (Some(number), _) => {
            let fits = unit
                .and_then(|unit| of_the_same_size(unit, &wanted.usual_unit()))
                .map(|unit| format!("{number} {unit}"));
            format!(
                "write {}, such as `{}`",
                article(wanted),
                fits.unwrap_or_else(|| example(Some(number), wanted))
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

pub fn list_for_number(span: Span) -> Diagnostic {
    Diagnostic::new(Code::WrongType, "expected one number, found a list")
        .at(span, "a list")
        .help("write one entry, as in `list[0]`, or a function, as in `max(list)`")
}

pub fn text_for_number(span: Span) -> Diagnostic {
    Diagnostic::new(Code::WrongType, "expected a number, found a string")
        .at(span, "a string")
        .help("write the number without quotes")
}

pub fn block_for_number(name: &str, kind: &BlockKind, span: Span) -> Diagnostic {
    let member = kind.results.iter().chain(kind.exports).next().map_or_else(
        || "a number".to_owned(),
        |result| format!("`{name}.{}`", result.name),
    );
    let words = kind.words();
    let article = if words.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    };
    Diagnostic::new(
        Code::WrongType,
        format!("`{name}` is {article} {words}, not a number"),
    )
    .at(span, format!("{article} {words}"))
    .help(format!("read one of its values, such as {member}"))
}

pub fn condition_for_number(span: Span, operator: &str) -> Diagnostic {
    Diagnostic::new(
        Code::WrongType,
        format!("`{operator}` does not give a number"),
    )
    .at(span, "a condition")
    .help("write conditions in `require` only; join two of them with `and`")
}

pub fn condition_wanted(wanted_by: &str, span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(
        Code::WrongType,
        format!("`{wanted_by}` requires a condition"),
    )
    .at(span, "a value, not a condition")
    .help(format!("compare it, as in `{text} < …`"))
}

pub fn text_wanted(field: &str, span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(
        Code::WrongType,
        format!("`{field}` requires a string in quotes"),
    )
    .at(span, "not a string")
    .help(format!("write `\"{text}\"`"))
}

pub fn block_wanted(kind: Kind, span: Span, text: &str) -> Diagnostic {
    let words = crate::schema::block(kind).words();
    Diagnostic::new(
        Code::WrongType,
        format!("expected the name of a {words}, found `{text}`"),
    )
    .at(span, format!("not a {words}"))
    .help(format!("write the name of a `{words}` block"))
}

pub fn procedure_wanted(name: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::WrongType, format!("`{name}` is not a procedure"))
        .at(span, "has no figures")
        .help("write the name of a procedure, as in `energy(hit)`")
}

pub fn figure_wanted(span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(Code::WrongType, format!("`{text}` is not a figure of a procedure"))
        .at(span, "not a figure")
        .help("write a figure with its procedure, as in `energy(hit)`, or several, as in `displacement(first, second)`")
}

pub fn result_wanted(span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(
        Code::WrongType,
        format!("`{text}` is not a result of a procedure"),
    )
    .at(span, "not a result")
    .help("name a procedure and its result, as in `hit.max_displacement`")
}

pub fn choice_wanted(field: &str, variants: &[Variant], span: Span, text: &str) -> Diagnostic {
    let known = one_of(variants.iter().map(|variant| variant.name));
    Diagnostic::new(
        Code::WrongType,
        format!("`{field}` requires one of its options, found `{text}`"),
    )
    .at(span, "unknown option")
    .help(
        match variants
            .iter()
            .find(|variant| variant.name == text.trim_matches('"'))
        {
            Some(meant) => format!("write it without quotes: `{}`", meant.name),
            None => format!("write one of its options: {known}"),
        },
    )
}

pub fn range_wanted(span: Span, text: &str) -> Diagnostic {
    Diagnostic::new(Code::WrongType, "expected a range, found one value")
        .at(span, "not a range")
        .help(format!("write both ends, as in `0 .. {text}`"))
}

pub fn range_wanted_by(field: &Field, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::WrongType,
        format!("`{}` requires a range, found one value", field.name),
    )
    .at(span, "not a range")
    .help(format!("write both ends, as in `{}`", field.example))
}

pub fn index_of_number(span: Span) -> Diagnostic {
    Diagnostic::new(Code::WrongType, "a number has no entries")
        .at(span, "one number")
        .help("remove the index")
}

pub fn index_not_whole(span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::WrongType,
        "a list index must be a whole number from 0",
    )
    .at(span, "invalid index")
    .help("write it as in `list[0]`")
}

pub fn angle_with_unit(function: &str, argument: &Typed) -> Diagnostic {
    let found = article(argument.dimension);
    Diagnostic::new(
        Code::WrongDimension,
        format!("`{function}` requires an angle in radians, found {found}"),
    )
    .at(argument.span, format!("this is {found}"))
    .help("divide by a value of the same kind, so that a number remains")
}

pub fn exponent_with_unit(exponent: &Typed) -> Diagnostic {
    let found = article(exponent.dimension);
    Diagnostic::new(
        Code::BadExponent,
        format!("an exponent must be a number, found {found}"),
    )
    .at(exponent.span, format!("this is {found}"))
    .help("write a number without a unit, as in `x^2`")
}

pub fn exponent_not_constant(span: Span, base: Dimension) -> Diagnostic {
    Diagnostic::new(
        Code::BadExponent,
        format!(
            "the exponent of {} must be known before the run",
            article(base)
        ),
    )
    .at(span, "known only after the run")
    .help("write a number, as in `x^2`")
}

pub fn exponent_not_rational(span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadExponent,
        "the exponent of a quantity must be a simple fraction",
    )
    .at(span, "not a fraction with a denominator up to 12")
    .help("write it as in `x^1.5` or `x^(1 / 3)`")
}

pub fn exponent_too_large(span: Span) -> Diagnostic {
    Diagnostic::new(Code::BadExponent, "exponents of this unit are too large")
        .at(span, "too large")
        .help("write smaller powers")
}

pub fn unit_exponent(text: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadExponent,
        format!("invalid exponent `{text}` in a unit"),
    )
    .at(span, "not a simple fraction")
    .help("write it as in `mm^2` or `N/m^1.5`")
}
