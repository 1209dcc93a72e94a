//! The generated parts of the book: the columns of the tables and the keys of `summary.json`.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use psd::procedures::columns;
use psd_plan::schema::BLOCKS;
use psd_text::units::display::si_unit;
use serde_json::Value;

const START: &str = "<!-- generated -->\n";
const END: &str = "<!-- end of generated -->\n";

/// Compares the generated part of a page, or writes it.
fn hold(page: &str, wanted: &str) {
    let path = super::docs().join(page);
    let text = fs::read_to_string(&path).expect("the page");
    let (before, rest) = text.split_once(START).expect("the part has a start");
    let (part, after) = rest.split_once(END).expect("the part has an end");
    if super::accepts_output() {
        fs::write(&path, format!("{before}{START}{wanted}{END}{after}")).expect("a writable page");
        return;
    }
    assert!(part == wanted, "docs/{page}: cargo xtask generate book");
}

/// The names in the first cells of the hand-written table of a page.
fn listed(page: &str) -> Vec<String> {
    let text = super::text(Path::new(page));
    let (before, _) = text.split_once(START).expect("the part has a start");
    before
        .lines()
        .filter_map(|line| line.strip_prefix("| `")?.split('`').next())
        .map(str::to_owned)
        .collect()
}

/// The end of the name of a column in this unit: `_m_per_s2` for m/s^2.
fn suffix(unit: &str) -> String {
    let words = unit
        .replace('/', "_per_")
        .replace('*', "_")
        .replace('^', "");
    format!("_{}", words.to_lowercase())
}

/// A procedure with its columns, each once.
type Listed = (String, Vec<&'static str>);

/// The columns of a procedure in words. Those of an earlier procedure that has many of them are named together.
fn row((words, names): &Listed, earlier: &[Listed]) -> String {
    let is_part =
        |other: &&Listed| other.1.len() > 20 && other.1.iter().all(|name| names.contains(name));
    let part = earlier.iter().find(is_part);
    let own = names
        .iter()
        .filter(|name| part.is_none_or(|(_, known)| !known.contains(name)));
    let own: Vec<String> = own.map(|name| format!("`{name}`")).collect();
    let of_part = part.map_or_else(String::new, |(part, _)| format!("; those of `{part}`"));
    format!("| `{words}` | {}{of_part} |", own.join(", "))
}

#[test]
fn every_column_is_explained_and_listed() {
    let mut text = "\n| procedure | numeric columns |\n|---|---|\n".to_owned();
    let mut units = BTreeMap::new();
    let mut earlier: Vec<Listed> = Vec::new();
    for block in BLOCKS.iter().filter(|block| block.is_procedure()) {
        let names = columns(block.kind).map(|column| column.name);
        units.extend(columns(block.kind).map(|column| (column.name, si_unit(column.dimension))));
        let mut once: Vec<&str> = Vec::new();
        names.for_each(|name| {
            if !once.contains(&name) {
                once.push(name);
            }
        });
        if !once.is_empty() {
            let listed = (block.words(), once);
            let _ = writeln!(text, "{}", row(&listed, &earlier));
            earlier.push(listed);
        }
    }
    for (name, unit) in &units {
        assert!(
            unit == "1" || name.ends_with(&suffix(unit)),
            "`{name}` does not end with its unit, {unit}"
        );
    }
    text += "\n";
    hold("reference/tables.md", &text);
    let listed = listed("reference/tables.md");
    for name in units.keys() {
        assert!(
            listed.iter().any(|column| column == name),
            "`{name}` is not explained"
        );
    }
    for name in listed
        .iter()
        .filter(|name| name.contains('_') && !name.contains('.'))
    {
        assert!(
            units.contains_key(name.as_str()) || TEXTS.contains(&name.as_str()),
            "no column `{name}`"
        );
    }
}

/// Text columns, and columns of tables that do not belong to a procedure.
const TEXTS: [&str; 2] = ["zero_drift", "force_state"];

/// The type of a property, and the definition that it refers to.
fn kind(property: &Value) -> String {
    if let Some(reference) = property["$ref"].as_str() {
        let name = reference.rsplit('/').next().unwrap_or_default();
        return format!("[{name}](#{})", name.to_lowercase());
    }
    if let Some(items) = property.get("items") {
        return format!("list of {}", kind(items));
    }
    if let Some(values) = property
        .get("additionalProperties")
        .filter(|values| values.is_object())
    {
        return format!("map of {}", kind(values));
    }
    for several in ["anyOf", "oneOf"] {
        if let Some(kinds) = property[several].as_array() {
            return kinds.iter().map(kind).collect::<Vec<_>>().join(" or ");
        }
    }
    if let Some(values) = property["enum"].as_array() {
        let words: Vec<String> = values
            .iter()
            .map(|value| format!("`{}`", value.as_str().unwrap_or("null")))
            .collect();
        return words.join(", ");
    }
    if let Some(value) = property["const"].as_str() {
        return format!("`{value}`");
    }
    match &property["type"] {
        Value::String(name) => name.clone(),
        Value::Array(names) => {
            let names: Vec<&str> = names.iter().filter_map(Value::as_str).collect();
            names.join(" or ")
        }
        _ => "any value".to_owned(),
    }
}

fn write_object(text: &mut String, object: &Value) {
    if let Some(about) = object["description"].as_str() {
        let _ = writeln!(text, "{about}\n");
    }
    let Some(properties) = object["properties"].as_object() else {
        let _ = writeln!(text, "{}\n", kind(object));
        return;
    };
    let _ = writeln!(text, "| key | value | |\n|---|---|---|");
    for (name, property) in properties {
        let about = property["description"]
            .as_str()
            .unwrap_or_default()
            .replace('\n', " ");
        let _ = writeln!(text, "| `{name}` | {} | {about} |", kind(property));
    }
    text.push('\n');
}

#[test]
fn the_keys_of_the_summary_are_those_of_its_schema() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("grammar/summary.schema.json");
    let schema: Value =
        serde_json::from_str(&fs::read_to_string(path).expect("the schema")).expect("JSON");
    let mut text = "\n## Keys\n\n".to_owned();
    write_object(&mut text, &schema);
    let parts: BTreeMap<&String, &Value> =
        schema["$defs"].as_object().expect("parts").iter().collect();
    for (name, part) in parts {
        let _ = write!(text, "### {name}\n\n");
        write_object(&mut text, part);
    }
    hold("reference/summary.md", &text);
}
