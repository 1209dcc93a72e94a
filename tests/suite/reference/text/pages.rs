//! Options whose arguments have their own page of the book: the models of a specimen, the links of a rig, the distributions of a study.

use std::fmt::Write as _;

use super::options::Written;
use super::values::{default, is_truth, row, value};
use psd_plan::schema::{BLOCKS, block};
use psd_plan::schema::{FieldType, Kind, Variant};

/// The options of a field that another page describes.
pub struct Page {
    kind: Kind,
    field: &'static str,
    /// The name of the page in `docs/`, without its ending.
    pub path: &'static str,
    /// The text and the label of the link to it: `[Specimen models][models]`.
    title: &'static str,
    label: &'static str,
    /// Whether each option has its own table; otherwise one list has all.
    has_tables: bool,
}

/// The pages with arguments of options, each with a generated part per option.
pub const PAGES: &[Page] = &[
    Page {
        kind: Kind::Specimen,
        field: "behaviour",
        path: "specimens",
        title: "Specimen models",
        label: "models",
        has_tables: true,
    },
    Page {
        kind: Kind::Rig,
        field: "link",
        path: "rigs",
        title: "Controllers",
        label: "links",
        has_tables: true,
    },
    Page {
        kind: Kind::Study,
        field: "vary",
        path: "how-to/studies",
        title: "Studies",
        label: "distributions",
        has_tables: false,
    },
];

impl Page {
    /// The page with these options, if they have one.
    pub(super) fn of(kind: Kind, field: &str) -> Option<&'static Self> {
        PAGES
            .iter()
            .find(|page| page.kind == kind && page.field == field)
    }

    /// The line of the reference that leads to the page.
    pub(super) fn pointer(&self) -> String {
        let names: Vec<String> = self
            .options()
            .iter()
            .map(|option| format!("`{}`", option.name))
            .collect();
        let (title, label) = (self.title, self.label);
        format!("{}: see [{title}][{label}]", names.join(", "))
    }

    fn options(&self) -> &'static [Variant] {
        let field = block(self.kind).field(self.field);
        field.map_or(&[], |field| field.ty.variants())
    }

    /// The generated parts of the page, by name.
    pub fn parts(&self) -> Vec<(&'static str, String)> {
        let mut listed = Vec::new();
        if !self.has_tables {
            let (mut text, block) = (String::new(), block(self.kind));
            Written::new(BLOCKS, &mut listed).list(&mut text, block, self.field, self.options(), 0);
            return vec![(self.field, text)];
        }
        let options = self.options();
        let parts = options.iter().enumerate().map(|(index, option)| {
            let mut written = Written::new(BLOCKS, &mut listed);
            (
                option.name,
                self.table(option, &options[..index], &mut written),
            )
        });
        parts.collect()
    }

    /// The arguments of an option in order, then the options of these. An argument with options that an `earlier` option has too is that
    /// of the earlier one.
    fn table(
        &self,
        option: &'static Variant,
        earlier: &'static [Variant],
        written: &mut Written<'_>,
    ) -> String {
        let mut text = String::new();
        if !option.arguments.is_empty() {
            text += "| argument | value | default | |\n|---|---|---|---|\n";
        }
        for argument in option.arguments {
            let mark = if argument.advanced { " (advanced)" } else { "" };
            let (name, doc) = (
                format!("`{}`", argument.name),
                format!("{}{mark}", argument.doc),
            );
            let (value, default) = (value(argument, BLOCKS), default(argument));
            text += &row(&[&name, &value, &default, &doc]);
        }
        let mut head = "\n";
        for argument in option.arguments.iter().filter(|it| !is_truth(it)) {
            let form = format!("{argument:?}");
            let same = |other: &&Variant| {
                other
                    .argument(argument.name)
                    .is_some_and(|other| format!("{other:?}") == form)
            };
            if let Some(other) = earlier.iter().find(same) {
                if matches!(argument.ty, FieldType::Choice(_)) {
                    let _ = writeln!(text, "{head}- `{}` as in `{}`", argument.name, other.name);
                    head = "";
                }
            } else if let FieldType::Choice(options) = argument.ty {
                let _ = writeln!(text, "{head}- `{}`:", argument.name);
                written.list(&mut text, block(self.kind), argument.name, options, 1);
                head = "";
            }
        }
        text
    }
}
