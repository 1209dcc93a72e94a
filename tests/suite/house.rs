//! The house rules that a reader would otherwise have to trust: read from the source text itself.

use std::fs;
use std::path::{Path, PathBuf};

/// What turns text into a verdict and its outputs: a function of its input, on every machine.
const PURE: &[&str] = &[
    "quantity",
    "syntax",
    "schema",
    "schema.rs",
    "check",
    "mechanics",
    "output",
    "plan",
    "formula.rs",
    "verdict.rs",
    "source.rs",
    "suggest.rs",
    "inert.rs",
    "digest.rs",
    "uncertainty.rs",
    "golden",
    "comparison",
];

/// What such code may not name: the clock, files, the environment, the terminal, processes and the network.
const IMPURE: &[&str] = &[
    "std::fs",
    "fs::",
    "File::",
    "std::env",
    "env::var",
    "std::time",
    "Instant::now",
    "SystemTime",
    "Zoned::now",
    "Timestamp::now",
    "std::net",
    "std::process",
    "println!",
    "eprintln!",
    "print!",
    "eprint!",
];

/// A crate, and the only folders of `src` that may name it.
const KNOWS: &[(&[&str], &[&str])] = &[
    (&["pest", "pest_derive"], &["syntax"]),
    (&["polars", "plotters", "png", "maud", "typst", "typst_layout", "typst_pdf", "typst_assets"], &["output"]),
    (&["clap", "indicatif", "signal_hook", "ratatui", "minisign", "rpassword"], &["cli"]),
    (&["serialport"], &["rig", "simulator", "cli"]),
    (&["miette"], &["diagnostic"]),
    (&["rand", "rand_pcg", "rand_distr"], &["rig", "simulator"]),
];

struct SourceText {
    /// Relative to `src` or `tests`, with `/`.
    path: String,
    text: String,
}

impl SourceText {
    fn top(&self) -> &str {
        self.path.split('/').next().unwrap_or_default()
    }

    /// Tests beside the code may be timed; the rules of the core are for what the product runs.
    fn is_test(&self) -> bool {
        self.path.contains("/tests/") || self.path.contains("/testing/") || self.path.ends_with("/tests.rs")
    }

    /// The lines where `word` stands and is not the end of a longer name, without comment lines.
    fn lines_with(&self, word: &str) -> Vec<String> {
        let names = |line: &str| {
            line.match_indices(word).any(|(at, _)| {
                let before = line[..at].chars().next_back();
                before.is_none_or(|before| !before.is_alphanumeric() && before != '_')
            })
        };
        let code = self.text.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//"));
        code.filter(|(_, line)| names(line)).map(|(at, line)| format!("{}:{}: {}", self.path, at + 1, line.trim())).collect()
    }
}

/// Every Rust file of a folder of the repository.
fn rust_files(folder: &str) -> Vec<SourceText> {
    fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("the folder can be read") {
            let path = entry.expect("the entry can be read").path();
            if path.is_dir() {
                walk(&path, found);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.push(path);
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut paths = Vec::new();
    walk(&root, &mut paths);
    paths.sort();
    assert!(paths.len() > 5, "{folder} holds the code");
    let read = |path: &PathBuf| SourceText {
        path: path.strip_prefix(&root).expect("below the root").to_string_lossy().replace('\\', "/"),
        text: fs::read_to_string(path).expect("the file is text"),
    };
    paths.iter().map(read).collect()
}

fn none(found: &[String], rule: &str) {
    assert!(found.is_empty(), "{rule}:\n{}", found.join("\n"));
}

#[test]
fn the_core_reads_no_clock_file_or_environment() {
    let files = rust_files("src");
    let pure = files.iter().filter(|file| PURE.contains(&file.top()) && !file.is_test());
    let found: Vec<String> = pure.flat_map(|file| IMPURE.iter().flat_map(|word| file.lines_with(word))).collect();
    none(&found, "the core is a function of its input");
}

#[test]
fn each_library_is_known_to_one_part_only() {
    let files = rust_files("src");
    let mut found = Vec::new();
    for (crates, folders) in KNOWS {
        for file in files.iter().filter(|file| !folders.contains(&file.top()) && !file.is_test()) {
            for name in *crates {
                found.extend(file.lines_with(&format!("{name}::")));
                found.extend(file.lines_with(&format!("use {name};")));
            }
        }
    }
    none(&found, "a library is named outside the part that knows it");
}

#[test]
fn only_the_run_and_those_it_is_lent_to_drive_a_rig() {
    let files = rust_files("src");
    let others = files.iter().filter(|file| !["rig", "run", "serve", "cli"].contains(&file.top()));
    let found: Vec<String> = others.flat_map(|file| [file.lines_with("dyn Rig"), file.lines_with("rig::Rig")].concat()).collect();
    none(&found, "a rig is driven outside `run` and `serve`");
}

/// A driver and the simulator it is tried on read the same bytes with code of their own: else a mistake of one is hidden by
/// the other. They share only the port, the clock, and the plan.
#[test]
fn simulator_and_drivers_share_no_parsing_code() {
    let files = rust_files("src");
    let mut found = Vec::new();
    let tests = ["_tests.rs", "testing", "fault_table"];
    let beside_tests = |file: &&SourceText| !tests.iter().any(|name| file.path.contains(name));
    for file in files.iter().filter(|file| file.top() == "simulator").filter(beside_tests) {
        found.extend(file.lines_with("rig::").into_iter().filter(|line| !line.contains("rig::port::")));
    }
    for file in files.iter().filter(|file| file.top() == "rig").filter(beside_tests) {
        found.extend(file.lines_with("simulator::"));
    }
    none(&found, "the stand-in and the driver must not know each other");
}

/// The program's name is a digest of its sources, without the files that are named as tests (`build.rs`): none of them may
/// become a part of the program.
#[test]
fn what_is_named_a_test_is_built_for_tests_alone() {
    let named = |name: &str| name == "tests" || name == "testing" || name.ends_with("_tests");
    let mut found = Vec::new();
    let mut modules = 0;
    for file in rust_files("src") {
        let lines: Vec<&str> = file.text.lines().map(str::trim).collect();
        let test = file.path.split(['/', '.']).any(named);
        for (at, line) in lines.iter().enumerate() {
            let module = line.strip_suffix(';').and_then(|line| line.split("mod ").nth(1)).is_some_and(named);
            let path = line.starts_with("#[path = ") && line.split(['"', '/', '.']).any(named);
            let included = line.contains("include_") && line.split(['"', '/', '.']).any(named);
            let for_tests = lines[at.saturating_sub(2)..at].contains(&"#[cfg(test)]");
            if included && !test || (module || path) && !for_tests {
                found.push(format!("{}:{}: {line}", file.path, at + 1));
            }
            modules += usize::from(module);
        }
    }
    assert!(modules > 20, "{modules} modules of tests");
    none(&found, "not of tests alone");
}

#[test]
fn every_file_says_what_it_is_and_stays_short() {
    let mut found = Vec::new();
    for file in rust_files("src") {
        if !file.text.starts_with("//! ") {
            found.push(format!("{}: no `//!` header", file.path));
        }
        let lines = file.text.lines().count();
        if lines > 500 {
            found.push(format!("{}: {lines} lines, the wall is 500", file.path));
        }
    }
    none(&found, "a file breaks the house rules");
}

#[test]
fn nothing_is_left_undone_or_switched_off() {
    // Written in two parts, so that this file does not find itself.
    let words = [
        concat!("TO", "DO"),
        concat!("FIX", "ME"),
        concat!("XX", "X"),
        concat!("dbg", "!("),
        concat!("to", "do!("),
        concat!("unimple", "mented!("),
        concat!("#[ig", "nore"),
    ];
    let mut found = Vec::new();
    for file in rust_files("src").into_iter().chain(rust_files("tests")) {
        for (at, line) in file.text.lines().enumerate() {
            if words.iter().any(|word| line.contains(word)) {
                found.push(format!("{}:{}: {}", file.path, at + 1, line.trim()));
            }
        }
    }
    none(&found, "left undone");
}
