//! The results of an impact, and the observations on how it ended. In: its summary and its history. Out: results in the order of the
//! reference. It moves nothing.

use super::summary::{FloorSummary, StruckSummary};
use crate::procedures::common::results::Evaluated;
use crate::procedures::frame::results::largest_forces;
use crate::procedures::stepping::energy;
use crate::procedures::stepping::tracking::{TrackingSummary, tracking_results};
use crate::run::session::Session;
use psd_physics::contact::ContactLaw;
use psd_physics::impact::energy::Energies;
use psd_physics::impact::summary::ImpactSummary;
use psd_physics::reintegration::impact::ImpactValues;
use psd_plan::Until;
use psd_plan::procedures::impact::block as schema;
use psd_plan::record::{EventKind, ImpactHistory, NamedResult, StruckFrame};
use psd_plan::schema::ResultKind;
use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// In the order of the reference; every number is missing if not even the start was read.
pub(crate) fn results(
    summary: Option<&StruckSummary>,
    followed: &TrackingSummary,
    history: &ImpactHistory,
) -> Vec<NamedResult> {
    let impact = summary.map(StruckSummary::impact);
    let found = |(kind, value): (&ResultKind, _)| kind.found(value);
    let mut results: Vec<_> = of_impact(impact.as_ref(), history).map(found).collect();
    let tracking = history.steps.last().map(|last| last.tracking);
    results.extend(tracking_results(followed.worst(), tracking));
    results.extend(of_steps(history).map(found));
    if let Some(frame) = &history.frame {
        let floors = summary.and_then(StruckSummary::floors);
        results.extend(of_frame(floors, frame));
        let forces = floors.and_then(|floors| largest_forces(&floors.element_force));
        results.extend(forces.map(|forces| schema::MAX_ELEMENT_FORCE.found_list(Some(forces))));
        results.extend(followed.of_each());
    }
    results
}

/// The value of a result of an impact, in a run and, if it has an uncertainty, in a re-integration of the run.
enum Value {
    /// Of the run alone.
    OfRun(fn(&ImpactSummary) -> Option<f64>),
    /// At the ends of steps, in both.
    AtSteps(fn(&ImpactSummary) -> Option<f64>),
    /// At the ends of steps in the run, interpolated between them in the re-integration.
    Between(fn(&ImpactSummary) -> Option<f64>, fn(&ImpactValues) -> f64),
    /// An energy at the last step of the run; in the re-integration at the end inside that step.
    Energy(fn(&Energies) -> f64, fn(&ImpactValues) -> f64),
}

/// Displacements, contact and energies: the results of an impact on any structure.
static OF_IMPACT: [(ResultKind, Value); 16] = [
    (
        schema::MAX_DISPLACEMENT,
        Value::Between(|it| Some(it.max_displacement), |it| it.max_displacement),
    ),
    (
        schema::TIME_OF_MAX_DISPLACEMENT,
        Value::Between(
            |it| Some(it.time_of_max_displacement),
            |it| it.time_of_max_displacement,
        ),
    ),
    (
        schema::STOP_TIME,
        Value::Between(|it| it.stop_time, |it| it.stop_time),
    ),
    (
        schema::FINAL_DISPLACEMENT,
        Value::Between(|it| Some(it.final_displacement), |it| it.final_displacement),
    ),
    (
        schema::MAX_VELOCITY,
        Value::AtSteps(|it| Some(it.max_velocity)),
    ),
    (
        schema::MAX_CONTACT_FORCE,
        Value::AtSteps(|it| Some(it.max_contact_force)),
    ),
    (schema::IMPULSE, Value::AtSteps(|it| Some(it.impulse))),
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
    (
        schema::CONTACTS,
        Value::OfRun(|it| Some(it.contacts as f64)),
    ),
    (schema::RESTITUTION, Value::AtSteps(|it| it.restitution)),
    (
        schema::INDENTATION,
        Value::AtSteps(|it| Some(it.indentation)),
    ),
    (
        schema::INDENTATION_ENERGY,
        Value::AtSteps(|it| Some(it.indentation_energy)),
    ),
    (
        schema::ABSORBED_ENERGY,
        Value::Between(|it| Some(it.absorbed_energy), |it| it.absorbed_energy),
    ),
    (
        schema::RESTORING_ENERGY,
        Value::Energy(|it| it.restoring, |it| it.restoring_energy),
    ),
    (
        schema::DAMPING_ENERGY,
        Value::Energy(|it| it.damping, |it| it.damping_energy),
    ),
    (
        schema::STRIKER_ENERGY,
        Value::AtSteps(|it| Some(it.striker_energy)),
    ),
    (
        schema::ENERGY_ERROR,
        Value::OfRun(|it| Some(it.energy_error)),
    ),
];

/// Displacements, contact and energies; an energy at the last step is missing without steps.
pub(super) fn of_impact(
    summary: Option<&ImpactSummary>,
    history: &ImpactHistory,
) -> impl Iterator<Item = (&'static ResultKind, Option<f64>)> {
    let energies = history.steps.last().map(|last| last.energies);
    OF_IMPACT.iter().map(move |(kind, value)| {
        let value = match value {
            Value::OfRun(read) | Value::AtSteps(read) | Value::Between(read, _) => {
                summary.and_then(read)
            }
            Value::Energy(read, _) => energies.as_ref().map(read),
        };
        (kind, value)
    })
}

/// The results of a re-integrated impact that have an uncertainty; NaN if a result does not exist.
pub(crate) fn re_integrated(values: &ImpactValues) -> Evaluated {
    let found = |(kind, value): &(ResultKind, Value)| {
        let number = match value {
            Value::OfRun(_) => return None,
            Value::AtSteps(read) => read(&values.summary).unwrap_or(f64::NAN),
            Value::Between(_, read) | Value::Energy(_, read) => read(values),
        };
        Some((*kind, vec![number]))
    };
    OF_IMPACT.iter().filter_map(found).collect()
}

/// Time steps, and how many.
pub(super) fn of_steps(history: &ImpactHistory) -> [(&'static ResultKind, Option<f64>); 3] {
    let known = |value: f64| (value > 0.0).then_some(value);
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STEPS")]
    let steps = history.steps.last().map(|last| last.step as f64);
    [
        (&schema::TIME_STEP, known(history.time_step)),
        (
            &schema::CRITICAL_TIME_STEP,
            known(history.critical_time_step),
        ),
        (&schema::STEPS, steps),
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

/// The contact was still active at the last step. The end condition `striker_stop` implies it.
pub(crate) const CUT: &str =
    "contact still active at the last step: contact duration and final impulse are lower bounds";

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
        let text = "maximum displacement not reached within the run: the structure was still moving outward";
        session.remark(text.to_owned());
    }
    energy::observe_imbalance(summary.energy_error, session);
    if let (ContactLaw::Limit { force }, true) = (law, summary.contacts > 0)
        && law.force_follows_the_step(summary.max_contact_force)
    {
        let limit = readable(*force, Dimension::FORCE);
        let text = format!(
            "limit force {limit} not reached: the largest contact force depends on the time step"
        );
        session.event(EventKind::Remark, text);
    }
    if summary.last_contact_cut {
        session.remark(CUT.to_owned());
    }
}
