//! The plans that a command line names. In: files, folders, and `-` for standard input. Out: the plans, each once. It reads a file of a
//! folder only to see whether a Markdown document has a plan.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::files::failure::{Failure, plain};
use crate::files::loader::{has_plan, is_stdin};
use psd_text::markdown::is_document;

/// The plans of a named folder that a command takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// Those of the folder itself: its subfolders are libraries, which cannot be run.
    Folder,
    /// Those of its subfolders too.
    Below,
}

/// The plans that `paths` name, in their order; those of a folder by name. A file that does not exist is reported where it is read.
pub fn named(paths: &[PathBuf], depth: Depth) -> Result<Vec<PathBuf>, Failure> {
    let mut found = Vec::new();
    for path in paths {
        if is_stdin(path) || !path.is_dir() {
            found.push(path.clone());
            continue;
        }
        let before = found.len();
        walk(path, depth, &mut { usize::MAX }, &mut found)?;
        if found.len() == before {
            return Err(
                Failure::command_line(format!("no plan in {}", path.display()))
                    .help("a plan is a `.psd` file, or a `.md` file with a `psd` block"),
            );
        }
    }
    let mut seen = BTreeSet::new();
    found.retain(|plan| seen.insert(plan.clone()));
    Ok(found)
}

/// Adds every plan under a folder, sorted by name. Links to folders and hidden folders are not entered. The search ends after `most` entries.
pub fn below(folder: &Path, most: usize, found: &mut Vec<PathBuf>) -> Result<(), Failure> {
    let mut left = most;
    walk(folder, Depth::Below, &mut left, found)
}

/// Adds the plans of a folder, sorted by name. A link to a plan counts in the folder itself only: `psd fmt`, which goes below, would replace
/// the link by a file.
fn walk(
    folder: &Path,
    depth: Depth,
    left: &mut usize,
    found: &mut Vec<PathBuf>,
) -> Result<(), Failure> {
    let failed = |error: std::io::Error| Failure::file(folder, plain(&error));
    let mut entries = std::fs::read_dir(folder)
        .map_err(failed)?
        .take(*left)
        .collect::<Result<Vec<_>, _>>()
        .map_err(failed)?;
    entries.sort_by_key(std::fs::DirEntry::file_name);
    *left -= entries.len();
    for entry in entries {
        let (path, kind) = (entry.path(), entry.file_type().map_err(failed)?);
        if entry.file_name().to_string_lossy().starts_with('.') {
            continue;
        }
        let is_file = match depth {
            Depth::Folder => path.is_file(),
            Depth::Below => kind.is_file(),
        };
        if kind.is_dir() && depth == Depth::Below {
            walk(&path, depth, left, found)?;
        } else if is_file && is_plan(&path) {
            found.push(path);
        }
    }
    Ok(())
}

/// Whether a file found in a folder is a plan: a `.psd` file, or a Markdown document with a block of a plan.
fn is_plan(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.extension().is_some_and(|ending| ending == "psd") || is_document(&name) && has_plan(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_folders_and_standard_input_are_plans_each_once() {
        let root = tempfile::tempdir().unwrap();
        for name in ["b.psd", "a.psd", "notes.md", ".hidden.psd", "lib/c.psd"] {
            let path = root.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "").unwrap();
        }
        let paths = |paths: &[&str]| {
            let paths = paths.iter().map(|path| root.path().join(path));
            paths.collect::<Vec<_>>()
        };
        let folder = [root.path().to_owned(), root.path().join("a.psd")];
        assert_eq!(
            named(&folder, Depth::Folder).unwrap(),
            paths(&["a.psd", "b.psd"])
        );
        assert_eq!(
            named(&folder, Depth::Below).unwrap(),
            paths(&["a.psd", "b.psd", "lib/c.psd"])
        );
        let typed = [PathBuf::from("-"), "none.psd".into(), "-".into()];
        assert_eq!(named(&typed, Depth::Folder).unwrap(), typed[..2]);
        std::fs::create_dir(root.path().join("empty")).unwrap();
        let none = named(&paths(&["empty"]), Depth::Below).unwrap_err();
        assert!(none.to_string().contains("no plan in "));
    }
}
