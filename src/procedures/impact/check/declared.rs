//! The check of an impact against striker and specimen: its time step, its end, whether the striker arrives. In: an impact and the
//! declarations of the plan. Out: errors and warnings.

use crate::codes::W712;
use crate::procedures::common::violations::TooManyInProcedure;
use crate::procedures::stepping::check::frame_check::FrameSteps;
use crate::procedures::stepping::check::{
    beyond_duration, frame_check, integrator_check, mode_check,
};
use psd_language::check::checker::Checker;
use psd_language::check::declared::Declared;
use psd_language::check::violations::NoEffect;
use psd_physics::structure::frame_properties::FrameProperties;
use psd_plan::formula::{Formula, NoResults};
use psd_plan::procedures::impact::block as schema;
use psd_plan::schema::methods;
use psd_plan::{
    Contact, Frame, Impact, ImpactTarget, MOST_STEPS, PointTarget, Specimen, StoreyTarget, Striker,
    Until, steps_in,
};

use super::time_step::predicted_critical;
use super::{arrival, warnings};

/// The slowest striker must arrive, the time step must follow the fastest.
pub(crate) struct Strikers<'a> {
    pub slowest: &'a Striker,
    pub fastest: &'a Striker,
}

/// Judges an impact of its own striker.
pub(crate) fn with_its_striker(
    checker: &mut Checker,
    block: usize,
    impact: &Impact,
    declared: &Declared<'_>,
) {
    if let Some(striker) = declared.striker(impact.striker) {
        let strikers = Strikers {
            slowest: striker,
            fastest: striker,
        };
        check_declared(checker, block, impact, &strikers, declared);
    }
}

/// Judges an impact of these strikers.
pub(crate) fn check_declared(
    checker: &mut Checker,
    block: usize,
    impact: &Impact,
    strikers: &Strikers<'_>,
    declared: &Declared<'_>,
) {
    match &impact.target {
        ImpactTarget::Point(point) => {
            let specimen = declared.specimen(impact.specimen);
            on_point(checker, block, impact, point, strikers.fastest, specimen);
        }
        ImpactTarget::Storey(target) => {
            let Some(frame) = declared.frame(impact.specimen) else {
                return;
            };
            on_storey(checker, block, impact, target, frame, strikers.fastest);
        }
    }
    arrival::check(checker, block, strikers.slowest, impact.duration.constant());
}

/// An impact on one degree of freedom, as far as its quantities are known before the run; a stiffness that is yet to be measured is
/// predicted. Checks the number of steps, stability, the critical time step and the time step of a limit force.
fn on_point(
    checker: &mut Checker,
    block: usize,
    impact: &Impact,
    point: &PointTarget,
    striker: &Striker,
    specimen: Option<&Specimen>,
) {
    let critical =
        predicted_critical(checker, impact, striker, specimen).map(|(critical, _)| critical);
    let time_step = impact
        .stepping
        .time_step
        .evaluate(&NoResults, critical)
        .ok()
        .map(|step| step.value);
    if let (Some(time_step), Some(duration)) = (time_step, impact.duration.constant())
        && steps_in(duration, time_step) > MOST_STEPS
    {
        let at = checker.value_or_head(block, methods::DURATION.name);
        let steps = steps_in(duration, time_step);
        let help = "reduce `duration` or increase `time_step`";
        checker.report(TooManyInProcedure {
            what: "steps",
            found: steps,
            most: MOST_STEPS,
            span: at,
            help,
        });
        return;
    }
    returns(checker, block, impact.until, striker);
    beyond_duration(checker, block, time_step, impact.duration.constant());
    let before = checker.diagnostics.len();
    mode_check::damping_twice(checker, block, impact, point, specimen);
    integrator_check::stable(checker, block, impact, point, striker, specimen);
    let allowed = checker.diagnostics[before..]
        .iter()
        .any(|fault| fault.code == W712);
    warnings::time_step(checker, block, impact, striker, specimen, allowed);
    warnings::mechanism(checker, block, impact, specimen);
}

/// An impact on a floor, as far as its quantities are known before the run: the checks of any frame, and the time step of a limit
/// force.
fn on_storey(
    checker: &mut Checker,
    block: usize,
    impact: &Impact,
    target: &StoreyTarget,
    frame: &Frame,
    striker: &Striker,
) {
    returns(checker, block, impact.until, striker);
    let steps = FrameSteps {
        specimen: impact.specimen,
        frame,
        damping: &target.damping,
        stepping: &impact.stepping,
        duration: impact.duration.constant(),
    };
    let critical = |properties: &FrameProperties| {
        let approach = impact.approach(striker, Formula::constant);
        approach.map(|approach| properties.critical_on_impact(target.storey, &approach))
    };
    let Some((properties, step)) = frame_check::check(checker, block, &steps, critical) else {
        return;
    };
    if let Contact::Limit { force } = &impact.contact
        && let Some(force) = force.constant()
    {
        let at = checker.value_or_head(block, methods::TIME_STEP.name);
        warnings::limit_force(
            checker,
            step,
            at,
            properties.struck_mass(target.storey),
            force,
            striker,
        );
    }
}

/// Warns of a run that waits until the striker has finally separated: a falling striker always returns.
fn returns(checker: &mut Checker, block: usize, until: Until, striker: &Striker) {
    if let (Until::Rebound, true, Some((_, entry))) = (
        until,
        striker.gravity > 0.0,
        checker.field(block, schema::UNTIL.name),
    ) {
        let message = "`rebound` never ends this run: a falling striker always returns".to_owned();
        let help = "write `until = striker_stop` or `until = duration`, or remove `gravity`";
        checker.report(NoEffect {
            message,
            span: entry.value.span,
            label: "continues to its `duration`",
            help,
        });
    }
}
