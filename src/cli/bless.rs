//! `psd run --bless`: the results that a plan is held against from now on. In: the files of a run. Out: the folder
//! `reports/NAME`, beside the folder of `plans/NAME.psd`. Replaces that folder as a whole and touches no other.

use std::path::{Path, PathBuf};

use super::exit::Failure;
use super::loader::plain;
use super::run_folder::write_new;
use crate::output::OutputFile;

/// Where a plan's blessed results are kept.
#[derive(Debug)]
pub struct BlessedFolder {
    reports: PathBuf,
    name: String,
}

impl BlessedFolder {
    /// The folder for `plan`, which exists.
    pub fn of(plan: &Path) -> Result<Self, Failure> {
        let place = plan.canonicalize().map_err(|error| Failure::file(plan, plain(&error)))?;
        let name = place.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let above = place.parent().and_then(Path::parent);
        match (name, above) {
            (Some(name), Some(above)) => Ok(Self { reports: above.join("reports"), name }),
            _ => Err(Failure::file(plan, "has no folder above its own to keep blessed results in")),
        }
    }

    pub fn path(&self) -> PathBuf {
        self.reports.join(&self.name)
    }

    /// Puts the files that are kept in place of those that were. The old ones go only when the new ones are written.
    pub fn replace(&self, files: &[OutputFile]) -> Result<(), Failure> {
        let failed = |path: &Path, error: &std::io::Error| Failure::file(path, plain(error));
        std::fs::create_dir_all(&self.reports).map_err(|error| failed(&self.reports, &error))?;
        let (path, fresh, old) = (self.path(), self.beside("new"), self.beside("old"));
        for left_over in [&fresh, &old] {
            remove(left_over).map_err(|error| failed(left_over, &error))?;
        }
        std::fs::create_dir(&fresh).map_err(|error| failed(&fresh, &error))?;
        files.iter().filter(|file| is_kept(&file.path)).try_for_each(|file| write_new(&fresh, file))?;
        let swap = || -> std::io::Result<()> {
            if path.symlink_metadata().is_ok() {
                std::fs::rename(&path, &old)?;
            }
            std::fs::rename(&fresh, &path)?;
            remove(&old)
        };
        swap().map_err(|error| failed(&path, &error))
    }

    fn beside(&self, what: &str) -> PathBuf {
        self.reports.join(format!(".{}.{what}", self.name))
    }
}

/// Removes a folder, or the link or file in its place.
fn remove(path: &Path) -> std::io::Result<()> {
    match path.symlink_metadata() {
        Ok(metadata) if metadata.is_dir() => std::fs::remove_dir_all(path),
        Ok(_) => std::fs::remove_file(path),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
    }
}

/// Results that a visitor reads and a later run is compared with; not the plan, which lies beside them, and no Parquet.
fn is_kept(path: &str) -> bool {
    let is = |folder: &str, ending: &str| path.starts_with(folder) && Path::new(path).extension().is_some_and(|e| e == ending);
    matches!(path, "summary.json" | "certificate.html" | "certificate.pdf") || is("figures/", "png") || is("tables/", "csv")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(path: &str) -> OutputFile {
        OutputFile { path: path.to_owned(), bytes: b"new".to_vec() }
    }

    #[test]
    fn only_the_plans_own_folder_is_replaced() {
        let root = tempfile::tempdir().unwrap();
        for folder in ["plans", "reports/beam/tables", "reports/other"] {
            std::fs::create_dir_all(root.path().join(folder)).unwrap();
        }
        for path in ["plans/beam.psd", "reports/beam/tables/gone.csv", "reports/other/summary.json"] {
            std::fs::write(root.path().join(path), "old").unwrap();
        }
        let blessed = BlessedFolder::of(&root.path().join("plans/beam.psd")).unwrap();
        blessed
            .replace(&[file("summary.json"), file("tables/hit.csv"), file("tables/hit.parquet"), file("plan/beam.psd")])
            .unwrap();
        let read = |path: &str| std::fs::read_to_string(root.path().join("reports").join(path)).ok();
        assert_eq!(read("beam/summary.json").as_deref(), Some("new"));
        assert_eq!(read("beam/tables/hit.csv").as_deref(), Some("new"));
        assert_eq!(read("other/summary.json").as_deref(), Some("old"));
        assert_eq!(
            (read("beam/tables/gone.csv"), read("beam/tables/hit.parquet"), read("beam/plan/beam.psd")),
            (None, None, None)
        );
        assert_eq!(std::fs::read_dir(root.path().join("reports")).unwrap().count(), 2);
    }
}
