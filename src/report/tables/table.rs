//! A table that is not made yet: it is written a stretch of its rows after the other, so that of a run of a million steps no
//! more than a stretch is ever in memory beside the record. In: who gives the columns of some steps. Out: CSV with shortest
//! round-trip numbers, or Parquet (zstd), each byte for byte what the whole table would be written as in one piece.

use std::io::{self, Write};
use std::ops::Range;

use polars::prelude::{
    Column, CsvWriter, DataFrame, ParquetCompression, ParquetWriter, SerWriter as _,
};

/// Rows of a stretch; in Parquet, a row group.
const STRETCH: usize = 65_536;

/// One table.
pub(crate) struct Table<'a> {
    pub name: String,
    /// Steps, each of which has `rows` rows.
    steps: usize,
    rows: usize,
    columns: Box<dyn Fn(Range<usize>) -> Vec<Column> + 'a>,
}

/// What it is written as.
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
    /// A row a step.
    pub fn of<T>(
        name: String,
        steps: &'a [T],
        columns: impl Fn(&'a [T]) -> Vec<Column> + 'a,
    ) -> Self {
        Self::of_steps(name, steps.len(), 1, move |range| columns(&steps[range]))
    }

    /// So many rows a step.
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

    /// Writes it.
    pub fn write(&self, form: Form, out: &mut dyn Write) -> io::Result<()> {
        match form {
            Form::Csv => self.csv(out),
            Form::Parquet => self.parquet(out),
        }
    }

    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        for (index, frame) in self.stretches().enumerate() {
            CsvWriter::new(&mut *out)
                .include_header(index == 0)
                .finish(&mut frame?)
                .map_err(io::Error::other)?;
        }
        Ok(())
    }

    fn parquet(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut stretches = self.stretches();
        let Some(first) = stretches.next().transpose()? else {
            return Ok(());
        };
        let writer = ParquetWriter::new(out).with_compression(ParquetCompression::Zstd(None));
        let mut writer = writer.batched(first.schema()).map_err(io::Error::other)?;
        for frame in std::iter::once(Ok(first)).chain(stretches) {
            writer.write_batch(&frame?).map_err(io::Error::other)?;
        }
        writer.finish().map(drop).map_err(io::Error::other)
    }

    /// At least one, for a table without rows has columns.
    fn stretches(&self) -> impl Iterator<Item = io::Result<DataFrame>> {
        let long = (STRETCH / self.rows).max(1);
        (0..self.steps.max(1)).step_by(long).map(move |from| {
            let columns = (self.columns)(from.min(self.steps)..(from + long).min(self.steps));
            let height = columns.first().map_or(0, Column::len);
            DataFrame::new(height, columns).map_err(io::Error::other)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

    /// One piece, by Polars alone.
    fn whole(steps: usize, form: Form) -> Vec<u8> {
        let mut frame = DataFrame::new(2 * steps, columns(0..steps)).unwrap();
        let mut bytes = Vec::new();
        match form {
            Form::Csv => CsvWriter::new(&mut bytes)
                .include_header(true)
                .finish(&mut frame)
                .unwrap(),
            Form::Parquet => {
                let writer =
                    ParquetWriter::new(&mut bytes).with_compression(ParquetCompression::Zstd(None));
                writer
                    .with_row_group_size(Some(STRETCH))
                    .finish(&mut frame)
                    .map(drop)
                    .unwrap();
            }
        }
        bytes
    }

    #[test]
    fn a_table_in_stretches_is_the_table_in_one_piece() {
        for steps in [0, 1, 1000, STRETCH / 2, STRETCH] {
            assert!(
                written(steps, Form::Csv) == whole(steps, Form::Csv),
                "{steps}"
            );
            assert!(
                written(steps, Form::Parquet) == whole(steps, Form::Parquet),
                "{steps}"
            );
        }
        // Neither a whole number of stretches: Polars would divide the row groups evenly.
        assert!(written(STRETCH + 5, Form::Csv) == whole(STRETCH + 5, Form::Csv));
    }
}
