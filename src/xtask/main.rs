//! `cargo xtask generate` writes every generated file of the repository: the reference, the book, the snapshots, the accepted results. In:
//! the sources. Out: the files, and a list of those whose bytes changed. It generates nothing itself: the tests that compare a file
//! with the program also write it.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Files of one kind, and the command of cargo that compares them.
struct Part {
    name: &'static str,
    files: &'static str,
    command: &'static [&'static str],
    /// What the command needs to write, beside the variables.
    accept: &'static [&'static str],
}

/// In this order: console blocks of the book show accepted results.
#[rustfmt::skip]
const PARTS: &[Part] = &[
    Part {
        name: "results",
        files: "accepted results that moved, reports/",
        command: &["run", "--", "test", "plans"],
        accept: &["--accept"],
    },
    Part {
        name: "reference",
        files: "grammar/LANGUAGE.md, docs/reference/, arguments of options",
        command: &["test", "--test", "suite", "reference::"],
        accept: &[],
    },
    Part {
        name: "specimens",
        files: "loops of the specimen models, docs/specimens/",
        command: &["test", "--test", "suite", "specimens_page::"],
        accept: &[],
    },
    Part {
        name: "book",
        files: "console blocks, figures and tables of docs/",
        command: &["test", "--test", "suite", "book::"],
        accept: &[],
    },
    Part {
        name: "editor",
        files: "docs/reference/language-server.md",
        command: &["test", "-p", "psd-lsp", "transcripts::"],
        accept: &[],
    },
    Part {
        name: "emulator",
        files: "docs/tutorial/emulator.md",
        command: &["test", "--test", "system", "book::emulator::"],
        accept: &[],
    },
    Part {
        name: "schema",
        files: "grammar/summary.schema.json",
        command: &["test", "--test", "suite", "outputs::"],
        accept: &[],
    },
    Part {
        name: "editors",
        files: "words of the schema in grammar/editors/",
        command: &["test", "--test", "suite", "editors::"],
        accept: &[],
    },
    Part {
        name: "tree-sitter",
        files: "the parser in grammar/editors/tree-sitter-psd/src/",
        command: &["test", "--test", "generated"],
        accept: &[],
    },
    Part {
        name: "extension",
        files: "the extension of VS Code as one file, target/psd.vsix",
        command: &["test", "--test", "system", "editors::vsix::"],
        accept: &[],
    },
    Part {
        name: "language",
        files: "cases and snapshots of the language",
        command: &["test", "--test", "suite", "lang::"],
        accept: &[],
    },
    Part {
        name: "screen",
        files: "snapshots of the live screen, src/cli/operator/screen/",
        command: &["test", "--bin", "psd", "screen::"],
        accept: &[],
    },
];

/// The variables that make a test write, and what they are while it does and while it does not. Without a value for insta a
/// comparison would leave a file beside a snapshot that differs. Tests that write run one at a time, because others read the same page.
const VARIABLES: [(&str, &str, Option<&str>); 4] = [
    ("RUST_TEST_THREADS", "1", None),
    ("PSD_BLESS", "1", None),
    ("SNAPSHOTS", "overwrite", None),
    ("INSTA_UPDATE", "always", Some("no")),
];

/// The folders that have generated files.
const FOLDERS: [&str; 5] = ["docs", "grammar", "reports", "src", "tests"];

const USAGE: &str = "usage: cargo xtask generate [--check] [PART]...";

type Files = BTreeMap<PathBuf, Vec<u8>>;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some(parts) = asked(&arguments) else {
        eprintln!("{USAGE}\nWithout a part, all of them:");
        for part in PARTS {
            eprintln!("  {:<10} {}", part.name, part.files);
        }
        return ExitCode::from(2);
    };
    let check = arguments.iter().any(|argument| argument == "--check");
    match generate(&parts, check) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// The parts that are asked for; none if an argument is unknown.
fn asked(arguments: &[String]) -> Option<Vec<&'static Part>> {
    let (command, rest) = arguments.split_first()?;
    let names: Vec<&String> = rest
        .iter()
        .filter(|argument| *argument != "--check")
        .collect();
    let is_known = |name: &&String| PARTS.iter().any(|part| part.name == **name);
    let known = command == "generate" && names.iter().all(is_known);
    let parts = PARTS
        .iter()
        .filter(|part| names.is_empty() || names.iter().any(|name| *name == part.name));
    known.then(|| parts.collect())
}

/// Writes or compares each part. Whether every command succeeded.
fn generate(parts: &[&Part], check: bool) -> io::Result<bool> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .nth(2)
        .expect("this package is in src/xtask");
    let before = read(root)?;
    let mut failed = Vec::new();
    for part in parts {
        println!("== {}: {}", part.name, part.files);
        let succeeds = || -> io::Result<bool> {
            let status = command(part, check).current_dir(root).status()?;
            Ok(status.success())
        };
        // A test may read a page before another one writes it: the second time decides.
        if !succeeds()? && (check || !succeeds()?) {
            failed.push(part.name);
        }
    }
    if !check {
        report(root, &before, &read(root)?);
    }
    for name in &failed {
        eprintln!("failed: {name}");
    }
    Ok(failed.is_empty())
}

fn command(part: &Part, check: bool) -> Command {
    let mut command = Command::new(env!("CARGO"));
    command.args(part.command);
    if !check {
        command.args(part.accept);
    }
    for (name, writes, compares) in VARIABLES {
        match if check { compares } else { Some(writes) } {
            Some(value) => command.env(name, value),
            None => command.env_remove(name),
        };
    }
    command
}

/// The files that can change, with their bytes.
fn read(root: &Path) -> io::Result<Files> {
    let mut files = Files::new();
    let mut folders: Vec<PathBuf> = FOLDERS.iter().map(|folder| root.join(folder)).collect();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let bytes = fs::read(&path)?;
                files.insert(path, bytes);
            }
        }
    }
    Ok(files)
}

/// Prints the files that are new, changed or removed.
fn report(root: &Path, before: &Files, after: &Files) {
    let mut changes: Vec<(&PathBuf, &str)> = Vec::new();
    for (path, bytes) in after {
        match before.get(path) {
            None => changes.push((path, "new")),
            Some(old) if old != bytes => changes.push((path, "changed")),
            Some(_) => {}
        }
    }
    let removed = before.keys().filter(|path| !after.contains_key(*path));
    changes.extend(removed.map(|path| (path, "removed")));
    changes.sort_unstable();
    println!("== {} files changed", changes.len());
    for (path, change) in changes {
        let path = path.strip_prefix(root).unwrap_or(path);
        println!("{change:<8} {}", path.display());
    }
}
