//! A column of a table, declared once: its name, its dimension and its value in a row. In: rows. Out: columns of Polars, and the numeric
//! columns that comparisons and the reference know. It knows no procedure.

use polars::prelude::Column as Written;

use psd_plan::schema::Column;
use psd_text::sanitize;

/// A column of a table whose rows are `T`.
pub(crate) enum TableColumn<T> {
    Number(Column, fn(&T) -> f64),
    /// A number that a row may lack.
    Optional(Column, fn(&T) -> Option<f64>),
    /// A whole number.
    Integer(Column, fn(&T) -> u64),
    Text(&'static str, fn(&T) -> &'static str),
    /// `true` or `false`.
    Flag(&'static str, fn(&T) -> Option<bool>),
}

impl<T> TableColumn<T> {
    /// The column of these rows.
    pub fn written(&self, rows: &[T]) -> Written {
        match self {
            Self::Number(column, read) => Written::new(column.name.into(), values(rows, *read)),
            Self::Optional(column, read) => Written::new(column.name.into(), values(rows, *read)),
            Self::Integer(column, read) => Written::new(column.name.into(), values(rows, *read)),
            Self::Text(name, read) => {
                let cells: Vec<String> = rows.iter().map(|row| sanitize::cell(read(row))).collect();
                Written::new((*name).into(), cells)
            }
            Self::Flag(name, read) => Written::new((*name).into(), values(rows, *read)),
        }
    }

    /// The name and dimension of a numeric column.
    pub const fn numeric(&self) -> Option<Column> {
        match self {
            Self::Number(column, _) | Self::Optional(column, _) | Self::Integer(column, _) => {
                Some(*column)
            }
            Self::Text(..) | Self::Flag(..) => None,
        }
    }
}

fn values<T, V>(rows: &[T], read: fn(&T) -> V) -> Vec<V> {
    rows.iter().map(read).collect()
}

/// All columns of these rows.
pub(crate) fn written<T>(columns: &[TableColumn<T>], rows: &[T]) -> Vec<Written> {
    columns.iter().map(|column| column.written(rows)).collect()
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
