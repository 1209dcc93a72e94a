//! The texts of a plan: the plan, a document, the files that it uses, its layout.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use psd::check::{LoadError, Options, check};
use psd_language::syntax;
use psd_text::diagnostic::render::{Appearance, render_all};
use psd_text::source::Sources;

use super::attack;

/// The files below a folder of the repository, by their names from there.
fn texts(folder: &str) -> BTreeMap<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut folders = vec![root.clone()];
    let mut found = BTreeMap::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path: PathBuf = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if let Ok(text) = fs::read_to_string(&path) {
                let name = path.strip_prefix(&root).expect("below the root");
                found.insert(name.to_string_lossy().into_owned(), text);
            }
        }
    }
    assert!(found.len() > 5, "{folder}");
    found
}

/// The inputs whose names end so.
fn ending(texts: &BTreeMap<String, String>, end: &str) -> Vec<Vec<u8>> {
    let of = texts.iter().filter(|(name, _)| name.ends_with(end));
    of.map(|(_, text)| text.clone().into_bytes()).collect()
}

/// Checks a plan and draws what is found. `other` is the text of every file that the plans of the repository do not have.
fn checked(name: &str, text: &str, files: &BTreeMap<String, String>, other: Option<&str>) {
    let load = |file: &str| {
        let text = files.get(file).map(String::as_str).or(other);
        text.map(str::to_owned).ok_or(LoadError::NotFound)
    };
    let checked = check(name, text, &load, &Options::default());
    let drawn = render_all(&checked.diagnostics, &checked.sources, &Appearance::plain());
    assert!(checked.plan.is_some() || !drawn.is_empty());
}

#[test]
fn a_plan() {
    let plans = texts("plans");
    let mut seeds = ending(&plans, ".psd");
    seeds.extend(ending(&texts("tests/lang"), ".psd"));
    attack("plan", &seeds, |bytes| {
        checked("plan.psd", &String::from_utf8_lossy(bytes), &plans, None);
    });
}

#[test]
fn a_document() {
    let plans = texts("plans");
    let mut seeds = ending(&plans, ".md");
    seeds.extend(ending(&texts("tests/lang"), ".md"));
    attack("document", &seeds, |bytes| {
        checked("plan.md", &String::from_utf8_lossy(bytes), &plans, None);
    });
}

#[test]
fn a_ground_motion() {
    const PLAN: &str = "two_storeys_sine.psd";
    let plans = texts("plans");
    let plan = plans[PLAN].replace("ground/sine.csv", "hostile.csv");
    let mut seeds = ending(&plans, ".csv");
    for seed in &mut seeds {
        seed.truncate(4 << 10);
    }
    seeds.push(b"time,acceleration\n0,0\n0.01,0.5\n0.02,-0.5\n".to_vec());
    attack("ground motion", &seeds, |bytes| {
        checked(PLAN, &plan, &plans, Some(&String::from_utf8_lossy(bytes)));
    });
}

#[test]
fn the_layout() {
    let mut seeds = ending(&texts("plans"), ".psd");
    seeds.extend(ending(&texts("tests/lang"), ".psd"));
    attack("layout", &seeds, |bytes| {
        let text = String::from_utf8_lossy(bytes).into_owned();
        let formatted = |text: &str| {
            let mut sources = Sources::default();
            let file = sources.add("plan.psd", text.to_owned());
            let (tree, errors) = syntax::parse(&sources, file);
            errors.is_empty().then(|| syntax::format(&tree, text))
        };
        if let Some(once) = formatted(&text) {
            let twice = formatted(&once).expect("the layout of a right plan is right");
            assert_eq!(twice, once);
        }
    });
}
