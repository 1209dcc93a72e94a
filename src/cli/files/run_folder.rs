//! The run folder: new or empty, each file created once. In: the path that the operator gives, and the files. Out: the folder on
//! disk. It overwrites only incomplete results that are made again, and deletes only files that it has just written.

use std::fs::{File, OpenOptions};
use std::io::{BufWriter, ErrorKind, IntoInnerError, Write};
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::{Component, Path, PathBuf};

use crate::files::failure::Failure;
use crate::files::failure::plain;
use crate::files::plan_file::name_of;
use psd::report::{OutputError, OutputFile, OutputSink};
use psd_text::sanitize;

/// An empty folder for one run.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
}

impl RunFolder {
    /// The folder named by `--out`, or `runs/PLAN-N` with the next free number.
    pub fn create(out: Option<&Path>, plan: &Path) -> Result<Self, Failure> {
        match out {
            Some(path) => Self::named(path),
            None => Self::numbered(
                Path::new("runs"),
                &sanitize::file_part(
                    &Path::new(&name_of(plan))
                        .file_stem()
                        .unwrap_or_default()
                        .to_string_lossy(),
                ),
            ),
        }
    }

    fn named(path: &Path) -> Result<Self, Failure> {
        let failed = |error: std::io::Error| Failure::file(path, plain(&error));
        // A link may lead outside the folder, or to no folder.
        if path.is_symlink() {
            return Err(Failure::file(path, "is a link").help("name the run folder itself"));
        }
        match std::fs::read_dir(path) {
            Ok(mut entries) => {
                if entries.next().is_some() {
                    return Err(Failure::file(path, "the run folder must be new or empty")
                        .help("name another with `--out`"));
                }
            }
            Err(error) if error.kind() == ErrorKind::NotFound => {
                std::fs::create_dir_all(path).map_err(failed)?;
            }
            Err(error) => return Err(failed(error)),
        }
        Ok(Self {
            path: path.to_owned(),
        })
    }

    fn numbered(runs: &Path, plan: &str) -> Result<Self, Failure> {
        let failed = |path: &Path, error: &std::io::Error| Failure::file(path, plain(error));
        std::fs::create_dir_all(runs).map_err(|error| failed(runs, &error))?;
        let used = std::fs::read_dir(runs)
            .map_err(|error| failed(runs, &error))?
            .filter_map(|entry| {
                let name = entry.ok()?.file_name().into_string().ok()?;
                name.strip_prefix(plan)?
                    .strip_prefix('-')?
                    .parse::<u32>()
                    .ok()
            });
        let mut number = used.max().unwrap_or(0);
        loop {
            number = number
                .checked_add(1)
                .ok_or_else(|| Failure::file(runs, "no run number is free"))?;
            let path = runs.join(format!("{plan}-{number}"));
            // Creating the folder reserves the number, also against a run that starts at the same time.
            match std::fs::create_dir(&path) {
                Ok(()) => return Ok(Self { path }),
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(failed(&path, &error)),
            }
        }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// Copies one file of a run, by its name in the folder. The copy is new and durable, as every file of a run folder.
pub fn copy(run: &Path, folder: &Path, name: &str) -> Result<(), Failure> {
    let from = run.join(name);
    let mut read = File::open(&from).map_err(|error| Failure::file(&from, plain(&error)))?;
    let to = inside(folder, name)?;
    written(&to, &mut |out| std::io::copy(&mut read, out).map(drop))
        .map_err(|error| unwritten(&to, &error))
}

/// Creates one file under `folder`, in which it must not exist.
pub fn write_new(folder: &Path, file: &OutputFile) -> Result<(), Failure> {
    let path = inside(folder, &file.path)?;
    written(&path, &mut |out| out.write_all(&file.bytes)).map_err(|error| unwritten(&path, &error))
}

/// The error of a file that was not written; with advice if one exists already.
fn unwritten(path: &Path, error: &std::io::Error) -> Failure {
    match error.kind() {
        ErrorKind::AlreadyExists => Failure::file(path, "exists already, written by another program")
            .help("a run log beside it is complete: create its results in a new folder with `psd report RUN --out FOLDER`"),
        _ => Failure::file(path, plain(error)),
    }
}

/// The path of a file in the folder.
fn inside(folder: &Path, relative: &str) -> Result<PathBuf, Failure> {
    let path = folder.join(relative);
    if Path::new(relative)
        .components()
        .all(|part| matches!(part, Component::Normal(_)))
    {
        return Ok(path);
    }
    Err(Failure::file(path, "would be written outside its folder"))
}

fn written(
    path: &Path,
    write: &mut dyn FnMut(&mut dyn Write) -> std::io::Result<()>,
) -> std::io::Result<()> {
    if let Some(parent) = path.parent() {
        std::fs::create_dir_all(parent)?;
    }
    let created = OpenOptions::new()
        .write(true)
        .create_new(true)
        .mode(MODE)
        .open(path)?;
    let mut created = BufWriter::with_capacity(WRITE_BYTES, created);
    write(&mut created)?;
    created
        .into_inner()
        .map_err(IntoInnerError::into_error)?
        .sync_all()
}

/// Results are readable by their owner only, as the run log is.
const MODE: u32 = 0o600;

/// Bytes that are written to the disk together.
const WRITE_BYTES: usize = 64 * 1024;

/// A sink that writes into a folder.
pub struct FolderSink<'a> {
    folder: &'a Path,
    /// Whether existing files are replaced: they are a part of incomplete results.
    replaces: bool,
    created: Vec<PathBuf>,
    failure: Option<Failure>,
}

impl<'a> FolderSink<'a> {
    pub const fn new(folder: &'a Path) -> Self {
        Self {
            folder,
            replaces: false,
            created: Vec::new(),
            failure: None,
        }
    }

    /// For a folder with incomplete results, which are made again.
    pub const fn replacing(folder: &'a Path) -> Self {
        Self {
            folder,
            replaces: true,
            created: Vec::new(),
            failure: None,
        }
    }

    pub const fn folder(&self) -> &'a Path {
        self.folder
    }

    /// The error of an incomplete run folder. If a file could not be made, the files before it are deleted: the results can be made
    /// again.
    pub fn failed(self, error: OutputError) -> Failure {
        self.failure.unwrap_or_else(|| {
            for path in &self.created {
                let _ = std::fs::remove_file(path);
            }
            error.into()
        })
    }
}

impl OutputSink for FolderSink<'_> {
    fn put(
        &mut self,
        path: &str,
        write: &mut dyn FnMut(&mut dyn Write) -> std::io::Result<()>,
    ) -> std::io::Result<()> {
        let target = match inside(self.folder, path) {
            Ok(target) => target,
            Err(failure) => {
                self.failure = Some(failure);
                return Err(ErrorKind::InvalidInput.into());
            }
        };
        // A link is removed, not the file that it leads to.
        if self.replaces && target.is_symlink() | target.is_file() {
            std::fs::remove_file(&target)
                .inspect_err(|error| self.failure = Some(unwritten(&target, error)))?;
        }
        written(&target, write)
            .inspect_err(|error| self.failure = Some(unwritten(&target, error)))?;
        self.created.push(target);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(path: &str) -> OutputFile {
        OutputFile {
            path: path.to_owned(),
            bytes: b"x".to_vec(),
        }
    }

    #[test]
    fn numbers_go_up_and_no_file_is_written_twice() {
        let root = tempfile::tempdir().unwrap();
        let first = RunFolder::numbered(root.path(), "beam").unwrap();
        std::fs::create_dir(root.path().join("beam-7")).unwrap();
        std::fs::create_dir(root.path().join("beam-of-9")).unwrap();
        let next = RunFolder::numbered(root.path(), "beam").unwrap();
        assert!(first.path().ends_with("beam-1") && next.path().ends_with("beam-8"));
        write_new(next.path(), &file("a/b.csv")).unwrap();
        assert!(write_new(next.path(), &file("a/b.csv")).is_err());
        assert!(write_new(next.path(), &file("../b.csv")).is_err());
    }

    #[test]
    fn a_folder_in_use_is_refused() {
        let root = tempfile::tempdir().unwrap();
        assert!(RunFolder::named(&root.path().join("new/deep")).is_ok());
        assert!(
            RunFolder::named(&root.path().join("new/deep")).is_ok(),
            "empty"
        );
        assert!(RunFolder::named(root.path()).is_err());
        std::fs::write(root.path().join("file"), "").unwrap();
        assert!(RunFolder::named(&root.path().join("file")).is_err());
        for target in ["empty", "nowhere"] {
            std::fs::create_dir_all(root.path().join("empty")).unwrap();
            let link = root.path().join(format!("to-{target}"));
            std::os::unix::fs::symlink(root.path().join(target), &link).unwrap();
            assert!(
                RunFolder::named(&link)
                    .unwrap_err()
                    .to_string()
                    .contains("is a link")
            );
        }
    }

    #[test]
    fn incomplete_results_are_deleted_and_an_error_names_its_file() {
        let root = tempfile::tempdir().unwrap();
        let mut sink = FolderSink::new(root.path());
        sink.put("tables/a.csv", &mut |out| out.write_all(b"x"))
            .unwrap();
        let failure = sink.failed(OutputError::Pdf("no such font".to_owned()));
        assert!(
            failure.to_string().contains("no such font")
                && !root.path().join("tables/a.csv").exists()
        );

        let mut sink = FolderSink::new(root.path());
        sink.put("tables/a.csv", &mut |out| out.write_all(b"x"))
            .unwrap();
        let error = sink
            .put("tables/a.csv", &mut |out| out.write_all(b"y"))
            .unwrap_err()
            .to_string();
        let failure = sink.failed(OutputError::Pdf(error)).to_string();
        assert!(
            failure.contains("tables/a.csv")
                && std::fs::read(root.path().join("tables/a.csv")).unwrap() == b"x",
            "{failure}"
        );
        let mut sink = FolderSink::new(root.path());
        assert!(sink.put("../a.csv", &mut |_| Ok(())).is_err());

        std::os::unix::fs::symlink(root.path().join("tables/a.csv"), root.path().join("link"))
            .unwrap();
        let mut sink = FolderSink::replacing(root.path());
        sink.put("link", &mut |out| out.write_all(b"z")).unwrap();
        assert_eq!(
            std::fs::read(root.path().join("tables/a.csv")).unwrap(),
            b"x",
            "what a link leads to stays"
        );
        sink.put("tables/a.csv", &mut |out| out.write_all(b"z"))
            .unwrap();
        assert_eq!(
            std::fs::read(root.path().join("tables/a.csv")).unwrap(),
            b"z"
        );
        let mode = std::os::unix::fs::PermissionsExt::mode(
            &root
                .path()
                .join("tables/a.csv")
                .metadata()
                .unwrap()
                .permissions(),
        );
        assert_eq!(mode & 0o777, 0o600, "for their owner alone, as the record");
    }
}
