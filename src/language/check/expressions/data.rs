//! Data files that a plan names: `file = "ground/quake.csv"`. In: the string and its span. Out: the file's
//! text, which then belongs to the plan like a used file. The block that names the file interprets it.

use std::sync::Arc;

use crate::check::checker::Checker;
use crate::check::imports::{MOST_FILES, refused, resolved};
use crate::check::violations::{FileMissing, TooManyFiles};
use crate::check::{LoadError, imports};
use crate::codes::{E501, E502};
use psd_plan::PlanFile;
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

use super::data_file::DataFile;

#[derive(Violation)]
#[violation(E502, "`{path}` cannot be read: {reason}")]
#[help("move the file into the plan's folder, or a folder in it")]
struct BadDataPath<'a> {
    path: &'a str,
    #[label("not in the plan's folder")]
    span: Span,
    reason: &'a str,
}

#[derive(Violation)]
#[violation(E501, "`{path}` cannot be read: {reason}")]
#[help("name a UTF-8 text file, or a picture, in the plan's folder")]
struct DataRefused<'a> {
    path: &'a str,
    reason: &'a str,
    #[label("cannot be read")]
    span: Span,
}

impl Checker<'_> {
    /// The text of the data file `written`, whose path is relative to the file that names it. Read once, however often it is
    /// requested.
    pub fn data_file(&mut self, written: &str, span: Span) -> Option<DataFile> {
        if let Some(reason) = refused(written) {
            return self.fail(BadDataPath {
                path: written,
                span,
                reason,
            });
        }
        let from = imports::own_path(self.sources, span.file);
        let name = resolved(&from, written);
        if let Some(known) = self.data.iter().find(|file| file.name == name) {
            return Some(known.clone());
        }
        if self.sources.iter().count() + self.data.len() >= MOST_FILES {
            return self.fail(TooManyFiles {
                most: MOST_FILES,
                span,
            });
        }
        match (self.loader)(&name) {
            Ok(text) => {
                let file = DataFile::new(name, text);
                self.data.push(file.clone());
                Some(file)
            }
            Err(LoadError::NotFound) => self.fail(FileMissing { path: &name, span }),
            Err(LoadError::Refused(reason)) => self.fail(DataRefused {
                path: &name,
                reason: &reason,
                span,
            }),
        }
    }

    /// The data files that the plan names, in the order of the requests, without those that it also uses as plans.
    pub fn data_files(&self) -> Vec<PlanFile> {
        let is_plan = |name: &str| self.sources.iter().any(|(_, file)| file.name == name);
        let named = self.data.iter().filter(|file| !is_plan(&file.name));
        named
            .map(|file| PlanFile {
                name: file.name.clone(),
                text: Arc::clone(&file.text),
            })
            .collect()
    }
}
