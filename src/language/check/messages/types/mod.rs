//! Errors of types: E304. Those of dimensions are in `dimensions`.

mod dimensions;

pub use dimensions::{
    WrittenValue, angle_without_unit, mismatched, missing_unit, missing_unit_of_entries,
    wrong_dimension, wrong_dimension_of_quantity,
};

use dimensions::article;

use super::one_of;
use crate::check::checker::Typed;
use psd_plan::schema::{BlockKind, Field, Kind, Variant};
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;
use psd_text::units::Dimension;

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

/// A condition in place of the name of a requirement. `required`: the requirement that it stands for.
pub fn requirement_wanted(field: &str, span: Span, required: &str) -> Diagnostic {
    Diagnostic::new(
        Code::WrongType,
        format!("`{field}` requires the name of a requirement"),
    )
    .at(span, "a condition")
    .help(format!(
        "add `require \"stays within\" {required}`, then write `{field}: \"stays within\"`"
    ))
}

pub fn block_wanted(kind: Kind, span: Span, text: &str) -> Diagnostic {
    let words = psd_plan::schema::block(kind).words();
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
