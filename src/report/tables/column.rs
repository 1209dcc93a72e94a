//! A column of a table, declared once: its name, its dimension and its value in a row. In: rows. Out: columns of Polars, and the numeric
//! columns that comparisons and the reference know. It knows no procedure.

use polars::prelude::{Column as Written, NamedFrom as _, NamedFromOwned as _, PlSmallStr, Series};

use psd_plan::schema::Column;

/// A column of a table whose rows are `T`.
pub(crate) enum TableColumn<T> {
    Number(Column, fn(&T) -> f64),
    /// A number that a row may lack.
    Optional(Column, fn(&T) -> Option<f64>),
    /// A whole number.
    Integer(Column, fn(&T) -> u64),
    /// A word of psd: no text of a plan.
    Text(&'static str, fn(&T) -> &'static str),
    /// `true` or `false`.
    Flag(&'static str, fn(&T) -> Option<bool>),
}

impl<T> TableColumn<T> {
    /// The name and dimension of a numeric column.
    pub const fn numeric(&self) -> Option<Column> {
        match self {
            Self::Number(column, _) | Self::Optional(column, _) | Self::Integer(column, _) => {
                Some(*column)
            }
            Self::Text(..) | Self::Flag(..) => None,
        }
    }

    /// Its cells in so many rows, none of which is read yet.
    fn cells<'a>(&self, rows: usize) -> Box<dyn Cells<T> + 'a>
    where
        T: 'a,
    {
        match self {
            Self::Number(column, read) => cells(column.name, *read, rows, Series::from_vec),
            Self::Optional(column, read) => cells(column.name, *read, rows, Series::new),
            Self::Integer(column, read) => cells(column.name, *read, rows, Series::from_vec),
            Self::Text(name, read) => cells(name, *read, rows, Series::new),
            Self::Flag(name, read) => cells(name, *read, rows, Series::new),
        }
    }
}

/// The cells of a column, as far as their rows were read.
trait Cells<T> {
    fn add(&mut self, rows: &[T]);
    fn written(self: Box<Self>) -> Written;
}

struct Filling<T, V> {
    name: &'static str,
    read: fn(&T) -> V,
    values: Vec<V>,
    series: fn(PlSmallStr, Vec<V>) -> Series,
}

fn cells<'a, T: 'a, V: 'a>(
    name: &'static str,
    read: fn(&T) -> V,
    rows: usize,
    series: fn(PlSmallStr, Vec<V>) -> Series,
) -> Box<dyn Cells<T> + 'a> {
    let values = Vec::with_capacity(rows);
    Box::new(Filling {
        name,
        read,
        values,
        series,
    })
}

impl<T, V> Cells<T> for Filling<T, V> {
    fn add(&mut self, rows: &[T]) {
        self.values.extend(rows.iter().map(self.read));
    }

    fn written(self: Box<Self>) -> Written {
        (self.series)(self.name.into(), self.values).into()
    }
}

/// Rows that all columns read before the next ones: few enough to stay in the cache meanwhile.
const BLOCK: usize = 128;

/// All columns of these rows.
pub(crate) fn written<T>(columns: &[TableColumn<T>], rows: &[T]) -> Vec<Written> {
    let mut filling = AllCells::new(columns, rows.len());
    rows.chunks(BLOCK).for_each(|block| filling.add(block));
    filling.written()
}

/// All columns of rows that are kept in another form.
pub(crate) fn written_one_by_one<T>(
    columns: &[TableColumn<T>],
    mut rows: impl ExactSizeIterator<Item = T>,
) -> Vec<Written> {
    let mut filling = AllCells::new(columns, rows.len());
    let mut block = Vec::with_capacity(BLOCK);
    while rows.len() > 0 {
        block.clear();
        block.extend(rows.by_ref().take(BLOCK));
        filling.add(&block);
    }
    filling.written()
}

/// The cells of all columns.
struct AllCells<'a, T>(Vec<Box<dyn Cells<T> + 'a>>);

impl<'a, T: 'a> AllCells<'a, T> {
    fn new(columns: &[TableColumn<T>], rows: usize) -> Self {
        Self(columns.iter().map(|column| column.cells(rows)).collect())
    }

    /// Adds rows, few enough to stay in the cache meanwhile.
    fn add(&mut self, block: &[T]) {
        for cells in &mut self.0 {
            cells.add(block);
        }
    }

    fn written(self) -> Vec<Written> {
        self.0.into_iter().map(Cells::written).collect()
    }
}

/// The numeric columns of a table.
pub(crate) fn numeric<T>(columns: &[TableColumn<T>]) -> Vec<Column> {
    columns.iter().filter_map(TableColumn::numeric).collect()
}

/// These columns, each once.
pub(crate) fn each_once(columns: Vec<Column>) -> Vec<Column> {
    let mut once: Vec<Column> = Vec::new();
    for column in columns {
        if !once.contains(&column) {
            once.push(column);
        }
    }
    once
}
