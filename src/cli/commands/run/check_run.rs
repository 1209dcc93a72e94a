//! `psd run --check-run`: the low-level check run. It makes the pre-test check and the leading stiffness ramps on the rig, with a run log.
//! The rest runs on a simulated specimen with the measured stiffness. In: a checked plan. Out: a run folder marked as a check run, and
//! the predicted margin of the whole run to each limit.

use super::on_rig::{End, on_its_rig};
use super::{Done, Job};
use crate::args::Format;
use crate::commands::explain_plan::DryRun;
use crate::commands::prediction::rig_and_specimen;
use crate::exit::{Exit, Failure};
use crate::operator::watch::Attendance;
use crate::output::{print_message, print_result};
use crate::settings::Settings;
use psd::run::check_run;
use psd_plan::Plan;

/// Measures and predicts; the exit code states whether every limit is predicted to be satisfied.
pub fn check_run(
    plan: &Plan,
    job: &Job<'_>,
    attendance: &Attendance,
    settings: Settings,
) -> Result<Done, Failure> {
    let part = check_run::measured_part(plan)?;
    let ran = on_its_rig(&part, job, attendance, settings)?;
    let finished = match ran.finish(&part, attendance, settings)? {
        End::Resumed(exit) => return Ok(exit.into()),
        End::Finished(finished) => finished,
    };
    let exit = finished.exit;
    let predicted = if exit <= Exit::Missed {
        let stand_in = check_run::prediction(plan, &finished.recorded.record)?;
        let dry = DryRun::on(plan, &stand_in, rig_and_specimen(plan, &stand_in));
        let text = dry.text(settings);
        match job.arguments.format {
            Format::Human => print_result(&text)?,
            Format::Json => print_message(&text),
        }
        dry.exit()
    } else {
        print_message("  no prediction: the check run was not completed\n");
        exit
    };
    finished.print(job.arguments.format)?;
    Ok(Done {
        exit: exit.max(predicted),
        folder: Some(finished.folder.path().to_owned()),
    })
}
