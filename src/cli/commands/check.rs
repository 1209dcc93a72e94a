//! `psd check`: all diagnostics of all plans; nothing moves.

use std::path::PathBuf;

use crate::args::{Format, PlanSettings};
use crate::exit::{Exit, Failure};
use crate::files::plan_file;
use crate::output::{print_message, print_result};
use crate::settings::Settings;
use clap::Args;
use psd_language::codes::E106;
use psd_text::diagnostic::excerpt::one_line;
use psd_text::diagnostic::json;

use super::explain_plan;

#[derive(Debug, Args)]
pub struct CheckArguments {
    /// The plans, `.psd` files or Markdown documents
    #[arg(value_name = "PLAN", required = true)]
    pub plans: Vec<PathBuf>,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// Predict the run by a dry run on an ideal virtual rig
    #[arg(long)]
    pub explain: bool,
    /// Diagnostics as text on standard error, or JSON on standard output
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub format: Format,
}

/// Checks every plan, and with `--explain` prints the prediction of its run.
pub fn check(arguments: &CheckArguments, settings: Settings) -> Result<Exit, Failure> {
    let mut exit = Exit::Met;
    let mut found = Vec::new();
    for path in &arguments.plans {
        let checked = match plan_file::open(path, &arguments.plan_settings) {
            Ok(checked) => checked,
            // A file that cannot be read does not stop the check of the others.
            Err(failure) => {
                print_message(&failure.report(settings));
                found.push(json::unreadable(
                    &path.display().to_string(),
                    &failure.to_string(),
                    failure.position().map(|at| (E106, at)),
                ));
                exit = exit.max(failure.exit());
                continue;
            }
        };
        match arguments.format {
            Format::Human => plan_file::show(&checked, path, settings),
            Format::Json => found.extend(plan_file::diagnostics(&checked, path)),
        }
        let Some(plan) = &checked.plan else {
            exit = exit.max(Exit::Wrong);
            continue;
        };
        if arguments.explain {
            let dry = explain_plan::Explained::of(plan);
            exit = exit.max(dry.exit());
            match arguments.format {
                Format::Human => print_result(&dry.text(settings))?,
                Format::Json => print_message(&dry.text(settings)),
            }
        } else if arguments.format == Format::Human {
            let name = one_line(&path.display().to_string());
            print_message(&format!(
                "{name}: {}\n",
                settings.paint_note("no errors found in the plan")
            ));
        }
    }
    if arguments.format == Format::Json {
        print_result(&json::text(&found))?;
    }
    Ok(exit)
}
