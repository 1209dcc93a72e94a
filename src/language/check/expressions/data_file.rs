//! A data file of a plan, as it was read.

use std::sync::Arc;

/// A data file as it was read.
#[derive(Clone, Debug)]
pub struct DataFile {
    /// Relative to the plan's folder, with `/`.
    pub name: String,
    pub text: Arc<str>,
}
