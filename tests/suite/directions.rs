//! The dependency rules inside the crate `psd`: which folder may use which. The compiler holds those between crates. No files form a
//! dependency cycle.

use std::collections::BTreeSet;

use super::import_graph::{ImportGraph, cycles, is_of_tests, without_comments_and_tests};
use super::source_text::{none, rust_files};

/// The folders of `psd`, lowest level first. A folder may use the folders of earlier lines. In its own line it may use only itself.
const ORDER: &[&[&str]] = &[
    &["run"],
    &["verdict"],
    &["report"],
    &["procedures"],
    &["check", "golden", "remote"],
    &["study"],
];

/// The one file that lists the procedures.
const DISPATCH: &str = "procedures/mod.rs";

/// The types of its facts about a procedure.
const FACTS: &str = "procedures/facts.rs";

/// The drivers of run and report. Only they query the procedures, and only through the dispatch file. All other files in their
/// folders are engines, which the procedures use.
const DRIVERS: &[&str] = &[
    "report/budget/line.rs",
    "report/figures/mod.rs",
    "report/sections/conditions/mod.rs",
    "report/sections/deviations.rs",
    "report/sections/headline.rs",
    "report/sections/results/budget_table.rs",
    "report/sections/results/mod.rs",
    "report/sections/provenance/validation.rs",
    "report/status/deviations.rs",
    "report/tables/mod.rs",
    "run/driver.rs",
];

/// Files, besides the dispatch file, that still distinguish procedures or histories. The list may only shrink.
const DISTINGUISHES_PROCEDURES: &[&str] = &["run/check_run.rs"];

fn position_in_order(folder: &str) -> Option<usize> {
    ORDER.iter().position(|line| line.contains(&folder))
}

/// The folder of `src` whose place in the order a file has.
fn folder_of(file: &str) -> &str {
    file.split('/').next().unwrap_or_default()
}

#[test]
fn a_folder_uses_only_folders_to_its_left() {
    let files = rust_files("src");
    let graph = ImportGraph::of(&files);
    let mut upwards = BTreeSet::new();
    let mut drivers = BTreeSet::new();
    for (file, used) in graph.uses() {
        let folder = folder_of(file);
        let Some(own) = position_in_order(folder) else {
            continue;
        };
        for used in used {
            let above = folder_of(used);
            let up = position_in_order(above).is_some_and(|above| above >= own) && above != folder;
            if up && [DISPATCH, FACTS].contains(&used) && DRIVERS.contains(&file) {
                drivers.insert(file);
            } else if up {
                upwards.insert((file, above));
            }
        }
    }
    let upwards = upwards
        .iter()
        .map(|(file, above)| format!("{file} uses {above}, which stands above it"));
    let idle = DRIVERS
        .iter()
        .filter(|driver| !drivers.contains(*driver))
        .map(|driver| format!("{driver} drives no procedure: remove it from the drivers"));
    let found: Vec<String> = upwards.chain(idle).collect();
    none(&found, "the arrows of the house");
}

#[test]
fn no_files_use_each_other_in_a_circle() {
    let files = rust_files("src");
    let graph = ImportGraph::of(&files);
    let uses = graph.uses();
    let found: Vec<String> = cycles(&uses)
        .iter()
        .map(|cycle| format!("{cycle:?}"))
        .collect();
    none(&found, "files use each other in a circle");
}

/// Whether code names a variant of an enum, such as `History::StiffnessRamp`, and not a function of it.
fn names_a_variant(code: &str, of: &str) -> bool {
    code.match_indices(of).any(|(at, _)| {
        let before = code[..at].chars().next_back();
        let whole = before.is_none_or(|before| !before.is_alphanumeric() && before != '_');
        whole && code[at + of.len()..].starts_with(|next: char| next.is_ascii_uppercase())
    })
}

/// A new procedure is added in its folder, in the two enums, and in the dispatch file. The compiler then reports the dispatch file,
/// because its matches name every variant.
#[test]
fn one_file_knows_which_procedures_there_are() {
    let variants = ["ProcedureKind::", "History::"];
    let files = rust_files("src");
    let mut found = Vec::new();
    for file in files.iter().filter(|file| !is_of_tests(&file.path)) {
        let code = without_comments_and_tests(&file.text);
        if file.path == DISPATCH {
            let arms = code.lines().filter(|line| line.trim().starts_with("_ =>"));
            found.extend(arms.map(|line| format!("{DISPATCH} skips variants: {}", line.trim())));
        }
        let distinguishes = !file.path.starts_with("procedures/")
            && variants
                .iter()
                .any(|variant| names_a_variant(&code, variant));
        let listed = DISTINGUISHES_PROCEDURES.contains(&file.path.as_str());
        if distinguishes && !listed {
            found.push(format!("{} tells procedures apart", file.path));
        }
        if listed && !distinguishes {
            found.push(format!(
                "{} no longer does: remove it from the list",
                file.path
            ));
        }
    }
    none(&found, "only the dispatch file tells procedures apart");
}
