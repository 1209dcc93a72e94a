//! The rules of the repository that a reader could otherwise not verify, checked in the source text.

use std::collections::BTreeSet;
use std::path::Path;

use super::import_graph::{is_of_tests, without_comments_and_tests};
use super::signatures::signatures;
use super::source_text::{SourceText, none, rust_files};

/// Code that converts text into a verdict and its outputs: a function of its input only, on every machine.
const PURE: &[&str] = &[
    "text",
    "physics",
    "plan",
    "language",
    "lsp",
    "check",
    "procedures",
    "verdict",
    "report",
    "golden",
];

/// Names that such code must not use: the clock, files, the environment, the terminal, processes and the network.
const IMPURE: &[&str] = &[
    "std::fs",
    "fs::",
    "File::",
    "std::env",
    "env::var",
    "std::time::Instant",
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
    (&["polars"], &["report", "study/data_set"]),
    (&["polars_parquet", "zmij", "zstd"], &["report"]),
    (
        &[
            "plotters",
            "plotters_backend",
            "resvg",
            "maud",
            "typst",
            "typst_layout",
            "typst_pdf",
        ],
        &["report"],
    ),
    (&["png"], &["report", "plan/report"]),
    (
        &[
            "clap",
            "indicatif",
            "signal_hook",
            "ratatui",
            "minisign",
            "rpassword",
        ],
        &["cli"],
    ),
    (&["serialport"], &["rig/transport", "rig/emulator", "cli"]),
];

#[test]
fn the_core_reads_no_clock_file_or_environment() {
    let files = rust_files("src");
    let pure = files
        .iter()
        .filter(|file| file.is_in(PURE) && !file.is_test());
    let found: Vec<String> = pure
        .flat_map(|file| IMPURE.iter().flat_map(|word| file.lines_with(word)))
        .collect();
    none(&found, "the core is a function of its input");
}

/// Below the command line, code takes the clock as an argument. A test gives it a simulated one.
#[test]
fn one_file_reads_the_clock_of_the_machine() {
    let reads = [
        "Instant::now",
        "SystemTime",
        "Timestamp::now",
        "Zoned::now",
        "clock_gettime",
    ];
    let files = rust_files("src");
    let mut readers: Vec<&str> = files
        .iter()
        .filter(|file| !file.is_in(&["cli"]) && !file.is_test())
        .filter(|file| reads.iter().any(|word| !file.lines_with(word).is_empty()))
        .map(|file| file.path.as_str())
        .collect();
    readers.sort_unstable();
    assert_eq!(readers, ["rig/transport/clock.rs"]);
}

#[test]
fn each_library_is_known_to_one_part_only() {
    let files = rust_files("src");
    let mut found = Vec::new();
    for (crates, folders) in KNOWS {
        for file in files
            .iter()
            .filter(|file| !file.is_in(folders) && !file.is_test())
        {
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
    let others = files
        .iter()
        .filter(|file| !file.is_in(&["rig", "run", "procedures", "remote", "cli", "tests"]));
    let found: Vec<String> = others
        .flat_map(|file| [file.lines_with("dyn Rig"), file.lines_with("rig::Rig")].concat())
        .filter(|line| !line.contains("rig::RigFault"))
        .collect();
    none(
        &found,
        "a rig is driven outside `run`, `procedures` and `remote`",
    );
}

/// A driver and its emulator read the same bytes with separate code; otherwise one error could hide the other. They share only the port,
/// the clock, and the plan.
#[test]
fn emulator_and_drivers_share_no_parsing_code() {
    let files = rust_files("src");
    let mut found = Vec::new();
    let tests = ["_tests.rs", "/tests/", "testing", "fault_table"];
    let beside_tests = |file: &&SourceText| !tests.iter().any(|name| file.path.contains(name));
    for file in files
        .iter()
        .filter(|file| file.is_in(&["rig/emulator"]))
        .filter(beside_tests)
    {
        let of_the_drivers = ["controllers", "real", "guard", "virtual_rig"];
        found.extend(
            of_the_drivers
                .iter()
                .flat_map(|room| file.lines_with(&format!("crate::{room}"))),
        );
    }
    for file in files
        .iter()
        .filter(|file| file.is_in(&["rig/controllers", "rig/real", "rig/guard"]))
        .filter(beside_tests)
    {
        found.extend(file.lines_with("emulator::"));
    }
    none(
        &found,
        "the emulator and the driver must not know each other",
    );
}

/// A failpoint switches a guard off in the tests of any crate. The program has no such call.
#[test]
fn nothing_but_tests_switches_a_guard_off() {
    let mut found = Vec::new();
    for file in rust_files("src") {
        if is_of_tests(&file.path) || file.path == "plan/record/failpoint.rs" {
            continue;
        }
        let code = without_comments_and_tests(&file.text);
        let calls = code.split(';').filter(|item| {
            item.contains("failpoint::without")
                || item.contains("failpoint::{") && item.contains("without")
        });
        found.extend(calls.map(|item| format!("{}: {}", file.path, item.trim())));
    }
    none(&found, "a guard is switched off outside of tests");
}

/// The program version is a digest of its sources, without the files whose names mark them as tests (`build.rs`). No such file may become
/// part of the program.
#[test]
fn what_is_named_a_test_is_built_for_tests_alone() {
    let named = |name: &str| name == "tests" || name == "testing" || name.ends_with("_tests");
    let mut found = Vec::new();
    let mut modules = 0;
    for file in rust_files("src") {
        let lines: Vec<&str> = file.text.lines().map(str::trim).collect();
        let test = file.path.split(['/', '.']).any(named);
        for (at, line) in lines.iter().enumerate() {
            let module = line
                .strip_suffix(';')
                .and_then(|line| line.split("mod ").nth(1))
                .is_some_and(named);
            let path = line.starts_with("#[path = ") && line.split(['"', '/', '.']).any(named);
            let included = line.contains("include_") && line.split(['"', '/', '.']).any(named);
            let for_tests = lines[at.saturating_sub(2)..at].contains(&"#[cfg(test)]");
            if included && !test || (module || path) && !for_tests && !test {
                found.push(format!("{}:{}: {line}", file.path, at + 1));
            }
            modules += usize::from(module);
        }
    }
    assert!(modules > 20, "{modules} modules of tests");
    none(&found, "not of tests alone");
}

#[test]
fn every_file_begins_with_what_it_is() {
    let files = rust_files("src");
    let found: Vec<String> = files
        .iter()
        .filter(|file| !file.text.starts_with("//! "))
        .map(|file| format!("{}: no `//!` header", file.path))
        .collect();
    none(&found, "a file breaks the house rules");
}

/// Arguments of a function, at most; `self` does not count.
const MOST_ARGUMENTS: usize = 6;

/// Two numbers that change places are the same program to the compiler, and another result. Three in a row have names: the fields of a
/// struct.
#[test]
fn the_arguments_of_a_function_are_few_and_have_names() {
    let mut found = Vec::new();
    let mut count = 0;
    for file in rust_files("src") {
        if is_of_tests(&file.path) || file.is_test() {
            continue;
        }
        for signature in signatures(&without_comments_and_tests(&file.text)) {
            count += 1;
            let location = format!("{}: fn {}", file.path, signature.name);
            if signature.longest_run_of_numbers() >= 3 {
                found.push(format!("{location} takes three `f64` in a row"));
            }
            if signature.parameters.len() > MOST_ARGUMENTS {
                found.push(format!(
                    "{location} takes more than {MOST_ARGUMENTS} arguments"
                ));
            }
            if signature.takes_a_tuple_apart() {
                found.push(format!("{location} takes a tuple apart: give it the parts"));
            }
        }
    }
    assert!(count > 4000, "{count} functions");
    none(&found, "give the arguments to a struct with named fields");
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

/// The numbers of every plan are accepted results. Pages and pictures are not, because they are large and change with every wording.
#[test]
fn accepted_results_stay_small() {
    let mut open = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("reports")];
    let (mut bytes, mut with_pages) = (0, BTreeSet::new());
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let entry = entry.unwrap();
            if entry.path().is_dir() {
                open.push(entry.path());
                continue;
            }
            bytes += entry.metadata().unwrap().len();
            if entry
                .path()
                .extension()
                .is_some_and(|ending| ending == "html")
            {
                with_pages.insert(folder.clone());
            }
        }
    }
    assert!(bytes < 8_000_000, "{bytes} bytes of accepted results");
    assert!(
        with_pages.len() <= 5,
        "pages of more than five plans: {with_pages:?}"
    );
}
