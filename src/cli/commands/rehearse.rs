//! `psd run --rehearse`: the low-level check run. It makes the pre-test check and the leading stiffness ramps on the rig, with a run log.
//! The rest runs on a simulated specimen with the measured stiffness. In: a checked plan. Out: a run folder marked as a rehearsal, and
//! the predicted margin of the whole run to each limit.

use super::explain_plan::DryRun;
use super::on_rig::{Ran, on_its_rig};
use super::prediction::told;
use crate::cli::args::{Format, RunArguments};
use crate::cli::exit::{Exit, Failure};
use crate::cli::files::finish_run::{finish_run, summary};
use crate::cli::operator::watch::Attendance;
use crate::cli::output::{print_message, print_result};
use crate::cli::settings::Settings;
use crate::plan::Plan;
use crate::run::rehearsal;

/// Measures and predicts; the exit code states whether every limit is predicted to be satisfied.
pub fn rehearse(
    plan: &Plan,
    arguments: &RunArguments,
    attendance: &Attendance,
    settings: Settings,
) -> Result<Exit, Failure> {
    let part = rehearsal::measured_part(plan)?;
    let ran = on_its_rig(&part, arguments, attendance, settings)?;
    if let Some(exit) = ran.goes_on(&part, attendance, settings)? {
        return Ok(exit);
    }
    let Ran {
        folder,
        provenance,
        recorded,
        ..
    } = ran;
    let exit = finish_run(folder.path(), &part, &provenance, &recorded, settings)?;
    let predicted = if exit <= Exit::Missed {
        let stand_in = rehearsal::prediction(plan, &recorded.record)?;
        let dry = DryRun::on(plan, &stand_in, told(plan, &stand_in));
        let text = dry.text(settings);
        match arguments.format {
            Format::Human => print_result(&text)?,
            Format::Json => print_message(&text),
        }
        dry.exit()
    } else {
        print_message("  no prediction: the rehearsal itself did not come to its end\n");
        exit
    };
    match arguments.format {
        Format::Human => print_result(&format!("{}\n", folder.path().display()))?,
        Format::Json => print_result(&summary(folder.path(), &recorded.record)?)?,
    }
    Ok(exit.max(predicted))
}
