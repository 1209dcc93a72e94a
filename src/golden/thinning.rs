//! Rows of a long table that are accepted and compared. In: CSV. Out: CSV with fewer rows. The results and the figures of a run
//! cover all rows, so that a change in any step shows in them.

/// Number of rows up to which a table is kept complete.
const WHOLE: usize = 200;
/// Parts of a longer table, spread evenly from its first row to its last.
const PARTS: usize = 20;
/// Consecutive rows of each part. They show every storey of a step and the change from step to step.
const ROWS: usize = WHOLE / PARTS;

/// The header, and all rows or 20 parts of 10 rows. A thinned table is thinned to itself.
#[must_use]
pub fn thinned(csv: &str) -> String {
    let lines: Vec<&str> = csv.split_inclusive('\n').collect();
    let Some((header, rows)) = lines.split_first() else {
        return String::new();
    };
    if rows.len() <= WHOLE {
        return csv.to_owned();
    }
    let last = rows.len() - ROWS;
    let parts = (0..PARTS).map(|part| {
        let first = part * last / (PARTS - 1);
        rows[first..first + ROWS].concat()
    });
    std::iter::once((*header).to_owned()).chain(parts).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(rows: usize) -> String {
        (0..rows).fold("step\n".to_owned(), |text, row| format!("{text}{row}\n"))
    }

    #[test]
    fn a_short_table_is_whole() {
        for rows in [0, 1, WHOLE] {
            assert_eq!(thinned(&table(rows)), table(rows));
        }
        assert_eq!(thinned(""), "");
    }

    #[test]
    fn a_long_table_keeps_its_ends_and_parts_that_do_not_overlap() {
        for rows in [WHOLE + 1, 1003, 60_000] {
            let kept = thinned(&table(rows));
            let steps: Vec<usize> = kept
                .lines()
                .skip(1)
                .map(|line| line.parse().unwrap())
                .collect();
            assert_eq!(steps.len(), WHOLE);
            assert!(steps.is_sorted_by(|one, next| one < next), "{rows}");
            assert_eq!((steps[0], steps[WHOLE - 1]), (0, rows - 1));
            assert_eq!(thinned(&kept), kept);
        }
    }
}
