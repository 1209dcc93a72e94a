//! The source text of the repository for the tests of repository rules: every Rust file of a folder, and the lines of a file that contain
//! a name.

use std::fs;
use std::path::{Path, PathBuf};

use psd::check::LoadError;

/// One Rust file.
pub struct SourceText {
    /// Relative to `src` or `tests`, with `/`.
    pub path: String,
    pub text: String,
}

impl SourceText {
    /// Whether the file lies in one of these folders of `src`.
    pub fn is_in(&self, folders: &[&str]) -> bool {
        folders.iter().any(|folder| {
            self.path
                .strip_prefix(folder)
                .is_some_and(|rest| rest.starts_with('/'))
        })
    }

    /// Tests beside the code may measure time, and an example prints. The rules of the core apply to the code that the product runs.
    pub fn is_test(&self) -> bool {
        self.is_in(&["tests", "physics/examples"])
            || self.path.contains("/tests/")
            || self.path.contains("/testing/")
            || self.path.ends_with("/tests.rs")
    }

    /// The lines in which `word` occurs and is not the end of a longer name, without comment lines.
    pub fn lines_with(&self, word: &str) -> Vec<String> {
        let names = |line: &str| {
            line.match_indices(word).any(|(at, _)| {
                let before = line[..at].chars().next_back();
                before.is_none_or(|before| !before.is_alphanumeric() && before != '_')
            })
        };
        let code = self
            .text
            .lines()
            .enumerate()
            .filter(|(_, line)| !line.trim_start().starts_with("//"));
        code.filter(|(_, line)| names(line))
            .map(|(at, line)| format!("{}:{}: {}", self.path, at + 1, line.trim()))
            .collect()
    }
}

/// Every Rust file of a folder of the repository.
pub fn rust_files(folder: &str) -> Vec<SourceText> {
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
        path: path
            .strip_prefix(&root)
            .expect("below the root")
            .to_string_lossy()
            .replace('\\', "/"),
        text: fs::read_to_string(path).expect("the file is text"),
    };
    paths.iter().map(read).collect()
}

/// Fails with the lines that violate a rule.
pub fn none(found: &[String], rule: &str) {
    assert!(found.is_empty(), "{rule}:\n{}", found.join("\n"));
}

/// Gives the files of a folder to the check of a plan.
pub fn files_in(folder: &Path) -> impl Fn(&str) -> Result<String, LoadError> {
    |path| fs::read_to_string(folder.join(path)).map_err(|_| LoadError::NotFound)
}
