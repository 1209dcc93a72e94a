//! What `psd check --explain` prints of a procedure. In: rows of text. Out: parts, each with its heading.

/// A part of the prediction of a procedure; nothing is printed of one without rows.
pub struct Predicted {
    pub heading: String,
    pub rows: Vec<Vec<String>>,
}

impl Predicted {
    pub(crate) const fn new(heading: String, rows: Vec<Vec<String>>) -> Self {
        Self { heading, rows }
    }
}

/// A row of a name and its value.
pub(crate) fn row(name: &str, value: String) -> Vec<String> {
    vec![name.to_owned(), value]
}
