//! Errors of variants, of functions and of their arguments.

use crate::check::messages::{all_of, suggestion};
use crate::syntax::ast::Ident;
use psd_plan::schema::{FUNCTIONS, Field, FunctionKind, Presence, Variant};
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;

pub fn unknown_variant(field: &str, name: &str, span: Span, variants: &[Variant]) -> Diagnostic {
    let known = variants.iter().map(|variant| variant.name);
    Diagnostic::new(
        Code::UnknownVariant,
        format!("`{field}` has no option `{name}`"),
    )
    .at(span, "unknown option")
    .help(suggestion(name, known))
}

pub fn unknown_function(name: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::UnknownFunction, format!("unknown function `{name}`"))
        .at(span, "unknown function")
        .help(suggestion(
            name,
            FUNCTIONS.iter().map(|function| function.name),
        ))
}

pub fn function_argument_with_name(function: &str, name: &Ident) -> Diagnostic {
    Diagnostic::new(
        Code::BadArgument,
        format!("the arguments of `{function}` have no names"),
    )
    .at(name.span, "named argument")
    .help(format!("remove `{}:`", name.node))
}

pub fn function_arguments(kind: &FunctionKind, found: usize, span: Span) -> Diagnostic {
    let wanted = if kind.many {
        "at least one value"
    } else {
        "one value"
    };
    Diagnostic::new(
        Code::BadArgument,
        format!("`{}` requires {wanted}, found {found}", kind.name),
    )
    .at(span, format!("{found} values"))
    .help(format!("write it as in `{}(x)`", kind.name))
}

pub fn unknown_argument(variant: &Variant, name: Option<&str>, span: Span) -> Diagnostic {
    let known: Vec<&str> = variant
        .arguments
        .iter()
        .map(|argument| argument.name)
        .collect();
    let (message, help) = match name {
        Some(name) => (
            format!("`{}` has no argument `{name}`", variant.name),
            suggestion(name, known),
        ),
        None if known.is_empty() => (
            format!("`{}` takes no arguments", variant.name),
            format!("write `{}` alone", variant.name),
        ),
        None => {
            let (arguments, they) = if known.len() == 1 {
                ("one argument".to_owned(), "it is")
            } else {
                (format!("{} arguments", known.len()), "they are")
            };
            (
                format!("`{}` takes at most {arguments}", variant.name),
                format!("{they} {}", all_of(known)),
            )
        }
    };
    Diagnostic::new(Code::BadArgument, message)
        .at(span, "unknown argument")
        .help(help)
}

/// The form of a missing argument: the whole call where it is short, `within(displacement: 0.01 mm, force_rate: 5 N/s)`,
/// else the argument alone.
fn argument_help(variant: &Variant, missing: &Field) -> String {
    let required: Vec<&Field> = variant
        .arguments
        .iter()
        .filter(|argument| argument.presence == Presence::Required)
        .collect();
    let written = |argument: &Field| {
        let named = argument.example.starts_with(&format!("{}:", argument.name));
        if named || required.len() == 1 {
            argument.example.to_owned()
        } else {
            format!("{}: {}", argument.name, argument.example)
        }
    };
    if required.len() > 2 {
        return format!("add it in the parentheses, as in `{}`", written(missing));
    }
    let arguments: Vec<String> = required.iter().map(|argument| written(argument)).collect();
    format!(
        "write it as in `{}({})`",
        variant.name,
        arguments.join(", ")
    )
}

pub fn missing_argument(variant: &Variant, field: &Field, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadArgument,
        format!("`{}` requires the argument `{}`", variant.name, field.name),
    )
    .at(span, format!("`{}` is missing", field.name))
    .help(argument_help(variant, field))
}

pub fn argument_needs(variant: &str, argument: &str, other: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadArgument,
        format!("`{argument}` of `{variant}` requires `{other}`"),
    )
    .at(span, format!("`{other}` is missing"))
    .help(format!("add `{other}: …`, or remove `{argument}`"))
}
