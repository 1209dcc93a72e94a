//! Parquet files with zstd, a row group at a time. In: frames, or the bytes of a file. Out: the other one. Equal frames give equal bytes:
//! the encodings are stated. Polars would choose them by an estimate.

use std::cell::RefCell;
use std::io::{self, Cursor, Write};

use polars::prelude::{
    ArrayRef, Column, CompatLevel, DataFrame, PolarsError, PolarsResult, SchemaExt as _, Series,
    polars_err,
};
use polars_parquet::parquet::CowBuffer;
use polars_parquet::parquet::compression::Compression;
use polars_parquet::parquet::page::{
    CompressedDataPage, CompressedDictPage, DataPage, DataPageHeader,
};
use polars_parquet::parquet::schema::Repetition;
use polars_parquet::read::{
    BasicDecompressor, ColumnChunkMetadata, PageReader, column_iter_to_arrays, infer_schema,
};
pub use polars_parquet::read::{FileMetadata, read_metadata};
pub use polars_parquet::write::Encoding;
use polars_parquet::write::{
    CompressedPage, CompressionOptions, DynIter, DynStreamingIterator, FallibleStreamingIterator,
    FileWriter, KeyValue, Page, ParquetType, StatisticsOptions, Version, WriteOptions,
    array_to_pages, to_nested, to_parquet_leaves,
};
use rayon::prelude::*;
use zstd::{bulk, zstd_safe};

/// zstd is fastest at this level; at a higher one, split numbers are hardly smaller.
const LEVEL: i32 = 1;

/// No statistics: no reader skips a row group of these files. Pages are compressed by [`PageCompressor`].
const OPTIONS: WriteOptions = WriteOptions {
    statistics: StatisticsOptions {
        min_value: false,
        max_value: false,
        distinct_count: false,
        null_count: false,
        binary_statistics_truncate_length: None,
    },
    version: Version::V1,
    compression: CompressionOptions::Uncompressed,
    data_page_size: None,
};

/// Columns that are compressed at the same time: a page is in memory several times meanwhile.
const AT_A_TIME: usize = 8;

/// A file that is being written.
pub struct ParquetFile<W: Write> {
    out: FileWriter<W>,
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
        let out = FileWriter::try_new(out, schema, OPTIONS)?;
        Ok(Self { out, encodings })
    }

    /// Writes the rows of a frame as a row group.
    ///
    /// # Errors
    /// The rows cannot be written.
    pub fn write(&mut self, frame: &DataFrame) -> PolarsResult<()> {
        let kinds = self.out.parquet_schema().fields().to_vec();
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
            let pages = |((array, kind), encoding): &((&ArrayRef, &ParquetType), &Encoding)| {
                pages_of(array, kind, **encoding)
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

/// The pages of a column of these tables, which is flat: `array_to_columns` looks for the leaves of any column, and makes eight mebibytes of
/// zeros for the first one without a value.
fn pages_of(
    array: &ArrayRef,
    kind: &ParquetType,
    encoding: Encoding,
) -> PolarsResult<Vec<CompressedPage>> {
    let is_split = encoding == Encoding::ByteStreamSplit;
    let encoding = if is_split { Encoding::Plain } else { encoding };
    let array = match array.null_count() {
        0 => array.with_validity(None),
        _ => array.to_boxed(),
    };
    let mut compressed = Vec::new();
    let leaves = to_parquet_leaves(kind.clone());
    for (leaf, nested) in leaves.into_iter().zip(to_nested(&*array, kind)?) {
        for page in array_to_pages(&*array, leaf, &nested, OPTIONS, encoding)? {
            let page = page?;
            compressed.push(PAGES.with_borrow_mut(|pages| pages.compressed(page, is_split))?);
        }
    }
    Ok(compressed)
}

thread_local! {
    /// One for each thread: a new compressor asks the processor for its features, which takes long in a virtual machine.
    static PAGES: RefCell<PageCompressor> = RefCell::default();
}

/// Compresses one page after the other.
#[derive(Default)]
struct PageCompressor {
    zstd: Option<bulk::Compressor<'static>>,
    /// A page with its numbers split.
    split: Vec<u8>,
    /// A compressed page.
    small: Vec<u8>,
}

impl PageCompressor {
    /// `is_split`: the page has doubles, which are split by bytes.
    fn compressed(&mut self, page: Page, is_split: bool) -> PolarsResult<CompressedPage> {
        let zstd = match &mut self.zstd {
            Some(zstd) => zstd,
            none => none.insert(bulk::Compressor::new(LEVEL)?),
        };
        let small = &mut self.small;
        let mut compress = |bytes: &[u8]| -> io::Result<CowBuffer> {
            small.clear();
            small.reserve(zstd_safe::compress_bound(bytes.len()));
            zstd.compress_to_buffer(bytes, small)?;
            Ok(CowBuffer::Owned(small.clone()))
        };
        let page = match page {
            Page::Dict(page) => {
                return Ok(CompressedPage::Dict(CompressedDictPage::new(
                    compress(&page.buffer)?,
                    Compression::Zstd,
                    page.buffer.len(),
                    page.num_values,
                    page.is_sorted,
                )));
            }
            Page::Data(page) => page,
        };
        let mut header = page.header().clone();
        let compressed = match &mut header {
            DataPageHeader::V1(header) if is_split => {
                header.encoding = Encoding::ByteStreamSplit.into();
                split(&page, &mut self.split);
                compress(&self.split)?
            }
            _ => compress(page.buffer())?,
        };
        let rows = page.num_rows().unwrap_or_else(|| page.num_values());
        Ok(CompressedPage::Data(CompressedDataPage::new(
            header,
            compressed,
            Compression::Zstd,
            page.buffer().len(),
            page.descriptor.clone(),
            rows,
        )))
    }
}

/// A plain page of doubles with the first bytes of all of them, then the second bytes, and so on. Neighbours in a table have the same sign,
/// exponent and leading digits: such a page is compressed faster, and to a smaller size.
fn split(page: &DataPage, bytes: &mut Vec<u8>) {
    const BYTES: usize = size_of::<f64>();
    let plain = page.buffer();
    // Which rows have a number comes first, with its length.
    let is_optional = page.descriptor.primitive_type.field_info.repetition == Repetition::Optional;
    let levels = match plain.first_chunk() {
        Some(length) if is_optional => size_of::<u32>() + u32::from_le_bytes(*length) as usize,
        _ => 0,
    };
    let (numbers, _) = plain[levels..].as_chunks::<BYTES>();
    bytes.clear();
    bytes.extend_from_slice(plain);
    let streams = bytes[levels..].chunks_exact_mut(numbers.len().max(1));
    for (byte, stream) in streams.take(BYTES).enumerate() {
        for (to, number) in stream.iter_mut().zip(numbers) {
            *to = number[byte];
        }
    }
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
