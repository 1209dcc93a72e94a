//! A file of measured points: `displacement_m,force_n`, one row per point. In: its text. Out: points in SI through the origin, for both
//! signs; or the row of an error, and the reason.

/// Why a file is not a table: number of the line from 1 and its text, if one row has the error, and the reason with a suggestion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadTable {
    pub row: Option<(usize, String)>,
    pub reason: String,
    pub help: &'static str,
}

/// Most rows of a table.
const MOST_ROWS: usize = 10_000;

const DISPLACEMENTS: &[(&str, f64)] = &[("displacement_m", 1.0), ("displacement_mm", 1e-3)];
const FORCES: &[(&str, f64)] = &[("force_n", 1.0), ("force_kn", 1e3)];

/// The points of a table, in order of increasing displacement. One-sided points are mirrored; the origin is added.
pub fn points(text: &str) -> Result<Vec<[f64; 2]>, BadTable> {
    let lines = text.lines().enumerate().map(|(index, line)| FileRow {
        line: index + 1,
        text: line.trim(),
    });
    let mut lines = lines.filter(|row| !row.text.is_empty() && !row.text.starts_with('#'));
    let Some(header) = lines.next() else {
        return Err(BadTable {
            row: None,
            reason: "the file has no rows".to_owned(),
            help: HEADER,
        });
    };
    let scales = header.scales()?;
    let mut points: Vec<[f64; 2]> = Vec::new();
    for row in lines {
        if points.len() >= MOST_ROWS {
            return Err(row.bad(
                &format!("more than {MOST_ROWS} rows"),
                "remove redundant rows",
            ));
        }
        let [displacement, force] = row.numbers()?;
        let point = [displacement * scales[0], force * scales[1]];
        row.follows(points.last(), point)?;
        points.push(point);
    }
    whole(points)
}

const HEADER: &str = "write `displacement_m,force_n` in the first line, then one point per row";

struct FileRow<'t> {
    /// Line number from 1.
    line: usize,
    text: &'t str,
}

impl FileRow<'_> {
    fn bad(&self, reason: &str, help: &'static str) -> BadTable {
        // A row may have the length of a whole file.
        let shown: String = self.text.chars().take(60).collect();
        BadTable {
            row: Some((self.line, shown)),
            reason: reason.to_owned(),
            help,
        }
    }

    fn cells(&self) -> Result<[&str; 2], BadTable> {
        let cells: Vec<&str> = self.text.split(',').map(str::trim).collect();
        <[&str; 2]>::try_from(cells).map_err(|cells| {
            self.bad(
                &format!("a row must have two columns, this one has {}", cells.len()),
                "write a comma between the two numbers",
            )
        })
    }

    fn scales(&self) -> Result<[f64; 2], BadTable> {
        let [displacement, force] = self.cells()?;
        let scale = |known: &[(&str, f64)], cell: &str| {
            known
                .iter()
                .find(|(name, _)| *name == cell)
                .map(|(_, scale)| *scale)
        };
        match (scale(DISPLACEMENTS, displacement), scale(FORCES, force)) {
            (Some(displacement), Some(force)) => Ok([displacement, force]),
            _ => Err(self.bad("the first line does not name the columns", HEADER)),
        }
    }

    fn numbers(&self) -> Result<[f64; 2], BadTable> {
        let [displacement, force] = self.cells()?;
        let number = |cell: &str| {
            let value: Option<f64> = cell.parse().ok();
            let help = "write a plain number, such as 0.0012 or 1.2e-3";
            value
                .filter(|value| value.is_finite())
                .ok_or_else(|| self.bad(&format!("`{cell}` is not a number"), help))
        };
        Ok([number(displacement)?, number(force)?])
    }

    /// Whether a point may follow the previous one.
    fn follows(
        &self,
        before: Option<&[f64; 2]>,
        [displacement, force]: [f64; 2],
    ) -> Result<(), BadTable> {
        if before.is_some_and(|[before, _]| displacement <= *before) {
            return Err(self.bad(
                "the displacement does not increase",
                "sort the rows, with one row per displacement",
            ));
        }
        if displacement == 0.0 && force != 0.0 {
            return Err(self.bad(
                "nonzero force at zero displacement",
                "subtract the zero reading of the load cell from every force",
            ));
        }
        if displacement * force < 0.0 {
            return Err(self.bad(
                "force and displacement have opposite signs",
                "reverse the sign of one column",
            ));
        }
        Ok(())
    }
}

fn whole(mut points: Vec<[f64; 2]>) -> Result<Vec<[f64; 2]>, BadTable> {
    if points.iter().all(|[_, force]| *force == 0.0) {
        let reason = "all forces are zero".to_owned();
        return Err(BadTable {
            row: None,
            reason,
            help: "add at least one point besides the origin",
        });
    }
    if points.iter().all(|[displacement, _]| *displacement != 0.0) {
        let after = points.partition_point(|[displacement, _]| *displacement < 0.0);
        points.insert(after, [0.0, 0.0]);
    }
    let mirrored = |points: &[[f64; 2]]| {
        points
            .iter()
            .rev()
            .map(|[x, force]| [-x, -force])
            .collect::<Vec<_>>()
    };
    if points[0][0] == 0.0 {
        points = [mirrored(&points[1..]), points].concat();
    } else if points[points.len() - 1][0] == 0.0 {
        let mirror = mirrored(&points[..points.len() - 1]);
        points.extend(mirror);
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_side_is_mirrored_and_two_are_used_unchanged() {
        let text = "# from the frame\r\ndisplacement_mm, force_kn\r\n1, 2\r\n\r\n3, 2.5\r\n";
        let found = points(text).unwrap();
        assert_eq!(
            found,
            [
                [-0.003, -2500.0],
                [-0.001, -2000.0],
                [0.0, 0.0],
                [0.001, 2000.0],
                [0.003, 2500.0]
            ]
        );
        let text = "displacement_m,force_n\n-0.002,-10\n0.001,20\n";
        assert_eq!(
            points(text).unwrap(),
            [[-0.002, -10.0], [0.0, 0.0], [0.001, 20.0]]
        );
        let text = "displacement_m,force_n\n-0.002,-10\n0,0";
        assert_eq!(
            points(text).unwrap(),
            [[-0.002, -10.0], [0.0, 0.0], [0.002, 10.0]]
        );
    }

    #[test]
    fn a_bad_row_is_named_with_its_position_and_reason() {
        for (text, line, reason) in [
            ("0,0\n1,2\n", 1, "name the columns"),
            (
                "displacement_m,force_n\n0.1,1\n0.1,2\n",
                3,
                "does not increase",
            ),
            (
                "displacement_m,force_n\n0.1;1\n",
                2,
                "two columns, this one has 1",
            ),
            (
                "displacement_m,force_n\n0.1,nan\n",
                2,
                "`nan` is not a number",
            ),
            ("displacement_m,force_n\n0.1,1e999\n", 2, "is not a number"),
            ("displacement_m,force_n\n0,3\n", 2, "at zero displacement"),
            ("displacement_m,force_n\n0.1,-3\n", 2, "opposite signs"),
        ] {
            let bad = points(text).unwrap_err();
            let (at, row) = bad.row.clone().expect("a row is to blame");
            assert!(at == line && bad.reason.contains(reason), "{text}: {bad:?}");
            assert_eq!(Some(row.as_str()), text.lines().nth(line - 1));
        }
        for text in [
            "",
            "# nothing\n",
            "displacement_m,force_n\n",
            "displacement_m,force_n\n0,0\n",
        ] {
            assert!(points(text).unwrap_err().row.is_none(), "{text}");
        }
    }
}
