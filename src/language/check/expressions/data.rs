//! Data files that a plan names: `file = "ground/quake.csv"`. In: the string and its span. Out: the file's
//! text, which then belongs to the plan like a used file. The block that names the file interprets it.

use super::data_file::DataFile;
use crate::check::checker::Checker;
use crate::check::imports::{MOST_FILES, refused, resolved};
use crate::check::messages::files as message;
use crate::check::{LoadError, imports};
use psd_plan::PlanFile;
use psd_text::source::Span;

impl Checker<'_> {
    /// The text of the data file `written`, whose path is relative to the file that names it. Read once, however often it is
    /// requested.
    pub fn data_file(&mut self, written: &str, span: Span) -> Option<DataFile> {
        if let Some(reason) = refused(written) {
            return self.fail(message::bad_data_path(written, span, reason));
        }
        let from = imports::own_path(self.sources, span.file);
        let name = resolved(&from, written);
        if let Some(known) = self.data.iter().find(|file| file.name == name) {
            return Some(known.clone());
        }
        if self.sources.iter().count() + self.data.len() >= MOST_FILES {
            return self.fail(message::too_many_files(MOST_FILES, span));
        }
        match (self.loader)(&name) {
            Ok(text) => {
                let file = DataFile {
                    name,
                    text: text.into(),
                };
                self.data.push(file.clone());
                Some(file)
            }
            Err(LoadError::NotFound) => self.fail(message::not_found(&name, span)),
            Err(LoadError::Refused(reason)) => {
                self.fail(message::data_refused(&name, &reason, span))
            }
        }
    }

    /// The data files that the plan names, in the order of the requests, without those that it also uses as plans.
    pub fn data_files(&self) -> Vec<PlanFile> {
        let is_plan = |name: &str| self.sources.iter().any(|(_, file)| file.name == name);
        let named = self.data.iter().filter(|file| !is_plan(&file.name));
        named
            .map(|file| PlanFile {
                name: file.name.clone(),
                text: file.text.to_string(),
            })
            .collect()
    }
}
