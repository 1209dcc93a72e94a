//! Writes a data set row group by row group. In: metadata and rows in the order of their runs. Out: `PATH.part`, which becomes `PATH` once
//! all of it is on the disk. A file that ends early keeps the name of a part, and never has a footer.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use crate::report::parquet::{Encoding, ParquetFile};

use super::block::{Block, StudyRow};
use super::fault::DataSetFault;
use super::group::{Group, Metered, SharedMeter};
use super::metadata::{FORMAT, Metadata};
use super::{GROUP_RUNS, footer, frame};

/// Keys of the footer.
pub(super) const KEY_FORMAT: &str = "psd.format";
pub(super) const KEY_STUDY: &str = "psd.study";
pub(super) const KEY_GROUPS: &str = "psd.row_groups";

/// A data set that is being written.
pub struct Writer {
    path: PathBuf,
    part: PathBuf,
    metadata: Metadata,
    file: File,
    out: ParquetFile<Metered<BufWriter<File>>>,
    meter: SharedMeter,
    /// Rows of the row group that is not written yet.
    block: Block,
    groups: Vec<Group>,
}

impl Writer {
    /// A data set of runs from `metadata.first` on; `metadata.end` follows from the rows. An older part of the same name is replaced.
    ///
    /// # Errors
    /// The file cannot be created, or two columns have one name.
    pub fn create(path: &Path, metadata: &Metadata) -> Result<Self, DataSetFault> {
        let mut part = path.as_os_str().to_owned();
        part.push(".part");
        let part = PathBuf::from(part);
        let file = File::create(&part).map_err(DataSetFault::of(&part))?;
        let block = Block::like(
            metadata.first,
            metadata.inputs.len(),
            metadata.results.len(),
            metadata.requirements.len(),
        );
        let empty = frame::frame(&block, metadata).map_err(DataSetFault::of(path))?;
        let meter = SharedMeter::default();
        let metered = Metered {
            out: BufWriter::new(file.try_clone().map_err(DataSetFault::of(&part))?),
            meter: meter.clone(),
        };
        let out = ParquetFile::new(metered, &empty, encodings(metadata))
            .map_err(DataSetFault::of(path))?;
        Ok(Self {
            path: path.to_owned(),
            part,
            metadata: metadata.clone(),
            file,
            out,
            meter,
            block,
            groups: Vec::new(),
        })
    }

    /// Adds the next run.
    ///
    /// # Errors
    /// It is not the next run, has other columns or a number that is not finite; or the disk is full.
    pub fn push(&mut self, row: &StudyRow) -> Result<(), DataSetFault> {
        if let Some(reason) = self.block.refuses(row) {
            return Err(DataSetFault::new(&self.path, reason));
        }
        self.block.push(row);
        if self.block.end().is_multiple_of(GROUP_RUNS) {
            self.write_group()?;
        }
        Ok(())
    }

    /// Writes what is left and the footer, and gives the file its name. Returns the metadata with the runs that it contains.
    ///
    /// # Errors
    /// The disk is full, or the file cannot be renamed.
    pub fn finish(mut self) -> Result<Metadata, DataSetFault> {
        self.write_group()?;
        self.metadata.end = self.block.first;
        let json = |value: serde_json::Result<String>| value.map_err(DataSetFault::of(&self.path));
        let texts = [
            (KEY_FORMAT, FORMAT.to_string()),
            (KEY_STUDY, json(serde_json::to_string(&self.metadata))?),
            (KEY_GROUPS, json(serde_json::to_string(&self.groups))?),
        ];
        self.meter.hold();
        let failed = DataSetFault::of(&self.part);
        self.out.finish(&texts).map_err(&failed)?;
        let end = footer::with_digest(&self.meter.held());
        let failed = DataSetFault::of(&self.part);
        self.file.write_all(&end).map_err(failed)?;
        let failed = DataSetFault::of(&self.part);
        self.file.sync_all().map_err(failed)?;
        let failed = DataSetFault::of(&self.path);
        std::fs::rename(&self.part, &self.path).map_err(&failed)?;
        let failed = DataSetFault::of(&self.path);
        let folder = self
            .path
            .parent()
            .filter(|path| !path.as_os_str().is_empty());
        File::open(folder.unwrap_or_else(|| Path::new(".")))
            .and_then(|folder| folder.sync_all())
            .map_err(failed)?;
        Ok(self.metadata)
    }

    /// Writes the rows of the block as a row group.
    fn write_group(&mut self) -> Result<(), DataSetFault> {
        if self.block.is_empty() {
            return Ok(());
        }
        let rows = self.block.len() as u64;
        let frame =
            frame::frame(&self.block, &self.metadata).map_err(DataSetFault::of(&self.path))?;
        self.out
            .write(&frame)
            .map_err(DataSetFault::of(&self.part))?;
        self.groups.push(self.meter.end_group(rows));
        self.block.clear();
        Ok(())
    }
}

/// The number of the run, its inputs and results, its outcomes, which are words that repeat, and the reason.
fn encodings(metadata: &Metadata) -> Vec<Encoding> {
    let numbers = metadata.inputs.len() + metadata.results.len();
    let words = metadata.requirements.len();
    std::iter::once(Encoding::Plain)
        .chain(std::iter::repeat_n(Encoding::ByteStreamSplit, numbers))
        .chain(std::iter::repeat_n(Encoding::RleDictionary, words))
        .chain(std::iter::once(Encoding::Plain))
        .collect()
}
