//! `psd lsp`: the language server over standard input and output. In: messages of an editor. Out: answers. It gives the server the check
//! of a plan, its dry run, and the files beside it. It opens no rig.

use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use psd_lsp::{Ended, Program, SimulatedRequirement, SimulatedResult, Simulation};

use super::explain_plan::DryRun;
use crate::exit::{Exit, Failure};
use crate::files::failure::plain;
use crate::files::loader::{FolderLoader, read_plan};
use crate::files::plans;
use crate::settings::today;
use psd::check::{LoadError, Loader, Options, check};
use psd::procedures::most_steps;
use psd_plan::Plan;

/// Most entries of a folder of the editor that are looked at: it may be a home folder.
const MOST_ENTRIES: usize = 20_000;

/// Serves an editor until it ends the conversation.
pub fn lsp() -> Result<Exit, Failure> {
    let ended = psd_lsp::serve(
        BufReader::new(std::io::stdin()),
        std::io::stdout(),
        Arc::new(Commands),
    );
    match ended.map_err(|error| Failure::file("standard output", plain(&error)))? {
        Ended::InOrder => Ok(Exit::Met),
        Ended::Abruptly => Ok(Exit::Missed),
    }
}

/// The program as the server needs it.
struct Commands;

impl Program for Commands {
    fn check(&self, name: &str, text: &str, loader: &Loader<'_>) -> psd_lsp::Checked {
        let options = Options {
            today: Some(today()),
            ..Options::default()
        };
        let checked = check(name, text, loader, &options);
        psd_lsp::Checked {
            plan: checked.plan,
            diagnostics: checked.diagnostics,
            sources: checked.sources,
        }
    }

    fn simulate(&self, plan: &Plan) -> Simulation {
        let dry = DryRun::of(plan);
        let procedures = dry.record().procedures.iter().map(|procedure| {
            let results = procedure.results.iter().filter_map(|result| {
                Some(SimulatedResult {
                    name: result.name,
                    value: result.value.number()?,
                    dimension: result.dimension,
                })
            });
            (procedure.name.clone(), results.collect())
        });
        let requirements = dry.assessment().requirements.iter();
        Simulation {
            stopped: dry.stopped(),
            procedures: procedures.collect(),
            requirements: requirements
                .map(|one| SimulatedRequirement {
                    label: one.label.clone(),
                    verdict: one.verdict.name(),
                    values: one
                        .conditions
                        .iter()
                        .map(|condition| (condition.value, condition.dimension))
                        .collect(),
                })
                .collect(),
        }
    }

    fn steps(&self, plan: &Plan) -> u64 {
        let procedures = plan.procedures.iter();
        procedures
            .filter_map(|procedure| most_steps(&procedure.kind, plan))
            .fold(0, u64::saturating_add)
    }

    fn load(&self, plan: &Path, file: &str) -> Result<String, LoadError> {
        // A plan that was never saved has no folder yet.
        let folder = FolderLoader::beside(plan).map_err(|_| LoadError::NotFound)?;
        folder.load(file)
    }

    fn plans(&self, folder: &Path) -> Vec<PathBuf> {
        let mut found = Vec::new();
        // What was found before a folder that cannot be read is known all the same.
        let _ = plans::below(folder, MOST_ENTRIES, &mut found);
        found
    }

    fn read(&self, plan: &Path) -> Option<String> {
        read_plan(plan).ok()
    }
}
