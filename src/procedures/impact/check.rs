//! `impact NAME { … }`

use super::storey_check;
use crate::language::check::checker::{Checker, Context};
use crate::language::check::declarations::specimen;
use crate::language::check::expressions::choice::Chosen;
use crate::language::check::expressions::fields::whole;
use crate::language::check::messages::values;
use crate::plan::formula::{Formula, NoResults, Part, ResultReference, ResultValue, Results};
use crate::plan::{
    Contact, Impact, InspectTrigger, MOST_STEPS, ProcedureKind, Specimen, Striker, Until, steps_in,
};
use crate::procedures::impact::warnings;
use crate::procedures::stepping;
use crate::procedures::stepping::{integrator_check, mode_check};
use crate::schema::Kind;
use crate::text::diagnostic::Code;

/// The step of a blow that names none: the critical one over this.
pub const FINER: f64 = 20.0;

pub fn impact(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    match storey_check::struck_frame(checker, block) {
        Some((specimen, frame)) => {
            storey_check::storey_impact(checker, block, specimen, frame.as_ref())
                .map(ProcedureKind::StoreyImpact)
        }
        None => blow(checker, block).map(ProcedureKind::Impact),
    }
}

/// What the fields of an impact say, in whatever block they stand.
pub fn blow(checker: &mut Checker, block: usize) -> Option<Impact> {
    let head = checker.scope.blocks[block].block.head;
    let striker = checker.reference(block, "striker", Kind::Striker);
    let specimen_block = checker.specimen_block(block);
    let no_frame = storey_check::no_frame(checker, block, specimen_block);
    let mass = match checker.field(block, "mass") {
        Some(_) => checker.quantity(block, "mass"),
        None => specimen_block
            .and_then(|tested| specimen::export(checker, tested, "mass", head))
            .map(Formula::Constant),
    };
    let mass_uncertainty = match checker.field(block, "mass") {
        Some(_) => Some(0.0),
        None => specimen_block.and_then(|tested| specimen::mass_uncertainty(checker, tested)),
    };
    let stiffness = checker.stiffness_or_specimens(block, specimen_block);
    let damping = checker.quantity(block, "damping");
    let contact = contact(checker, block);
    let stepping = stepping::check::stepping(checker, block, contact.as_ref(), FINER);
    let duration = checker.quantity(block, "duration");
    let until = until(checker, block);
    let impact = Impact {
        specimen: checker.scope.index_in_kind(specimen_block?),
        striker: checker.scope.index_in_kind(striker?),
        mass: mass?,
        mass_uncertainty: mass_uncertainty?,
        stiffness: stiffness?,
        damping: damping?,
        contact: contact?,
        stepping: stepping?,
        duration: duration?,
        until: until?,
    };
    no_frame?;
    integrator_check::meets_the_contact(
        checker,
        block,
        impact.stepping.integrator,
        &impact.contact,
    )?;
    Some(impact)
}

pub fn until(checker: &mut Checker, block: usize) -> Option<Until> {
    Some(match checker.word(block, "until", "striker_stop")? {
        "duration" => Until::Duration,
        "rebound" => Until::Rebound,
        _ => Until::StrikerStop,
    })
}

/// What the steps of a blow of this striker (of several, of the fastest) must be held against, as far as they are known before
/// the run, a stiffness that is yet to be measured as it is foreseen: their number, stability, the critical step, what a limit force needs.
pub fn judge(
    checker: &mut Checker,
    block: usize,
    impact: &Impact,
    striker: &Striker,
    specimen: Option<&Specimen>,
) {
    let critical =
        critical_foreseen(checker, impact, striker, specimen).map(|(critical, _)| critical);
    let time_step = impact
        .stepping
        .time_step
        .evaluate(&NoResults, critical)
        .ok()
        .map(|step| step.value);
    if let (Some(time_step), Some(duration)) = (time_step, impact.duration.constant())
        && steps_in(duration, time_step) > MOST_STEPS
    {
        let head = checker.scope.blocks[block].block.head;
        let at = checker
            .field(block, "duration")
            .map_or(head, |(_, entry)| entry.value.span);
        let steps = steps_in(duration, time_step);
        let help = "shorten `duration` or take a longer `time_step`";
        checker
            .diagnostics
            .push(values::too_many("steps", steps, MOST_STEPS, at, help));
        return;
    }
    returns(checker, block, impact.until, striker);
    beyond_duration(checker, block, time_step, impact.duration.constant());
    let before = checker.diagnostics.len();
    mode_check::damping_twice(checker, block, impact, specimen);
    integrator_check::stable(checker, block, impact, striker, specimen);
    let allowed = checker.diagnostics[before..]
        .iter()
        .any(|fault| fault.code == Code::BeyondStability);
    warnings::impact(checker, block, impact, striker, specimen, allowed);
    warnings::mechanism(checker, block, impact, specimen);
}

/// A step that is longer than the run is no step of it.
pub fn beyond_duration(
    checker: &mut Checker,
    block: usize,
    step: Option<f64>,
    duration: Option<f64>,
) {
    let Some((step, duration)) = step
        .zip(duration)
        .filter(|(step, duration)| step > duration)
    else {
        return;
    };
    let head = checker.scope.blocks[block].block.head;
    let at = |field| {
        checker
            .field(block, field)
            .map_or(head, |(_, entry)| entry.value.span)
    };
    checker.diagnostics.push(values::step_beyond_duration(
        at("time_step"),
        step,
        at("duration"),
        duration,
    ));
}

/// A run that waits for a striker to have left for good, which one that falls never has.
pub fn returns(checker: &mut Checker, block: usize, until: Until, striker: &Striker) {
    if let (Until::Rebound, true, Some((_, entry))) =
        (until, striker.gravity > 0.0, checker.field(block, "until"))
    {
        let message =
            "a striker that falls always comes back: `rebound` never ends this run".to_owned();
        let help = "write `until = striker_stop` or `until = duration`, or leave `gravity` out";
        checker.diagnostics.push(values::no_effect(
            message,
            entry.value.span,
            "goes on to its `duration`",
            help,
        ));
    }
}

/// Δtc of a blow of this striker, where all that it needs is known before the run.
pub fn critical_before_the_run(impact: &Impact, striker: &Striker) -> Option<f64> {
    impact.critical_time_step(striker, Formula::constant)
}

/// The same as it is foreseen: a stiffness that an earlier procedure is to measure is taken for the one with which the specimen of
/// a virtual rig begins. Whether it is a foreseen one, too.
pub fn critical_foreseen(
    checker: &Checker,
    impact: &Impact,
    striker: &Striker,
    specimen: Option<&Specimen>,
) -> Option<(f64, bool)> {
    if let Some(critical) = critical_before_the_run(impact, striker) {
        return Some((critical, false));
    }
    let behaviour = specimen
        .filter(|_| checker.real_rig.is_none())?
        .behaviour
        .as_ref()?;
    let foreseen = Foreseen {
        stiffness: behaviour.initial_stiffness(),
    };
    let known = |formula: &Formula| {
        formula
            .evaluate(&foreseen, None)
            .ok()
            .map(|estimate| estimate.value)
    };
    Some((impact.critical_time_step(striker, known)?, true))
}

/// What ramps and cycles will find of a specimen that is declared.
struct Foreseen {
    /// N/m
    stiffness: f64,
}

impl Results for Foreseen {
    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        let found = matches!(reference.name, "stiffness" | "secant_stiffness")
            && reference.part == Part::Value;
        found.then_some(ResultValue::Number {
            value: Some(self.stiffness),
            uncertainty: None,
        })
    }
}

/// Δt, where it is known before the run.
pub fn time_step_before_the_run(impact: &Impact, striker: &Striker) -> Option<f64> {
    let critical = critical_before_the_run(impact, striker);
    impact
        .stepping
        .time_step
        .evaluate(&NoResults, critical)
        .ok()
        .map(|estimate| estimate.value)
}

pub fn contact(checker: &mut Checker, block: usize) -> Option<Contact> {
    let Some((entry, _)) = checker.field(block, "contact") else {
        return Some(Contact::Rigid);
    };
    let place = checker.context_of(block, entry);
    let chosen = checker.choice(block, "contact")?;
    Some(match chosen.variant.name {
        "limit" => Contact::Limit {
            force: checker.argument(&chosen, "force", place)?,
        },
        "restitution" => Contact::Restitution {
            coefficient: checker.argument(&chosen, "coefficient", place)?,
        },
        "hertz" => {
            let stiffness = checker.argument(&chosen, "stiffness", place);
            let loss = checker.argument(&chosen, "loss", place);
            let force_limit = match chosen.find("force_limit") {
                Some((_, Some(_))) => checker.argument(&chosen, "force_limit", place).map(Some),
                _ => Some(None),
            };
            Contact::Hertz {
                stiffness: stiffness?,
                loss: loss?,
                force_limit: force_limit?,
            }
        }
        _ => Contact::Rigid,
    })
}

pub fn triggers(checker: &mut Checker, block: usize) -> Option<Vec<InspectTrigger>> {
    let Some((entry, _)) = checker.field(block, "inspect") else {
        return Some(Vec::new());
    };
    let place = checker.context_of(block, entry);
    let chosen = checker.choices(block, "inspect")?;
    let triggers: Vec<Option<InspectTrigger>> = chosen
        .iter()
        .map(|chosen| trigger(checker, chosen, place))
        .collect();
    triggers.into_iter().collect()
}

fn trigger<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    place: Context,
) -> Option<InspectTrigger> {
    Some(match chosen.variant.name {
        "every" => InspectTrigger::Every(
            checker
                .constant_argument(chosen, "steps", place)
                .and_then(whole)?,
        ),
        "force_drop" => {
            InspectTrigger::ForceDrop(checker.constant_argument(chosen, "fraction", place)?)
        }
        _ => InspectTrigger::At(checker.constant_argument(chosen, "time", place)?),
    })
}
