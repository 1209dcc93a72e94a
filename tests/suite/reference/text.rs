//! The schema as text: the generated part of the language reference, in Markdown. In: the tables of blocks, functions, units and
//! diagnostic codes. Out: one text, in which every field, result and code has an anchor where it is described. Knows no plan.

use std::fmt::Write as _;

use psd_plan::schema::{BLOCKS, CONSTANTS, FUNCTIONS};
use psd_text::diagnostic::page::Page;
use psd_text::units::Dimension;
use psd_text::units::display::si_unit;
use psd_text::units::unit::{PREFIXES, UNITS};

use crate::explain_pages::page_text;

mod blocks;
mod options;
mod pages;
mod values;

pub use pages::PAGES;

const INTRODUCTION: &str = "## Vocabulary

- Every field and result has an anchor where it is described: `#impact.duration`. All codes are in [Diagnostics][codes].
- **Value** shows the usual unit and the limits: `mm` ≥ 0 is a length in any unit, at least 0. A number can be written in `%`.
- A list is `[a, b, …]`, or a range with a step. A range is `a .. b`; a single number b is −b .. b (marked ±) or 0 .. b.
- ᴿ: for real rigs only. ᶠ: for frames only.
- *u*: the result has a standard uncertainty, read as `.u`.
- Arguments of an option are in the order of the lines below it: `limit(force: 1500 N)`.
- Models, links and distributions have their arguments on a page of their own.
";

/// The generated part of `grammar/LANGUAGE.md`: every block, field, option and result, then functions and units.
pub fn reference() -> String {
    let mut text = INTRODUCTION.to_owned();
    let mut options = Vec::new();
    for (index, block) in BLOCKS.iter().enumerate() {
        blocks::write(&mut text, block, &BLOCKS[..index], &mut options);
    }
    write_functions(&mut text);
    write_units(&mut text);
    text
}

/// The generated part of `docs/reference/diagnostics.md`: every code with its title.
pub fn codes() -> String {
    let mut text = "| code | |\n|---|---|\n".to_owned();
    for code in psd::codes::all() {
        let page = page_text(code);
        let title = Page::read(&page).title();
        let _ = writeln!(text, "| <b id={code}>{code}</b> | {title} |");
    }
    text
}

// Writing to a string cannot fail, so that the results of `write!` are ignored.

fn write_functions(text: &mut String) {
    let _ = writeln!(text, "\n## Functions\n\n| function | |\n|---|---|");
    for function in FUNCTIONS {
        let arguments = function.takes.arguments();
        let _ = writeln!(
            text,
            "| `{}({arguments})` | {} |",
            function.name, function.doc
        );
    }
    for (name, _, doc) in CONSTANTS {
        let _ = writeln!(text, "| `{name}` | {doc} |");
    }
}

fn write_units(text: &mut String) {
    let _ = writeln!(
        text,
        "\n## Units\n\n| unit | name | measures | prefixes | in SI |\n|---|---|---|---|---|"
    );
    for unit in UNITS {
        let prefixes = if unit.prefixes { "yes" } else { "" };
        let base = if unit.dimension == Dimension::NUMBER {
            String::new()
        } else {
            format!(" `{}`", si_unit(unit.dimension))
        };
        let zero = if unit.zero == 0.0 {
            String::new()
        } else {
            format!(", from {}{base}", unit.zero)
        };
        let (symbol, doc, measures) = (unit.symbol, unit.doc, unit.dimension.describe());
        let _ = writeln!(
            text,
            "| `{symbol}` | {doc} | {measures} | {prefixes} | {}{base}{zero} |",
            unit.factor
        );
    }
    let prefixes: Vec<String> = PREFIXES
        .iter()
        .map(|(prefix, factor)| format!("`{prefix}` {factor:e}"))
        .collect();
    let _ = writeln!(text, "\nPrefixes: {}.", prefixes.join(", "));
}
