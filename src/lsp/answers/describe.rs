//! Words of the language in Markdown, for hover and completion. In: entries of the vocabulary. Out: text.

use std::fmt::Write as _;

use psd_plan::schema::{
    BlockKind, Field, FieldType, Naming, Presence, Printed, Range, ResultKind, Variant,
};
use psd_text::units::display::readable;
use psd_text::units::{Dimension, display};

/// A kind of block.
pub fn block(kind: &BlockKind) -> String {
    format!(
        "**{}**\n\n{}\n\n```psd\n{}\n```",
        kind.words(),
        kind.doc,
        kind.example
    )
}

/// A field or an argument: its value, its meaning, its default and its range.
pub fn field(field: &Field) -> String {
    let mut lines = vec![
        format!("**{}**: {}{}", field.name, value(&field.ty), unit(field)),
        field.doc.to_owned(),
    ];
    lines.push(match field.presence {
        Presence::Required => format!("Required, as in `{}`", field.example),
        Presence::Optional => "Optional".to_owned(),
        Presence::Default { number, unit } => {
            format!("Default: `{}`", format!("{number} {unit}").trim_end())
        }
        Presence::DefaultInWords(words) => format!("Default: {words}"),
        Presence::RequiredOn(rig, otherwise) => {
            format!("Required on a {} rig; otherwise {otherwise}", rig.name())
        }
    });
    lines.extend(range(field.range, field.dimension()).map(|range| format!("Range: {range}")));
    if field.real_rig_only {
        lines.push("Only for a real rig".to_owned());
    }
    if field.of_frames {
        lines.push("Only for a frame".to_owned());
    }
    lines.join("\n\n")
}

/// One line about a field, beside its name in a list.
pub fn short(field: &Field) -> String {
    let presence = match field.presence {
        Presence::Required => ", required".to_owned(),
        Presence::Default { number, unit } => format!(", default {number} {unit}"),
        Presence::DefaultInWords(words) => format!(", default {words}"),
        Presence::Optional | Presence::RequiredOn(..) => String::new(),
    };
    format!("{}{}{}", value(&field.ty), unit(field), presence.trim_end())
}

/// A word of a choice, with its arguments.
pub fn variant(variant: &Variant) -> String {
    let mut text = format!("**{}**\n\n{}", call(variant), variant.doc);
    for argument in variant.arguments {
        let _ = write!(
            text,
            "\n- `{}`: {}; {}",
            argument.name,
            short(argument),
            argument.doc
        );
    }
    text
}

/// `kelvin_voigt(stiffness, damping)`
pub fn call(variant: &Variant) -> String {
    let names: Vec<&str> = variant
        .arguments
        .iter()
        .map(|argument| argument.name)
        .collect();
    if names.is_empty() {
        variant.name.to_owned()
    } else {
        format!("{}({})", variant.name, names.join(", "))
    }
}

/// A result of a procedure.
pub fn result(result: &ResultKind) -> String {
    let several = if result.list { "list of " } else { "" };
    let unit = if result.printed == Printed::InPercent {
        "%".to_owned()
    } else {
        display::si_unit(result.dimension)
    };
    let unit = if unit.is_empty() {
        unit
    } else {
        format!(" [{unit}]")
    };
    let uncertainty = if result.measured {
        "\n\nIts standard uncertainty is `.u`"
    } else {
        ""
    };
    format!(
        "**{}**: {several}{}{unit}\n\n{}{uncertainty}",
        result.name,
        if result.count {
            "count".to_owned()
        } else {
            result.dimension.describe()
        },
        result.doc,
    )
}

/// The line that begins a block, with placeholders for its name.
pub fn head(kind: &BlockKind, placeholder: &dyn Fn(&str) -> String) -> String {
    let words = kind.words();
    match kind.naming {
        Naming::Named => {
            let example = kind.example.lines().next().unwrap_or_default();
            let name = example.strip_prefix(&words).unwrap_or_default();
            let name = name.trim().split([' ', '{']).next().unwrap_or_default();
            format!(
                "{words} {} {{",
                placeholder(if name.is_empty() { "name" } else { name })
            )
        }
        Naming::Titled => format!("{words} \"{}\" {{", placeholder("Title")),
        Naming::Unnamed | Naming::MaybeNamed => format!("{words} {{"),
    }
}

fn unit(field: &Field) -> String {
    match field.dimension() {
        Some(dimension) if dimension != Dimension::NUMBER => {
            format!(" [{}]", dimension.usual_unit())
        }
        _ => String::new(),
    }
}

/// What the value of a field is.
fn value(ty: &FieldType) -> String {
    match ty {
        FieldType::Text => "text".to_owned(),
        FieldType::Texts => "list of texts".to_owned(),
        FieldType::Inner => "a model".to_owned(),
        FieldType::Inners => "several models".to_owned(),
        FieldType::Quantity(dimension) => dimension.describe(),
        FieldType::QuantityOr(dimension, variants) => {
            format!("{}, or {}", dimension.describe(), one_of(variants))
        }
        FieldType::Quantities(dimension) => format!("list or range of {}", dimension.describe()),
        FieldType::Bounds { dimension, .. } => {
            format!("bound or range of {}", dimension.describe())
        }
        FieldType::Interval(dimension) => format!("range of {}", dimension.describe()),
        FieldType::Count => "whole number".to_owned(),
        FieldType::Choice(variants) => one_of(variants),
        FieldType::Choices(variants) => format!("list of {}", one_of(variants)),
        FieldType::Reference(kind) => {
            format!("name of a {}", psd_plan::schema::block(*kind).words())
        }
        FieldType::Figures => "list of figures of procedures".to_owned(),
        FieldType::ResultName => "result of a procedure".to_owned(),
        FieldType::ResultNames => "list of results of procedures".to_owned(),
        FieldType::ColumnName => "column of a table".to_owned(),
        FieldType::Tolerance => "tolerance, in a unit or in %".to_owned(),
        FieldType::Formula => "number, which may read results".to_owned(),
        FieldType::Condition => "condition on results".to_owned(),
        FieldType::Inputs(_) => "list of `INPUT ~ DISTRIBUTION`".to_owned(),
        FieldType::Intensity => "`INPUT in VALUES`".to_owned(),
        FieldType::InputName => "name of an input".to_owned(),
        FieldType::RequirementName => "name of a requirement".to_owned(),
        FieldType::OfInput => "value of the input".to_owned(),
        FieldType::RangeOfInput => "range of the input".to_owned(),
    }
}

fn one_of(variants: &[Variant]) -> String {
    let names: Vec<String> = variants
        .iter()
        .map(|variant| format!("`{}`", variant.name))
        .collect();
    names.join(", ")
}

/// The values that are allowed; None if all are.
fn range(range: Range, dimension: Option<Dimension>) -> Option<String> {
    let dimension = dimension?;
    let shown = |value: f64| {
        if value == 0.0 {
            "0".to_owned()
        } else {
            readable(value, dimension)
        }
    };
    let low = range.low.is_finite().then(|| {
        format!(
            "{} {}",
            if range.above { "above" } else { "from" },
            shown(range.low)
        )
    });
    let high = range
        .high
        .is_finite()
        .then(|| format!("up to {}", shown(range.high)));
    let parts: Vec<String> = low.into_iter().chain(high).collect();
    (!parts.is_empty()).then(|| parts.join(" "))
}
