//! The language reference, `grammar/LANGUAGE.md`: its generated part equals that of the schema, its plans are valid. `PSD_BLESS=1 cargo
//! test` regenerates the generated part.

use std::fs;
use std::path::PathBuf;

use psd::language::check::{LoadError, Loader, Options, check};
use psd::language::syntax::{format, parse};
use psd::schema::reference;
use psd::text::diagnostic::render::{Appearance, render_all};
use psd::text::source::Sources;

const START: &str = "<!-- generated -->\n";
const END: &str = "<!-- end of generated -->\n";

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("grammar/LANGUAGE.md")
}

fn page() -> String {
    fs::read_to_string(path()).expect("the reference is there")
}

/// The plans of the reference use no files.
struct NoFiles;

impl Loader for NoFiles {
    fn load(&self, _: &str) -> Result<String, LoadError> {
        Err(LoadError::NotFound)
    }
}

#[test]
fn the_generated_part_is_what_the_schema_says() {
    let page = page();
    let (before, rest) = page
        .split_once(START)
        .expect("the generated part has a start");
    let (generated, after) = rest.split_once(END).expect("the generated part has an end");
    let wanted = format!("\n{}\n", reference());
    if std::env::var_os("PSD_BLESS").is_some() {
        fs::write(path(), format!("{before}{START}{wanted}{END}{after}"))
            .expect("the reference can be written");
        return;
    }
    let differs = generated
        .lines()
        .zip(wanted.lines())
        .find(|(left, right)| left != right);
    assert!(
        generated == wanted,
        "grammar/LANGUAGE.md is behind the schema ({differs:?}): run PSD_BLESS=1 cargo test reference"
    );
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
        let file = sources.add("LANGUAGE.md", plan);
        assert_eq!(
            format(&parse(&sources, file).0, plan),
            plan,
            "psd fmt would change a plan of the reference"
        );
        // A plan on a real rig is a plan that is run with `--rig`.
        let rig =
            (plan.contains("serial(") && !plan.contains("behaviour")).then(|| "frame".to_owned());
        let checked = check(
            "LANGUAGE.md",
            plan,
            &NoFiles,
            &Options {
                rig,
                ..Options::default()
            },
        );
        let said = render_all(&checked.diagnostics, &checked.sources, &Appearance::plain());
        assert!(
            checked.plan.is_some() && checked.diagnostics.is_empty(),
            "{plan}\n{said}"
        );
    }
}
