//! `mass_matrix = "m.csv"`: a square table of numbers without a header, one row per line. In: the text. Out: a symmetric, positive
//! definite matrix, or the row and column of an error, and the reason. It knows no plan.

use psd_plan::MOST_STOREYS;

/// Relative difference within which two mirrored entries are equal: the last digits of the program that wrote the file.
const SYMMETRIC: f64 = 1e-9;

/// The matrix in `text`; blank lines and lines that begin with `#` are ignored.
pub fn read(text: &str) -> Result<Vec<Vec<f64>>, String> {
    let matrix = read_symmetric(text)?;
    positive_definite(&matrix)?;
    Ok(matrix)
}

/// The same of a matrix that is symmetric alone.
pub fn read_symmetric(text: &str) -> Result<Vec<Vec<f64>>, String> {
    let written = (1..)
        .zip(text.lines())
        .filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'));
    let mut matrix = Vec::new();
    for (line, row) in written {
        if matrix.len() == MOST_STOREYS {
            return Err(format!("more than {MOST_STOREYS} rows"));
        }
        matrix.push(numbers(line, row)?);
    }
    square(&matrix)?;
    symmetric(&mut matrix)?;
    Ok(matrix)
}

/// The reason why it is not.
pub fn positive_definite(matrix: &[Vec<f64>]) -> Result<(), String> {
    match first_pivot_that_is_not_positive(matrix) {
        Some(row) => Err(format!(
            "not positive definite: the determinant of the first {} rows and columns is not positive",
            row + 1
        )),
        None => Ok(()),
    }
}

fn numbers(line: usize, row: &str) -> Result<Vec<f64>, String> {
    let number = |(column, cell): (usize, &str)| match cell.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!(
            "line {line}, column {column}: `{}` is not a finite number",
            cell.trim()
        )),
    };
    (1..).zip(row.split(',')).map(number).collect()
}

fn square(matrix: &[Vec<f64>]) -> Result<(), String> {
    let rows = matrix.len();
    if rows == 0 {
        return Err("the file has no numbers".to_owned());
    }
    match (1..).zip(matrix).find(|(_, row)| row.len() != rows) {
        Some((number, row)) => Err(format!(
            "not square: {rows} rows, but row {number} has {} columns",
            row.len()
        )),
        None => Ok(()),
    }
}

/// Makes mirrored entries equal.
fn symmetric(matrix: &mut [Vec<f64>]) -> Result<(), String> {
    let pairs = (0..matrix.len()).flat_map(|row| (0..row).map(move |column| (row, column)));
    for (row, column) in pairs {
        let (below, above) = (matrix[row][column], matrix[column][row]);
        if (below - above).abs() > SYMMETRIC * below.abs().max(above.abs()) {
            let (row, column) = (row + 1, column + 1);
            return Err(format!(
                "not symmetric: row {row}, column {column} is {below}, but row {column}, column {row} is {above}"
            ));
        }
        matrix[row][column] = above;
    }
    Ok(())
}

/// Cholesky factorisation up to the first row whose pivot is not above its rounding error; returns that row.
fn first_pivot_that_is_not_positive(matrix: &[Vec<f64>]) -> Option<usize> {
    let mut factor = matrix.to_vec();
    for row in 0..matrix.len() {
        for column in 0..=row {
            let products = (0..column)
                .map(|k| factor[row][k] * factor[column][k])
                .sum::<f64>();
            let rest = matrix[row][column] - products;
            if row == column {
                if rest <= 1e-12 * matrix[row][row].abs() {
                    return Some(row);
                }
                factor[row][row] = rest.sqrt();
            } else {
                factor[row][column] = rest / factor[column][column];
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::read;

    #[test]
    fn a_symmetric_positive_definite_matrix_is_read() {
        let read = read("# N/m\n5e6, -2e6\n-2e6, 2e6\n\n").unwrap();
        assert_eq!(read, [[5e6, -2e6], [-2e6, 2e6]]);
    }

    #[test]
    fn every_other_is_refused_with_its_row_and_column() {
        for (text, reason) in [
            ("", "the file has no numbers"),
            ("1, 2\n2", "row 2 has 1 columns"),
            ("1, 2, 3\n2, 1, 3", "2 rows, but row 1 has 3 columns"),
            ("2, -1\n-1, x", "line 2, column 2: `x`"),
            ("2, nan\n-1, 1", "line 1, column 2: `nan`"),
            (
                "2, -1\n-1.1, 2",
                "row 2, column 1 is -1.1, but row 1, column 2 is -1",
            ),
            ("1, -1\n-1, 1", "the first 2 rows"),
            ("-1", "the first 1 rows"),
            ("1, 0, 0\n0, 1, 2\n0, 2, 1", "the first 3 rows"),
        ] {
            let refused = read(text).unwrap_err();
            assert!(refused.contains(reason), "{text:?}: {refused}");
        }
        assert!(
            read(&"1\n".repeat(65))
                .unwrap_err()
                .contains("more than 64 rows")
        );
    }

    #[test]
    fn the_last_digits_of_a_writer_are_no_asymmetry() {
        let read = read("2, -1\n-1.0000000000001, 2").unwrap();
        assert_eq!(read[0][1].to_bits(), read[1][0].to_bits());
    }
}
