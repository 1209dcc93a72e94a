//! `psd run`: check → run → verdict → files. Nothing moves while an error stands, and nothing moves before there is a
//! folder to keep the record in.

use super::args::{Format, RunArguments};
use super::bless::BlessedFolder;
use super::exit::{Exit, Failure};
use super::output::{give, tell};
use super::run_folder::RunFolder;
use super::settings::Settings;
use super::watch::{Attendance, Watcher};
use super::{plan_file, provenance};
use crate::diagnostic::json;
use crate::output::{self, OutputFile, Run};
use crate::rig::{Rig as _, VirtualRig, Wish};
use crate::{run as runner, verdict};

/// Runs one plan.
pub fn run(arguments: &RunArguments, settings: Settings) -> Result<Exit, Failure> {
    let checked = plan_file::open(&arguments.plan, &arguments.plan_settings)?;
    plan_file::show(&checked, &arguments.plan, settings);
    let Some(plan) = &checked.plan else {
        if arguments.format == Format::Json {
            give(&format!("{:#}\n", json::document(&plan_file::diagnostics(&checked, &arguments.plan))))?;
        }
        return Ok(Exit::Wrong);
    };
    let blessed = arguments.bless.then(|| BlessedFolder::of(&arguments.plan)).transpose()?;
    let mut rig = VirtualRig::of_plan(plan);
    let attendance = Attendance { yes: arguments.yes, operator: arguments.operator.clone() };
    let simulated = rig.identity().simulated;
    let mut watcher = Watcher::new(settings, &attendance, plan, simulated, Wish::default()).map_err(Failure::Signals)?;
    let folder = RunFolder::create(arguments.out.as_deref(), &arguments.plan)?;

    let record = runner::run(plan, &mut rig, &mut watcher);
    watcher.finish();

    let assessment = verdict::assess(plan, &record);
    let provenance = provenance::of(plan);
    let run = Run { plan, record: &record, assessment: &assessment, provenance: &provenance };
    tell(&output::console::verdict_text(&run, settings.color));
    let files = output::everything(&run)?;
    folder.write(&files)?;
    let exit = Exit::from(assessment.verdict);
    if let Some(blessed) = blessed {
        if exit <= Exit::Missed {
            blessed.replace(&files)?;
            tell(&format!("  blessed {}\n", blessed.path().display()));
        } else {
            tell("  not blessed: the run did not come to its end\n");
        }
    }
    match arguments.format {
        Format::Human => give(&format!("{}\n", folder.path().display()))?,
        Format::Json => give(&String::from_utf8_lossy(summary(&files)))?,
    }
    Ok(exit)
}

fn summary(files: &[OutputFile]) -> &[u8] {
    files.iter().find(|file| file.path == "summary.json").map_or(&[], |file| &file.bytes)
}
