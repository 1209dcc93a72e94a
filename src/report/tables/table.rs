//! A table that is written in chunks of rows, so that a run of a million steps needs memory for one chunk beside the record. In:
//! a function that gives the columns of a range of steps. Out: CSV, or Parquet (zstd), bit-identical with the table written as a whole.

use std::io::{self, Write};
use std::ops::Range;

use polars::prelude::{Column, DataFrame, DataType};

use super::csv;
use crate::report::parquet::{Encoding, ParquetFile};

/// Rows of a chunk; in Parquet, a row group. A page of so many doubles is compressed in the cache.
const CHUNK: usize = 16_384;

/// One table.
pub(crate) struct Table<'a> {
    pub name: String,
    /// Number of steps.
    steps: usize,
    /// Rows per step.
    rows: usize,
    columns: Box<dyn Fn(Range<usize>) -> Vec<Column> + 'a>,
}

/// File format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    Csv,
    Parquet,
}

impl Form {
    pub const fn ending(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Parquet => "parquet",
        }
    }
}

impl<'a> Table<'a> {
    /// A table with one row per step.
    pub fn of<T>(
        name: String,
        steps: &'a [T],
        columns: impl Fn(&'a [T]) -> Vec<Column> + 'a,
    ) -> Self {
        Self::of_steps(name, steps.len(), 1, move |range| columns(&steps[range]))
    }

    /// A table with `rows` rows per step.
    pub fn of_steps(
        name: String,
        steps: usize,
        rows: usize,
        columns: impl Fn(Range<usize>) -> Vec<Column> + 'a,
    ) -> Self {
        Self {
            name,
            steps,
            rows: rows.max(1),
            columns: Box::new(columns),
        }
    }

    /// Writes the table.
    pub fn write(&self, form: Form, out: &mut dyn Write) -> io::Result<()> {
        match form {
            Form::Csv => self.csv(out),
            Form::Parquet => self.parquet(out),
        }
    }

    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        for (index, frame) in self.chunks().enumerate() {
            let frame = frame?;
            if index == 0 {
                csv::header(&frame, out)?;
            }
            csv::rows(&frame, out)?;
        }
        Ok(())
    }

    fn parquet(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut chunks = self.chunks();
        let Some(first) = chunks.next().transpose()? else {
            return Ok(());
        };
        let encodings = first.columns().iter().map(encoding).collect();
        let mut file = ParquetFile::new(out, &first, encodings).map_err(io::Error::other)?;
        for frame in std::iter::once(Ok(first)).chain(chunks) {
            file.write(&frame?).map_err(io::Error::other)?;
        }
        file.finish(&[]).map_err(io::Error::other)
    }

    /// The data in chunks; at least one, because a table without rows has columns.
    fn chunks(&self) -> impl Iterator<Item = io::Result<DataFrame>> {
        let length = (CHUNK / self.rows).max(1);
        (0..self.steps.max(1)).step_by(length).map(move |from| {
            let columns = (self.columns)(from.min(self.steps)..(from + length).min(self.steps));
            let height = columns.first().map_or(0, Column::len);
            DataFrame::new(height, columns).map_err(io::Error::other)
        })
    }
}

/// The texts of a table are words of psd, which repeat.
fn encoding(column: &Column) -> Encoding {
    match column.dtype() {
        DataType::String => Encoding::RleDictionary,
        DataType::Float64 => Encoding::ByteStreamSplit,
        _ => Encoding::Plain,
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::report::parquet::{read_metadata, row_group};

    fn columns(range: Range<usize>) -> Vec<Column> {
        let number = |step: usize| f64::from(u32::try_from(step).unwrap()) / 7.0;
        let rows = || range.clone().flat_map(|step| [step, step]);
        vec![
            Column::new(
                "step".into(),
                rows().map(|step| step as u64).collect::<Vec<u64>>(),
            ),
            Column::new(
                "state".into(),
                rows()
                    .map(|step| if step % 3 == 0 { "free" } else { "contact" })
                    .collect::<Vec<_>>(),
            ),
            Column::new("time_s".into(), rows().map(number).collect::<Vec<f64>>()),
            Column::new(
                "tangent".into(),
                rows()
                    .map(|step| (step > 50_000).then(|| number(step)))
                    .collect::<Vec<Option<f64>>>(),
            ),
        ]
    }

    fn written(steps: usize, form: Form) -> Vec<u8> {
        let mut bytes = Vec::new();
        Table::of_steps("hit".to_owned(), steps, 2, columns)
            .write(form, &mut bytes)
            .unwrap();
        bytes
    }

    fn whole(steps: usize) -> DataFrame {
        DataFrame::new(2 * steps, columns(0..steps)).unwrap()
    }

    #[test]
    fn a_csv_table_in_chunks_is_the_table_written_as_a_whole() {
        for steps in [0, 1, 1000, CHUNK / 2, CHUNK, CHUNK + 5] {
            let mut bytes = Vec::new();
            csv::header(&whole(steps), &mut bytes).unwrap();
            csv::rows(&whole(steps), &mut bytes).unwrap();
            assert!(written(steps, Form::Csv) == bytes, "{steps}");
        }
    }

    #[test]
    fn a_parquet_table_is_read_as_it_was_and_has_the_same_bytes_again() {
        for steps in [0, 1, 1000, CHUNK / 2, CHUNK, CHUNK + 5] {
            let bytes = written(steps, Form::Parquet);
            let footer = read_metadata(&mut Cursor::new(&bytes)).unwrap();
            let mut read = whole(0);
            for group in 0..footer.row_groups.len() {
                let rows = row_group(&bytes, 0, &footer, group).unwrap();
                read.vstack_mut(&rows).unwrap();
            }
            assert!(read.equals_missing(&whole(steps)), "{steps}");
            assert!(written(steps, Form::Parquet) == bytes, "{steps}");
        }
    }
}
