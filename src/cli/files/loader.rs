//! Files of a plan. In: paths. Out: their text; the bytes of a PNG or JPEG picture as base64. A plan may `use` only files below its folder: relative paths of
//! regular files, no parent folder and no link to the outside, at most [`FILE_BYTES`] of UTF-8.

use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::files::failure::{Failure, plain};
use psd::check::LoadError;
use psd_language::syntax::limits::FILE_BYTES;
use psd_plan::{PICTURE_BYTES, PictureKind};
use psd_text::markdown::Document;
use psd_text::source::Position;

/// The path that stands for standard input.
const STDIN: &str = "-";
/// The name of a plan from standard input, in messages, in its run log and in the name of its run folder.
pub const STDIN_PLAN: &str = "stdin.psd";

/// Whether a path stands for standard input.
pub fn is_stdin(path: &Path) -> bool {
    path == Path::new(STDIN)
}

/// Loads files of one folder and of the folders below it.
#[derive(Debug)]
pub struct FolderLoader {
    /// The folder with links resolved, for comparison with the resolved path of a file.
    folder: PathBuf,
}

impl FolderLoader {
    /// A loader for the folder of `plan`, which exists; for a plan from standard input the working folder.
    pub fn beside(plan: &Path) -> Result<Self, Failure> {
        if is_stdin(plan) {
            let here = Path::new(".");
            let folder = here
                .canonicalize()
                .map_err(|error| Failure::file(here, plain(&error)))?;
            return Ok(Self { folder });
        }
        let plan = plan
            .canonicalize()
            .map_err(|error| Failure::file(plan, plain(&error)))?;
        Ok(Self {
            folder: plan.parent().unwrap_or(&plan).to_owned(),
        })
    }

    /// The text of a file.
    pub fn load(&self, path: &str) -> Result<String, LoadError> {
        let relative = Path::new(path);
        let inside = relative
            .components()
            .all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        if !inside || path.is_empty() || path.contains(['\\', '\0']) {
            return Err(LoadError::Refused(
                "the path must lead down from the plan's folder".to_owned(),
            ));
        }
        let file =
            self.folder
                .join(relative)
                .canonicalize()
                .map_err(|error| match error.kind() {
                    std::io::ErrorKind::NotFound => LoadError::NotFound,
                    _ => LoadError::Refused(plain(&error)),
                })?;
        if !file.starts_with(&self.folder) {
            return Err(LoadError::Refused(
                "it is a link that leads out of the plan's folder".to_owned(),
            ));
        }
        if PictureKind::of(path).is_some_and(PictureKind::is_binary) {
            return bytes(&file, PICTURE_BYTES)
                .map(|bytes| STANDARD.encode(bytes))
                .map_err(LoadError::Refused);
        }
        read(&file).map_err(|fault| LoadError::Refused(fault.reason))
    }
}

/// Whether a Markdown document has a block of a plan.
pub fn has_plan(document: &Path) -> bool {
    read(document).is_ok_and(|text| !Document::read(&text).blocks.is_empty())
}

/// The text of the plan. It may be a link, because the operator named it.
pub fn read_plan(path: &Path) -> Result<String, Failure> {
    let not_a_plan = |Unread { reason, at }| Failure::NotAPlan {
        path: path.to_owned(),
        reason,
        at,
    };
    if is_stdin(path) {
        return limited(std::io::stdin().lock(), FILE_BYTES)
            .map_err(Unread::from)
            .and_then(utf8)
            .map_err(not_a_plan);
    }
    let metadata = path.metadata().map_err(|error| {
        let failure = Failure::file(path, plain(&error));
        let with_ending = path.with_added_extension("psd");
        if with_ending.is_file() {
            failure.help(format!("did you mean `{}`?", with_ending.display()))
        } else {
            failure
        }
    })?;
    if metadata.is_dir() {
        return Err(
            Failure::file(path, "is a folder").help("name the plan itself, a `.psd` or `.md` file")
        );
    }
    read(path).map_err(not_a_plan)
}

/// The reason why a file is not a text, and the position of the invalid byte if there is one.
struct Unread {
    reason: String,
    at: Option<Position>,
}

impl From<String> for Unread {
    fn from(reason: String) -> Self {
        Self { reason, at: None }
    }
}

/// The bytes of a regular file of up to `most` bytes.
fn bytes(path: &Path, most: usize) -> Result<Vec<u8>, String> {
    // Checked before opening: opening a pipe or a device may block.
    if !path.metadata().map_err(|error| plain(&error))?.is_file() {
        return Err("it is not a regular file".to_owned());
    }
    limited(File::open(path).map_err(|error| plain(&error))?, most)
}

/// What can be read, up to `most` bytes.
fn limited(from: impl Read, most: usize) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    from.take(most as u64 + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| plain(&error))?;
    if bytes.len() > most {
        return Err(format!("it is larger than {} MiB", most >> 20));
    }
    Ok(bytes)
}

fn read(path: &Path) -> Result<String, Unread> {
    utf8(bytes(path, FILE_BYTES)?)
}

fn utf8(bytes: Vec<u8>) -> Result<String, Unread> {
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let (line, column) = line_and_column(&error.as_bytes()[..at]);
        let reason = format!(
            "it is not UTF-8 text (byte {at}, line {line}, column {column}): save it as UTF-8"
        );
        Unread {
            reason,
            at: Some(Position { line, column }),
        }
    })
}

/// Line and column, from 1, of the byte after `before`.
fn line_and_column(before: &[u8]) -> (usize, usize) {
    let line = before
        .rsplit(|byte| *byte == b'\n')
        .next()
        .unwrap_or_default();
    (
        before.split(|byte| *byte == b'\n').count(),
        String::from_utf8_lossy(line).chars().count() + 1,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(loader: &FolderLoader, path: &str) -> String {
        match loader.load(path) {
            Err(LoadError::Refused(reason)) => reason,
            other => panic!("{path}: {other:?}"),
        }
    }

    #[test]
    fn only_regular_files_under_the_plans_folder_are_given() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("plans");
        std::fs::create_dir_all(folder.join("lib")).unwrap();
        for (name, bytes) in [
            ("plans/a.psd", "let a = 1".as_bytes()),
            ("plans/lib/b.psd", b"let b = 2"),
            ("secret.psd", b"x"),
            ("plans/bytes.psd", b"a\xffb"),
        ] {
            std::fs::write(root.path().join(name), bytes).unwrap();
        }
        std::fs::write(folder.join("large.psd"), vec![b' '; FILE_BYTES + 1]).unwrap();
        std::os::unix::fs::symlink("../secret.psd", folder.join("out.psd")).unwrap();
        std::os::unix::fs::symlink("lib/b.psd", folder.join("in.psd")).unwrap();
        let loader = FolderLoader::beside(&folder.join("a.psd")).unwrap();

        assert_eq!(loader.load("lib/b.psd").as_deref(), Ok("let b = 2"));
        assert_eq!(loader.load("./in.psd").as_deref(), Ok("let b = 2"));
        assert_eq!(loader.load("lib/none.psd"), Err(LoadError::NotFound));
        assert!(refused(&loader, "../secret.psd").contains("plan's folder"));
        assert!(refused(&loader, folder.join("a.psd").to_str().unwrap()).contains("plan's folder"));
        assert!(refused(&loader, "out.psd").contains("leads out"));
        assert!(refused(&loader, "lib").contains("regular"));
        assert!(
            refused(&loader, "bytes.psd").contains("(byte 1, line 1, column 2): save it as UTF-8")
        );
        assert_eq!(line_and_column("a\né".as_bytes()), (2, 2));
        assert!(refused(&loader, "large.psd").contains("1 MiB"));
    }
}
