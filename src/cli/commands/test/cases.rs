//! The plans that are tested. In: paths as typed. Out: a case for each plan, in order of name, and the folders of accepted
//! results that none of them uses.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::TestArguments;
use super::shown;
use crate::exit::Failure;
use crate::files::accepted::AcceptedFolder;
use crate::files::failure::plain;
use crate::files::loader::is_stdin;
use crate::files::plans::{Depth, named};
use psd::golden::{DIAGNOSTICS, SUMMARY};

/// The default folder of plans.
const DEFAULT: &str = "plans";

/// One plan to test.
#[derive(Clone, Debug)]
pub struct Case {
    /// For example `plans/beam`.
    pub name: String,
    pub plan: PathBuf,
    pub golden: AcceptedFolder,
    /// The name of its folder among the failures: `beam`.
    pub folder: String,
}

/// The cases and unused folders.
#[derive(Debug)]
pub struct Cases {
    pub cases: Vec<Case>,
    pub unused: Vec<PathBuf>,
}

/// The named plans, and those in the named folders. Subfolders are libraries and are not searched.
pub fn find(arguments: &TestArguments) -> Result<Cases, Failure> {
    let default = [PathBuf::from(DEFAULT)];
    let paths = if arguments.paths.is_empty() {
        &default[..]
    } else {
        &arguments.paths[..]
    };
    if let Some(path) = paths.iter().find(|path| !is_stdin(path) && !path.exists()) {
        return Err(missing(path, arguments.paths.is_empty()));
    }
    let whole: Vec<&PathBuf> = paths.iter().filter(|path| path.is_dir()).collect();
    let mut plans = named(paths, Depth::Folder)?;
    plans.sort();
    let mut cases = Vec::new();
    for plan in plans {
        let golden = match &arguments.golden {
            Some(reports) => AcceptedFolder::within(reports, &plan)?,
            None => AcceptedFolder::of(&plan)?,
        };
        let name = plan.with_extension("").to_string_lossy().into_owned();
        let folder = plan
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        cases.push(Case {
            name,
            plan,
            golden,
            folder,
        });
    }
    refuse_shared_results(&cases)?;
    let unused = if arguments.filter.is_none() {
        unused(&whole, &cases, arguments.golden.as_deref())?
    } else {
        Vec::new()
    };
    if let Some(filter) = &arguments.filter {
        cases.retain(|case| case.name.contains(filter.as_str()));
    }
    if cases.is_empty() {
        let names: Vec<String> = paths
            .iter()
            .map(|path| path.display().to_string())
            .collect();
        let what = arguments
            .filter
            .as_ref()
            .map_or_else(String::new, |filter| {
                format!(" with `{filter}` in its name")
            });
        return Err(
            Failure::command_line(format!("no plan{what} in {}", names.join(", ")))
                .help("a plan is a `.psd` file, or a `.md` file with a `psd` block; `psd test --list` shows them"),
        );
    }
    give_distinct_names(&mut cases);
    Ok(Cases { cases, unused })
}

/// `beam.psd` and `beam.md`, or `a/beam.psd` and `b/beam.psd`, would have the same folder of accepted results.
fn refuse_shared_results(cases: &[Case]) -> Result<(), Failure> {
    let mut plans: BTreeMap<PathBuf, &Path> = BTreeMap::new();
    for case in cases {
        if let Some(other) = plans.insert(case.golden.absolute(), &case.plan) {
            return Err(Failure::command_line(format!(
                "{} and {} would share the accepted results in {}",
                other.display(),
                case.plan.display(),
                case.golden.path().display()
            ))
            .help("rename one of the two plans, or test them one after the other, each with its own `--golden`"));
        }
    }
    Ok(())
}

fn missing(path: &Path, is_default: bool) -> Failure {
    let failure = Failure::file(path, "no such file");
    if is_default {
        failure.help("name a plan, or a folder of plans")
    } else {
        failure
    }
}

/// Plans of the same name in different folders get separate folders of failures.
fn give_distinct_names(cases: &mut [Case]) {
    let names: Vec<String> = cases.iter().map(|case| case.folder.clone()).collect();
    for case in cases {
        if names.iter().filter(|name| **name == case.folder).count() > 1 {
            case.folder = case.name.replace(['/', '\\', ':'], "_");
        }
    }
}

/// Folders of accepted results that belong to no plan of a folder.
fn unused(
    folders: &[&PathBuf],
    cases: &[Case],
    golden: Option<&Path>,
) -> Result<Vec<PathBuf>, Failure> {
    let mut reports: Vec<PathBuf> = Vec::new();
    for folder in folders {
        let beside = shown(folder)
            .canonicalize()
            .ok()
            .and_then(|folder| Some(folder.parent()?.join("reports")));
        // As the operator would write it, if the folder of plans has a name.
        let typed = folder.parent().map(|above| shown(above).join("reports"));
        let typed = typed.filter(|typed| {
            typed.canonicalize().ok() == beside.as_ref().and_then(|path| path.canonicalize().ok())
        });
        reports.extend(golden.map(Path::to_owned).or(typed).or(beside));
    }
    reports.sort();
    reports.dedup();
    let used: BTreeSet<String> = cases
        .iter()
        .filter_map(|case| {
            Some(
                case.golden
                    .path()
                    .file_name()?
                    .to_string_lossy()
                    .into_owned(),
            )
        })
        .collect();
    let mut found = Vec::new();
    for reports in reports.into_iter().filter(|path| path.is_dir()) {
        let failed = |error: std::io::Error| Failure::file(&reports, plain(&error));
        for entry in std::fs::read_dir(&reports).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            let name = path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            let accepted = [SUMMARY, DIAGNOSTICS]
                .iter()
                .any(|file| path.join(file).is_file());
            if accepted && !name.starts_with('.') && !used.contains(&name) {
                found.push(path.strip_prefix("./").map(Path::to_owned).unwrap_or(path));
            }
        }
    }
    found.sort();
    Ok(found)
}
