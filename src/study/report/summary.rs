//! `summary.json` of a study: schema `psd.study/1`, SI, stable order. In: metadata and answers. Out: the file.

use serde::Serialize;

use crate::study::answers::Answers;
use crate::study::data_set::Metadata;
use psd_text::sanitize;

/// Name and version of the format; a change that breaks a reader raises the number.
pub const SCHEMA: &str = "psd.study/1";

/// The file.
#[derive(Serialize)]
struct Summary<'a> {
    schema: &'static str,
    /// The metadata of the data set.
    study: &'a Metadata,
    answers: &'a Answers,
}

/// The summary as JSON.
#[must_use]
pub fn summary(metadata: &Metadata, answers: &Answers) -> String {
    sanitize::json_file(&Summary {
        schema: SCHEMA,
        study: metadata,
        answers,
    })
}
