//! The options of a field, each with its arguments below it. An argument or a list of options that was written before is named only.

use std::fmt::Write as _;

use super::values::{default, is_truth, value};
use psd_plan::schema::{BlockKind, Field, FieldType, Presence, Variant};

/// The default of an argument that is a field of its block as well.
const OF_THE_RIG: &str = "the rig's";

/// An option that was written: in all its parts, with its field and block.
pub(super) struct Listed {
    form: String,
    field: &'static str,
    block: &'static BlockKind,
}

/// The options that were written, and the arguments of one block.
pub(super) struct Written<'b> {
    /// The blocks that a value may name.
    blocks: &'b [&'b BlockKind],
    options: &'b mut Vec<Listed>,
    /// An argument in all its parts, and the option with it.
    arguments: Vec<(String, &'static str)>,
}

impl<'b> Written<'b> {
    /// Nothing is written yet.
    pub(super) const fn new(
        blocks: &'b [&'static BlockKind],
        options: &'b mut Vec<Listed>,
    ) -> Self {
        Self {
            blocks,
            options,
            arguments: Vec::new(),
        }
    }

    /// Notes options that another page describes: the same options of another field refer to this one.
    pub(super) fn note(
        &mut self,
        block: &'static BlockKind,
        field: &'static str,
        variants: &'static [Variant],
    ) {
        self.options.extend(variants.iter().map(|variant| {
            let form = format!("{variant:?}");
            Listed { form, field, block }
        }));
    }

    /// Writes a list of options at this depth.
    pub(super) fn list(
        &mut self,
        text: &mut String,
        block: &'static BlockKind,
        field: &'static str,
        variants: &'static [Variant],
        depth: usize,
    ) {
        let indent = "  ".repeat(depth);
        let mut known: Vec<(String, Vec<String>)> = Vec::new();
        for variant in variants {
            let form = format!("{variant:?}");
            if let Some(option) = self.options.iter().find(|it| it.form == form) {
                push(&mut known, &option.origin(block), variant.name);
                continue;
            }
            self.options.push(Listed { form, field, block });
            self.write_option(text, block, variant, depth);
        }
        for (of, names) in known {
            let there = self.options.iter().filter(|it| it.origin(block) == of);
            let named = if names.len() == variants.len() && names.len() == there.count() {
                "all".to_owned()
            } else {
                names.join(", ")
            };
            let _ = writeln!(text, "{indent}- {named} as in {of}");
        }
    }

    /// An option and its arguments in their order. Arguments that were written before are named only.
    fn write_option(
        &mut self,
        text: &mut String,
        block: &'static BlockKind,
        variant: &'static Variant,
        depth: usize,
    ) {
        let indent = "  ".repeat(depth);
        let _ = writeln!(text, "{indent}- `{}`: {}", signature(variant), variant.doc);
        let indent = "  ".repeat(depth + 1);
        let mut rest = variant.arguments;
        while let Some((argument, after)) = rest.split_first() {
            let origin = |argument: &Field| self.origin(block, argument);
            let Some(of) = origin(argument) else {
                self.arguments.push((format!("{argument:?}"), variant.name));
                self.write_argument(text, &indent, argument);
                if let (FieldType::Choice(inner) | FieldType::QuantityOr(_, inner), false) =
                    (argument.ty, is_truth(argument))
                {
                    self.list(text, block, argument.name, inner, depth + 2);
                }
                rest = after;
                continue;
            };
            let count = rest
                .iter()
                .take_while(|argument| origin(argument).as_ref() == Some(&of))
                .count();
            let (known, after) = rest.split_at(count);
            let names: Vec<String> = known
                .iter()
                .map(|argument| format!("`{}`", argument.name))
                .collect();
            let _ = writeln!(text, "{indent}- {} as in {of}", names.join(", "));
            rest = after;
        }
    }

    /// The text that says where an argument was written before; none for a new one.
    fn origin(&self, block: &'static BlockKind, argument: &Field) -> Option<String> {
        if argument.presence == Presence::DefaultInWords(OF_THE_RIG)
            && block.field(argument.name).is_some()
        {
            return Some("the block, whose value is the default".to_owned());
        }
        let form = format!("{argument:?}");
        let known = self.arguments.iter().find(|(it, _)| *it == form);
        known.map(|(_, of)| format!("`{of}`"))
    }

    fn write_argument(&self, text: &mut String, indent: &str, argument: &Field) {
        let marks = if argument.advanced { " (advanced)" } else { "" };
        let value = [value(argument, self.blocks), default(argument)]
            .into_iter()
            .filter(|part| !part.is_empty())
            .collect::<Vec<String>>()
            .join("; ");
        let _ = writeln!(
            text,
            "{indent}- `{}` [{value}]{marks}: {}",
            argument.name, argument.doc
        );
    }
}

impl Listed {
    /// The field with its block, where that is another one than `block`.
    fn origin(&self, block: &BlockKind) -> String {
        if self.block.kind == block.kind {
            return format!("`{}`", self.field);
        }
        let anchor = self.block.keyword.join("-");
        format!("`{}` of [{}](#{anchor})", self.field, self.block.words())
    }
}

/// Adds a name to the group of its origin.
fn push(groups: &mut Vec<(String, Vec<String>)>, of: &str, name: &str) {
    let name = format!("`{name}`");
    match groups.iter_mut().find(|(it, _)| *it == of) {
        Some((_, names)) => names.push(name),
        None => groups.push((of.to_owned(), vec![name])),
    }
}

/// `elastic(…)`, or `series(a, b, …)`.
fn signature(variant: &Variant) -> String {
    let is_list = |argument: &Field| matches!(argument.ty, FieldType::Inners);
    match (
        variant.arguments.is_empty(),
        variant.arguments.iter().any(is_list),
    ) {
        (true, _) => variant.name.to_owned(),
        (false, true) => format!("{}(a, b, …)", variant.name),
        (false, false) => format!("{}(…)", variant.name),
    }
}
