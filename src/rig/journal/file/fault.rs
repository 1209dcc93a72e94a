//! The reason why the file of a run log cannot be used. In: a path and the error of the system. Out: a sentence for the
//! reader.

use std::io;
use std::path::{Path, PathBuf};

/// The file cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum FileFault {
    #[error("another psd uses the run log {}", path.display())]
    InUse { path: PathBuf },
    #[error("the run log {} is not a regular file", path.display())]
    NotAFile { path: PathBuf },
    #[error("the run log {} has more than {most} bytes", path.display())]
    TooLarge { path: PathBuf, most: u64 },
    #[error("the run log {} cannot be {doing}: {error}", path.display())]
    System {
        doing: &'static str,
        path: PathBuf,
        error: io::Error,
    },
}

impl FileFault {
    pub(super) fn cannot_be(doing: &'static str, path: &Path) -> impl Fn(io::Error) -> Self {
        move |error| Self::System {
            doing,
            path: path.to_owned(),
            error,
        }
    }
}
