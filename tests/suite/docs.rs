//! The pages at the root are true: their plans check, their links lead somewhere, and the commands they name are there.

use std::fs;
use std::path::Path;

use psd::check::{LoadFault, Loader, Options, check};

struct NoFiles;

impl Loader for NoFiles {
    fn load(&self, _: &str) -> Result<String, LoadFault> {
        Err(LoadFault::NotFound)
    }
}

fn page(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).expect("the page is there")
}

#[test]
fn the_plan_in_the_readme_checks() {
    let readme = page("README.md");
    let plans: Vec<&str> = readme.split("```psd\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(!plans.is_empty(), "the README shows a plan");
    for plan in plans {
        let checked = check("README.psd", plan, &NoFiles, &Options::default());
        assert!(checked.plan.is_some(), "{:?}", checked.diagnostics);
    }
}

#[test]
fn links_of_the_pages_lead_somewhere() {
    for name in ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"] {
        for rest in page(name).split("](").skip(1) {
            let target = rest.split(')').next().expect("a link ends");
            assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join(target).exists(), "{name} links to {target}");
        }
    }
}

/// Paths named in code marks on the pages of the house exist.
#[test]
fn places_named_on_the_pages_exist() {
    for name in ["ARCHITECTURE.md", "CONTRIBUTING.md"] {
        for quoted in page(name).split('`').skip(1).step_by(2) {
            let is_place = quoted.starts_with("src/") || quoted.starts_with("tests/") || quoted.starts_with("grammar/");
            let is_pattern = quoted.contains(['{', ' ']) || quoted.contains("NAME") || quoted.contains("CODE");
            if is_place && !is_pattern {
                assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join(quoted).exists(), "{name} names {quoted}");
            }
        }
    }
}

#[test]
fn the_readmes_commands_are_there() {
    let readme = page("README.md");
    assert!(readme.contains("cargo run -- run plans/beam.psd") && readme.contains("cargo test"));
    assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join("plans/beam.psd").exists());
}
