//! A plan on disk, read and checked, for `run` and `check`. In: a path. Out: the checked plan; its diagnostics are printed.

use std::path::Path;

use serde_json::Value;

use super::loader::{FolderLoader, STDIN_PLAN, is_stdin, read_plan};
use crate::args::PlanSettings;
use crate::files::failure::Failure;
use crate::output::print_message;
use crate::settings::{Settings, folder_of, today};
use psd::check::{Checked, Options, ParsedPlan};
use psd_text::diagnostic::{Diagnostic, json, render};
use psd_text::source::{Position, Span};

/// Reads and checks a plan. Inside the program it has the name of its file; its folder is not recorded.
pub fn open(path: &Path, settings: &PlanSettings) -> Result<Checked, Failure> {
    open_to_run(path, settings, false)
}

/// [`open`] without a run: the plan is also run on an ideal copy of its rig, if that takes milliseconds, and checked on each rig that
/// it declares, unless the command line names one.
pub fn open_to_check(path: &Path, settings: &PlanSettings) -> Result<Checked, Failure> {
    let options = Options {
        dry_run: true,
        ..Options::default()
    };
    let text = read_plan(path)?;
    let (_, mut checked) = parsed(path, &text, settings, &options)?;
    if settings.rig.is_some() {
        return Ok(checked);
    }
    let own = checked.plan.as_ref().map(|plan| plan.rig.name.clone());
    let others = checked.rigs.clone().into_iter();
    for rig in others.filter(|rig| Some(rig) != own.as_ref()) {
        let named = PlanSettings {
            rig: Some(rig.clone()),
            ..settings.clone()
        };
        let (_, on_rig) = parsed(path, &text, &named, &options)?;
        for mut found in on_rig.diagnostics {
            let known =
                |known: &Diagnostic| known.code == found.code && known.span() == found.span();
            if checked.diagnostics.iter().any(known) {
                continue;
            }
            if !found.message.contains(&format!("`{rig}`")) {
                found.message = format!("{} (with `--rig {rig}`)", found.message);
            }
            if found.is_error() {
                checked.plan = None;
            }
            checked.diagnostics.push(found);
        }
    }
    checked
        .diagnostics
        .sort_by_key(|found| found.span().map(|span| (span.file, span.start, span.end)));
    Ok(checked)
}

/// [`open`] before a run; `unattended` if no operator is named and none can be asked.
pub fn open_to_run(
    path: &Path,
    settings: &PlanSettings,
    unattended: bool,
) -> Result<Checked, Failure> {
    let options = Options {
        unattended,
        ..Options::default()
    };
    parsed(path, &read_plan(path)?, settings, &options).map(|(_, checked)| checked)
}

/// [`open`] before the studies of the plan are run, with the syntax trees, which a study binds to other values.
pub fn open_for_studies(
    path: &Path,
    settings: &PlanSettings,
) -> Result<(ParsedPlan, Checked), Failure> {
    let options = Options {
        for_studies: true,
        ..Options::default()
    };
    parsed(path, &read_plan(path)?, settings, &options)
}

fn parsed(
    path: &Path,
    text: &str,
    settings: &PlanSettings,
    options: &Options,
) -> Result<(ParsedPlan, Checked), Failure> {
    for (at, (name, _)) in settings.set.iter().enumerate() {
        if settings.set[..at].iter().any(|(before, _)| before == name) {
            return Err(
                Failure::command_line(format!("`--set {name}` is given twice"))
                    .help("give it once, with the intended value"),
            );
        }
    }
    let folder = FolderLoader::beside(path)?;
    let loader = |file: &str| folder.load(file);
    let (rig, set, date) = (
        settings.rig.clone(),
        settings.set.clone(),
        settings.date.clone(),
    );
    let options = Options {
        rig,
        settings: set,
        today: Some(date.clone().unwrap_or_else(today)),
        date,
        ..options.clone()
    };
    let mut parsed = ParsedPlan::parse(&name_of(path), text, &loader, &options);
    let checked = parsed.check(&loader);
    Ok((parsed, checked))
}

/// Prints the diagnostics for the operator.
pub fn show(checked: &Checked, path: &Path, settings: Settings) {
    print_message(&render::render_all(
        &checked.diagnostics,
        &checked.sources,
        &settings.appearance(path),
    ));
}

/// The diagnostics as JSON, for an editor.
pub fn diagnostics(checked: &Checked, path: &Path) -> Vec<Value> {
    let (name, folder) = (name_of(path), folder_of(path));
    checked
        .diagnostics
        .iter()
        .map(|found| json::diagnostic(found, &checked.sources, &name, &folder))
        .collect()
}

/// The position in the plan of a rig that cannot be opened: the field with the port that the fault names.
pub fn location_of_link(checked: &Checked, path: &Path, fault: &str) -> Option<String> {
    let text = |span: &Span| {
        checked
            .sources
            .file(span.file)
            .text
            .get(span.range())
            .unwrap_or_default()
    };
    let quoted = |text: &str| {
        text.split('"')
            .skip(1)
            .step_by(2)
            .any(|word| !word.is_empty() && fault.contains(word))
    };
    let links = &checked.rig_links;
    let span = *links
        .iter()
        .find(|span| quoted(text(span)))
        .or(links.first())?;
    let Position { line, column } = checked.sources.position(span);
    let file = &checked.sources.file(span.file).name;
    let written: Vec<&str> = text(&span)
        .lines()
        .next()
        .unwrap_or_default()
        .split_whitespace()
        .collect();
    let written = written.join(" ");
    Some(format!(
        "{}{file}:{line}:{column}: {written}",
        folder_of(path)
    ))
}

/// The name of a plan's file, without its folder.
pub fn name_of(path: &Path) -> String {
    if is_stdin(path) {
        return STDIN_PLAN.to_owned();
    }
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}
