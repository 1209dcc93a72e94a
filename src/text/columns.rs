//! Aligned columns. In: rows of cells. Out: text with two spaces before and between columns.

/// Aligned rows, each ending with a newline. A row may be shorter than others.
pub fn columns(rows: &[Vec<String>]) -> String {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let length = |cell: &String| cell.chars().count();
    let widths: Vec<usize> = (0..count)
        .map(|column| {
            rows.iter()
                .filter_map(|row| row.get(column))
                .map(length)
                .max()
                .unwrap_or(0)
        })
        .collect();
    let mut text = String::new();
    for row in rows {
        let line = row
            .iter()
            .zip(&widths)
            .fold(String::new(), |line, (cell, width)| {
                format!("{line}  {cell:<width$}")
            });
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    #[test]
    fn columns_align_and_lines_end_with_words() {
        let rows = [
            vec!["a".to_owned(), "bb".to_owned()],
            vec!["–—ä".to_owned(), "c".to_owned()],
            vec!["d".to_owned()],
        ];
        assert_eq!(super::columns(&rows), "  a    bb\n  –—ä  c\n  d\n");
    }
}
