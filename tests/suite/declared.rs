//! Fields, results and columns are declared once: the schema, the reader, the tables and the report name them by constants. No other
//! file has such a name as a string, so that a name cannot differ in two places.

use std::collections::BTreeSet;

use psd::procedures::columns;
use psd_plan::schema::{BLOCKS, Field};

use super::import_graph::{is_of_tests, without_comments_and_tests};
use super::source_text::{SourceText, none, rust_files};

/// Where names are declared, beside the data of each procedure. The numbers of contact laws and of models have their names in the physics, which the schema takes.
const DECLARATIONS: &[&str] = &["plan/schema", "physics/contact/mod.rs", "physics/specimen"];

/// Files that have such a name as a string with another meaning, and why.
const OTHER_MEANINGS: &[(&str, &str, &str)] = &[
    (
        "cli/commands/rig/list.rs",
        "serial_number",
        "a key of JSON: the number of a USB device",
    ),
    ("golden/print/json.rs", "time_s", "a key of JSON"),
    ("report/tables/mod.rs", "zero_drift", "the name of a table"),
    (
        "language/check/declarations/specimen/table_file.rs",
        "displacement_m",
        "the head of a file that others write",
    ),
    (
        "language/check/declarations/ground/record.rs",
        "time_s",
        "the head of a file that others write",
    ),
    (
        "language/check/declarations/ground/record.rs",
        "acceleration_m_per_s2",
        "the head of a file that others write",
    ),
];

/// Functions that read a field of a block by its name.
const READ_A_FIELD: &[&str] = &[
    "field",
    "quantity",
    "constant",
    "count",
    "optional",
    "quantities",
    "text_field",
    "texts",
    "reference",
    "choice",
    "choices",
    "word",
    "bounds",
    "within_entry",
    "misspelt",
];

/// Functions that read an argument of a variant, a number of the plan at run time, or a result, by its name.
const READ_BY_NAME: &[&str] = &[
    "argument",
    "constant_argument",
    "optional_argument",
    "chosen_argument",
    "list_argument",
    "text_argument",
    "interval_argument",
    "bounds_argument",
    "result",
    "list",
];

/// The files of the product that declare no name.
fn users() -> Vec<SourceText> {
    let declares = |file: &SourceText| {
        file.is_in(DECLARATIONS)
            || DECLARATIONS.contains(&file.path.as_str())
            || file.is_in(&["plan/procedures"])
                && ["/block.rs", "/parameters.rs"]
                    .iter()
                    .any(|name| file.path.ends_with(name))
    };
    let product = |file: &SourceText| !is_of_tests(&file.path) && !declares(file);
    rust_files("src").into_iter().filter(product).collect()
}

/// The string literals of the code, each with the code before it. A literal over several lines is no name.
fn literals(code: &str) -> Vec<(&str, &str)> {
    let mut found = Vec::new();
    let mut start_of_line = 0;
    for line in code.split_inclusive('\n') {
        // In a line without character literals of a quote, every second part is a string.
        if !line.contains("'\"'") {
            let mut at = start_of_line;
            for (index, part) in line.split('"').enumerate() {
                if index % 2 == 1 {
                    found.push((&code[..at - 1], part));
                }
                at += part.len() + 1;
            }
        }
        start_of_line += line.len();
    }
    found
}

/// Names of a field, of its arguments, and of theirs.
fn names_of(field: &'static Field, found: &mut BTreeSet<&'static str>) {
    found.insert(field.name);
    let variants = field.ty.variants().iter();
    for argument in variants.flat_map(|variant| variant.arguments) {
        // A model inside a model has no further names.
        if found.insert(argument.name) {
            names_of(argument, found);
        }
    }
}

/// The declared names of several words. A name of one word is often an ordinary word, such as `force`.
fn names() -> BTreeSet<&'static str> {
    let mut found = BTreeSet::new();
    for block in BLOCKS {
        for field in block.fields {
            names_of(field, &mut found);
        }
        found.extend(block.results.iter().map(|result| result.name));
        found.extend(columns(block.kind).map(|column| column.name));
    }
    found.retain(|name| name.contains('_'));
    found
}

/// Whether the code ends with a declaration of a column, whose name comes next.
fn declares(before: &str) -> bool {
    before.trim_end().ends_with("column(")
}

#[test]
fn names_are_strings_where_they_are_declared_only() {
    let names = names();
    assert!(names.len() > 150, "{} names", names.len());
    let mut found = Vec::new();
    let mut met = BTreeSet::new();
    for file in users() {
        let code = without_comments_and_tests(&file.text);
        for (before, text) in literals(&code) {
            if !names.contains(text) || declares(before) {
                continue;
            }
            let other = |(path, name, _): &&(&str, &str, &str)| *path == file.path && *name == text;
            match OTHER_MEANINGS.iter().find(other) {
                Some((path, name, _)) => {
                    met.insert((*path, *name));
                }
                None => found.push(format!("{}: \"{text}\"", file.path)),
            }
        }
    }
    let idle = OTHER_MEANINGS
        .iter()
        .filter(|(path, name, _)| !met.contains(&(*path, *name)));
    found.extend(idle.map(|(path, name, _)| format!("{path}: no \"{name}\", remove it here")));
    none(
        &found,
        "a field, result or column has a constant: name it by that",
    );
}

/// Whether the code before a string is a call of one of these functions, and the string is the name.
fn calls(before: &str, functions: &[&str]) -> bool {
    let before = before.trim_end().trim_end_matches(['&', '[']).trim_end();
    let before = match before.strip_suffix(',') {
        Some(before) => before
            .trim_end()
            .trim_end_matches(|c: char| c.is_alphanumeric() || "_*&.".contains(c)),
        None => before,
    };
    before.trim_end().strip_suffix('(').is_some_and(|before| {
        functions.iter().any(|function| {
            before
                .strip_suffix(function)
                .is_some_and(|before| before.ends_with(['.', ' ']))
        })
    })
}

#[test]
fn no_reader_names_a_field_by_a_string() {
    let files = users();
    let readers = files
        .iter()
        .filter(|file| file.is_in(&["language/check", "check", "procedures"]));
    let mut found = Vec::new();
    for file in readers {
        let code = without_comments_and_tests(&file.text);
        for (before, text) in literals(&code) {
            if calls(before, READ_BY_NAME) || calls(before, READ_A_FIELD) {
                found.push(format!("{}: \"{text}\"", file.path));
            }
        }
    }
    none(&found, "a reader names its fields by their constants");
}
