//! The results of an impact, and the observations on how it ended. In: its summary and history. Out: results in the order of the
//! reference. It moves nothing.

use super::summary::{FloorSummary, StruckSummary};
use crate::physics::contact::state::ContactLaw;
use crate::physics::impact::summary::ImpactSummary;
use crate::plan::Until;
use crate::procedures::stepping::energy;
use crate::procedures::stepping::tracking_summary::{Followed, tracking_results};
use crate::record::{EventKind, ImpactHistory, NamedResult, StruckFrame};
use crate::run::session::Session;
use crate::schema::ResultKind;
use crate::schema::procedures::impact as schema;
use crate::units::Dimension;
use crate::units::display::readable;

/// In the order of the reference; every number is missing if not even the start was read.
pub(crate) fn results(
    summary: Option<&StruckSummary>,
    followed: &Followed,
    history: &ImpactHistory,
) -> Vec<NamedResult> {
    let impact = summary.map(StruckSummary::impact);
    let mut results = of_impact(impact.as_ref(), history).to_vec();
    let tracking = history.steps.last().map(|last| last.tracking);
    results.extend(tracking_results(followed.worst(), tracking));
    results.extend(of_steps(history));
    if let Some(frame) = &history.frame {
        results.extend(of_frame(summary.and_then(StruckSummary::floors), frame));
        results.extend(followed.of_each());
    }
    results
}

/// Displacements, contact and energies.
fn of_impact(summary: Option<&ImpactSummary>, history: &ImpactHistory) -> [NamedResult; 16] {
    let peak = |kind: ResultKind, read: fn(&ImpactSummary) -> f64| kind.found(summary.map(read));
    let event = |kind: ResultKind, read: fn(&ImpactSummary) -> Option<f64>| {
        kind.found(summary.and_then(read))
    };
    let energies = history.steps.last().map(|last| last.energies);
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
    let contacts: fn(&ImpactSummary) -> f64 = |summary| summary.contacts as f64;
    [
        peak(schema::MAX_DISPLACEMENT, |it| it.max_displacement),
        peak(schema::TIME_OF_MAX_DISPLACEMENT, |it| {
            it.time_of_max_displacement
        }),
        event(schema::STOP_TIME, |it| it.stop_time),
        peak(schema::FINAL_DISPLACEMENT, |it| it.final_displacement),
        peak(schema::MAX_VELOCITY, |it| it.max_velocity),
        peak(schema::MAX_CONTACT_FORCE, |it| it.max_contact_force),
        peak(schema::IMPULSE, |it| it.impulse),
        peak(schema::CONTACTS, contacts),
        event(schema::RESTITUTION, |it| it.restitution),
        peak(schema::INDENTATION, |it| it.indentation),
        peak(schema::INDENTATION_ENERGY, |it| it.indentation_energy),
        peak(schema::ABSORBED_ENERGY, |it| it.absorbed_energy),
        schema::RESTORING_ENERGY.found(energies.map(|it| it.restoring)),
        schema::DAMPING_ENERGY.found(energies.map(|it| it.damping)),
        peak(schema::STRIKER_ENERGY, |it| it.striker_energy),
        peak(schema::ENERGY_ERROR, |it| it.energy_error),
    ]
}

/// Time steps, and how many.
fn of_steps(history: &ImpactHistory) -> [NamedResult; 3] {
    let known = |value: f64| (value > 0.0).then_some(value);
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
    let steps = history.steps.last().map(|last| last.step as f64);
    [
        schema::TIME_STEP.found(known(history.time_step)),
        schema::CRITICAL_TIME_STEP.found(known(history.critical_time_step)),
        schema::STEPS.found(steps),
    ]
}

/// Floors and storeys of a frame, and the striker on one of them.
fn of_frame(floors: Option<&FloorSummary>, frame: &StruckFrame) -> [NamedResult; 8] {
    let list = |kind: ResultKind, read: fn(&FloorSummary) -> &[f64]| {
        kind.found_list(floors.map(|floors| read(floors).to_vec()))
    };
    let periods = frame.modes.as_ref().map(|modes| modes.periods.clone());
    [
        schema::CONTACT_DURATION.found(floors.and_then(FloorSummary::contact_duration)),
        schema::REBOUND_VELOCITY.found(floors.and_then(FloorSummary::rebound_velocity)),
        list(schema::FLOOR_DISPLACEMENT, |it| &it.floor_displacement),
        list(schema::MAX_DRIFT, |it| &it.max_drift),
        list(schema::FINAL_DRIFT, |it| &it.drift),
        list(schema::STOREY_ENERGY, FloorSummary::storey_energy),
        schema::MAX_BASE_SHEAR.found(floors.and_then(FloorSummary::max_base_shear)),
        schema::PERIODS.found_list(periods),
    ]
}

/// Records the observations that a reader of the results needs on the end of the run.
pub(crate) fn observe(
    summary: &ImpactSummary,
    until: Until,
    law: &ContactLaw,
    session: &mut Session<'_>,
) {
    if until == Until::StrikerStop && summary.stop_time.is_none() {
        session.remark("the striker did not stop within the duration".to_owned());
    }
    if summary.still_rising {
        let text =
            "the structure was still moving on at the end: its largest displacement is not a peak";
        session.remark(text.to_owned());
    }
    energy::observe_imbalance(summary.energy_error, session);
    if let (ContactLaw::Limit { force }, true) = (law, summary.contacts > 0)
        && law.force_follows_the_step(summary.max_contact_force)
    {
        let limit = readable(*force, Dimension::FORCE);
        let text = format!(
            "the limit force {limit} was not reached: the largest contact force grows as the time step shrinks"
        );
        session.event(EventKind::Remark, text);
    }
    if summary.last_blow_cut {
        let text =
            "the striker stopped with a contact force in its last step: the last blow is cut";
        session.remark(text.to_owned());
    }
}
