//! `psd run --rehearse`: pre-test check and leading stiffness ramps on the rig, recorded; then the rest on a virtual specimen
//! with the measured stiffness. In: a checked plan. Out: a run folder marked as a rehearsal, and the predicted margin of the
//! whole run to each limit.

use super::explain_plan::DryRun;
use super::run::{Ran, on_its_rig};
use crate::cli::args::{Format, RunArguments};
use crate::cli::exit::{Exit, Failure};
use crate::cli::files::finish_run::{finish_run, summary};
use crate::cli::operator::watch::Attendance;
use crate::cli::output::{print_message, print_result};
use crate::cli::settings::Settings;
use crate::plan::{Behaviour, Frame, Plan};
use crate::record::{Outcome, Record};
use crate::report::Prediction;
use crate::rig::VirtualRig;
use crate::run::rehearsal;
use crate::text::diagnostic::excerpt::escape;
use crate::units::Dimension;
use crate::units::display::readable;

/// Measures and predicts; the exit code states whether every limit would be kept.
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

/// The prediction of the whole run from the record of a rehearsal; None for any other run and for an incomplete rehearsal.
pub fn prediction(part: &Plan, record: &Record) -> Option<Prediction> {
    let plan = part
        .rehearses
        .as_deref()
        .filter(|_| record.outcome == Outcome::Completed)?;
    let stand_in = rehearsal::prediction(plan, record).ok()?;
    Some(DryRun::on(plan, &stand_in, told(plan, &stand_in)).prediction())
}

/// The description of the model.
fn told(plan: &Plan, stand_in: &Plan) -> String {
    let specimen = VirtualRig::specimen_of(stand_in);
    let storeys = specimen
        .and_then(|specimen| specimen.frame.as_ref())
        .map(Frame::degrees_of_freedom);
    let stiffness = specimen
        .and_then(|specimen| specimen.behaviour.as_ref())
        .map(Behaviour::initial_stiffness);
    let stiffness = stiffness.map_or_else(
        || "unknown".to_owned(),
        |stiffness| readable(stiffness, Dimension::STIFFNESS),
    );
    let noise = stand_in
        .rig
        .link
        .as_virtual()
        .map_or(0.0, |link| link.noise);
    let noise = readable(noise, Dimension::FORCE);
    let name = escape(&plan.rig.name);
    if let Some(storeys) = storeys {
        return format!(
            "rehearsal of the run on rig `{name}`, predicted on the {storeys} storeys of the plan, noise {noise}"
        );
    }
    format!(
        "rehearsal of the run on rig `{name}`, predicted on a virtual specimen as measured: stiffness {stiffness}, noise {noise}"
    )
}
