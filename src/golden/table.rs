//! Tables: reading of CSV, and comparison of columns. Rows are compared by their index.

use super::finding::{Change, Count, Finding, FindingPart, RowRef};
use super::tolerance::Tolerances;
use super::{Truth, number};
use crate::procedures;
use psd_plan::schema;
use psd_plan::schema::columns;
use psd_text::units::Dimension;

/// A table as it was read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Name and cells, in the order of the file.
    pub columns: Vec<(String, Vec<String>)>,
}

/// The content of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// An empty cell has no number.
    Numbers(Vec<Option<f64>>),
    Words(Vec<String>),
}

impl Table {
    /// Reads CSV as psd writes it: the names, then the rows; quotes only around texts.
    #[must_use]
    pub fn read(text: &str) -> Self {
        let mut lines = text.lines();
        let mut columns: Vec<(String, Vec<String>)> = lines.next().map_or_else(Vec::new, |line| {
            cells(line)
                .into_iter()
                .map(|name| (name, Vec::new()))
                .collect()
        });
        for line in lines {
            let mut row = cells(line).into_iter();
            for (_, column) in &mut columns {
                column.push(row.next().unwrap_or_default());
            }
        }
        Self { columns }
    }

    #[must_use]
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, cells)| cells.len())
    }

    /// The cells of a column: numbers if every one is a number or empty.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<Cells> {
        let (_, cells) = self.columns.iter().find(|(known, _)| known == name)?;
        let number = |cell: &String| {
            if cell.is_empty() {
                Some(None)
            } else {
                cell.parse().ok().map(Some)
            }
        };
        let numbers: Option<Vec<Option<f64>>> = cells.iter().map(number).collect();
        Some(numbers.map_or_else(|| Cells::Words(cells.clone()), Cells::Numbers))
    }

    /// The numbers of a column; None if it contains texts.
    #[must_use]
    pub fn numbers(&self, name: &str) -> Option<Vec<Option<f64>>> {
        match self.column(name)? {
            Cells::Numbers(numbers) => Some(numbers),
            Cells::Words(_) => None,
        }
    }

    /// The identification of a row: its step, and the time of the test or of the rig.
    fn row_ref(&self, row: usize) -> RowRef {
        let cell = |name: &str| {
            self.numbers(name)
                .and_then(|cells| cells.get(row).copied().flatten())
        };
        let step = self
            .columns
            .iter()
            .find(|(name, _)| name == columns::STEP.name)
            .and_then(|(_, cells)| cells.get(row)?.parse().ok());
        RowRef {
            row,
            step,
            time: cell(columns::TIME.name).or_else(|| cell(columns::WALL_TIME.name)),
        }
    }
}

/// The cells of one line.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    let mut rest = line.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '"' if quoted && rest.peek() == Some(&'"') => {
                rest.next();
                cells.last_mut().expect("never empty").push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            other => cells.last_mut().expect("never empty").push(other),
        }
    }
    cells
}

/// Compares all tables of both results.
pub(super) fn compare_all(
    accepted: &Truth,
    now: &Truth,
    tolerances: &Tolerances,
    found: &mut Vec<Finding>,
) {
    let of = |truth: &Truth| {
        truth
            .tables()
            .map(|(name, table)| (name.to_owned(), table))
            .collect::<Vec<_>>()
    };
    let (was, is) = (of(accepted), of(now));
    for (name, table) in &was {
        match is.iter().find(|(other, _)| other == name) {
            Some((_, new)) => compare(name, table, new, tolerances, found),
            None => found.push(Finding::new(
                FindingPart::Table,
                format!("table of {name}"),
                Change::Missing,
            )),
        }
    }
    for (name, _) in is
        .iter()
        .filter(|(name, _)| !was.iter().any(|(other, _)| other == name))
    {
        found.push(Finding::new(
            FindingPart::Table,
            format!("table of {name}"),
            Change::New,
        ));
    }
}

fn compare(
    procedure: &str,
    was: &Table,
    is: &Table,
    tolerances: &Tolerances,
    found: &mut Vec<Finding>,
) {
    let named = |column: &str| format!("{procedure}.{column}");
    let rows = Change::length("rows", was.rows(), is.rows());
    found.extend(
        rows.map(|change| {
            Finding::new(FindingPart::Table, format!("table of {procedure}"), change)
        }),
    );
    for (column, _) in &was.columns {
        let (Some(old), new) = (was.column(column), is.column(column)) else {
            continue;
        };
        let change = match (old, new) {
            (_, None) => Some(Change::Missing),
            (Cells::Numbers(old), Some(Cells::Numbers(new))) => {
                let scale = number::scale(old.iter().chain(&new).flatten().copied());
                // Rows that only one of the two has are counted above.
                let pairs: Vec<_> = old.into_iter().zip(new).collect();
                let rule = tolerances.column(procedure, column);
                number::many(&pairs, dimension(column), rule, scale, |row| {
                    was.row_ref(row)
                })
            }
            (_, Some(_)) => words(was, is, column),
        };
        found.extend(change.map(|change| Finding::new(FindingPart::Table, named(column), change)));
    }
    for (column, _) in is
        .columns
        .iter()
        .filter(|(column, _)| was.column(column).is_none())
    {
        found.push(Finding::new(FindingPart::Table, named(column), Change::New));
    }
}

/// Texts, which must be identical.
fn words(was: &Table, is: &Table, column: &str) -> Option<Change> {
    let of = |table: &Table| {
        table
            .columns
            .iter()
            .find(|(name, _)| name == column)
            .map(|(_, cells)| cells.clone())
    };
    let pairs: Vec<(String, String)> = of(was)?.into_iter().zip(of(is)?).collect();
    let mut differ = pairs.iter().enumerate().filter(|(_, (was, is))| was != is);
    let (row, (old, new)) = differ.next()?;
    let count = Count {
        moved: 1 + differ.count(),
        of: pairs.len(),
    };
    Some(Change::Text {
        was: old.clone(),
        is: new.clone(),
        first: Some((was.row_ref(row), count)),
    })
}

/// The quantity of a column: one name has one meaning in every table.
#[must_use]
pub fn dimension(column: &str) -> Dimension {
    let known = schema::BLOCKS
        .iter()
        .map(|block| block.kind)
        .flat_map(procedures::columns)
        .find(|known| known.name == column);
    known.map_or(Dimension::NUMBER, |known| known.dimension)
}

#[cfg(test)]
mod tests {
    use super::*;

    const OLD: &str = "step,time_s,state,restoring_force_n,tangent\n0,0,free,1,\n1,0.1,contact,1000,5\n2,0.2,free,-3,6\n";

    fn findings(new: &str) -> Vec<Finding> {
        let mut found = Vec::new();
        compare(
            "hit",
            &Table::read(OLD),
            &Table::read(new),
            &Tolerances::default(),
            &mut found,
        );
        found
    }

    #[test]
    fn a_cell_is_held_by_the_largest_of_its_column() {
        assert_eq!(findings(OLD), []);
        // 1e-9 of 1000 N is 1 µN, also of the 1 N in the first row.
        assert_eq!(findings(&OLD.replace("free,1,", "free,1.0000009,")), []);
        let found = findings(
            &OLD.replace("free,1,", "free,1.0000011,")
                .replace("free,-3", "free,-3.5"),
        );
        let [
            Finding {
                name,
                change: Change::Moved(moved),
                ..
            },
        ] = found.as_slice()
        else {
            panic!("{found:?}")
        };
        assert_eq!(
            (name.as_str(), moved.dimension, moved.was, moved.is),
            (
                "hit.restoring_force_n",
                Dimension::FORCE,
                Some(-3.0),
                Some(-3.5)
            )
        );
        assert_eq!(
            (moved.count, moved.scale),
            (Some(Count { moved: 2, of: 3 }), 1000.0)
        );
        assert_eq!(
            moved.first,
            Some(RowRef {
                row: 0,
                step: Some(0),
                time: Some(0.0)
            })
        );
        assert_eq!(
            moved.largest,
            Some(RowRef {
                row: 2,
                step: Some(2),
                time: Some(0.2)
            })
        );
    }

    #[test]
    fn words_rows_columns_and_empty_cells_count() {
        let change = |new: &str| {
            findings(new)
                .into_iter()
                .map(|finding| (finding.name, finding.change))
                .collect::<Vec<_>>()
        };
        let [
            (
                name,
                Change::Text {
                    was,
                    is,
                    first: Some((largest, count)),
                },
            ),
        ] = &change(&OLD.replace("contact", "limit"))[..]
        else {
            panic!("one text")
        };
        assert_eq!(
            (name.as_str(), was.as_str(), is.as_str(), largest.step),
            ("hit.state", "contact", "limit", Some(1))
        );
        assert_eq!(*count, Count { moved: 1, of: 3 });
        let rows = Change::Length {
            of: "rows",
            was: 3,
            is: 4,
        };
        assert_eq!(
            change(&format!("{OLD}3,0.3,free,0,1\n")),
            [("table of hit".to_owned(), rows)]
        );
        assert_eq!(
            change(&OLD.replace("tangent", "other")),
            [
                ("hit.tangent".to_owned(), Change::Missing),
                ("hit.other".to_owned(), Change::New)
            ]
        );
        let [(_, Change::Moved(moved))] = &change(&OLD.replace("free,1,", "free,1,7"))[..] else {
            panic!("one number came")
        };
        assert_eq!((moved.was, moved.is), (None, Some(7.0)));
    }

    #[test]
    fn quotes_hold_commas() {
        assert_eq!(cells("a,\"b,\"\"c\"\"\",d"), ["a", "b,\"c\"", "d"]);
    }
}
