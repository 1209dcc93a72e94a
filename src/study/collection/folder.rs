//! The folder of a study: names of its files. In: a folder. Out: paths, and the files that are there. It reads no data set.
//!
//! `study.parquet` is the data set, `shard-003-of-008.parquet` a shard of it. While runs are added, `STEM.piece-000000001024.parquet`
//! contains those from run 1024 on, `STEM.lock` is held, and a file with the ending `.part` is being written.

use std::fs::File;
use std::path::{Path, PathBuf};

use crate::study::cluster::shard::Shard;
use crate::study::data_set::DataSetFault;

/// The name of a whole study.
pub const STUDY: &str = "study";
const EXTENSION: &str = "parquet";

/// The file of a study or of a shard, and its pieces.
#[derive(Clone, Debug)]
pub struct DataSetFiles {
    folder: PathBuf,
    stem: String,
}

impl DataSetFiles {
    /// The whole study, or a shard of it.
    #[must_use]
    pub fn of(folder: &Path, shard: Option<Shard>) -> Self {
        Self {
            folder: folder.to_owned(),
            stem: shard.map_or_else(|| STUDY.to_owned(), Shard::stem),
        }
    }

    /// The data set.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        self.folder.join(format!("{}.{EXTENSION}", self.stem))
    }

    /// The piece from this run on.
    #[must_use]
    pub fn piece(&self, first: u64) -> PathBuf {
        self.folder
            .join(format!("{}.piece-{first:012}.{EXTENSION}", self.stem))
    }

    /// The file that the process holds which adds runs.
    #[must_use]
    pub fn lock(&self) -> PathBuf {
        self.folder.join(format!("{}.lock", self.stem))
    }

    /// The pieces that are there, by their first run.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn pieces(&self) -> Result<Vec<PathBuf>, DataSetFault> {
        let prefix = format!("{}.piece-", self.stem);
        let mut pieces: Vec<(u64, PathBuf)> = names(&self.folder)?
            .into_iter()
            .filter_map(|name| {
                let number = name.strip_prefix(&prefix)?;
                let number = number.strip_suffix(&format!(".{EXTENSION}"))?;
                Some((number.parse().ok()?, self.folder.join(&name)))
            })
            .collect();
        pieces.sort();
        Ok(pieces.into_iter().map(|(_, path)| path).collect())
    }
}

/// The shards of which a file or a piece is there, each once, in order.
///
/// # Errors
/// The folder cannot be read.
pub fn shards(folder: &Path) -> Result<Vec<Shard>, DataSetFault> {
    let mut shards: Vec<Shard> = names(folder)?
        .iter()
        .filter_map(|name| Shard::of_stem(name.split('.').next()?))
        .collect();
    shards.sort_by_key(|shard| (shard.of, shard.number));
    shards.dedup();
    Ok(shards)
}

/// Names of files that are data sets; a folder that is not there has none.
fn names(folder: &Path) -> Result<Vec<String>, DataSetFault> {
    let failed = |error: std::io::Error| DataSetFault::new(folder, error.to_string());
    let entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(failed(error)),
    };
    let mut names = Vec::new();
    for entry in entries {
        let name = entry.map_err(failed)?.file_name();
        let name = name.to_string_lossy();
        if name.ends_with(&format!(".{EXTENSION}")) {
            names.push(name.into_owned());
        }
    }
    Ok(names)
}

/// Makes a renamed or removed file durable.
///
/// # Errors
/// The folder cannot be synced.
pub fn sync(path: &Path) -> Result<(), DataSetFault> {
    let folder = path.parent().filter(|path| !path.as_os_str().is_empty());
    let folder = folder.unwrap_or_else(|| Path::new("."));
    File::open(folder)
        .and_then(|folder| folder.sync_all())
        .map_err(|error| DataSetFault::new(folder, error.to_string()))
}
