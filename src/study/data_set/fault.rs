//! Why a data set cannot be written or read. In: a file and what is wrong with it. Out: the message, which names both.

use std::path::{Path, PathBuf};

/// The data set cannot be written or read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: {reason}", path.display())]
pub struct DataSetFault {
    pub path: PathBuf,
    /// What is wrong, and in which rows.
    pub reason: String,
}

impl DataSetFault {
    pub fn new(path: &Path, reason: impl Into<String>) -> Self {
        Self {
            path: path.to_owned(),
            reason: reason.into(),
        }
    }

    /// Turns any other error into one of this file.
    pub(super) fn of<E: std::fmt::Display>(path: &Path) -> impl Fn(E) -> Self + '_ {
        move |error| Self::new(path, error.to_string())
    }
}
