//! Values of fields in words: the type with its limits, and the default.

use psd_plan::schema::{BlockKind, Field, FieldType, Presence, Range};
use psd_text::units::Dimension;
use psd_text::units::display::{si_unit, significant};

/// The value of a field: `` `kg` > 0 ``, `string`, `option`; `blocks`: those that it may name.
pub(super) fn value(field: &Field, blocks: &[&BlockKind]) -> String {
    match field.ty {
        FieldType::Text => "string".to_owned(),
        FieldType::Texts => "list of strings".to_owned(),
        FieldType::Inner => "model".to_owned(),
        FieldType::Inners => "two or more models".to_owned(),
        FieldType::Quantity(dimension) => {
            format!("{}{}", unit(dimension), limits(field.range, dimension))
        }
        FieldType::QuantityOr(dimension, _) => {
            format!(
                "{}{}, or option",
                unit(dimension),
                limits(field.range, dimension)
            )
        }
        FieldType::Quantities(dimension) => format!("list, {}", unit(dimension)),
        FieldType::Bounds {
            dimension,
            symmetric,
        } => format!(
            "range{}, {}",
            if symmetric { " or ±b" } else { "" },
            unit(dimension)
        ),
        FieldType::Interval(dimension) => format!(
            "range, {}{}",
            unit(dimension),
            limits(field.range, dimension)
        ),
        FieldType::Count => format!("integer{}", limits(field.range, Dimension::NUMBER)),
        FieldType::Choice(_) if is_truth(field) => "`true` or `false`".to_owned(),
        FieldType::Choice(_) => "option".to_owned(),
        FieldType::Choices(_) => "list of options".to_owned(),
        FieldType::Reference(kind) => {
            let named = blocks.iter().find(|block| block.kind == kind);
            format!(
                "a `{}`",
                named.map_or_else(String::new, |block| block.words())
            )
        }
        FieldType::Condition => "condition, as in `require`".to_owned(),
        FieldType::Formula => "number with its unit".to_owned(),
        FieldType::Figures => "list of `figure(PROCEDURE)`".to_owned(),
        FieldType::ResultNames => "list of results, such as `[hit.stop_time]`".to_owned(),
        FieldType::ResultName => "result, such as `hit.stop_time`".to_owned(),
        FieldType::ColumnName => {
            "numeric column: `hit.displacement_m`, or `displacement_m` of all tables".to_owned()
        }
        FieldType::Inputs(_) => "list of `INPUT ~ DISTRIBUTION`".to_owned(),
        FieldType::Intensity => "`INPUT in VALUES`".to_owned(),
        FieldType::InputName => "input".to_owned(),
        FieldType::RequirementName => "name of a requirement".to_owned(),
        FieldType::OfInput => format!("as the input{}", limits(field.range, Dimension::NUMBER)),
        FieldType::RangeOfInput => "range, as the input".to_owned(),
        FieldType::Tolerance => "value in the unit of the number, or `%` of it; ≥ 0".to_owned(),
    }
}

/// A row of a table; `---` in every cell makes the line below the head.
pub(super) fn row(cells: &[&str]) -> String {
    let rule = cells.iter().all(|cell| *cell == "---");
    let mut row = "|".to_owned();
    for cell in cells {
        match (rule, cell.is_empty()) {
            (true, _) => row += "---|",
            (false, true) => row += " |",
            (false, false) => row.extend([" ", cell, " |"]),
        }
    }
    row + "\n"
}

/// Whether a field is `true` or `false`, which needs no list of options.
pub(super) fn is_truth(field: &Field) -> bool {
    let FieldType::Choice(variants) = field.ty else {
        return false;
    };
    variants
        .iter()
        .map(|variant| variant.name)
        .eq(["true", "false"])
}

/// The usual unit of a dimension.
fn unit(dimension: Dimension) -> String {
    if dimension == Dimension::NUMBER {
        "number".to_owned()
    } else if dimension == Dimension::ANGLE {
        "`deg` or `rad`".to_owned()
    } else {
        format!("`{}`", dimension.usual_unit())
    }
}

/// The range of a value, ` > 0`; a limit with a dimension is in its SI unit.
fn limits(range: Range, dimension: Dimension) -> String {
    let shown = |value: f64| {
        let value = if matches!(dimension, Dimension::NUMBER | Dimension::ANGLE) {
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
    let (low, high) = (shown(range.low), shown(range.high));
    match (range.low.is_finite(), range.high.is_finite()) {
        (false, false) => String::new(),
        (true, false) if range.above => format!(" > {low}"),
        (true, false) => format!(" ≥ {low}"),
        (false, true) => format!(" ≤ {high}"),
        (true, true) if range.above => format!(" > {low}, ≤ {high}"),
        (true, true) => format!(" {low} to {high}"),
    }
}

/// The default of a field, or that it is required; empty if it has neither.
pub(super) fn default(field: &Field) -> String {
    match field.presence {
        Presence::Required => "required".to_owned(),
        Presence::Optional => String::new(),
        Presence::Default { number, unit } => format!("{number} {unit}").trim_end().to_owned(),
        Presence::DefaultInWords(words) => words.to_owned(),
        Presence::RequiredOn(rig, "") => format!("required on a {} rig", rig.name()),
        Presence::RequiredOn(rig, words) => format!("{words}; required on a {} rig", rig.name()),
    }
}
