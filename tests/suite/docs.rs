//! Checks of the pages at the root: their plans check, their links lead to a target, and the commands they name exist.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::source_text::{none, rust_files};
use psd::check::{Options, check, no_files};

fn page(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).expect("the page is there")
}

#[test]
fn the_plan_in_the_readme_checks() {
    let readme = page("README.md");
    let plans: Vec<&str> = readme
        .split("```psd\n")
        .skip(1)
        .filter_map(|rest| rest.split("```").next())
        .collect();
    assert!(!plans.is_empty(), "the README shows a plan");
    for plan in plans {
        let checked = check("README.psd", plan, &no_files, &Options::default());
        assert!(checked.plan.is_some(), "{:?}", checked.diagnostics);
    }
}

#[test]
fn links_of_the_pages_lead_somewhere() {
    for name in ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"] {
        for rest in page(name).split("](").skip(1) {
            let target = rest.split(')').next().expect("a link ends");
            assert!(
                Path::new(env!("CARGO_MANIFEST_DIR")).join(target).exists(),
                "{name} links to {target}"
            );
        }
    }
}

/// Every path of the tree, and each of its ends: `frame/modes.rs` is a path seen from its folder.
fn ends_of_paths() -> BTreeSet<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut folders: Vec<PathBuf> = ["src", "tests", "grammar", "docs", "plans", "benches"]
        .map(|folder| root.join(folder))
        .to_vec();
    let mut ends = BTreeSet::from(["build.rs".to_owned()]);
    while let Some(folder) = folders.pop() {
        let inside = fs::read_dir(&folder).expect("the folder can be read");
        let paths: Vec<PathBuf> = inside.map(|entry| entry.unwrap().path()).collect();
        for path in paths.iter().chain([&folder]) {
            let path = path.strip_prefix(root).expect("below the root");
            let mut end = path.to_string_lossy().into_owned();
            while ends.insert(end.clone())
                && let Some((_, shorter)) = end.split_once('/')
            {
                end = shorter.to_owned();
            }
        }
        folders.extend(paths.into_iter().filter(|path| path.is_dir()));
    }
    ends
}

/// Whether a text in code marks is a path of the tree. A word in capitals, such as `NAME`, is a placeholder.
fn is_path(quoted: &str) -> bool {
    let is_placeholder =
        |word: &str| word.len() > 1 && word.chars().all(|letter| letter.is_ascii_uppercase());
    let is_name = |letter: char| letter.is_ascii_alphanumeric() || "._-/".contains(letter);
    quoted.chars().all(is_name)
        && !quoted.split(['/', '.', '_']).any(is_placeholder)
        && (Path::new(quoted)
            .extension()
            .is_some_and(|ending| ending == "rs")
            || ["src/", "tests/", "grammar/", "docs/"]
                .iter()
                .any(|root| quoted.starts_with(root)))
}

/// Paths in code marks exist: on the pages, and in the comments of the code.
#[test]
fn paths_in_pages_and_comments_exist() {
    let ends = ends_of_paths();
    let mut texts: Vec<(String, String)> = ["ARCHITECTURE.md", "CONTRIBUTING.md", "README.md"]
        .map(|name| (name.to_owned(), page(name)))
        .to_vec();
    for path in crate::book::pages() {
        let name = format!("docs/{}", path.display());
        let text = page(&name);
        texts.push((name, text));
    }
    for folder in ["src", "tests"] {
        for file in rust_files(folder) {
            let comments = file.text.lines().filter_map(|line| line.split_once("//"));
            let comments: Vec<_> = comments.map(|(_, comment)| comment).collect();
            texts.push((format!("{folder}/{}", file.path), comments.join("\n")));
        }
    }
    let mut shown = 0;
    let mut absent = Vec::new();
    for (name, text) in &texts {
        for line in text.lines() {
            for quoted in line
                .split('`')
                .skip(1)
                .step_by(2)
                .filter(|quoted| is_path(quoted))
            {
                shown += 1;
                if !ends.contains(quoted.trim_end_matches('/')) {
                    absent.push(format!("{name} names {quoted}"));
                }
            }
        }
    }
    assert!(shown > 300, "{shown}");
    none(&absent, "a path that does not exist");
}

/// Cells of a row of a table in Markdown. A bar after a backslash is text.
fn cells(row: &str) -> usize {
    row.replace(r"\|", "").matches('|').count() - 1
}

#[test]
fn every_row_of_a_table_has_the_cells_of_its_head() {
    let mut pages: Vec<String> = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"]
        .map(str::to_owned)
        .to_vec();
    pages.extend(
        crate::book::pages()
            .iter()
            .map(|path| format!("docs/{}", path.display())),
    );
    let mut rows = 0;
    let mut wrong = Vec::new();
    for name in &pages {
        let mut head = None;
        for (line, row) in (1..).zip(page(name).lines()) {
            if !row.starts_with('|') {
                head = None;
                continue;
            }
            rows += 1;
            if cells(row) != *head.get_or_insert_with(|| cells(row)) {
                wrong.push(format!("{name}:{line}"));
            }
        }
    }
    assert!(rows > 500, "{rows}");
    none(&wrong, "a row with other cells than its head");
}

#[test]
fn terms_of_the_glossary_are_in_alphabetical_order() {
    let glossary = page("docs/glossary.md");
    let terms: Vec<String> = glossary
        .lines()
        .filter(|line| line.starts_with("| "))
        .skip(1)
        .filter_map(|line| line.split('|').nth(1))
        .map(|term| {
            let term = term
                .to_lowercase()
                .replace('α', "alpha")
                .replace('δ', "delta");
            term.chars()
                .filter(|letter| letter.is_ascii_lowercase() || *letter == ' ')
                .collect::<String>()
                .trim()
                .to_owned()
        })
        .collect();
    assert!(terms.len() > 80, "{}", terms.len());
    for pair in terms.windows(2) {
        assert!(pair[0] <= pair[1], "{} follows {}", pair[1], pair[0]);
    }
}

#[test]
fn the_readmes_commands_are_there() {
    let readme = page("README.md");
    assert!(readme.contains("cargo run -- run plans/beam.psd") && readme.contains("cargo test"));
    assert!(
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("plans/beam.psd")
            .exists()
    );
}

/// Every part of the code is listed on the code map.
#[test]
fn every_part_of_the_code_is_on_the_map() {
    let (root, map) = (
        Path::new(env!("CARGO_MANIFEST_DIR")).join("src"),
        page("ARCHITECTURE.md"),
    );
    for entry in fs::read_dir(root).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let is_named = map.contains(&format!("`src/{name}"));
        assert!(is_named, "ARCHITECTURE.md does not name src/{name}");
    }
}

/// Output of `psd … --help`.
fn help(words: &[&str]) -> Option<String> {
    let output = Command::new(env!("CARGO_BIN_EXE_psd"))
        .args(words)
        .arg("--help")
        .output()
        .unwrap();
    output
        .status
        .success()
        .then(|| String::from_utf8(output.stdout).unwrap())
}

/// Commands and options of psd that the pages show in code marks or blocks are those of the program.
#[test]
fn commands_and_options_on_the_pages_are_those_of_the_program() {
    let mut pages = vec!["README.md".to_owned(), "CONTRIBUTING.md".to_owned()];
    pages.extend(
        crate::book::pages()
            .iter()
            .map(|page| format!("docs/{}", page.display())),
    );
    let is_word = |word: &&str| {
        word.chars()
            .all(|letter| letter.is_ascii_lowercase() || letter == '-')
    };
    let mut shown = 0;
    for name in &pages {
        let page = page(name);
        let marked = page
            .split('`')
            .skip(1)
            .step_by(2)
            .filter(|code| code.starts_with("psd ") && !code.contains('\n'));
        let blocks = page
            .split("```sh\n")
            .skip(1)
            .filter_map(|rest| rest.split("```").next())
            .flat_map(str::lines);
        let lines = blocks.filter_map(|line| {
            line.trim()
                .strip_prefix("cargo run -- ")
                .or_else(|| line.trim().strip_prefix("psd "))
        });
        for line in marked.map(|code| &code[4..]).chain(lines) {
            let line = line.split(" #").next().unwrap_or_default();
            let words: Vec<&str> = line.split_whitespace().collect();
            let has_subcommands = matches!(words.first(), Some(&"rig" | &"study"));
            let count = if has_subcommands { 2 } else { 1 };
            let command: Vec<&str> = words.iter().copied().take(count).filter(is_word).collect();
            if command.is_empty() || command[0].starts_with('-') {
                continue;
            }
            let help = help(&command).unwrap_or_else(|| panic!("{name} shows `psd {line}`"));
            for option in words
                .iter()
                .filter_map(|word| word.split('=').next())
                .filter(|word| word.starts_with("--"))
            {
                assert!(
                    help.contains(option),
                    "{name} shows `psd {line}`, and there is no {option}"
                );
            }
            shown += 1;
        }
    }
    assert!(shown > 80, "{shown}");
}
