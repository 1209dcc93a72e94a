//! The accepted results of a plan. In: the path of the plan, and the files of a run. Out: the folder `reports/NAME`, beside the folder of
//! `plans/NAME.psd`, read or replaced as a whole. No other folder is changed.

use std::path::{Component, Path, PathBuf};

use super::run_folder::write_new;
use crate::files::failure::Failure;
use crate::files::failure::plain;
use crate::files::loader::is_stdin;
use psd::golden::{Accepted, SUMMARY, Tolerances, Truth, compare};
use psd::report::{OutputFile, PAGE, PAPER};

/// The file that names the plan whose results a folder has: its path, from the folder above `reports`.
const PLAN: &str = "plan.txt";

/// The folder of the accepted results of a plan.
#[derive(Clone, Debug)]
pub struct AcceptedFolder {
    reports: PathBuf,
    name: String,
    /// The content of [`PLAN`] for its plan.
    plan: String,
}

impl AcceptedFolder {
    /// The folder for `plan`, which exists.
    pub fn of(plan: &Path) -> Result<Self, Failure> {
        refuse_stdin(plan)?;
        let path = canonical(plan)?;
        match path.parent().and_then(Path::parent) {
            Some(above) => {
                // As the operator would write it, if that is the same path.
                let typed = plan
                    .parent()
                    .and_then(Path::parent)
                    .filter(|typed| typed.canonicalize().is_ok_and(|path| path == above));
                let here = plan
                    .parent()
                    .is_some_and(|folder| folder.parent() == Some(Path::new("")));
                let here = here
                    && Path::new(".")
                        .canonicalize()
                        .is_ok_and(|path| path == above);
                Self::within(
                    &if here {
                        PathBuf::new()
                    } else {
                        typed.unwrap_or(above).to_owned()
                    }
                    .join("reports"),
                    &path,
                )
            }
            None => Err(Failure::file(
                plan,
                "has no folder above its own for accepted results",
            )),
        }
    }

    /// The folder for `plan`, which exists, among others in `reports`.
    pub fn within(reports: &Path, plan: &Path) -> Result<Self, Failure> {
        refuse_stdin(plan)?;
        let Some(name) = plan.file_stem() else {
            return Err(Failure::file(plan, "has no name for its accepted results"));
        };
        let above = resolved(reports);
        let from = above.parent().unwrap_or(&above);
        Ok(Self {
            reports: reports.to_owned(),
            name: name.to_string_lossy().into_owned(),
            plan: relative(from, &canonical(plan)?)
                .to_string_lossy()
                .into_owned(),
        })
    }

    pub fn path(&self) -> PathBuf {
        self.reports.join(&self.name)
    }

    /// The path, the same for every way to write it.
    pub fn absolute(&self) -> PathBuf {
        resolved(&self.reports).join(&self.name)
    }

    /// The reason not to use the folder: it has the accepted results of another plan. A folder that names no plan is that of this one.
    pub fn belongs_to_another(&self) -> Result<Option<String>, Failure> {
        let path = self.path().join(PLAN);
        let owner = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(Failure::file(&path, plain(&error))),
        };
        let owner = owner.trim_end();
        Ok((owner != self.plan).then(|| {
            format!(
                "{} has the accepted results of {owner}, not of {}: name another folder with `--golden`, or delete {} if the plan was moved",
                self.path().display(),
                self.plan,
                path.display()
            )
        }))
    }

    /// The compared part of the accepted results; empty if there are none.
    pub fn truth(&self) -> Result<Truth, Failure> {
        truth_in(&self.path())
    }

    /// Accepts the files of a run. If every number is within tolerance and the list of files is the same, nothing is written, unless
    /// `rewrite` requests it. Rendered pages are written with `pages`, or if the folder already has some.
    pub fn accept(
        &self,
        files: &[OutputFile],
        tolerances: &Tolerances,
        rewrite: bool,
        pages: bool,
    ) -> Result<Accepted, Failure> {
        if let Some(reason) = self.belongs_to_another()? {
            return Ok(Accepted::Refused(reason));
        }
        let (old, new) = (self.truth()?, truth_of(files));
        if old.text(SUMMARY).is_some() && new.is_of_faults() {
            return Ok(Accepted::Refused(
                "the plan had results and now fails to check; delete its results folder first"
                    .to_owned(),
            ));
        }
        let before = names(&self.path())?;
        let pages = pages || before.iter().any(|path| is_page(path));
        let mut kept: Vec<OutputFile> = files
            .iter()
            .filter(|file| pages && is_page(&file.path))
            .cloned()
            .chain(new.files().map(|(path, text)| OutputFile {
                path: path.to_owned(),
                bytes: text.as_bytes().to_vec(),
            }))
            .chain([OutputFile {
                path: PLAN.to_owned(),
                bytes: format!("{}\n", self.plan).into_bytes(),
            }])
            .collect();
        kept.sort_by(|one, other| one.path.cmp(&other.path));
        if old.is_empty() {
            self.replace(&kept)?;
            return Ok(Accepted::New);
        }
        let found = compare(&old, &new, tolerances);
        if found.is_empty() && !rewrite && kept.iter().map(|file| &file.path).eq(&before) {
            return Ok(Accepted::Unchanged);
        }
        self.replace(&kept)?;
        Ok(Accepted::Changed(found))
    }

    /// Replaces the files of the folder. The old files are removed only after the new ones are written.
    fn replace(&self, files: &[OutputFile]) -> Result<(), Failure> {
        let failed = |path: &Path, error: &std::io::Error| Failure::file(path, plain(error));
        std::fs::create_dir_all(&self.reports).map_err(|error| failed(&self.reports, &error))?;
        let (path, fresh, old) = (self.path(), self.beside("new"), self.beside("old"));
        for left_over in [&fresh, &old] {
            remove(left_over).map_err(|error| failed(left_over, &error))?;
        }
        std::fs::create_dir(&fresh).map_err(|error| failed(&fresh, &error))?;
        files.iter().try_for_each(|file| write_new(&fresh, file))?;
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

/// The accepted results of a plan are found by its path.
fn refuse_stdin(plan: &Path) -> Result<(), Failure> {
    if is_stdin(plan) {
        return Err(
            Failure::command_line("a plan from standard input has no accepted results")
                .help("save it in a file"),
        );
    }
    Ok(())
}

fn canonical(plan: &Path) -> Result<PathBuf, Failure> {
    plan.canonicalize()
        .map_err(|error| Failure::file(plan, plain(&error)))
}

/// The absolute path of a folder whose last parts need not exist.
fn resolved(folder: &Path) -> PathBuf {
    let path = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    path.ancestors()
        .find_map(|above| {
            let rest = path.strip_prefix(above).ok()?;
            Some(above.canonicalize().ok()?.join(rest))
        })
        .unwrap_or(path)
}

/// The path to a file from a folder, both absolute.
fn relative(from: &Path, to: &Path) -> PathBuf {
    let shared = from
        .components()
        .zip(to.components())
        .take_while(|(one, other)| one == other)
        .count();
    let up = from.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(to.components().skip(shared)).collect()
}

/// The compared part of a folder of results; empty if there is none.
pub fn truth_in(folder: &Path) -> Result<Truth, Failure> {
    let mut files = Vec::new();
    for name in names(folder)?.into_iter().filter(|name| Truth::holds(name)) {
        let path = folder.join(&name);
        let text =
            std::fs::read_to_string(&path).map_err(|error| Failure::file(&path, plain(&error)))?;
        files.push((name, text));
    }
    Ok(Truth::of(files))
}

/// The compared part of the files of a run.
pub fn truth_of(files: &[OutputFile]) -> Truth {
    let text = |file: &OutputFile| {
        (
            file.path.clone(),
            String::from_utf8_lossy(&file.bytes).into_owned(),
        )
    };
    Truth::of(
        files
            .iter()
            .filter(|file| Truth::holds(&file.path))
            .map(text),
    )
}

/// The paths of all files of a folder and of its subfolders, sorted; empty if the folder does not exist.
fn names(folder: &Path) -> Result<Vec<String>, Failure> {
    let mut found = Vec::new();
    let mut open = vec![(folder.to_owned(), String::new())];
    while let Some((path, prefix)) = open.pop() {
        let entries = match std::fs::read_dir(&path) {
            Ok(entries) => entries,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound && prefix.is_empty() => {
                return Ok(found);
            }
            Err(error) => return Err(Failure::file(path, plain(&error))),
        };
        for entry in entries {
            let entry = entry.map_err(|error| Failure::file(&path, plain(&error)))?;
            let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
            if entry.path().is_dir() {
                open.push((entry.path(), format!("{name}/")));
            } else {
                found.push(name);
            }
        }
    }
    found.sort();
    Ok(found)
}

/// Removes a folder, or the link or file of that name.
pub fn remove(path: &Path) -> std::io::Result<()> {
    match path.symlink_metadata() {
        Ok(metadata) if metadata.is_dir() => std::fs::remove_dir_all(path),
        Ok(_) => std::fs::remove_file(path),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
    }
}

/// Whether a file is a rendered page or picture, made from the numbers that are compared.
pub fn is_page(path: &str) -> bool {
    let picture = path.starts_with("figures/")
        && Path::new(path)
            .extension()
            .is_some_and(|ending| ending == "png");
    picture || matches!(path, PAGE | PAPER)
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd::golden::DIAGNOSTICS;

    fn file(path: &str) -> OutputFile {
        OutputFile {
            path: path.to_owned(),
            bytes: b"{}".to_vec(),
        }
    }

    #[test]
    fn only_the_plans_own_folder_is_replaced_and_only_where_something_changed() {
        let root = tempfile::tempdir().unwrap();
        for folder in ["plans", "reports/beam/tables", "reports/other"] {
            std::fs::create_dir_all(root.path().join(folder)).unwrap();
        }
        for path in [
            "plans/beam.psd",
            "reports/beam/tables/gone.csv",
            "reports/other/summary.json",
        ] {
            std::fs::write(root.path().join(path), "old").unwrap();
        }
        let accepted = AcceptedFolder::of(&root.path().join("plans/beam.psd")).unwrap();
        let files = [
            file("summary.json"),
            file("tables/hit.csv"),
            file("tables/hit.parquet"),
            file("plan/beam.psd"),
            file("report.html"),
        ];
        let accept_with = |rewrite, pages| {
            accepted
                .accept(&files, &Tolerances::default(), rewrite, pages)
                .unwrap()
        };
        let accept = |rewrite| accept_with(rewrite, false);
        assert!(matches!(accept(false), Accepted::Changed(found) if !found.is_empty()));
        let read =
            |path: &str| std::fs::read_to_string(root.path().join("reports").join(path)).ok();
        assert_eq!(read("beam/summary.json").as_deref(), Some("{}"));
        assert_eq!(read("beam/tables/hit.csv").as_deref(), Some("{}"));
        assert_eq!(read("other/summary.json").as_deref(), Some("old"));
        assert_eq!(
            (
                read("beam/tables/gone.csv"),
                read("beam/tables/hit.parquet"),
                read("beam/plan/beam.psd")
            ),
            (None, None, None)
        );
        assert_eq!(
            std::fs::read_dir(root.path().join("reports"))
                .unwrap()
                .count(),
            2
        );
        assert_eq!(
            (accept(false), accept(true)),
            (Accepted::Unchanged, Accepted::Changed(Vec::new()))
        );
        let page = "beam/report.html";
        assert_eq!(read(page), None, "data alone");
        assert!(matches!(accept_with(false, true), Accepted::Changed(found) if found.is_empty()));
        assert_eq!(read(page).as_deref(), Some("{}"));
        assert!(matches!(accept(true), Accepted::Changed(_)));
        assert_eq!(read(page).as_deref(), Some("{}"), "a page stays");
        let faults = [file(DIAGNOSTICS)];
        assert!(matches!(
            accepted
                .accept(&faults, &Tolerances::default(), true, false)
                .unwrap(),
            Accepted::Refused(_)
        ));
        std::fs::remove_dir_all(accepted.path()).unwrap();
        assert_eq!(
            accepted
                .accept(&faults, &Tolerances::default(), false, false)
                .unwrap(),
            Accepted::New
        );
    }
}
