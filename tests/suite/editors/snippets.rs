//! A snippet for each block: the short valid block of the schema, its name and values as places to fill in.

use psd_language::syntax;
use psd_plan::schema::{BLOCKS, BlockKind, Naming, Presence};
use psd_text::source::Sources;
use serde_json::{Map, Value, json};

use super::compare;

/// A keyword, what it is for, and the text with its places: `${1:hit}`.
struct Snippet {
    words: String,
    doc: &'static str,
    lines: Vec<String>,
}

/// The places to fill in, numbered as they come.
#[derive(Default)]
struct Places(usize);

impl Places {
    fn place(&mut self, text: &str) -> String {
        self.0 += 1;
        let text = text
            .replace('\\', r"\\")
            .replace('$', r"\$")
            .replace('}', r"\}");
        format!("${{{}:{text}}}", self.0)
    }
}

/// The fields of a block: of its example, or, where that is too short, all that are required.
fn entries(block: &BlockKind) -> Vec<(&'static str, &'static str)> {
    let (_, inside) = block.example.split_once('{').expect("a block");
    let inside = inside.trim_end_matches('}');
    let required = block.fields.iter();
    let required = required.filter(|field| field.presence == Presence::Required);
    let required: Vec<&str> = required.map(|field| field.example).collect();
    let shown: Vec<&str> = inside.lines().filter(|line| line.contains('=')).collect();
    let lines = if required.len() > shown.len() {
        required
    } else {
        shown
    };
    let entries = lines.into_iter().filter_map(|line| line.split_once('='));
    entries
        .map(|(key, value)| (key.trim(), value.trim()))
        .collect()
}

fn of_block(block: &'static BlockKind) -> Snippet {
    let words = block.words();
    let mut places = Places::default();
    let (head, _) = block.example.split_once('{').expect("a block");
    let name = head.strip_prefix(&words).expect("its keyword").trim();
    let head = match block.naming {
        Naming::Named => format!("{words} {} {{", places.place(name)),
        Naming::Titled => format!("{words} \"{}\" {{", places.place(name.trim_matches('"'))),
        Naming::Unnamed | Naming::MaybeNamed => format!("{words} {{"),
    };
    let entries = entries(block);
    let width = entries.iter().map(|(key, _)| key.len()).max();
    let lines = match width {
        None => vec![format!("{head} }}")],
        Some(width) => {
            let fields = entries
                .iter()
                .map(|(key, value)| match value.strip_prefix('"') {
                    Some(text) => format!(
                        "\t{key:width$} = \"{}\"",
                        places.place(text.trim_end_matches('"'))
                    ),
                    None => format!("\t{key:width$} = {}", places.place(value)),
                });
            let fields: Vec<String> = fields.collect();
            [vec![head], fields, vec!["}".to_owned()]].concat()
        }
    };
    Snippet {
        words,
        doc: block.doc,
        lines,
    }
}

/// The items that are no blocks have no entry in the schema.
fn of_items() -> Vec<Snippet> {
    let item = |words: &str, doc, line: &str| Snippet {
        words: words.to_owned(),
        doc,
        lines: vec![line.to_owned()],
    };
    vec![
        item(
            "use",
            "Blocks of another file",
            r#"use "${1:lib/beam.psd}""#,
        ),
        item(
            "param",
            "A number that `--set` changes",
            "param ${1:speed} = ${2:1 m/s}",
        ),
        item("let", "A name for a value", "let ${1:width} = ${2:40 mm}"),
        item(
            "require",
            "A requirement, which the run decides",
            r#"require "${1:stays in travel}" ${2:hit.max_displacement < 0.2 m}"#,
        ),
    ]
}

fn all() -> Vec<Snippet> {
    let blocks = BLOCKS.iter().map(|block| of_block(block));
    of_items().into_iter().chain(blocks).collect()
}

#[test]
fn the_snippets_are_those_of_the_schema() {
    let entries = all().into_iter().map(|snippet| {
        let Snippet { words, doc, lines } = snippet;
        let entry = json!({ "prefix": words, "description": doc, "body": lines });
        (words, entry)
    });
    let page = Value::Object(entries.collect::<Map<String, Value>>());
    let page = serde_json::to_string_pretty(&page).expect("JSON");
    compare("vscode/snippets/psd.json", &format!("{page}\n"));
}

/// A snippet as it stands in a plan when nothing is filled in.
fn inserted(snippet: &Snippet) -> String {
    let text = snippet.lines.join("\n").replace('\t', "  ");
    let mut parts = text.split("${");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| {
        let (_, rest) = part.split_once(':').expect("a place has a text");
        text + &rest.replacen('}', "", 1)
    }) + "\n"
}

#[test]
fn a_snippet_is_right_in_the_standard_layout_and_has_the_required_fields() {
    for snippet in all() {
        let text = inserted(&snippet);
        let mut sources = Sources::default();
        let file = sources.add("snippet.psd", text.clone());
        let (ast, errors) = syntax::parse(&sources, file);
        assert!(errors.is_empty(), "{text}: {errors:?}");
        assert_eq!(syntax::format(&ast, &text), text);
    }
    for block in BLOCKS {
        let named: Vec<&str> = entries(block).iter().map(|(key, _)| *key).collect();
        for field in block.fields {
            let required = field.presence == Presence::Required;
            assert!(!required || named.contains(&field.name), "{}", field.name);
        }
    }
}
