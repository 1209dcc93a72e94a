//! Frames as CSV, block by block. In: frames with numbers, flags, and words that need no quotes. Out: lines. A number has the fewest digits
//! that are read as the same number.

use std::io::{self, Write};

use polars::prelude::{
    BooleanChunked, Column, DataFrame, DataType, Float64Chunked, PlSmallStr, PolarsResult,
    StringChunked, UInt64Chunked,
};

/// Number of bytes that are collected before they are written.
const COLLECTED: usize = 64 * 1024;

/// The first line: the names of the columns.
pub(super) fn header(frame: &DataFrame, out: &mut dyn Write) -> io::Result<()> {
    let names = frame.get_column_names().into_iter();
    let names: Vec<&str> = names.map(PlSmallStr::as_str).collect();
    writeln!(out, "{}", names.join(","))
}

/// A line for each row.
pub(super) fn rows(frame: &DataFrame, out: &mut dyn Write) -> io::Result<()> {
    let columns = frame.columns().iter().map(Cells::of);
    let columns: PolarsResult<Vec<Cells<'_>>> = columns.collect();
    let mut columns = columns.map_err(io::Error::other)?;
    let mut lines = Vec::with_capacity(2 * COLLECTED);
    for row in 0..frame.height() {
        for cells in &mut columns {
            cells.put(row, &mut lines)?;
            lines.push(b',');
        }
        if let Some(end) = lines.last_mut() {
            *end = b'\n';
        }
        if lines.len() >= COLLECTED {
            out.write_all(&lines)?;
            lines.clear();
        }
    }
    out.write_all(&lines)
}

/// The cells of a column. One without a value is empty.
enum Cells<'a> {
    Numbers(&'a [f64], Repeated),
    Optional(&'a Float64Chunked, Repeated),
    Integers(&'a UInt64Chunked),
    Words(&'a StringChunked),
    Flags(&'a BooleanChunked),
}

impl<'a> Cells<'a> {
    fn of(column: &'a Column) -> PolarsResult<Self> {
        Ok(match column.dtype() {
            DataType::String => Self::Words(column.str()?),
            DataType::Boolean => Self::Flags(column.bool()?),
            DataType::UInt64 => Self::Integers(column.u64()?),
            _ => {
                let numbers = column.f64()?;
                numbers.cont_slice().map_or_else(
                    |_| Self::Optional(numbers, Repeated::default()),
                    |numbers| Self::Numbers(numbers, Repeated::default()),
                )
            }
        })
    }

    fn put(&mut self, row: usize, line: &mut Vec<u8>) -> io::Result<()> {
        match self {
            Self::Numbers(numbers, repeated) => repeated.put(numbers[row], line),
            Self::Optional(numbers, repeated) => {
                if let Some(number) = numbers.get(row) {
                    repeated.put(number, line);
                }
            }
            Self::Integers(integers) => {
                if let Some(integer) = integers.get(row) {
                    write!(line, "{integer}")?;
                }
            }
            Self::Words(words) => line.extend(words.get(row).unwrap_or_default().as_bytes()),
            Self::Flags(flags) => {
                if let Some(flag) = flags.get(row) {
                    write!(line, "{flag}")?;
                }
            }
        }
        Ok(())
    }
}

/// The last number of a column as text: many numbers of a test do not change from step to step.
#[derive(Default)]
struct Repeated {
    bits: u64,
    text: [u8; LONGEST],
    /// Zero before the first number.
    length: usize,
}

/// Number of bytes of the longest number, -1.7976931348623157e+308.
const LONGEST: usize = 24;

impl Repeated {
    fn put(&mut self, number: f64, line: &mut Vec<u8>) {
        if self.length == 0 || self.bits != number.to_bits() {
            let mut buffer = zmij::Buffer::new();
            let text = buffer.format(number).as_bytes();
            self.text[..text.len()].copy_from_slice(text);
            (self.bits, self.length) = (number.to_bits(), text.len());
        }
        // A copy of a fixed length is no call.
        let end = line.len() + self.length;
        line.extend_from_slice(&self.text);
        line.truncate(end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use polars::prelude::{NamedFrom as _, Series};

    /// Numbers with the fewest digits, also where they repeat; what is absent is empty.
    #[test]
    fn cells_are_put_as_text() {
        let column = |series: Series| Column::from(series);
        let frame = DataFrame::new(
            4,
            vec![
                column(Series::new("step".into(), [0_u64, 1, 2, u64::MAX])),
                column(Series::new("time_s".into(), [0.1 + 0.2, 1e-7, 1e-7, -0.0])),
                column(Series::new(
                    "state".into(),
                    ["free", "contact", "free", "free"],
                )),
                column(Series::new(
                    "k".into(),
                    [None, Some(1e300), Some(1e300), Some(2.0)],
                )),
                column(Series::new(
                    "met".into(),
                    [Some(true), None, Some(false), None],
                )),
                column(Series::new(
                    "odd".into(),
                    [f64::NAN, f64::INFINITY, 12345.678, -f64::MAX],
                )),
            ],
        );
        let mut bytes = Vec::new();
        let frame = frame.unwrap();
        header(&frame, &mut bytes).unwrap();
        rows(&frame, &mut bytes).unwrap();
        assert_eq!(
            String::from_utf8(bytes).unwrap(),
            "step,time_s,state,k,met,odd\n\
             0,0.30000000000000004,free,,true,NaN\n\
             1,1e-7,contact,1e+300,,inf\n\
             2,1e-7,free,1e+300,false,12345.678\n\
             18446744073709551615,-0.0,free,2.0,,-1.7976931348623157e+308\n"
        );
    }
}
