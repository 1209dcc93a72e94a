//! Writes a data set row group by row group. In: metadata and rows in the order of their runs. Out: `PATH.part`, which becomes `PATH` once
//! all of it is on the disk. A file that ends early keeps the name of a part, and never has a footer.
//!
//! The encodings are stated here: left to Polars, they would depend on an estimate with a random seed.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use polars::prelude::{CompatLevel, PolarsError, SchemaExt as _};
use polars_io::prelude::KeyValueMetadata;
use polars_parquet::read::ParquetError;
use polars_parquet::write::{
    CompressionOptions, Compressor, DynIter, DynStreamingIterator, Encoding,
    FallibleStreamingIterator as _, FileWriter, StatisticsOptions, Version, WriteOptions,
    array_to_columns,
};

use super::block::{Block, StudyRow};
use super::fault::DataSetFault;
use super::group::{Group, Metered, SharedMeter};
use super::metadata::{FORMAT, Metadata};
use super::{GROUP_RUNS, footer, frame};

/// Keys of the footer.
pub(super) const KEY_FORMAT: &str = "psd.format";
pub(super) const KEY_STUDY: &str = "psd.study";
pub(super) const KEY_GROUPS: &str = "psd.row_groups";

const OPTIONS: WriteOptions = WriteOptions {
    statistics: StatisticsOptions {
        min_value: false,
        max_value: false,
        distinct_count: false,
        null_count: false,
        binary_statistics_truncate_length: None,
    },
    version: Version::V1,
    compression: CompressionOptions::Zstd(None),
    data_page_size: None,
};

/// A data set that is being written.
pub struct Writer {
    path: PathBuf,
    part: PathBuf,
    metadata: Metadata,
    file: File,
    out: FileWriter<Metered<BufWriter<File>>>,
    meter: SharedMeter,
    encodings: Vec<[Encoding; 1]>,
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
        let schema = empty.schema().to_arrow(CompatLevel::newest());
        let meter = SharedMeter::default();
        let metered = Metered {
            out: BufWriter::new(file.try_clone().map_err(DataSetFault::of(&part))?),
            meter: meter.clone(),
        };
        let out = FileWriter::try_new(metered, schema, OPTIONS).map_err(DataSetFault::of(path))?;
        Ok(Self {
            path: path.to_owned(),
            part,
            encodings: encodings(metadata),
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
        let texts = vec![
            (KEY_FORMAT.to_owned(), FORMAT.to_string()),
            (
                KEY_STUDY.to_owned(),
                json(serde_json::to_string(&self.metadata))?,
            ),
            (
                KEY_GROUPS.to_owned(),
                json(serde_json::to_string(&self.groups))?,
            ),
        ];
        let KeyValueMetadata::Static(texts) = KeyValueMetadata::from_static(texts) else {
            unreachable!("made of texts")
        };
        self.meter.hold();
        let failed = DataSetFault::of(&self.part);
        self.out.end(Some(texts)).map_err(&failed)?;
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
        let types = self.out.parquet_schema().fields().to_vec();
        for batch in frame.iter_chunks(CompatLevel::newest(), false) {
            let mut columns = Vec::new();
            for ((array, kind), encoding) in batch
                .columns()
                .iter()
                .zip(types.clone())
                .zip(&self.encodings)
            {
                let pages = array_to_columns(array, kind, OPTIONS, encoding)
                    .map_err(DataSetFault::of(&self.path))?;
                columns.extend(pages.into_iter().map(|pages| {
                    let pages = pages.map(|page| page.map_err(unencoded));
                    let compressed =
                        Compressor::new_from_vec(pages, OPTIONS.compression, Vec::new());
                    Ok(DynStreamingIterator::new(
                        compressed.map_err(PolarsError::from),
                    ))
                }));
            }
            self.out
                .write(rows, DynIter::new(columns.into_iter()))
                .map_err(DataSetFault::of(&self.part))?;
        }
        self.groups.push(self.meter.end_group(rows));
        self.block.clear();
        Ok(())
    }
}

#[expect(clippy::needless_pass_by_value, reason = "it maps an error")]
fn unencoded(error: PolarsError) -> ParquetError {
    ParquetError::FeatureNotSupported(error.to_string())
}

/// Words repeat, so they are in a dictionary; all other columns are plain.
fn encodings(metadata: &Metadata) -> Vec<[Encoding; 1]> {
    let numbers = 1 + metadata.inputs.len() + metadata.results.len();
    let words = metadata.requirements.len();
    std::iter::repeat_n([Encoding::Plain], numbers)
        .chain(std::iter::repeat_n([Encoding::RleDictionary], words))
        .chain(std::iter::once([Encoding::Plain]))
        .collect()
}
