//! The energy error of tracking in `psd check --explain`: that of a dry run on the lagging rig. In: a plan. Out: rows of text.

use psd::run::{self, Keep, Unwatched};
use psd_plan::record::{Outcome, Record};
use psd_plan::schema::procedures::tracking::TRACKING_ENERGY_ERROR;
use psd_plan::{Link, Plan, VirtualLink};
use psd_rig::virtual_rig;
use psd_text::units::display::significant;

/// A dry run on a rig with the lag and undershoot of the plan's rig, and no other error; None if the rig has neither.
pub(crate) fn lagging(plan: &Plan) -> Option<Record> {
    let Link::Virtual(VirtualLink {
        lag,
        tracking,
        seed,
        ..
    }) = plan.rig.link
    else {
        return None;
    };
    if lag <= 0.0 && tracking == 0.0 {
        return None;
    }
    let mut lagging = plan.clone();
    lagging.rig.link = Link::Virtual(VirtualLink {
        lag,
        tracking,
        seed,
        ..VirtualLink::default()
    });
    Some(run::run_with(
        &lagging,
        &mut *virtual_rig(&lagging),
        &mut Unwatched,
        Keep::Steps,
    ))
}

/// The energy that tracking errors add to or remove from a procedure of the lagging dry run.
pub(crate) fn energy(lagging: Option<&Record>, procedure: usize) -> Vec<Vec<String>> {
    let Some((lagging, found)) =
        lagging.and_then(|run| Some((run, run.procedures.get(procedure)?)))
    else {
        return Vec::new();
    };
    let Some(share) = found.number(TRACKING_ENERGY_ERROR.name) else {
        return Vec::new();
    };
    let does = if share < 0.0 { "put in" } else { "taken out" };
    let held = match &lagging.outcome {
        Outcome::Completed => String::new(),
        _ if found.complete => String::new(),
        _ => "; the run is stopped".to_owned(),
    };
    let share = significant(100.0 * share.abs(), 2);
    vec![vec![
        "energy by tracking".to_owned(),
        format!("up to {share} % of the input {does}{held}"),
    ]]
}
