//! A block of the reference: its fields, the options of the fields, its values and results. A field or result that an earlier block has
//! in the same form is listed by name only.

use std::fmt::Write as _;

use super::options;
use super::pages::Page;
use super::values::{default, is_truth, row, value};
use psd_plan::schema::{BlockKind, Field, FieldType, Naming, ResultKind};
use psd_text::units::Dimension;
use psd_text::units::display::si_unit;

/// Writes the section of a block; `earlier`: the blocks before it; `options`: those that are written already.
pub(super) fn write(
    text: &mut String,
    block: &'static BlockKind,
    earlier: &[&'static BlockKind],
    options: &mut Vec<options::Listed>,
) {
    let naming = match block.naming {
        Naming::Named => " NAME",
        Naming::Titled => " \"TITLE\"",
        Naming::Unnamed => "",
        Naming::MaybeNamed => " [NAME]",
    };
    let words = block.words();
    let kind = if block.is_procedure() {
        "Procedure"
    } else {
        "Block"
    };
    let _ = writeln!(
        text,
        "\n### {words}\n\n{kind} `{words}{naming} {{ … }}`. {}.\n",
        block.doc
    );
    let (new, known) = apart(block.fields.iter(), earlier, |it| it.fields, same_field);
    let (advanced, usual): (Vec<&Field>, Vec<&Field>) =
        new.into_iter().partition(|field| field.advanced);
    write_fields(text, block, &usual, earlier);
    write_known(text, "Fields", &known, |field| (field.name, marks(field)));
    let mut written = options::Written::new(earlier, options);
    write_options(text, block, &usual, &mut written);
    write_values(text, block, "value", block.exports);
    let (new, known) = apart(block.results.iter(), earlier, |it| it.results, same_result);
    let new: Vec<ResultKind> = new.into_iter().copied().collect();
    write_values(text, block, "result", &new);
    write_known(text, "Results", &known, |result| {
        (result.name, of_frames(result.of_storey))
    });
    if !advanced.is_empty() {
        let _ = writeln!(text, "\n#### Advanced: {words}\n");
        write_fields(text, block, &advanced, earlier);
        write_options(text, block, &advanced, &mut written);
    }
}

/// Entries that are new in this block, and those that an earlier block has in the same form, with that block.
fn apart<'e, T: 'static>(
    entries: impl Iterator<Item = &'e T>,
    earlier: &[&'e BlockKind],
    of: fn(&BlockKind) -> &'static [T],
    is_same: fn(&T, &T) -> bool,
) -> (Vec<&'e T>, Vec<(&'e BlockKind, &'e T)>) {
    let (mut new, mut known) = (Vec::new(), Vec::new());
    for entry in entries {
        let same = |block: &&&BlockKind| of(block).iter().any(|it| is_same(it, entry));
        match earlier.iter().find(same) {
            Some(block) => known.push((*block, entry)),
            None => new.push(entry),
        }
    }
    (new, known)
}

/// Whether two fields have the same line. Their marks may differ.
fn same_field(one: &Field, other: &Field) -> bool {
    (one.name, one.doc, one.presence, one.range)
        == (other.name, other.doc, other.presence, other.range)
        && format!("{:?}", one.ty) == format!("{:?}", other.ty)
}

fn same_result(one: &ResultKind, other: &ResultKind) -> bool {
    let line = |it: &ResultKind| (it.name, it.doc, it.dimension, it.measured, it.list);
    line(one) == line(other)
}

/// `#impact.duration`; a result with the name of a field has `-result` behind it.
fn anchor(block: &BlockKind, name: &str, is_field: bool) -> String {
    let twice = !is_field && block.field(name).is_some();
    format!(
        "<b id={}.{name}{}>{name}</b>",
        block.keyword.join("-"),
        if twice { "-result" } else { "" }
    )
}

const fn of_frames(is: bool) -> &'static str {
    if is { "ᶠ" } else { "" }
}

fn marks(field: &Field) -> &'static str {
    if field.real_rig_only {
        "ᴿ"
    } else {
        of_frames(field.of_frames)
    }
}

fn write_fields(text: &mut String, block: &BlockKind, fields: &[&Field], earlier: &[&BlockKind]) {
    if fields.is_empty() {
        return;
    }
    let has_defaults = fields.iter().any(|field| !default(field).is_empty());
    let row = |name: &str, value: &str, default: &str, doc: &str| {
        if has_defaults {
            row(&[name, value, default, doc])
        } else {
            row(&[name, value, doc])
        }
    };
    *text += &row("field", "value", "default", "");
    *text += &row("---", "---", "---", "---");
    for field in fields {
        let name = format!("{}{}", anchor(block, field.name, true), marks(field));
        *text += &row(&name, &value(field, earlier), &default(field), field.doc);
    }
}

/// The entries of earlier blocks, block by block.
fn write_known<T>(
    text: &mut String,
    what: &str,
    known: &[(&BlockKind, &T)],
    named: impl Fn(&T) -> (&'static str, &'static str),
) {
    let mut rest = known;
    while let Some((of, _)) = rest.first() {
        let count = rest.iter().take_while(|(it, _)| it.kind == of.kind).count();
        let (group, after) = rest.split_at(count);
        let names: Vec<String> = group
            .iter()
            .map(|(_, entry)| {
                let (name, marks) = named(entry);
                format!("`{name}`{marks}")
            })
            .collect();
        let _ = writeln!(
            text,
            "\n{what} as in [{}](#{}): {}.",
            of.words(),
            of.keyword.join("-"),
            names.join(", ")
        );
        rest = after;
    }
}

fn write_options(
    text: &mut String,
    block: &'static BlockKind,
    fields: &[&Field],
    written: &mut options::Written<'_>,
) {
    let mut head = "\nOptions:\n\n";
    for field in fields.iter().filter(|field| !is_truth(field)) {
        if let FieldType::Choice(variants)
        | FieldType::Choices(variants)
        | FieldType::Inputs(variants) = field.ty
        {
            let _ = writeln!(text, "{head}- `{}`:", field.name);
            if let Some(page) = Page::of(block.kind, field.name) {
                let _ = writeln!(text, "  - {}", page.pointer());
                written.note(block, field.name, variants);
            } else {
                written.list(text, block, field.name, variants, 1);
            }
            head = "";
        }
    }
}

fn write_values(text: &mut String, block: &BlockKind, head: &str, values: &[ResultKind]) {
    if values.is_empty() {
        return;
    }
    let are_measured = values.iter().any(|value| value.measured);
    let row = |name: &str, unit: &str, u: &str, doc: &str| {
        if are_measured {
            row(&[name, unit, u, doc])
        } else {
            row(&[name, unit, doc])
        }
    };
    *text += "\n";
    *text += &row(head, "unit", "*u*", "");
    *text += &row("---", "---", "---", "---");
    for value in values {
        let unit = if value.dimension == Dimension::NUMBER {
            String::new()
        } else {
            format!("`{}`", si_unit(value.dimension))
        };
        let unit = match (value.list, unit.is_empty()) {
            (true, true) => "list".to_owned(),
            (true, false) => format!("list, {unit}"),
            (false, _) => unit,
        };
        let mark = of_frames(value.of_storey);
        let name = format!("{}{mark}", anchor(block, value.name, false));
        let u = if value.measured { "u" } else { "" };
        *text += &row(&name, &unit, u, value.doc);
    }
}
