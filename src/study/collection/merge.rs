//! Shards of a study put together. In: a folder. Out: `study.parquet` with the bytes that one process would have written. Rows stream
//! through; memory does not grow with their number.

use std::path::{Path, PathBuf};

use thiserror::Error;

use super::folder::{self, DataSetFiles};
use super::joined;
use super::same::{Difference, same};
use crate::study::cluster::shard::Shard;
use crate::study::cluster::slurm;
use crate::study::data_set::{DataSetFault, Metadata, Reader};

/// Why shards cannot be put together.
#[derive(Debug, Error)]
pub enum MergeFault {
    #[error(transparent)]
    DataSet(#[from] DataSetFault),
    #[error("{}: no shards are here", folder.display())]
    NoShards { folder: PathBuf },
    #[error("{}: shards of {} and of {} are here", folder.display(), of[0], of[1])]
    SeveralDivisions { folder: PathBuf, of: [u32; 2] },
    #[error("{} of {of} shards are missing: {}", missing.len(), listed(missing))]
    Missing {
        folder: PathBuf,
        missing: Vec<u32>,
        of: u32,
    },
    #[error("{}: {difference}", path.display())]
    Other {
        path: PathBuf,
        difference: Difference,
    },
    #[error("{}: it contains runs {} to {}, shard {} has {} to {}", path.display(), found[0], found[1], shard.number, wanted[0], wanted[1])]
    OtherRuns {
        path: PathBuf,
        shard: Shard,
        found: [u64; 2],
        wanted: [u64; 2],
    },
}

impl MergeFault {
    /// What corrects it.
    #[must_use]
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Missing {
                folder, missing, ..
            } => Some(format!(
                "submit them again: {}",
                resubmission(folder, missing)
            )),
            Self::NoShards { .. } => {
                Some("name the folder in which `psd study run --shard` has written them".to_owned())
            }
            Self::SeveralDivisions { .. } => {
                Some("remove the shards that do not belong to the study".to_owned())
            }
            Self::Other { path, .. } | Self::OtherRuns { path, .. } => {
                Some(format!("remove {} and run its shard again", path.display()))
            }
            Self::DataSet(_) => None,
        }
    }
}

/// Numbers as `--array` takes them: `3,17,20-22`.
#[must_use]
pub fn listed(numbers: &[u32]) -> String {
    let mut ranges: Vec<[u32; 2]> = Vec::new();
    for number in numbers {
        match ranges.last_mut() {
            Some([_, last]) if *last + 1 == *number => *last = *number,
            _ => ranges.push([*number, *number]),
        }
    }
    let texts = ranges.iter().map(|[first, last]| {
        if first == last {
            first.to_string()
        } else {
            format!("{first}-{last}")
        }
    });
    texts.collect::<Vec<_>>().join(",")
}

/// What submits shards again, and the job that merges after them: the command, if the folder has the scripts of its jobs; the option of
/// the batch system if not.
#[must_use]
pub fn resubmission(folder: &Path, numbers: &[u32]) -> String {
    let option = format!("--array={}", listed(numbers));
    let script = |name: &str| {
        let path = Some(folder.join(name)).filter(|path| path.exists())?;
        Some(slurm::quoted(&path.display().to_string()))
    };
    match script(slurm::ARRAY_SCRIPT).zip(script(slurm::MERGE_SCRIPT)) {
        Some((array, merge)) => {
            format!("sbatch --dependency=afterany:$(sbatch --parsable {option} {array}) {merge}")
        }
        None => option,
    }
}

/// Puts the shards of a folder together. Returns the path of the study and its metadata.
///
/// # Errors
/// A shard is missing, damaged or of another study.
pub fn merge(folder: &Path) -> Result<(PathBuf, Metadata), MergeFault> {
    let shards = folder::shards(folder)?;
    let of = match (shards.first(), shards.last()) {
        (Some(first), Some(last)) if first.of == last.of => first.of,
        (Some(first), Some(last)) => {
            return Err(MergeFault::SeveralDivisions {
                folder: folder.to_owned(),
                of: [first.of, last.of],
            });
        }
        _ => {
            return Err(MergeFault::NoShards {
                folder: folder.to_owned(),
            });
        }
    };
    let path = |number| DataSetFiles::of(folder, Some(Shard { number, of })).path();
    let missing: Vec<u32> = (1..=of).filter(|number| !path(*number).exists()).collect();
    if !missing.is_empty() {
        let folder = folder.to_owned();
        return Err(MergeFault::Missing {
            folder,
            missing,
            of,
        });
    }
    let readers = (1..=of)
        .map(|number| Reader::open(&path(number)))
        .collect::<Result<Vec<_>, _>>()?;
    let metadata = readers[0].metadata().clone();
    for (number, reader) in (1..).zip(&readers) {
        let path = reader.path().to_owned();
        same(reader.metadata(), &metadata).map_err(|difference| MergeFault::Other {
            path: path.clone(),
            difference,
        })?;
        let shard = Shard { number, of };
        let wanted = shard.runs(metadata.at_most);
        let found = [reader.metadata().first, reader.metadata().end];
        if found != [wanted.start, wanted.end] {
            return Err(MergeFault::OtherRuns {
                path,
                shard,
                found,
                wanted: [wanted.start, wanted.end],
            });
        }
    }
    let study = DataSetFiles::of(folder, None).path();
    let merged = joined(&study, &metadata, &readers)?;
    Ok((study, merged))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_shards_are_listed_as_an_array() {
        assert_eq!(listed(&[3, 17]), "3,17");
        assert_eq!(listed(&[1, 2, 3, 5, 8, 9]), "1-3,5,8-9");
        assert_eq!(listed(&[]), "");
    }
}
