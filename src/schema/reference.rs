//! The schema as text: the generated part of the language reference, in Markdown. In: the tables of blocks,
//! functions, units and diagnostic codes. Out: one text. Knows no plan.

use std::fmt::Write as _;

use super::{
    BLOCKS, BlockKind, FUNCTIONS, Field, FieldType, Kind, Naming, Need, Range, ResultKind, Variant,
};
use crate::text::diagnostic::Code;
use crate::units::Dimension;
use crate::units::display::{si_unit, significant};
use crate::units::unit::{PREFIXES, UNITS};

/// The generated part of `grammar/LANGUAGE.md`: every block, field, choice and result, then functions, units and codes.
#[must_use]
pub fn reference() -> String {
    let mut text = "## Vocabulary\n".to_owned();
    for block in BLOCKS.iter().filter(|block| block.kind != Kind::Later) {
        write_block(&mut text, block);
    }
    write_later(&mut text);
    write_functions(&mut text);
    write_units(&mut text);
    write_codes(&mut text);
    text
}

// Writing to a string cannot fail, so that the results of `write!` are ignored.

fn write_block(text: &mut String, block: &BlockKind) {
    let naming = match block.naming {
        Naming::Named => " NAME",
        Naming::Titled => " \"TITLE\"",
        Naming::Unnamed => "",
        Naming::MaybeNamed => " [NAME]",
    };
    let _ = write!(
        text,
        "\n### `{}{naming} {{ … }}`\n\n{}.",
        block.words(),
        block.doc
    );
    let _ = writeln!(
        text,
        "{}\n",
        if block.procedure { " A procedure." } else { "" }
    );
    let _ = writeln!(text, "| field | takes | if absent | |\n|---|---|---|---|");
    for field in block.fields.iter().filter(|field| field.available) {
        let real = match (field.real_rig_only, field.of_frames) {
            (true, _) => "; real rigs only",
            (_, true) => "; of frames only",
            _ => "",
        };
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {}{real} |",
            field.name,
            takes(field),
            absent(field),
            field.doc
        );
    }
    let mut written = Vec::new();
    for field in block.fields {
        if let FieldType::Choice(variants) | FieldType::Choices(variants) = field.ty {
            let _ = writeln!(text, "\n`{}`:\n", field.name);
            write_variants(text, variants, 0, &mut written);
        }
    }
    write_values(text, "what follows", block.exports);
    write_values(text, "result", block.results);
    let later: Vec<String> = block
        .fields
        .iter()
        .filter(|field| !field.available)
        .map(|field| format!("`{}`", field.name))
        .collect();
    if !later.is_empty() {
        let _ = writeln!(text, "\nNot in this version: {}.", later.join(", "));
    }
}

/// The variants of a choice, each with its arguments below it; a list that this block has already is not repeated.
fn write_variants(
    text: &mut String,
    variants: &[Variant],
    depth: usize,
    written: &mut Vec<Vec<&'static str>>,
) {
    let indent = "  ".repeat(depth);
    for variant in variants {
        let names: Vec<&str> = variant
            .arguments
            .iter()
            .map(|argument| argument.name)
            .collect();
        let many = variant
            .arguments
            .iter()
            .any(|argument| matches!(argument.ty, FieldType::Inners));
        let brackets = match (names.is_empty(), many) {
            (true, _) => String::new(),
            (false, true) => "(a, b, …)".to_owned(),
            (false, false) => format!("({})", names.join(", ")),
        };
        let _ = writeln!(
            text,
            "{indent}- `{}{brackets}`: {}",
            variant.name, variant.doc
        );
        let signature = [vec![variant.name], names].concat();
        if written.contains(&signature) {
            let _ = writeln!(text, "{indent}  - as above");
            continue;
        }
        if signature.len() > 1 {
            written.push(signature);
        }
        for argument in variant.arguments {
            let absent = match absent(argument) {
                words if words.is_empty() => String::new(),
                words if argument.need == Need::Required => format!("; {words}"),
                words => format!("; if absent {words}"),
            };
            let _ = writeln!(
                text,
                "{indent}  - `{}`: {}; {}{absent}",
                argument.name,
                argument.doc,
                takes(argument)
            );
            match argument.ty {
                FieldType::Choice(inner) if is_written(inner, written) => {
                    let _ = writeln!(text, "{indent}    - as above");
                }
                FieldType::Choice(inner) => write_variants(text, inner, depth + 2, written),
                _ => {}
            }
        }
    }
}

/// Whether every variant with arguments is in this block already.
fn is_written(variants: &[Variant], written: &[Vec<&'static str>]) -> bool {
    let mut with = variants
        .iter()
        .filter(|variant| !variant.arguments.is_empty())
        .peekable();
    let known = |name: &str| {
        written
            .iter()
            .any(|signature| signature.first() == Some(&name))
    };
    with.peek().is_some() && with.all(|variant| known(variant.name))
}

fn write_values(text: &mut String, head: &str, values: &[ResultKind]) {
    if values.is_empty() {
        return;
    }
    let _ = writeln!(text, "\n| {head} | unit | |\n|---|---|---|");
    for value in values {
        let unit = if value.dimension == Dimension::NUMBER {
            String::new()
        } else {
            format!("`{}`", si_unit(value.dimension))
        };
        let measured = if value.measured {
            ", with its standard uncertainty `.u`"
        } else {
            ""
        };
        let list = if value.list { "; a list" } else { "" };
        let storey = if value.of_storey {
            "; of frames only"
        } else {
            ""
        };
        let _ = writeln!(
            text,
            "| `{}` | {unit} | {}{measured}{list}{storey} |",
            value.name, value.doc
        );
    }
}

/// The type of a field: `mass in kg, above 0`, `one of …`.
fn takes(field: &Field) -> String {
    match field.ty {
        FieldType::Text => "a text".to_owned(),
        FieldType::Texts => "a list of texts".to_owned(),
        FieldType::Inner => "one of this list".to_owned(),
        FieldType::Inners => "two or more of this list".to_owned(),
        FieldType::Quantity(dimension) if field.angle => {
            format!("an angle with its unit, `deg` or `rad`{}", allowed(field.range, dimension))
        }
        FieldType::Quantity(dimension) => format!("{}{}", measure(dimension), allowed(field.range, dimension)),
        FieldType::Quantities(dimension) => format!("a list or a range with a step: {}", measure(dimension)),
        FieldType::Bounds { dimension, symmetric } => {
            let low = if symmetric { "−b" } else { "0" };
            format!("a range, or one bound b for {low} .. b: {}", measure(dimension))
        }
        FieldType::Interval(dimension) => {
            format!("a range: {}{}", measure(dimension), allowed(field.range, dimension))
        }
        FieldType::Count => format!("a whole number{}", allowed(field.range, Dimension::NUMBER)),
        FieldType::Choice(_) => "a choice".to_owned(),
        FieldType::Choices(_) => "a list of choices".to_owned(),
        FieldType::Reference(kind) => format!("the name of a `{}`", super::block(kind).words()),
        FieldType::Condition => "a condition, as in `require`".to_owned(),
        FieldType::Figures => "a list of `figure(PROCEDURE)`".to_owned(),
        FieldType::ResultName => "a result, such as `hit.stop_time`".to_owned(),
        FieldType::ColumnName => {
            "a column with numbers, such as `hit.displacement_m`, or `displacement_m` of every table".to_owned()
        }
        FieldType::Tolerance => "a value in the unit of the number, or `%` of its size; at least 0".to_owned(),
    }
}

fn measure(dimension: Dimension) -> String {
    if dimension == Dimension::NUMBER {
        return "a number or `%`".to_owned();
    }
    match dimension.name() {
        Some(name) => format!("{name}, such as `{}`", dimension.usual_unit()),
        None => format!("`{}`", dimension.usual_unit()),
    }
}

/// The range of a value, `, above 0`; a limit with a dimension is in its SI unit.
fn allowed(range: Range, dimension: Dimension) -> String {
    let shown = |value: f64| {
        let value = if dimension == Dimension::NUMBER {
            (value * 1e4).round() / 1e4
        } else {
            value
        };
        let number = if value.abs() < 1e7 {
            value.to_string()
        } else {
            significant(value, 2)
        };
        if value == 0.0 || dimension == Dimension::NUMBER {
            number
        } else {
            format!("{number} {}", si_unit(dimension))
        }
    };
    match (range.low.is_finite(), range.high.is_finite()) {
        (false, false) => String::new(),
        (true, false) if range.above => format!(", above {}", shown(range.low)),
        (true, false) => format!(", at least {}", shown(range.low)),
        (false, true) => format!(", at most {}", shown(range.high)),
        (true, true) if range.above => format!(
            ", above {} and at most {}",
            shown(range.low),
            shown(range.high)
        ),
        (true, true) => format!(", {} to {}", shown(range.low), shown(range.high)),
    }
}

fn absent(field: &Field) -> String {
    match (field.need, field.default_text()) {
        (Need::Required, _) => "**required**".to_owned(),
        (_, Some(default)) => default,
        (_, None) => String::new(),
    }
}

fn write_later(text: &mut String) {
    let _ = writeln!(
        text,
        "\n### Not in this version\n\nKnown words that this version of psd does not carry out.\n"
    );
    for block in BLOCKS.iter().filter(|block| block.kind == Kind::Later) {
        let _ = writeln!(text, "- `{}`: {}", block.words(), block.doc);
    }
}

fn write_functions(text: &mut String) {
    let _ = writeln!(text, "\n## Functions\n\n| function | |\n|---|---|");
    for function in FUNCTIONS {
        let arguments = if function.many { "a, b, …" } else { "a" };
        let _ = writeln!(
            text,
            "| `{}({arguments})` | {} |",
            function.name, function.doc
        );
    }
}

fn write_units(text: &mut String) {
    let _ = writeln!(
        text,
        "\n## Units\n\n| unit | | measures | prefixes | in SI |\n|---|---|---|---|---|"
    );
    for unit in UNITS {
        let prefixes = if unit.prefixes { "yes" } else { "" };
        let base = if unit.dimension == Dimension::NUMBER {
            String::new()
        } else {
            format!(" `{}`", si_unit(unit.dimension))
        };
        let (symbol, doc, measures) = (unit.symbol, unit.doc, unit.dimension.describe());
        let _ = writeln!(
            text,
            "| `{symbol}` | {doc} | {measures} | {prefixes} | {}{base} |",
            unit.factor
        );
    }
    let prefixes: Vec<String> = PREFIXES
        .iter()
        .map(|(prefix, factor)| format!("`{prefix}` {factor:e}"))
        .collect();
    let _ = writeln!(text, "\nPrefixes: {}.", prefixes.join(", "));
}

fn write_codes(text: &mut String) {
    let _ = writeln!(
        text,
        "\n## Diagnostic codes\n\nWarnings start with W. `psd explain CODE` tells more.\n\n| code | |\n|---|---|"
    );
    for code in Code::ALL {
        let title = code
            .page()
            .lines()
            .next()
            .and_then(|line| line.split_once(": "))
            .map_or("", |(_, title)| title);
        let _ = writeln!(text, "| {code} | {title} |");
    }
}
