//! `psd check`: all diagnostics of all plans, with those of a dry run and of every rig; nothing moves.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::args::{Format, PlanSettings};
use crate::exit::{Exit, Failure};
use crate::files::plan_file;
use crate::files::plans::{Depth, named};
use crate::output::{print_message, print_result};
use crate::settings::Settings;
use clap::Args;
use psd::check::{Checked, is_short};
use psd_language::codes::E106;
use psd_plan::Plan;
use psd_text::diagnostic::excerpt::one_line;
use psd_text::diagnostic::json;
use serde_json::{Value, json as object};

use super::explain_plan;

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
    /// Diagnostics as text on standard error, or JSON on standard output
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub format: Format,
}

/// Checks every plan, and with `--explain` prints the prediction of its run.
pub fn check(arguments: &CheckArguments, settings: Settings) -> Result<Exit, Failure> {
    let mut exit = Exit::Met;
    let mut diagnostics = Vec::new();
    let mut predictions = Vec::new();
    let named = named(&arguments.plans, Depth::Below)?;
    let checked: Vec<_> = named
        .iter()
        .map(|path| plan_file::open_to_check(path, &arguments.plan_settings))
        .collect();
    let libraries = libraries(&named, &checked);
    for (path, checked) in named.iter().zip(checked) {
        if libraries.contains(path) && !arguments.plans.contains(path) {
            continue;
        }
        let mut prediction = Value::Null;
        match checked {
            Ok(checked) => {
                exit = exit.max(one(path, &checked, arguments, settings, &mut prediction)?);
                diagnostics.extend(plan_file::diagnostics(&checked, path));
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
    if arguments.format == Format::Json {
        print_result(&if arguments.explain {
            json::text_with_predictions(&diagnostics, predictions)
        } else {
            json::text(&diagnostics)
        })?;
    }
    Ok(exit)
}

/// The files that another of the plans uses: they are checked as a part of it.
fn libraries(named: &[PathBuf], checked: &[Result<Checked, Failure>]) -> BTreeSet<PathBuf> {
    let plans = named.iter().zip(checked);
    let of_plan = plans.flat_map(|(path, checked)| {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let files = checked.iter().flat_map(|checked| checked.sources.iter());
        // The first one is the plan itself.
        files.skip(1).map(move |(_, file)| folder.join(&file.name))
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
