//! The facts about an impact that check and report need without running it. In: an impact of the plan, or its history. Out: facts, the
//! motion at its end, the parts of the program that it uses.

use super::check::time_step::time_step_before_the_run;
use super::{figures, report, results};
use crate::procedures::facts::{Delay, Facts, Listed, Motion, Recorded, Tests};
use crate::procedures::frame::charts::{entries_of, members_of};
use crate::procedures::stepping;
use crate::procedures::stepping::self_tested::stepped;
use crate::procedures::stepping::tracking::{delay as actuator_delay, frame_delay};
use psd_physics::self_test::SelfTestPart;
use psd_plan::formula::Formula;
use psd_plan::record::{Floors, ImpactHistory};
use psd_plan::{
    Dependence, Escalate, Impact, ImpactTarget, Plan, PointTarget, StoreyTarget, Striker, Until,
};

pub(crate) fn facts(impact: &Impact) -> Facts<'_> {
    let shared = Facts {
        stepping: Some(&impact.stepping),
        contact: Some(&impact.contact),
        implied: match impact.until {
            Until::StrikerStop => &[results::CUT],
            _ => &[],
        },
        ..Facts::default()
    };
    match &impact.target {
        ImpactTarget::Point(point) => Facts {
            dependence: Dependence {
                striker: Some(impact.striker),
                mass_uncertainty: Some(point.mass_uncertainty),
                frame: None,
            },
            figures: figures::FIGURES,
            shared_figures: figures::SHARED,
            ..shared
        },
        ImpactTarget::Storey(storey) => Facts {
            tests: Tests::Frame,
            frame_damping: Some((&storey.damping, storey.damping_uncertainty)),
            dependence: Dependence {
                striker: Some(impact.striker),
                mass_uncertainty: None,
                frame: Some(impact.specimen),
            },
            figures: figures::STOREY_FIGURES,
            ..shared
        },
    }
}

pub(crate) fn listed(impact: &Impact) -> Listed {
    let unprinted = report::unprinted(&impact.contact);
    match &impact.target {
        ImpactTarget::Point(point) => Listed {
            headline: report::headline(&impact.contact),
            unprinted: [unprinted, report::undamped(point)].concat(),
        },
        ImpactTarget::Storey(_) => Listed {
            headline: report::storey::HEADLINE.to_vec(),
            unprinted,
        },
    }
}

pub(crate) fn recorded(history: &ImpactHistory) -> Recorded {
    let ends = history.steps.first().zip(history.steps.last());
    let of_frame = history.frame.is_some();
    let floors = history
        .frame
        .as_ref()
        .and_then(|frame| frame.floors.first());
    let elements = floors.is_some_and(Floors::has_elements);
    Recorded {
        lists_are_tabled: of_frame,
        time_spans: ends
            .map(|(first, last)| (last.time - first.time, last.wall_time - first.wall_time)),
        budgeted: if of_frame {
            stepping::report::FRAME_BUDGET
        } else {
            report::BUDGET
        },
        uncertainty: stepping::report::UNCERTAINTY,
        entries: entries_of(elements),
        members: members_of(elements),
        ..Recorded::default()
    }
}

/// The state in which an impact leaves the specimen.
pub(crate) const PEAK: &str = "ends near its largest displacement";

/// The motion at the end of an impact. A frame comes to rest if the run continues for long enough.
pub(crate) fn motion(impact: &Impact) -> Motion<'static> {
    match &impact.target {
        ImpactTarget::Point(_) => Motion {
            what: "impact",
            ends: PEAK,
            help: "unload in between: `unload rest { }`",
            rests: false,
        },
        ImpactTarget::Storey(_) => Motion {
            what: "impact",
            ends: PEAK,
            help: "unload in between: `unload rest { }`; or let the frame come to rest: `until = duration`, with a `damping_ratio`",
            rests: impact.until == Until::Duration,
        },
    }
}

/// The parts of the self-test that an impact uses, each with the parts in combination with it.
pub(crate) fn self_tested(impact: &Impact) -> Vec<Vec<SelfTestPart>> {
    let of_frame = matches!(impact.target, ImpactTarget::Storey(_));
    let [point, storey] = impact.contact.self_tested();
    let law = if of_frame { storey } else { point };
    stepped(&impact.stepping, of_frame, Some(law))
}

/// The delay of the actuators in an impact, before the run; None where not enough is known.
pub(crate) fn delay(plan: &Plan, impact: &Impact) -> Option<Delay> {
    with_striker(plan, impact, plan.strikers.get(impact.striker)?)
}

/// The delay in the fastest impact of a series.
pub(crate) fn delay_in_series(plan: &Plan, series: &Escalate) -> Option<Delay> {
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
    let late = actuator_delay(plan, &impact.stepping, time_step);
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
    frame_delay(
        plan,
        impact.specimen,
        &target.damping,
        &impact.stepping,
        |properties| Some(properties.critical_on_impact(target.storey, &approach)),
    )
}
