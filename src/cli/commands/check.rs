//! `psd check`: all diagnostics of all plans, with those of a dry run and of every rig; nothing moves.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use crate::args::{Format, PlanSettings};
use crate::exit::{Exit, Failure};
use crate::files::loader::is_stdin;
use crate::files::plan_file;
use crate::files::plans::{Depth, named};
use crate::output::{clear_terminal, print_message, print_result};
use crate::settings::Settings;
use clap::Args;
use psd::check::{Checked, is_short};
use psd_language::codes::E106;
use psd_plan::Plan;
use psd_text::diagnostic::excerpt::one_line;
use psd_text::diagnostic::json;
use serde_json::{Value, json as object};

use super::explain_plan;

/// Time between two looks at the watched files.
const BETWEEN_LOOKS: Duration = Duration::from_millis(200);

/// The clock of a file system is coarser than that of the computer by less than this.
const CLOCK_STEP: Duration = Duration::from_millis(20);

#[derive(Debug, Args)]
pub struct CheckArguments {
    /// Plans, folders of plans, or `-` for standard input
    #[arg(value_name = "PLAN", required = true)]
    pub plans: Vec<PathBuf>,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// Predict the run by a dry run on an ideal virtual rig
    #[arg(long)]
    pub explain: bool,
    /// End with exit code 2 also if there are warnings only
    #[arg(long)]
    pub deny_warnings: bool,
    /// Check again whenever a file of a plan changes, until Ctrl-C
    #[arg(long, conflicts_with = "format")]
    pub watch: bool,
    /// Diagnostics as text on standard error, or JSON on standard output
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub format: Format,
}

/// Checks every plan, and with `--explain` prints the prediction of its run.
pub fn check(arguments: &CheckArguments, settings: Settings) -> Result<Exit, Failure> {
    if !arguments.watch {
        return once(arguments, settings, &mut Vec::new());
    }
    if arguments.plans.iter().any(|path| is_stdin(path)) {
        return Err(
            Failure::command_line("standard input does not change: it cannot be watched")
                .help("name the file of the plan"),
        );
    }
    loop {
        let mut files = Vec::new();
        let began = SystemTime::now() - CLOCK_STEP;
        // A folder without a plan, or a file that is missing now, can change too.
        if let Err(failure) = once(arguments, settings, &mut files) {
            print_message(&failure.report(settings));
        }
        files.extend(arguments.plans.iter().cloned());
        let before = stamps(&files);
        print_message(&settings.paint_note("watching for changes; Ctrl-C ends\n"));
        // A file that changed after the check had read it is checked once more.
        let changed_meanwhile = before.iter().flatten().any(|(_, at)| *at >= began);
        std::thread::sleep(BETWEEN_LOOKS);
        while !changed_meanwhile && stamps(&files) == before {
            std::thread::sleep(BETWEEN_LOOKS);
        }
        clear_terminal(settings);
    }
}

/// Size and time of the last change of each file; of a folder, of its list of files.
fn stamps(files: &[PathBuf]) -> Vec<Option<(u64, SystemTime)>> {
    let stamp = |path: &PathBuf| {
        let metadata = path.metadata().ok()?;
        Some((metadata.len(), metadata.modified().ok()?))
    };
    files.iter().map(stamp).collect()
}

/// Checks every plan once, and adds the files that were read to `files`.
fn once(
    arguments: &CheckArguments,
    settings: Settings,
    files: &mut Vec<PathBuf>,
) -> Result<Exit, Failure> {
    let mut exit = Exit::Met;
    // The document for an editor. A reader of text has had the same already.
    let is_json = arguments.format == Format::Json;
    let mut diagnostics = Vec::new();
    let mut predictions = Vec::new();
    let named = named(&arguments.plans, Depth::Below)?;
    let checked: Vec<_> = named
        .iter()
        .map(|path| plan_file::open_to_check(path, &arguments.plan_settings))
        .collect();
    let used = used(&named, &checked);
    let libraries: BTreeSet<&PathBuf> = used.iter().collect();
    files.extend(named.iter().chain(&used).cloned());
    for (path, checked) in named.iter().zip(checked) {
        if libraries.contains(path) && !arguments.plans.contains(path) {
            continue;
        }
        let mut prediction = Value::Null;
        match checked {
            Ok(checked) => {
                exit = exit.max(one(path, &checked, arguments, settings, &mut prediction)?);
                if is_json {
                    diagnostics.extend(plan_file::diagnostics(&checked, path));
                }
            }
            // A file that cannot be read does not stop the check of the others.
            Err(failure) => {
                print_message(&failure.report(settings));
                diagnostics.push(json::unreadable(
                    &path.display().to_string(),
                    &failure.to_string(),
                    failure.position().map(|at| (E106, at)),
                ));
                exit = exit.max(failure.exit());
            }
        }
        predictions.push(object!({ "plan": path.display().to_string(), "prediction": prediction }));
    }
    if is_json {
        print_result(&if arguments.explain {
            json::printed_with_predictions(&diagnostics, predictions)
        } else {
            json::printed_diagnostics(&diagnostics)
        })?;
    }
    Ok(exit)
}

/// The files that the plans use: a library is checked as a part of the plan that uses it.
fn used(named: &[PathBuf], checked: &[Result<Checked, Failure>]) -> Vec<PathBuf> {
    let plans = named.iter().zip(checked);
    let of_plan = plans.flat_map(|(path, checked)| {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let checked = checked.as_ref().ok();
        let sources = checked
            .into_iter()
            .flat_map(|checked| checked.sources.iter());
        // The first one is the plan itself.
        let sources = sources.skip(1).map(|(_, file)| file.name.clone());
        let plan = checked.and_then(|checked| checked.plan.as_ref());
        let data = plan.into_iter().flat_map(|plan| &plan.files).skip(1);
        let names = sources.chain(data.map(|file| file.name.clone()));
        names.map(move |name| folder.join(name)).collect::<Vec<_>>()
    });
    of_plan.collect()
}

/// Prints what was found in one plan, for a reader of text. With `--explain`, `prediction` becomes the predicted run as data.
fn one(
    path: &Path,
    checked: &Checked,
    arguments: &CheckArguments,
    settings: Settings,
    prediction: &mut Value,
) -> Result<Exit, Failure> {
    let human = arguments.format == Format::Human;
    if human {
        plan_file::show(checked, path, settings);
    }
    let Some(plan) = &checked.plan else {
        return Ok(Exit::Wrong);
    };
    // Without an error every diagnostic is a warning.
    let exit = if arguments.deny_warnings && !checked.diagnostics.is_empty() {
        Exit::Wrong
    } else {
        Exit::Met
    };
    if arguments.explain {
        let explained = explain_plan::Explained::of(plan);
        if human {
            print_result(&explained.text(settings))?;
        }
        *prediction = object!(explained.prediction());
        return Ok(exit.max(explained.exit()));
    }
    if human {
        let name = one_line(&path.display().to_string());
        let sound = settings.paint_note("no errors found in the plan");
        print_message(&format!("{name}: {sound}{}\n", without_dry_run(plan)));
    }
    Ok(exit)
}

/// The remark about a plan that is too long for a dry run.
fn without_dry_run(plan: &Plan) -> &'static str {
    if is_short(plan) {
        ""
    } else {
        " (too many steps for a dry run: `--explain` makes it)"
    }
}
