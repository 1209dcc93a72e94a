//! How far the study of a folder is. In: a folder. Out: the runs that are there, of the whole study or of each shard. It reads footers
//! alone.

use std::path::Path;

use super::folder::{self, DataSetFiles};
use crate::study::cluster::shard::Shard;
use crate::study::data_set::{DataSetFault, Metadata, Reader};

/// The state of a study or of a shard.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyPart {
    /// None: the whole study.
    pub shard: Option<Shard>,
    /// Runs that are durable.
    pub runs: u64,
    pub of: u64,
    /// Its data set is finished.
    pub finished: bool,
}

/// The study of a folder.
#[derive(Clone, Debug, PartialEq)]
pub struct Status {
    /// Of some data set in the folder; None without one.
    pub metadata: Option<Metadata>,
    /// The whole study if a part of it is there, then every shard.
    pub parts: Vec<StudyPart>,
}

impl Status {
    /// Numbers of the shards that are not finished.
    #[must_use]
    pub fn unfinished(&self) -> Vec<u32> {
        let unfinished = self.parts.iter().filter(|part| !part.finished);
        unfinished
            .filter_map(|part| part.shard.map(|shard| shard.number))
            .collect()
    }
}

/// Reads the state of a folder.
///
/// # Errors
/// A data set is damaged.
pub fn status(folder: &Path) -> Result<Status, DataSetFault> {
    let mut metadata = None;
    let mut parts = Vec::new();
    let whole = part(folder, None, &mut metadata)?;
    let found = folder::shards(folder)?;
    let divisions: Vec<u32> = found.iter().map(|shard| shard.of).collect();
    if whole.finished || whole.runs > 0 {
        parts.push(whole);
    }
    let mut last = None;
    for of in divisions {
        if last.replace(of) == Some(of) {
            continue;
        }
        for number in 1..=of {
            parts.push(part(folder, Some(Shard { number, of }), &mut metadata)?);
        }
    }
    let at_most = metadata.as_ref().map_or(0, |known| known.at_most);
    for part in &mut parts {
        part.of = part.shard.map_or(at_most, |shard| {
            let runs = shard.runs(at_most);
            runs.end - runs.start
        });
    }
    Ok(Status { metadata, parts })
}

fn part(
    folder: &Path,
    shard: Option<Shard>,
    metadata: &mut Option<Metadata>,
) -> Result<StudyPart, DataSetFault> {
    let files = DataSetFiles::of(folder, shard);
    let mut runs = 0;
    let mut read = |path: &Path| -> Result<(), DataSetFault> {
        let reader = Reader::open(path)?;
        runs += reader.metadata().runs();
        if metadata.is_none() {
            *metadata = Some(reader.metadata().clone());
        }
        Ok(())
    };
    let path = files.path();
    let finished = path.exists();
    if finished {
        read(&path)?;
    } else {
        for piece in files.pieces()? {
            read(&piece)?;
        }
    }
    Ok(StudyPart {
        shard,
        runs,
        of: 0,
        finished,
    })
}
