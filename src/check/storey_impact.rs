//! `impact NAME { storey = 2 … }`: a striker on one floor of a frame. In: a block whose specimen is a frame. Out: the impact,
//! and what its time step must be held against.

use std::rc::Rc;

use super::checker::Checker;
use super::faults::{frames as fault, methods, values, whole};
use super::fields::whole as whole_number;
use super::{frame, impact, integrator, mode, shake, warnings};
use crate::formula::NoResults;
use crate::mechanics::frame_properties::{Approach, FrameProperties};
use crate::plan::{Contact, Frame, MOST_STEPS, Mode, ProcedureKind, ShakeDamping, StoreyImpact, Striker};
use crate::schema::Kind;

/// The frame that a block strikes one storey of; None where it strikes one degree of freedom, or nothing that is known.
pub fn struck_frame(checker: &mut Checker, block: usize) -> Option<(usize, Option<Rc<Frame>>)> {
    let known = checker.faults.len();
    let specimen = checker.specimen_block(block);
    // Whoever reads the block says what is wrong with its specimen.
    checker.faults.truncate(known);
    let specimen = specimen.filter(|specimen| frame::is_frame(checker, *specimen))?;
    let frame = frame::frame(checker, specimen);
    let several = frame.as_ref().is_none_or(|frame| frame.degrees_of_freedom() > 1);
    (several || checker.given(block, "storey").is_some()).then_some((specimen, frame))
}

pub fn storey_impact(checker: &mut Checker, block: usize, specimen: usize, frame: Option<&Rc<Frame>>) -> Option<ProcedureKind> {
    let striker = checker.reference(block, "striker", Kind::Striker);
    // Named or the only one: what is wrong with the name was not said before.
    let named = checker.specimen_block(block);
    let struck = storey(checker, block, specimen, frame);
    let own = [
        ("mass", "remove it: the storeys of the frame have masses of their own"),
        ("stiffness", "remove it: the storeys of the frame have stiffnesses of their own"),
        ("damping", "write `damping_ratio = 2 %`: damping of the frame's modes"),
    ];
    let mut foreign = false;
    for (field, help) in own {
        if let Some((_, entry)) = checker.given(block, field) {
            let at = entry.key.span;
            checker.faults.push(fault::no_use_on_a_frame(field, at, help));
            foreign = true;
        }
    }
    let damping = shake::damping(checker, block);
    let damping_uncertainty = shake::damping_uncertainty(checker, block, damping.as_ref());
    let contact = impact::contact(checker, block);
    let mode = mode::mode(checker, block);
    let integrator = integrator::integrator(checker, block, mode, contact.as_ref());
    let allow_unstable = checker.word(block, "allow_unstable", "false").map(|word| word == "true");
    let unsaid = if matches!(mode, Some(Mode::Continuous { .. })) { "true" } else { "false" };
    let i_modification = checker.word(block, "i_modification", unsaid).map(|word| word == "true");
    let time_step = match checker.given(block, "time_step") {
        Some(_) => checker.quantity(block, "time_step"),
        None => Some(impact::twentieth_of_critical()),
    };
    let duration = checker.quantity(block, "duration");
    let until = impact::until(checker, block);
    let pause = checker.quantity(block, "pause");
    let max_tangent_ratio = checker.quantity(block, "max_tangent_ratio");
    let inspect = impact::triggers(checker, block);
    if foreign {
        return None;
    }
    let impact = StoreyImpact {
        specimen: checker.scope.place_in_kind(named?),
        striker: checker.scope.place_in_kind(striker?),
        struck: struck?,
        damping: damping?,
        damping_uncertainty: damping_uncertainty?,
        contact: contact?,
        integrator: integrator?,
        allow_unstable: allow_unstable?,
        i_modification: i_modification?,
        mode: mode?,
        time_step: time_step?,
        duration: duration?,
        until: until?,
        pause: pause?,
        max_tangent_ratio: max_tangent_ratio?,
        inspect: inspect?,
    };
    integrator::meets_the_contact(checker, block, impact.integrator, &impact.contact)?;
    Some(ProcedureKind::StoreyImpact(impact))
}

/// The struck floor, from 0.
fn storey(checker: &mut Checker, block: usize, specimen: usize, frame: Option<&Rc<Frame>>) -> Option<usize> {
    let (head, tested) = (checker.scope.blocks[block].block.head, &checker.scope.blocks[specimen]);
    let (name, declared) = (tested.name.map_or("", |name| name.node.as_str()), tested.block.head);
    let storeys = frame.map(|frame| frame.degrees_of_freedom());
    let Some((_, entry)) = checker.given(block, "storey") else {
        return checker.fail(fault::which_storey(name, storeys?, head, declared));
    };
    let at = entry.value.span;
    let storey = whole_number(checker.constant(block, "storey")?)?;
    let storey = usize::try_from(storey).ok()?;
    if storey > storeys? {
        return checker.fail(fault::no_such_storey(name, storeys?, at, declared));
    }
    storey.checked_sub(1)
}

/// What is known of a blow before the run: the striker as it meets the floor, under this law.
fn approach(impact: &StoreyImpact, striker: &Striker) -> Option<Approach> {
    let hertz = match &impact.contact {
        Contact::Hertz { stiffness, .. } => Some(stiffness.constant()?),
        _ => None,
    };
    Some(Approach::of(striker, hertz))
}

/// What the time step must be held against, as far as it is known before the run: the shortest period, stability, what a
/// limit force needs, the number of steps.
pub fn judge(checker: &mut Checker, block: usize, impact: &StoreyImpact, frame: &Frame, striker: &Striker) {
    let head = checker.scope.blocks[block].block.head;
    mode::storeys_damped_twice(checker, block, (impact.specimen, impact.mode, &impact.damping), frame);
    let at = |checker: &Checker, field| checker.given(block, field).map_or(head, |(_, entry)| entry.value.span);
    let Some(damping) = impact.damping.known() else { return };
    let ratios = at(checker, "damping_ratio");
    if let ShakeDamping::Modal(given) = &impact.damping
        && given.len() != frame.degrees_of_freedom()
    {
        checker.faults.push(fault::damping_ratios(given.len(), frame.degrees_of_freedom(), ratios));
        return;
    }
    let properties = match FrameProperties::of(frame, &damping) {
        Ok(properties) => properties,
        Err(reason) => {
            checker.faults.push(fault::damping_impossible(&reason.to_string(), ratios));
            return;
        }
    };
    let critical = approach(impact, striker).map(|approach| properties.critical_on_impact(impact.struck, &approach));
    let Ok(step) = impact.time_step.evaluate(&NoResults, critical).map(|estimate| estimate.value) else { return };
    let step_at = at(checker, "time_step");
    let behaves = if checker.real_rig.is_some() { None } else { Some(frame) };
    let limit = properties.longest_stable_step(impact.integrator, behaves);
    if step > limit {
        checker.faults.push(if impact.allow_unstable {
            fault::unstable_though(step_at, step, limit)
        } else {
            methods::unstable(step_at, impact.integrator, step, limit)
        });
        return;
    }
    if let Some(critical) = critical.filter(|critical| step > *critical) {
        checker.faults.push(whole::step_above_critical(step_at, step, critical));
    }
    if let Contact::Limit { force } = &impact.contact
        && let Some(force) = force.constant()
    {
        warnings::limit_force(checker, step_at, step, (properties.struck_mass(impact.struck), force), striker);
    }
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STOREYS")]
    let rows = impact.duration.constant().map(|duration| (duration / step).ceil() * frame.degrees_of_freedom() as f64);
    if let Some(rows) = rows.filter(|rows| *rows > MOST_STEPS) {
        let help = "shorten `duration` or take a longer `time_step`";
        checker.faults.push(values::too_many("steps of its storeys", rows, MOST_STEPS, at(checker, "duration"), help));
    }
}

/// In an impact on one degree of freedom: what only a frame has.
pub fn no_frame(checker: &mut Checker, block: usize, specimen: Option<usize>) -> Option<()> {
    let mut sound = Some(());
    let hints = [
        ("damping_ratio", "write `damping = 50 N*s/m`"),
        ("damping_ratio_uncertainty", "remove it: the modes of a frame have damping ratios"),
    ];
    for (field, hint) in hints {
        if let Some((_, entry)) = checker.given(block, field) {
            let at = entry.key.span;
            sound = checker.fail(fault::of_a_frame_only(field, at, hint));
        }
    }
    if let (Some((_, entry)), Some(specimen)) = (checker.given(block, "storey"), specimen) {
        let (at, tested) = (entry.key.span, &checker.scope.blocks[specimen]);
        let (name, declared) = (tested.name.map_or("", |name| name.node.as_str()), tested.block.head);
        sound = checker.fail(fault::storey_of_none(name, at, declared));
    }
    sound
}
