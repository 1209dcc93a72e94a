//! A data file of a plan, as it was read.

use std::sync::{Arc, OnceLock};

use crate::check::declarations::ground::record::{self, GroundRecord};

/// A data file as it was read.
#[derive(Clone, Debug)]
pub struct DataFile {
    /// Relative to the plan's folder, with `/`.
    pub name: String,
    pub text: Arc<str>,
    /// The ground motion in it, once it was requested.
    ground: Arc<OnceLock<Result<GroundRecord, String>>>,
}

impl DataFile {
    pub fn new(name: String, text: String) -> Self {
        Self {
            name,
            text: text.into(),
            ground: Arc::default(),
        }
    }

    /// The ground motion in it, read once for all runs of a study.
    ///
    /// # Errors
    /// The reason why the text is not read.
    pub fn ground(&self) -> Result<&GroundRecord, &str> {
        let read = || record::read(&self.name, &self.text);
        self.ground
            .get_or_init(read)
            .as_ref()
            .map_err(String::as_str)
    }
}
