//! Reads a data set, a row group at a time. In: a file. Out: its metadata, and its rows in the order of their runs. A file that is cut,
//! changed or of another program is an error with its position; no byte is decoded before its digest is verified.

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

use sha2::{Digest as _, Sha256};

use super::block::{Block, StudyRow};
use super::fault::DataSetFault;
use super::footer::{self, Footer};
use super::frame;
use super::group::Group;
use super::metadata::{FORMAT, Metadata};
use super::writer::{KEY_FORMAT, KEY_GROUPS, KEY_STUDY};
use crate::report::parquet::{FileMetadata, read_metadata, row_group};
use psd_text::digest::hex;

/// A data set on the disk.
#[derive(Debug)]
pub struct Reader {
    path: PathBuf,
    metadata: Metadata,
    groups: Vec<Group>,
    footer: FileMetadata,
}

impl Reader {
    /// Reads and checks the footer.
    ///
    /// # Errors
    /// The file cannot be read, is no data set of a study, or is incomplete.
    pub fn open(path: &Path) -> Result<Self, DataSetFault> {
        let mut file = File::open(path).map_err(DataSetFault::of(path))?;
        let foreign =
            || DataSetFault::new(path, "is a Parquet file, but not a data set of a study");
        match footer::verify(&mut file).map_err(DataSetFault::of(path))? {
            Footer::Intact => {}
            Footer::Foreign => return Err(foreign()),
            Footer::Incomplete => {
                let reason = "is incomplete, or not a Parquet file";
                return Err(DataSetFault::new(path, reason));
            }
            Footer::Damaged => {
                let reason = "has a damaged footer: its SHA-256 is not the one before it";
                return Err(DataSetFault::new(path, reason));
            }
        }
        let footer = read_metadata(&mut file).map_err(DataSetFault::of(path))?;
        let format = footer_text(&footer, KEY_FORMAT).ok_or_else(foreign)?;
        if format != FORMAT.to_string() {
            let reason = format!("is a data set of format {format}, this program reads {FORMAT}");
            return Err(DataSetFault::new(path, reason));
        }
        let study = footer_text(&footer, KEY_STUDY).ok_or_else(foreign)?;
        let groups = footer_text(&footer, KEY_GROUPS).ok_or_else(foreign)?;
        let damaged = |error| DataSetFault::new(path, format!("has a damaged footer: {error}"));
        let metadata: Metadata = serde_json::from_str(study).map_err(damaged)?;
        let groups: Vec<Group> = serde_json::from_str(groups).map_err(damaged)?;
        if let Some(reason) = contradiction(&footer, &metadata, &groups) {
            return Err(DataSetFault::new(
                path,
                format!("has a damaged footer: {reason}"),
            ));
        }
        Ok(Self {
            path: path.to_owned(),
            metadata,
            groups,
            footer,
        })
    }

    #[must_use]
    pub const fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// All rows; after an error, no more follow.
    pub fn rows(&self) -> impl Iterator<Item = Result<StudyRow, DataSetFault>> + '_ {
        self.blocks().flat_map(|block| {
            let (rows, fault) = match block {
                Ok(block) => (block.rows().map(Ok).collect(), None),
                Err(fault) => (Vec::new(), Some(Err(fault))),
            };
            rows.into_iter().chain(fault)
        })
    }

    /// All rows, one block for each row group; after an error, no more follow.
    pub fn blocks(&self) -> impl Iterator<Item = Result<Block, DataSetFault>> + '_ {
        let mut first = self.metadata.first;
        let mut from = 0;
        let mut failed = false;
        self.groups
            .iter()
            .enumerate()
            .map_while(move |(at, group)| {
                if failed {
                    return None;
                }
                let block = self.block(at, first, from);
                first += group.rows;
                from += group.bytes;
                failed = block.is_err();
                Some(block)
            })
    }

    /// One row group: `first` is the number of its first run, `from` the position of its first byte.
    fn block(&self, at: usize, first: u64, from: u64) -> Result<Block, DataSetFault> {
        let group = &self.groups[at];
        let last = first + group.rows.saturating_sub(1);
        let fault = |reason: String| {
            DataSetFault::new(&self.path, format!("runs {first} to {last}: {reason}"))
        };
        let mut file = File::open(&self.path).map_err(DataSetFault::of(&self.path))?;
        let bytes = read(&mut file, from, group.bytes).map_err(|error| fault(error.to_string()))?;
        let found = hex(&Sha256::digest(&bytes));
        if found != group.sha256 {
            return Err(fault(format!(
                "damaged: SHA-256 of bytes {from} to {} is {found}, the footer states {}",
                from + group.bytes,
                group.sha256
            )));
        }
        let frame = row_group(&bytes, from, &self.footer, at);
        let frame = frame.map_err(|error| fault(error.to_string()))?;
        frame::block(&frame, first, &self.metadata).map_err(fault)
    }
}

/// A text of the footer.
fn footer_text<'a>(footer: &'a FileMetadata, key: &str) -> Option<&'a str> {
    let texts = footer.key_value_metadata().as_ref()?;
    let found = texts.iter().find(|text| text.key == key)?;
    found.value.as_deref()
}

/// What in the footer contradicts itself: its row groups must be those that the metadata name, and lie one behind the other.
fn contradiction(footer: &FileMetadata, metadata: &Metadata, groups: &[Group]) -> Option<String> {
    let rows: u64 = groups.iter().map(|group| group.rows).sum();
    if metadata.end.checked_sub(metadata.first) != Some(rows) {
        let Metadata { first, end, .. } = metadata;
        return Some(format!("runs {first} to {end} are {rows} rows"));
    }
    if footer.row_groups.len() != groups.len() {
        let [found, named] = [footer.row_groups.len(), groups.len()];
        return Some(format!("{found} row groups, of which it names {named}"));
    }
    let mut from = 0;
    for (at, (found, named)) in footer.row_groups.iter().zip(groups).enumerate() {
        let end = from + named.bytes;
        let inside = |range: std::ops::Range<u64>| from <= range.start && range.end <= end;
        let wrong = found.num_rows() as u64 != named.rows || !found.byte_ranges_iter().all(inside);
        if wrong {
            return Some(format!("row group {at} is not where it should be"));
        }
        from = end;
    }
    None
}

/// So many bytes from a position on.
fn read(file: &mut File, from: u64, bytes: u64) -> std::io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(from))?;
    let mut read = Vec::new();
    file.take(bytes).read_to_end(&mut read)?;
    Ok(read)
}
