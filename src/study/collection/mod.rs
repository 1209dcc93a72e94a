//! Adds runs to a study on the disk. In: the simulation of a study, its metadata, a folder. Out: the data set of the study or of a shard.
//! What is there already is kept: a study that was stopped goes on, a finished one may grow, a finished shard is not run again.
//!
//! Runs are written in pieces, each durable once it has its name: a process that is killed loses at most the runs of one minute. The
//! finished data set is made from the pieces, and its bytes do not depend on how many there were.

pub mod folder;
pub mod merge;
pub mod same;
pub mod status;
#[cfg(test)]
mod tests;

use std::ops::Range;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use rustix::fs::{FlockOperation, flock};
use thiserror::Error;

use crate::study::cluster::shard::Shard;
use crate::study::counts::Counts;
use crate::study::data_set::{DataSetFault, Metadata, Reader, StudyRow, Writer};
use crate::study::simulation::Simulation;
use crate::study::stopping::Looks;
use psd_plan::study::Runs;
use psd_rig::transport::Clock;

use folder::DataSetFiles;
use same::{Difference, grown, same};

/// Longest time whose runs a kill may cost \[s\].
const PIECE: f64 = 60.0;
/// A round of runs takes about this long \[s\]: after each one, a stop request is obeyed.
const ROUND: f64 = 0.25;
/// Runs of the first round.
const FIRST_ROUND: u64 = 64;
/// Most runs of a round.
const LARGEST_ROUND: u64 = 1 << 17;

/// What is added to which folder.
pub struct Collection<'a> {
    pub simulation: &'a Simulation<'a>,
    pub metadata: &'a Metadata,
    pub runs: Runs,
    pub folder: &'a Path,
    pub shard: Option<Shard>,
}

/// How far a collection is.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    pub counts: &'a Counts,
    /// Most runs of this data set.
    pub of: u64,
    /// Runs that this process simulated.
    pub simulated: u64,
}

/// How a collection ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ended {
    /// The data set is complete.
    Finished { path: PathBuf, simulated: u64 },
    /// Stopped on request; the same command goes on.
    Stopped { runs: u64, of: u64 },
}

/// Why no runs can be added.
#[derive(Debug, Error)]
pub enum CollectionFault {
    #[error(transparent)]
    DataSet(#[from] DataSetFault),
    #[error("{}: {difference}", path.display())]
    Other {
        path: PathBuf,
        difference: Difference,
    },
    #[error("{}: it contains runs {first} to {end}, which belong to another shard", path.display())]
    OtherRuns { path: PathBuf, first: u64, end: u64 },
    #[error("{}: another process adds runs to this study", path.display())]
    Locked { path: PathBuf },
    #[error(
        "a study with `until` or `sampling = subset` looks at all of its runs: it has no shards"
    )]
    UntilInShards,
    #[error("{}: shards of {found} are here, not of {wanted}", folder.display())]
    OtherShards {
        folder: PathBuf,
        found: u32,
        wanted: u32,
    },
}

impl Collection<'_> {
    /// Simulates the runs that are not there yet. `observe` is called after each round, and stops the collection with `false`.
    ///
    /// # Errors
    /// The folder contains another study, or cannot be written.
    pub fn run(
        &self,
        clock: &dyn Clock,
        observe: &mut dyn FnMut(&Progress<'_>) -> bool,
    ) -> Result<(Ended, Looks), CollectionFault> {
        let files = DataSetFiles::of(self.folder, self.shard);
        let at_most = self.runs.at_most();
        let range = match self.shard {
            None => 0..at_most,
            Some(_) if !matches!(self.runs, Runs::Fixed(_)) => {
                return Err(CollectionFault::UntilInShards);
            }
            Some(shard) => {
                self.only_shards_of(shard)?;
                shard.runs(at_most)
            }
        };
        std::fs::create_dir_all(self.folder)
            .map_err(|error| DataSetFault::new(self.folder, error.to_string()))?;
        let _lock = Lock::of(&files)?;
        let runs = match self.shard {
            None => self.runs,
            Some(_) => Runs::Fixed(range.end - range.start),
        };
        let mut looks = Looks::of(runs, self.metadata);
        let mut kept = self.kept(&files, range.start)?;
        for reader in &kept {
            for row in reader.rows() {
                looks.add(&row?);
            }
        }
        let mut simulated = 0;
        let of = range.end - range.start;
        let mut round = FIRST_ROUND;
        let mut goes_on = true;
        while goes_on && !looks.are_over() {
            let first = range.start + looks.counts.runs;
            let path = files.piece(first);
            let mut piece = Writer::create(
                &path,
                &Metadata {
                    first,
                    ..self.metadata.clone()
                },
            )?;
            let began = clock.now();
            while goes_on && !looks.are_over() && clock.now() - began < PIECE {
                let next = range.start + looks.counts.runs;
                let end = (next + round).min(range.start + looks.next());
                let before = clock.now();
                for row in self.rows(&looks, next..end) {
                    looks.add(&row);
                    piece.push(&row)?;
                }
                simulated += end - next;
                round = next_round(round, clock.now() - before);
                goes_on = observe(&Progress {
                    counts: &looks.counts,
                    of,
                    simulated,
                });
            }
            piece.finish()?;
            kept.push(Reader::open(&path)?);
        }
        let ended = if looks.are_over() {
            self.finish(&files, &kept, range.start)?;
            let path = files.path();
            Ended::Finished { path, simulated }
        } else {
            let runs = looks.counts.runs;
            Ended::Stopped { runs, of }
        };
        Ok((ended, looks))
    }

    /// The next runs: the numbers of those of a subset simulation follow from the runs before them.
    fn rows(&self, looks: &Looks, runs: Range<u64>) -> Vec<StudyRow> {
        let Some(rare) = looks.rare() else {
            return self.simulation.rows(runs);
        };
        let count = usize::try_from(runs.end - runs.start).expect("at most a round");
        self.simulation
            .rows_at(runs.start, &rare.pending()[..count])
    }

    /// The data sets of the runs from `first` on that are there, one behind the other.
    fn kept(&self, files: &DataSetFiles, first: u64) -> Result<Vec<Reader>, CollectionFault> {
        let mut kept = Vec::new();
        let mut next = first;
        let path = files.path();
        if path.exists() {
            let reader = self.open(&path)?;
            let Metadata { first, end, .. } = *reader.metadata();
            if first != next {
                return Err(CollectionFault::OtherRuns { path, first, end });
            }
            next = end;
            kept.push(reader);
        }
        for path in files.pieces()? {
            let reader = self.open(&path)?;
            if reader.metadata().first == next {
                next = reader.metadata().end;
                kept.push(reader);
            } else {
                // Left behind by a process that was killed before it could remove it, or after a gap: its runs are simulated again.
                remove(&path)?;
            }
        }
        Ok(kept)
    }

    fn open(&self, path: &Path) -> Result<Reader, CollectionFault> {
        let reader = Reader::open(path)?;
        // The shards of a larger study have other runs.
        let compare = if self.shard.is_some() { same } else { grown };
        compare(reader.metadata(), self.metadata).map_err(|difference| CollectionFault::Other {
            path: path.to_owned(),
            difference,
        })?;
        Ok(reader)
    }

    /// Shards of another number divide the study differently.
    fn only_shards_of(&self, shard: Shard) -> Result<(), CollectionFault> {
        let found = folder::shards(self.folder)?;
        match found.iter().find(|found| found.of != shard.of) {
            None => Ok(()),
            Some(other) => Err(CollectionFault::OtherShards {
                folder: self.folder.to_owned(),
                found: other.of,
                wanted: shard.of,
            }),
        }
    }

    /// Makes the data set of all that is kept, and removes the pieces.
    fn finish(
        &self,
        files: &DataSetFiles,
        kept: &[Reader],
        first: u64,
    ) -> Result<(), CollectionFault> {
        let path = files.path();
        let end = kept.last().map_or(first, |last| last.metadata().end);
        match kept {
            [only] if only.path() == path => {}
            [only] if only.metadata().at_most == self.metadata.at_most => {
                std::fs::rename(only.path(), &path)
                    .map_err(|error| DataSetFault::new(&path, error.to_string()))?;
                folder::sync(&path)?;
            }
            _ => {
                let metadata = Metadata {
                    first,
                    // A study of fewer runs than are there keeps them.
                    at_most: self.metadata.at_most.max(end),
                    ..self.metadata.clone()
                };
                joined(&path, &metadata, kept)?;
            }
        }
        for piece in files.pieces()? {
            remove(&piece)?;
        }
        Ok(())
    }
}

/// Writes the rows of data sets that lie one behind the other into one.
///
/// # Errors
/// A row cannot be read or written, or is not the next one.
fn joined(path: &Path, metadata: &Metadata, readers: &[Reader]) -> Result<Metadata, DataSetFault> {
    let mut writer = Writer::create(path, metadata)?;
    for reader in readers {
        for row in reader.rows() {
            writer.push(&row?)?;
        }
    }
    writer.finish()
}

fn remove(path: &Path) -> Result<(), DataSetFault> {
    std::fs::remove_file(path).map_err(|error| DataSetFault::new(path, error.to_string()))
}

/// The number of runs of the next round, from that of the last one and its time \[s\].
fn next_round(runs: u64, took: f64) -> u64 {
    if took < ROUND / 2.0 {
        (2 * runs).min(LARGEST_ROUND)
    } else if took > 2.0 * ROUND {
        (runs / 2).max(1)
    } else {
        runs
    }
}

/// Held as long as this process adds runs: two of them would write the same pieces.
struct Lock {
    path: PathBuf,
    _file: std::fs::File,
}

impl Lock {
    fn of(files: &DataSetFiles) -> Result<Self, CollectionFault> {
        let path = files.lock();
        let file = std::fs::OpenOptions::new()
            .create(true)
            .truncate(false)
            .write(true)
            .open(&path)
            .map_err(|error| DataSetFault::new(&path, error.to_string()))?;
        match flock(&file, FlockOperation::NonBlockingLockExclusive) {
            Err(rustix::io::Errno::WOULDBLOCK) => Err(CollectionFault::Locked { path }),
            // The process before may have removed the file between opening and locking it.
            Ok(()) if !is_at(&file, &path) => Err(CollectionFault::Locked { path }),
            // A file system without locks: two processes would only do the same work.
            Ok(()) | Err(_) => Ok(Self { path, _file: file }),
        }
    }
}

/// Whether this is still the file with this name.
fn is_at(file: &std::fs::File, path: &Path) -> bool {
    let device_and_inode = |metadata: std::fs::Metadata| (metadata.dev(), metadata.ino());
    let [own, found] =
        [file.metadata(), path.metadata()].map(|found| found.ok().map(device_and_inode));
    own == found
}

impl Drop for Lock {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path);
    }
}
