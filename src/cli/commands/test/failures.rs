//! The files of a failed case: `NAME/new/`, the results of this run; `NAME/*.png`, accepted and new results on one sheet;
//! `NAME/difference.txt`, all differences. In: both results. Out: the folder, which no other program writes into. The files of an earlier
//! test are removed when its plan is tested again.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::cases::Case;
use super::overlay;
use crate::exit::Failure;
use crate::files::accepted::{is_page, remove};
use crate::files::failure::plain;
use crate::files::run_folder::write_new;
use psd::golden::{Finding, Truth, Words};
use psd::report::OutputFile;

/// The file that marks the folder of a failed case.
const DIFFERENCE: &str = "difference.txt";

/// The folder of a case.
pub fn folder(out: &Path, case: &Case) -> PathBuf {
    out.join(&case.folder)
}

/// Removes the files of an earlier test; any other folder is kept.
pub fn clear(out: &Path, case: &Case) -> Result<(), Failure> {
    let path = folder(out, case);
    if path.join(DIFFERENCE).is_file() {
        remove(&path).map_err(|error| Failure::file(&path, plain(&error)))?;
    }
    Ok(())
}

/// Writes all files of the case.
pub fn write(
    out: &Path,
    case: &Case,
    accepted: &Truth,
    files: &[OutputFile],
    found: &[Finding],
) -> Result<(), Failure> {
    let folder = folder(out, case);
    if folder.symlink_metadata().is_ok() {
        return Err(
            Failure::file(folder, "exists, and is not a folder of failed tests")
                .help("name another folder with `--out`"),
        );
    }
    std::fs::create_dir_all(&folder).map_err(|error| Failure::file(&folder, plain(&error)))?;
    write_new(
        &folder,
        &OutputFile {
            path: DIFFERENCE.to_owned(),
            bytes: failure_page(case, found).into_bytes(),
        },
    )?;
    let new = folder.join("new");
    files
        .iter()
        .filter(|file| is_page(&file.path) || Truth::holds(&file.path))
        .try_for_each(|file| write_new(&new, file))?;
    overlay::all(accepted, &crate::files::accepted::truth_of(files), found)?
        .iter()
        .try_for_each(|file| write_new(&folder, file))
}

/// Every difference, one per line.
fn failure_page(case: &Case, found: &[Finding]) -> String {
    let mut text = format!(
        "{}: {} from {}\n",
        case.name,
        found.len(),
        case.golden.path().display()
    );
    for finding in found {
        let words = Words::of(finding);
        let _ = writeln!(text, "{:<12} {}", words.part, words.line());
    }
    text
}
