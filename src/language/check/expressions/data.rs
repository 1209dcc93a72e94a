//! Data files that a plan names: `record = "ground/quake.csv"`. In: the text in quotes and where it stands. Out: the file's
//! text, which from then on belongs to the plan as a used file does. What the text means is for the block that asked.

use std::sync::Arc;

use crate::language::check::checker::Checker;
use crate::language::check::imports::{MOST_FILES, refused, resolved};
use crate::language::check::messages::files as fault;
use crate::language::check::{LoadFault, imports};
use crate::plan::PlanFile;
use crate::text::source::Span;

/// A data file as it was read.
#[derive(Clone, Debug)]
pub struct DataFile {
    /// Relative to the plan's folder, with `/`.
    pub name: String,
    pub text: Arc<str>,
}

impl Checker<'_> {
    /// The text of the data file `written`, whose path is relative to the file that names it. Read once, however often it is
    /// asked for.
    pub fn data_file(&mut self, written: &str, span: Span) -> Option<DataFile> {
        if let Some(reason) = refused(written) {
            return self.fail(fault::bad_data_path(written, span, reason));
        }
        let from = imports::own_path(self.sources, span.file);
        let name = resolved(&from, written);
        if let Some(known) = self.data.iter().find(|file| file.name == name) {
            return Some(known.clone());
        }
        if self.sources.iter().count() + self.data.len() >= MOST_FILES {
            return self.fail(fault::too_many_files(MOST_FILES, span));
        }
        match self.loader.load(&name) {
            Ok(text) => {
                let file = DataFile {
                    name,
                    text: text.into(),
                };
                self.data.push(file.clone());
                Some(file)
            }
            Err(LoadFault::NotFound) => self.fail(fault::not_found(&name, span)),
            Err(LoadFault::Refused(reason)) => self.fail(fault::data_refused(&name, &reason, span)),
        }
    }

    /// The data files that the plan named, in the order they were asked for; not those that it uses as plans too.
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
