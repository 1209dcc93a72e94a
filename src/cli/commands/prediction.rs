//! The prediction of a whole run from the run log of its low-level check run. In: the checked part of a plan and its record. Out: the
//! prediction, from a dry run on a simulated specimen with the measured properties.

use super::explain_plan::DryRun;
use psd::report::Prediction;
use psd::run::check_run;
use psd_plan::record::{Outcome, Record};
use psd_plan::{Behaviour, Frame, Plan};
use psd_rig::VirtualRig;
use psd_text::diagnostic::excerpt::escape;
use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// The prediction of the whole run from the record of its low-level check run alone. None if the record is of a different kind, or if the
/// check run is not complete.
pub fn prediction(part: &Plan, record: &Record) -> Option<Prediction> {
    let plan = part
        .check_run_of
        .as_deref()
        .filter(|_| record.outcome == Outcome::Completed)?;
    let stand_in = check_run::prediction(plan, record).ok()?;
    Some(DryRun::on(plan, &stand_in, rig_and_specimen(plan, &stand_in)).prediction())
}

/// Description of the rig and specimen of the prediction.
pub fn rig_and_specimen(plan: &Plan, stand_in: &Plan) -> String {
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
            "check run on rig `{name}`, predicted with the {storeys} storeys of the plan, noise {noise}"
        );
    }
    format!(
        "check run on rig `{name}`, predicted with a virtual specimen as measured: stiffness {stiffness}, noise {noise}"
    )
}
