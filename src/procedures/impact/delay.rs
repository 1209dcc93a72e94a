//! The delay of the actuators in an impact, before the run. In: the plan, the striker. Out: the delay; None where not enough is known.

use super::check::time_step::time_step_before_the_run;
use crate::plan::formula::Formula;
use crate::plan::{Escalate, Impact, ImpactTarget, Plan, PointTarget, StoreyTarget, Striker};
use crate::procedures::facts::Delay;
use crate::procedures::stepping::tracking::delay::{late, of_frame};

pub(crate) fn of_impact(plan: &Plan, impact: &Impact) -> Option<Delay> {
    with_striker(plan, impact, plan.strikers.get(impact.striker)?)
}

/// The delay in the fastest impact of a series.
pub(crate) fn of_series(plan: &Plan, series: &Escalate) -> Option<Delay> {
    let impact = &series.impact;
    let fastest = series.fastest(plan.strikers.get(impact.striker)?);
    with_striker(plan, impact, &fastest)
}

fn with_striker(plan: &Plan, impact: &Impact, striker: &Striker) -> Option<Delay> {
    match &impact.target {
        ImpactTarget::Point(point) => on_point(plan, impact, point, striker),
        ImpactTarget::Storey(storey) => on_storey(plan, impact, storey, striker),
    }
}

fn on_point(plan: &Plan, impact: &Impact, point: &PointTarget, striker: &Striker) -> Option<Delay> {
    let behaviour = plan.specimens.get(impact.specimen)?.behaviour.as_ref()?;
    // The stiffness from an earlier procedure is near the specimen's own.
    let stiffness = point
        .stiffness
        .constant()
        .unwrap_or_else(|| behaviour.initial_stiffness());
    let time_step = time_step_before_the_run(impact, striker)?;
    let late = late(plan, &impact.stepping, time_step);
    Some(Delay {
        late,
        time_step,
        omega: (stiffness / point.mass.constant()?).sqrt(),
    })
}

fn on_storey(
    plan: &Plan,
    impact: &Impact,
    target: &StoreyTarget,
    striker: &Striker,
) -> Option<Delay> {
    let approach = impact.approach(striker, Formula::constant)?;
    of_frame(
        plan,
        impact.specimen,
        &target.damping,
        &impact.stepping,
        |properties| Some(properties.critical_on_impact(target.storey, &approach)),
    )
}
