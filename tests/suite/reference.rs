//! The language reference, `grammar/LANGUAGE.md`: its generated part equals that of the schema, its plans are valid. `cargo xtask
//! generate reference` writes the generated part.

use std::fs;
use std::path::PathBuf;

use psd::check::{Options, check, no_files};
use psd_language::syntax::{format, parse};
use psd_plan::schema::BLOCKS;
use psd_text::diagnostic::render::{Appearance, render_all};
use psd_text::source::Sources;

mod text;

use text::{PAGES, codes, reference};

const END: &str = "<!-- end of generated -->\n";

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("grammar/LANGUAGE.md")
}

fn page() -> String {
    fs::read_to_string(path()).expect("the reference is there")
}

/// Compares a generated part of a page with `text`, or writes it. The part begins with `<!-- generated: PART -->`.
fn compare(name: &str, part: &str, text: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(name);
    let page = fs::read_to_string(&path).expect("the page is there");
    let start = match part {
        "" => "<!-- generated -->\n".to_owned(),
        part => format!("<!-- generated: {part} -->\n"),
    };
    let (before, rest) = page
        .split_once(&start)
        .unwrap_or_else(|| panic!("{name} has no `{}`", start.trim()));
    let (generated, after) = rest.split_once(END).expect("the generated part has an end");
    let wanted = format!("\n{text}\n");
    if std::env::var_os("PSD_BLESS").is_some() {
        fs::write(path, format!("{before}{start}{wanted}{END}{after}"))
            .expect("the page can be written");
        return;
    }
    let differs = generated
        .lines()
        .zip(wanted.lines())
        .find(|(left, right)| left != right);
    assert!(
        generated == wanted,
        "{name} is behind the schema ({differs:?}): cargo xtask generate reference"
    );
}

#[test]
fn the_generated_parts_are_those_of_the_schema() {
    compare("grammar/LANGUAGE.md", "", &reference());
    compare("docs/reference/diagnostics.md", "", &codes());
    for page in PAGES {
        for (part, text) in page.parts() {
            compare(&format!("docs/{}.md", page.path), part, &text);
        }
    }
}

/// The part of the page on a block, without the heading.
fn section<'p>(page: &'p str, words: &str) -> &'p str {
    let (_, after) = page
        .split_once(&format!("\n### {words}\n"))
        .unwrap_or_default();
    after.split("\n### ").next().unwrap_or_default()
}

/// Whether a section names an entry in a list such as `Fields as in [impact](#impact): …`.
fn is_named_only(section: &str, kind: &str, name: &str) -> bool {
    let head = format!("{kind} as in [");
    let mut lists = section.lines().filter(|line| line.starts_with(&head));
    lists.any(|list| list.contains(&format!("`{name}`")))
}

/// A field and a result of a block may share a name: the anchor of the result then ends in `-result`. An entry that an earlier block
/// has in the same form has its anchor there; its own block names it, after a link to that block.
#[test]
fn every_field_result_and_code_has_one_anchor() {
    let (page, codes) = (reference(), codes());
    let text = format!("{page}{codes}");
    let mut found: Vec<&str> = text
        .split("<b id=")
        .skip(1)
        .filter_map(|rest| rest.split('>').next())
        .collect();
    let mut wanted: Vec<String> = psd::codes::all().iter().map(ToString::to_string).collect();
    for block in BLOCKS {
        let of = block.keyword.join("-");
        let section = section(&page, &block.words());
        let fields = block.fields.iter();
        let fields = fields.map(|field| ("Fields", field.name, ""));
        let values = block.exports.iter().chain(block.results).map(|value| {
            let twice = block.field(value.name).is_some();
            ("Results", value.name, if twice { "-result" } else { "" })
        });
        for (kind, name, end) in fields.chain(values) {
            if !is_named_only(section, kind, name) {
                wanted.push(format!("{of}.{name}{end}"));
            }
        }
    }
    found.sort_unstable();
    wanted.sort_unstable();
    assert_eq!(found, wanted);
    assert!(found.len() > 300, "{} anchors", found.len());
    for link in page.split("](#").skip(1) {
        let target = link.split(')').next().unwrap_or_default();
        let heading = target.replace('-', " ");
        assert!(
            page.contains(&format!("### {heading}\n")),
            "no heading {target}"
        );
    }
}

#[test]
fn the_plans_of_the_reference_are_right() {
    let page = page();
    let plans: Vec<&str> = page
        .split("```psd\n")
        .skip(1)
        .map(|after| after.split("```").next().unwrap_or_default())
        .collect();
    assert!(plans.len() >= 2, "the reference shows whole plans");
    for plan in plans {
        let mut sources = Sources::default();
        let file = sources.add("LANGUAGE.psd", plan);
        assert_eq!(
            format(&parse(&sources, file).0, plan),
            plan,
            "psd fmt would change a plan of the reference"
        );
        // A plan on a real rig is a plan that is run with `--rig`.
        let rig =
            (plan.contains("serial(") && !plan.contains("behaviour")).then(|| "frame".to_owned());
        let checked = check(
            "LANGUAGE.psd",
            plan,
            &no_files,
            &Options {
                rig,
                ..Options::default()
            },
        );
        let output = render_all(&checked.diagnostics, &checked.sources, &Appearance::plain());
        assert!(
            checked.plan.is_some() && checked.diagnostics.is_empty(),
            "{plan}\n{output}"
        );
    }
}
