//! The program of the tests: files in memory, and the check of the language without that of the procedures. Its simulation is one fixed
//! answer.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use psd_language::check::checker::Checker;
use psd_language::check::scope::Scope;
use psd_language::check::{LoadError, Loader, declarations, imports};
use psd_plan::Plan;
use psd_plan::schema::Kind;
use psd_text::diagnostic::Diagnostic;
use psd_text::source::Sources;
use psd_text::units::Dimension;

use crate::{Checked, Program, SimulatedRequirement, SimulatedResult, Simulation};

/// A name of a `let` at which the check panics, as a fault of the program would.
pub const PANICS: &str = "let panics = 1";

/// Files by their absolute paths.
pub struct Files(pub BTreeMap<PathBuf, String>);

impl Program for Files {
    fn check(&self, name: &str, text: &str, loader: &Loader<'_>) -> Checked {
        assert!(!text.contains(PANICS), "a fault of the program");
        let mut sources = Sources::default();
        let mut errors = Vec::new();
        let imports = imports::load(name, text, loader, &mut sources, &mut errors);
        let settings = BTreeMap::new();
        let unread = errors.iter().filter_map(Diagnostic::span).collect();
        let scope = Scope::collect(&imports.asts, &settings, &mut errors);
        let mut checker =
            Checker::new(&sources, &scope, loader, errors, unread, imports.incomplete);
        for block in 0..scope.blocks.len() {
            checker.entries_of(block);
            for entry in 0..scope.blocks[block].block.fields.len() {
                let declared = &scope.blocks[block];
                let field = declared.kind.field(&declared.block.fields[entry].key.node);
                if declared.kind.is_procedure() && field.is_some_and(|field| field.ty.is_numeric())
                {
                    let span = declared.block.fields[entry].span;
                    checker.entry(block, entry, span);
                }
            }
            match scope.blocks[block].kind.kind {
                Kind::Specimen => drop(declarations::specimen::specimen(&mut checker, block)),
                Kind::Striker => drop(declarations::striker::striker(&mut checker, block)),
                _ => {}
            }
        }
        for index in 0..scope.values.len() {
            checker.parameter(index);
        }
        checker.requirements();
        let mut diagnostics = checker.diagnostics;
        diagnostics.sort_by_key(|found| found.span().map(|span| (span.file, span.start)));
        let is_valid = !diagnostics.iter().any(Diagnostic::is_error);
        Checked {
            plan: is_valid.then(super::testing::plans::empty_plan),
            diagnostics,
            sources,
        }
    }

    fn simulate(&self, _: &Plan) -> Simulation {
        let result = |name, value, dimension| SimulatedResult {
            name,
            value,
            dimension,
        };
        Simulation {
            stopped: None,
            procedures: vec![(
                "hit".to_owned(),
                vec![
                    result("max_displacement", 0.0081, Dimension::LENGTH),
                    result("critical_time_step", 0.000_35, Dimension::TIME),
                ],
            )],
            requirements: vec![SimulatedRequirement {
                label: "stays in travel".to_owned(),
                verdict: "pass",
                values: vec![(Some(0.0081), Dimension::LENGTH)],
            }],
        }
    }

    fn steps(&self, _: &Plan) -> u64 {
        0
    }

    fn load(&self, plan: &Path, file: &str) -> Result<String, LoadError> {
        let path = plan.parent().unwrap_or(plan).join(file);
        self.read(&path).ok_or(LoadError::NotFound)
    }

    fn plans(&self, folder: &Path) -> Vec<PathBuf> {
        let below = self.0.keys().filter(|path| path.starts_with(folder));
        below.cloned().collect()
    }

    fn read(&self, plan: &Path) -> Option<String> {
        self.0.get(plan).cloned()
    }
}
