//! Parquet files with zstd, a row group at a time. In: frames, or the bytes of a file. Out: the other one. Equal frames give equal bytes:
//! the encodings are stated. Polars would choose them by an estimate.

use std::io::{Cursor, Write};

use polars::prelude::{
    Column, CompatLevel, DataFrame, PolarsError, PolarsResult, SchemaExt as _, Series, polars_err,
};
use polars_parquet::parquet::CowBuffer;
use polars_parquet::parquet::compression::ZstdLevel;
use polars_parquet::parquet::page::{DataPage, DataPageHeader};
use polars_parquet::parquet::schema::Repetition;
use polars_parquet::read::{
    BasicDecompressor, ColumnChunkMetadata, PageReader, column_iter_to_arrays, infer_schema,
};
pub use polars_parquet::read::{FileMetadata, read_metadata};
pub use polars_parquet::write::Encoding;
use polars_parquet::write::{
    CompressedPage, CompressionOptions, DynIter, DynStreamingIterator, FallibleStreamingIterator,
    FileWriter, KeyValue, Page, ParquetType, StatisticsOptions, Version, WriteOptions,
    array_to_columns, compress,
};
use rayon::prelude::*;

/// zstd is fastest at this level; at a higher one, split numbers are hardly smaller.
const LEVEL: i32 = 1;

/// No statistics: no reader skips a row group of these files.
fn options() -> PolarsResult<WriteOptions> {
    Ok(WriteOptions {
        statistics: StatisticsOptions {
            min_value: false,
            max_value: false,
            distinct_count: false,
            null_count: false,
            binary_statistics_truncate_length: None,
        },
        version: Version::V1,
        compression: CompressionOptions::Zstd(Some(ZstdLevel::try_new(LEVEL)?)),
        data_page_size: None,
    })
}

/// Columns that are compressed at the same time: a page is in memory several times meanwhile.
const AT_A_TIME: usize = 8;

/// A file that is being written.
pub struct ParquetFile<W: Write> {
    out: FileWriter<W>,
    options: WriteOptions,
    /// One of each column.
    encodings: Vec<Encoding>,
}

impl<W: Write> ParquetFile<W> {
    /// A file with the columns of `frame`, whose rows are not written. Words that repeat belong into a dictionary, numbers with a fraction
    /// into a byte stream split; all else is plain.
    ///
    /// # Errors
    /// Two columns have one name.
    pub fn new(out: W, frame: &DataFrame, encodings: Vec<Encoding>) -> PolarsResult<Self> {
        let schema = frame.schema().to_arrow(CompatLevel::newest());
        let options = options()?;
        let out = FileWriter::try_new(out, schema, options)?;
        Ok(Self {
            out,
            options,
            encodings,
        })
    }

    /// Writes the rows of a frame as a row group.
    ///
    /// # Errors
    /// The rows cannot be written.
    pub fn write(&mut self, frame: &DataFrame) -> PolarsResult<()> {
        let kinds = self.out.parquet_schema().fields().to_vec();
        let options = self.options;
        for batch in frame.iter_chunks(CompatLevel::newest(), false) {
            let rows = batch.len();
            if rows == 0 {
                continue;
            }
            let columns: Vec<_> = batch
                .columns()
                .iter()
                .zip(&kinds)
                .zip(&self.encodings)
                .collect();
            let pages = |((array, kind), encoding): &((_, &ParquetType), &Encoding)| {
                let is_split = **encoding == Encoding::ByteStreamSplit;
                let encoding = if is_split {
                    Encoding::Plain
                } else {
                    **encoding
                };
                let pages = array_to_columns(*array, (*kind).clone(), options, &[encoding])?;
                let pages = pages.into_iter().flatten();
                pages
                    .map(|page| {
                        let page = if is_split { split(page?) } else { page? };
                        Ok(compress(page, Vec::new(), options.compression)?)
                    })
                    .collect()
            };
            let columns = columns.chunks(AT_A_TIME).flat_map(|some| {
                let pages: Vec<PolarsResult<Vec<CompressedPage>>> = if in_a_pool() {
                    some.iter().map(pages).collect()
                } else {
                    some.par_iter().map(pages).collect()
                };
                pages.into_iter().map(|pages| {
                    Ok(DynStreamingIterator::new(Pages {
                        left: pages?.into_iter(),
                        now: None,
                    }))
                })
            });
            self.out.write(rows as u64, DynIter::new(columns))?;
        }
        Ok(())
    }

    /// Writes the footer, with these texts under their keys.
    ///
    /// # Errors
    /// The footer cannot be written.
    pub fn finish(mut self, texts: &[(&str, String)]) -> PolarsResult<()> {
        let texts = texts.iter().map(|(key, text)| KeyValue {
            key: (*key).to_owned(),
            value: Some(text.clone()),
        });
        let texts: Vec<KeyValue> = texts.collect();
        self.out.end((!texts.is_empty()).then_some(texts)).map(drop)
    }
}

/// Pages on their way into the file.
struct Pages {
    left: std::vec::IntoIter<CompressedPage>,
    now: Option<CompressedPage>,
}

impl FallibleStreamingIterator for Pages {
    type Item = CompressedPage;
    type Error = PolarsError;

    fn advance(&mut self) -> PolarsResult<()> {
        self.now = self.left.next();
        Ok(())
    }

    fn get(&self) -> Option<&CompressedPage> {
        self.now.as_ref()
    }
}

/// A plain page of doubles with the first bytes of all of them, then the second bytes, and so on. Neighbours in a table have the same sign,
/// exponent and leading digits: such a page is compressed faster, and to a smaller size.
fn split(page: Page) -> Page {
    const BYTES: usize = size_of::<f64>();
    let Page::Data(page) = page else {
        return page;
    };
    let (DataPageHeader::V1(header), Some(rows)) = (page.header(), page.num_rows()) else {
        return Page::Data(page);
    };
    let plain = page.buffer();
    // Which rows have a number comes first, with its length.
    let is_optional = page.descriptor.primitive_type.field_info.repetition == Repetition::Optional;
    let levels = match plain.first_chunk() {
        Some(length) if is_optional => size_of::<u32>() + u32::from_le_bytes(*length) as usize,
        _ => 0,
    };
    let (numbers, _) = plain[levels..].as_chunks::<BYTES>();
    let mut bytes = plain.to_vec();
    let streams = bytes[levels..].chunks_exact_mut(numbers.len().max(1));
    for (byte, stream) in streams.take(BYTES).enumerate() {
        for (to, number) in stream.iter_mut().zip(numbers) {
            *to = number[byte];
        }
    }
    let mut header = header.clone();
    header.encoding = Encoding::ByteStreamSplit.into();
    Page::Data(DataPage::new(
        DataPageHeader::V1(header),
        CowBuffer::Owned(bytes),
        page.descriptor.clone(),
        rows,
    ))
}

/// Row group number `at` of a file with this footer. `bytes` are bytes of the file, the first of which is byte `from`.
///
/// # Errors
/// The bytes are not those of the row group.
pub fn row_group(
    bytes: &[u8],
    from: u64,
    footer: &FileMetadata,
    at: usize,
) -> PolarsResult<DataFrame> {
    let schema = infer_schema(footer)?;
    let group = &footer.row_groups[at];
    let part = |column: &ColumnChunkMetadata| {
        let range = column.byte_range();
        let [begin, end] = [range.start, range.end]
            .map(|byte| byte.checked_sub(from))
            .map(|byte| byte.and_then(|byte| usize::try_from(byte).ok()));
        bytes.get(begin?..end?)
    };
    let columns = schema
        .iter_values()
        .zip(group.parquet_columns())
        .map(|(field, column)| {
            let bytes = part(column).ok_or_else(
                || polars_err!(ComputeError: "`{}` is outside its row group", field.name),
            )?;
            let pages = PageReader::new(
                Cursor::new(bytes.to_vec().into()),
                column,
                Vec::new(),
                usize::MAX,
            );
            let kind = &column.descriptor().descriptor.primitive_type;
            let pages = BasicDecompressor::new(pages, Vec::new());
            let (arrays, _) = column_iter_to_arrays(vec![pages], vec![kind], field.clone(), None)?;
            Ok(Column::from(Series::try_from((field, arrays))?))
        });
    DataFrame::new(group.num_rows(), columns.collect::<PolarsResult<_>>()?)
}

/// Whether this is a thread of a pool. Waiting there for other threads, it would begin other work of its own pool on the same stack:
/// the next report, which waits in turn, until the stack overflows.
fn in_a_pool() -> bool {
    rayon::current_thread_index().is_some()
}
